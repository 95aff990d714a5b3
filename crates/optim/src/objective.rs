//! What is made small: the largest energy of the primary structure as a function of the damper's design.

use retune_model::{Damper, NonNegative, OutOfRange, Scene};
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
    /// The run could not be finished.
    #[error(transparent)]
    Run(#[from] SolverError),
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

/// E1max over a window, J, of a scene whose damper is varied. It may be shared by threads.
///
/// A design that cannot be evaluated counts as +∞, and is kept in [`Self::failures`].
#[derive(Debug)]
pub struct PeakEnergy {
    scene: Scene,
    damper: Damper,
    variables: Vec<Variable>,
    window: Window,
    settings: Settings,
    failures: Mutex<Failures>,
}

impl PeakEnergy {
    /// The objective over `variables` of `damper`, hung on the structure of `scene` in the place of its own, if any.
    pub fn new(
        scene: Scene,
        damper: Damper,
        variables: Vec<Variable>,
        window: Window,
        settings: Settings,
    ) -> Self {
        Self { scene, damper, variables, window, settings, failures: Mutex::default() }
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
        let run = || {
            let scene = self.scene(design)?;
            Ok(retune_solver::e1_max(&scene, self.window, &self.settings, cutoff)?.value)
        };
        run().unwrap_or_else(|reason| {
            self.note(design, reason);
            f64::INFINITY
        })
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

#[cfg(test)]
#[expect(clippy::approx_constant, reason = "the paper's rounded numbers")]
mod tests {
    use super::*;
    use retune_model::{Contact, Forcing, PoissonRatio, Positive, Primary};

    fn scene() -> (Scene, Damper) {
        let positive = |v| Positive::new(v).expect("positive");
        let value = |v| NonNegative::new(v).expect("not negative");
        let nu = |v| PoissonRatio::new(v).expect("a Poisson ratio");
        let contact = Contact {
            radius: positive(2.0),
            coefficient: positive(0.318),
            young_1: positive(2.1e11),
            poisson_1: nu(0.3),
            young_2: positive(2.21e7),
            poisson_2: nu(0.4),
            young_3: positive(2.1e11),
            poisson_3: nu(0.3),
            young_4: positive(2.05e7),
            poisson_4: nu(0.4),
        };
        let damper = Damper {
            mass: positive(60.0),
            stiffness: value(600.0),
            damping: value(262.0),
            rest_distance: value(2.08),
            clearance: value(4.7),
            contact,
        };
        let primary = Primary { mass: positive(1000.0), damping: value(452.0), stiffness: value(39500.0) };
        let forcing = Forcing { amplitude: value(800.0), frequency: value(6.28) };
        (Scene { primary, forcing, damper: Some(damper) }, damper)
    }

    fn objective(variables: Vec<Variable>, to: f64, settings: Settings) -> PeakEnergy {
        let (scene, damper) = scene();
        PeakEnergy::new(scene, damper, variables, Window { from: 0.0, to }, settings)
    }

    #[test]
    fn exact_design_sets_the_named_parameters_and_no_other() {
        let objective = objective(Variable::ALL.to_vec(), 1.0, Settings::default());
        let damper = objective.damper(&[1.0, 2.0, 3.0, 4.0]).expect("a damper");
        assert_eq!(Variable::ALL.map(|variable| variable.get(&damper)), [1.0, 2.0, 3.0, 4.0]);
        let (_, original) = scene();
        assert_eq!((damper.mass, damper.contact), (original.mass, original.contact));
    }

    #[test]
    fn exact_value_is_that_of_a_run_of_the_scene() {
        let objective = objective(vec![Variable::C2], 5.0, Settings::default());
        let (scene, _) = scene();
        let window = Window { from: 0.0, to: 5.0 };
        let run = retune_solver::e1_max(&scene, window, &Settings::default(), f64::INFINITY).expect("a run");
        assert_eq!(objective.value(&[262.0], f64::INFINITY).to_bits(), run.value.to_bits());
        assert_eq!(objective.failures(), Failures::default());
    }

    #[test]
    fn exact_failures_are_infinite_counted_and_one_is_kept() {
        let objective = objective(vec![Variable::C2, Variable::D], 5.0, Settings::default());
        for design in [[1.0, -2.0], [-1.0, 0.0], [f64::NAN, 1.0]] {
            assert_eq!(objective.value(&design, f64::INFINITY), f64::INFINITY);
        }
        let failures = objective.failures();
        assert_eq!(failures.count, 3);
        let (design, reason) = failures.example.expect("an example");
        assert_eq!(design, [-1.0, 0.0]);
        assert_eq!(reason.to_string(), "c2: -1 is not allowed here: give a finite number not below 0");
    }
}
