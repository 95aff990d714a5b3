//! The interface between continuation and a system, implemented for a structure with a damper.

use super::seen::{Seen, seen};
use crate::parameter::Error;
use crate::poincare::coupled;
use nalgebra::{Matrix4, Vector4};
use retune_model::{Coupled, Parameter, Scene};
use retune_solver::observe::Unobserved;
use retune_solver::{Motion, Phase, Settings, Tangent};
use std::f64::consts::TAU;

/// Largest tolerance of the contacts.
const TOLERANCE: f64 = 1e-10;

/// A system under a periodic force, with four state variables, along one parameter. [`Damped`] is Retune's; a test follows
/// Duffing's oscillator, whose folds are known.
pub trait Forced: Clone {
    /// The flow over each of the equal segments of `periods` periods of the force, from the state at its beginning, at a value of the
    /// parameter.
    ///
    /// # Errors
    /// The system cannot be run there.
    fn flows(&self, value: f64, periods: usize, states: &[[f64; 4]]) -> Result<Vec<Flow>, Error>;

    /// The largest values and the impacts of the motion from these states.
    ///
    /// # Errors
    /// The system cannot be run there.
    fn seen(&self, value: f64, periods: usize, states: &[[f64; 4]]) -> Result<Seen, Error>;
}

/// The end of a segment and its derivatives.
#[derive(Clone, Debug)]
pub struct Flow {
    /// The state at its end.
    pub end: [f64; 4],
    /// The derivative of that state by the one at its beginning.
    pub by_state: Matrix4<f64>,
    /// Its derivative by the parameter, which may be the frequency: the ends of the segment then move with the period.
    pub by_value: Vector4<f64>,
}

/// A structure with a damper, along one of its parameters.
#[derive(Clone, Debug)]
pub struct Damped {
    /// The scene, but for the parameter.
    pub scene: Scene,
    /// The parameter.
    pub parameter: Parameter,
    /// The settings of the segments' runs.
    pub settings: Settings,
}

/// The settings for segments, derived from those of a study.
pub fn settings_of(settings: &Settings) -> Settings {
    Settings { rtol: settings.rtol.min(TOLERANCE), ..*settings }
}

impl Damped {
    /// The scene at a value of the parameter.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn scene_at(&self, value: f64) -> Result<Scene, Error> {
        Ok(self.parameter.at(self.scene, value)?)
    }

    /// The system at a value of the parameter.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn system(&self, value: f64) -> Result<Coupled, Error> {
        coupled(&self.scene_at(value)?)
    }
}

impl Forced for Damped {
    fn flows(&self, value: f64, periods: usize, states: &[[f64; 4]]) -> Result<Vec<Flow>, Error> {
        let system = self.system(value)?;
        let omega = system.bare().frequency();
        let share = periods as f64 * TAU / omega / states.len() as f64;
        let mut tangent = Tangent::new(&system, &self.settings, share, &[self.parameter]);
        let flow = |(k, &y): (usize, &[f64; 4])| {
            let [from, to] = [k as f64 * share, (k + 1) as f64 * share];
            let start = Motion { t: from, y, phase: Phase::of(&system, &y) };
            let found = tangent.propagate(start, to, &mut Unobserved)?;
            let by_state = Matrix4::from_fn(|i, j| found.by_state[j][i]);
            let mut by_value = Vector4::from(found.by[0]);
            if self.parameter == Parameter::Omega {
                let rate = |t: f64, y: &[f64; 4]| Vector4::from(system.derivative(system.excitation(t), y));
                by_value += (by_state * rate(from, &y) * from - rate(to, &found.end.y) * to) / omega;
            }
            Ok(Flow { end: found.end.y, by_state, by_value })
        };
        states.iter().enumerate().map(flow).collect()
    }

    fn seen(&self, value: f64, periods: usize, states: &[[f64; 4]]) -> Result<Seen, Error> {
        seen(&self.scene_at(value)?, &self.settings, periods, states)
    }
}
