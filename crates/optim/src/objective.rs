//! What is made small: the largest energy of the primary structure as a function of the damper's design.

use crate::band::{Band, worst_over};
use retune_model::{Bare, Coupled, Damper, NonNegative, OutOfRange, Scene, Worst};
use retune_solver::{Settings, SolverError, Window};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
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

/// When E1max is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// In a window of a run from rest.
    Window(Window),
    /// Once all transients have died, in closed form: for scenes without contacts only.
    Steady,
}

impl From<Window> for When {
    fn from(window: Window) -> Self {
        Self::Window(window)
    }
}

/// E1max of a scene, J, and the ω at which it is: at the scene's own, or the worst over `band`. Any value above `cutoff` as
/// soon as it is known to be above.
///
/// In a window it comes from runs ([`worst_over`]); the steady one is exact over the whole band ([`Coupled::steady_e1_max`]).
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
    let own = scene.forcing.frequency.get();
    let Scene { primary, forcing, damper } = scene;
    match when {
        When::Window(window) => {
            let run = |omega: f64| -> Result<f64, Unusable> {
                let mut scene = *scene;
                scene.forcing.frequency = NonNegative::new(omega).map_err(Unusable::Frequency)?;
                Ok(retune_solver::e1_max(&scene, window, settings, cutoff)?.value)
            };
            match band {
                Some(band) => worst_over(&band, run, cutoff),
                None => Ok(Worst { value: run(own)?, frequency: own }),
            }
        }
        When::Steady => {
            let band = band.map_or([own; 2], |band| [band.from, band.to]);
            let Some(damper) = damper else { return Ok(Bare::new(primary, forcing).steady_e1_max(band)) };
            let system = Coupled::new(primary, forcing, damper);
            let Worst { value: stroke, frequency: omega } = system.steady_stroke_max(band);
            let room = damper.rest_distance.get().min(damper.clearance.get());
            if stroke < room {
                Ok(system.steady_e1_max(band))
            } else {
                Err(Unusable::Touches { omega, stroke, room })
            }
        }
    }
}

/// The designs that could not be evaluated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Failures {
    /// How many evaluations failed.
    pub count: u64,
    /// One of them with its reason: the lowest in lexicographic order of the parameters, so that the choice does not depend on
    /// which thread failed first.
    pub example: Option<(Vec<f64>, Unusable)>,
}

/// E1max, J, of a scene whose damper is varied. It may be shared by threads.
///
/// A design that cannot be evaluated counts as +∞, and is kept in [`Self::failures`].
#[derive(Debug)]
pub struct PeakEnergy {
    scene: Scene,
    damper: Damper,
    variables: Vec<Variable>,
    when: When,
    band: Option<Band>,
    settings: Settings,
    failures: Mutex<Failures>,
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
        let when = when.into();
        Self { scene, damper, variables, when, band: None, settings, failures: Mutex::default() }
    }

    /// The worst over `band` instead of the value at the scene's own ω; `None` for that again.
    #[must_use]
    pub fn over(self, band: Option<Band>) -> Self {
        Self { band, ..self }
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

    /// E1max of `design`, J; any number above `cutoff` as soon as it is known to be above; +∞ where there is none.
    pub fn value(&self, design: &[f64], cutoff: f64) -> f64 {
        let worst = self.scene(design).and_then(|scene| self.worst(&scene, cutoff));
        worst.map(|worst| worst.value).unwrap_or_else(|reason| {
            self.note(design, reason);
            f64::INFINITY
        })
    }

    /// E1max of a scene as this objective takes it, J, with its ω; see [`e1_max`].
    ///
    /// # Errors
    /// As [`e1_max`].
    pub fn worst(&self, scene: &Scene, cutoff: f64) -> Result<Worst, Unusable> {
        e1_max(scene, self.when, self.band, &self.settings, cutoff)
    }

    /// The evaluations that failed so far.
    pub fn failures(&self) -> Failures {
        self.failures.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn note(&self, design: &[f64], reason: Unusable) {
        let mut failures = self.failures.lock().unwrap_or_else(PoisonError::into_inner);
        failures.count += 1;
        if failures.example.as_ref().is_none_or(|(lowest, _)| design < lowest.as_slice()) {
            failures.example = Some((design.to_vec(), reason));
        }
    }
}
