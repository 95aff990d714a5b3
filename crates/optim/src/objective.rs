//! What is made small: the largest energy of the primary structure as a function of the damper's design.

use crate::band::Band;
use crate::goal::{Evaluation, Frequencies, Goal, Term, When};
use retune_model::{Damper, NonNegative, OutOfRange, Scene, Worst};
use retune_solver::{Settings, SolverError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use thiserror::Error;

/// A parameter of the damper that a search may vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub enum Variable {
    /// k2, stiffness of the damper's spring, N/m.
    #[serde(rename = "k2")]
    K2,
    /// c2, damping between damper and primary structure, N·s/m.
    #[serde(rename = "c2")]
    C2,
    /// D, distance between the damper at rest and the primary structure, m.
    D,
    /// C, clearance between the damper at rest and the obstacle, m.
    C,
}

impl Variable {
    /// All of them, in the order of the paper's tables.
    pub const ALL: [Self; 4] = [Self::K2, Self::C2, Self::D, Self::C];

    /// The paper's symbol.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::K2 => "k2",
            Self::C2 => "c2",
            Self::D => "D",
            Self::C => "C",
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::K2 => "N/m",
            Self::C2 => "N·s/m",
            Self::D | Self::C => "m",
        }
    }

    /// Its value in `damper`.
    pub const fn get(self, damper: &Damper) -> f64 {
        match self {
            Self::K2 => damper.stiffness.get(),
            Self::C2 => damper.damping.get(),
            Self::D => damper.rest_distance.get(),
            Self::C => damper.clearance.get(),
        }
    }

    /// Gives it a value in `damper`.
    ///
    /// # Errors
    /// A value that no damper can have; `damper` is then unchanged.
    pub fn set(self, damper: &mut Damper, value: f64) -> Result<(), OutOfRange> {
        let value = NonNegative::new(value)?;
        match self {
            Self::K2 => damper.stiffness = value,
            Self::C2 => damper.damping = value,
            Self::D => damper.rest_distance = value,
            Self::C => damper.clearance = value,
        }
        Ok(())
    }
}

impl std::fmt::Display for Variable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.symbol())
    }
}

/// Why a design has no value.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Unusable {
    /// A parameter that no damper can have.
    #[error("{variable}: {source}")]
    OutOfRange {
        /// The parameter.
        variable: Variable,
        /// Its value and what is allowed.
        source: OutOfRange,
    },
    /// A stiffness that no structure can have.
    #[error("k1: {0}")]
    Stiffness(OutOfRange),
    /// A member of an ensemble with a parameter out of its range.
    #[error("a member of the ensemble: {0}")]
    Member(OutOfRange),
    /// A frequency that no force can have.
    #[error("omega: {0}")]
    Frequency(OutOfRange),
    /// The run could not be finished.
    #[error(transparent)]
    Run(#[from] SolverError),
    /// The steady motion reaches a wall, so that it is not linear.
    #[error(
        "the damper reaches a wall: its steady stroke at omega = {omega} rad/s is {stroke} m, of which D and C leave {room} m; \
         widen them, or look at a window of time instead of the steady response"
    )]
    Touches {
        /// Where the stroke is largest, rad/s.
        omega: f64,
        /// The stroke without walls, m.
        stroke: f64,
        /// The smaller of D and C, m.
        room: f64,
    },
}

/// E1max of a scene, J, and the ω at which it is: at the scene's own, or the worst over `band`. Any value above `cutoff` as
/// soon as it is known to be above; see [`Goal::evaluate`].
///
/// # Errors
/// A run could not be finished, or the damper of a steady motion reaches a wall.
pub fn e1_max(
    scene: &Scene,
    when: When,
    band: Option<Band>,
    settings: &Settings,
    cutoff: f64,
) -> Result<Worst, Unusable> {
    let term = Term { omega: band.map(Frequencies::from), ..Term::new(when) };
    let Evaluation { value, worst, .. } = Goal::one(term).evaluate(scene, settings, cutoff)?;
    Ok(Worst { value, frequency: worst.scene.forcing.frequency.get() })
}

/// The designs that could not be evaluated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Failures {
    /// How many evaluations failed.
    pub count: u64,
    /// One of them with its reason: the lowest in lexicographic order of the parameters, so that the choice does not depend on
    /// which thread failed first.
    pub example: Option<Box<(Vec<f64>, Unusable)>>,
}

/// How many designs were looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Values asked for.
    pub evaluations: u64,
    /// Of these, values of designs that were found to break a limit. One that was given up as too energetic before that is
    /// not among them.
    pub infeasible: u64,
}

/// The goal of a search as a function of a design: a value for each varied parameter of the damper. It may be shared by threads.
///
/// A design that cannot be evaluated counts as +∞, and is kept in [`Self::failures`].
#[derive(Debug)]
pub struct PeakEnergy {
    scene: Scene,
    damper: Damper,
    variables: Vec<Variable>,
    goal: Goal,
    settings: Settings,
    failures: Mutex<Failures>,
    counts: [AtomicU64; 2],
}

impl PeakEnergy {
    /// The objective over `variables` of `damper`, hung on the structure of `scene` in the place of its own, if any.
    pub fn new(
        scene: Scene,
        damper: Damper,
        variables: Vec<Variable>,
        when: impl Into<When>,
        settings: Settings,
    ) -> Self {
        let goal = Goal::one(Term::new(when));
        let (failures, counts) = Default::default();
        Self { scene, damper, variables, goal, settings, failures, counts }
    }

    /// The same for another goal.
    #[must_use]
    pub fn with(self, goal: Goal) -> Self {
        Self { goal, ..self }
    }

    /// What is made small.
    pub fn goal(&self) -> &Goal {
        &self.goal
    }

    /// The varied parameters, in the order of a design.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The damper of `design`: one value for each of [`Self::variables`], SI units; the rest as given at first.
    ///
    /// # Errors
    /// A value that no damper can have.
    pub fn damper(&self, design: &[f64]) -> Result<Damper, Unusable> {
        let mut damper = self.damper;
        for (&variable, &value) in self.variables.iter().zip(design) {
            variable.set(&mut damper, value).map_err(|source| Unusable::OutOfRange { variable, source })?;
        }
        Ok(damper)
    }

    /// The scene of `design`.
    ///
    /// # Errors
    /// A value that no damper can have.
    pub fn scene(&self, design: &[f64]) -> Result<Scene, Unusable> {
        Ok(Scene { damper: Some(self.damper(design)?), ..self.scene })
    }

    /// What searches make small: the goal's energy of `design`, J, or above [`INFEASIBLE`](crate::INFEASIBLE) if it breaks a
    /// limit; any number above `cutoff` as soon as it is known to be above; +∞ where there is none.
    pub fn value(&self, design: &[f64], cutoff: f64) -> f64 {
        self.counts[0].fetch_add(1, Relaxed);
        match self.scene(design).and_then(|scene| self.evaluate(&scene, cutoff)) {
            Ok(found) => {
                self.counts[1].fetch_add(u64::from(found.violation > 0.0), Relaxed);
                found.value
            }
            Err(reason) => {
                self.note(design, reason);
                f64::INFINITY
            }
        }
    }

    /// Takes note of a value that [`Self::value`] gave in an earlier run of the same search, so that [`Self::counts`] are those of an
    /// unbroken one.
    pub fn recall(&self, value: f64) {
        self.counts[0].fetch_add(1, Relaxed);
        self.counts[1].fetch_add(u64::from(value > crate::INFEASIBLE), Relaxed);
    }

    /// The value of a scene as this objective takes it, and what it was made of; see [`Goal::evaluate`].
    ///
    /// # Errors
    /// As [`Goal::evaluate`].
    pub fn evaluate(&self, scene: &Scene, cutoff: f64) -> Result<Evaluation, Unusable> {
        self.goal.evaluate(scene, &self.settings, cutoff)
    }

    /// The evaluations that failed so far.
    pub fn failures(&self) -> Failures {
        self.failures.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How many designs were looked at so far.
    pub fn counts(&self) -> Counts {
        let [evaluations, infeasible] = [0, 1].map(|i| self.counts[i].load(Relaxed));
        Counts { evaluations, infeasible }
    }

    fn note(&self, design: &[f64], reason: Unusable) {
        let mut failures = self.failures.lock().unwrap_or_else(PoisonError::into_inner);
        failures.count += 1;
        if failures.example.as_ref().is_none_or(|lowest| design < lowest.0.as_slice()) {
            failures.example = Some(Box::new((design.to_vec(), reason)));
        }
    }
}
