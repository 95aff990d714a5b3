//! The derivatives of a run's largest value by parameters of the damper: [`extremes_by`] for [`extremes`], [`settled_by`] for [`settled`].
//!
//! They are those of the value at the fixed time at which it is reached: at a maximum a shift of the time has no effect to first order, and
//! an end of the window does not move. Where the value is reached at several times it has a kink, and these are the derivatives at the
//! first of them: a subgradient. They are computed by the exact method, whatever the settings.

use crate::error::SolverError;
use crate::extremes::{Ask, extremes};
use crate::plan::{Plan, Request};
use crate::recurrence::test::Settle;
use crate::response::Extreme;
use crate::settings::{Settings, Window};
use crate::settle::settled;
use crate::tangent::{Tangent, gradient_at};
use retune_model::{Coupled, Parameter, Scene};

/// The derivatives of the largest value of [`Ask::measure`] that [`extremes`] finds in a window by parameters of the damper, in the unit of
/// the measure per SI unit of each; zeros without a damper. [`Ask::cutoff`] is not used.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn extremes_by(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
    parameters: &[Parameter],
) -> Result<Vec<f64>, SolverError> {
    let Some((system, settings)) = exact(scene, settings, ask)? else {
        return Ok(vec![0.0; parameters.len()]);
    };
    let ask = Ask { also: None, cutoff: f64::INFINITY, ..ask };
    let at = extremes(scene, window, &settings, ask)?.largest;
    by(&system, window, &settings, ask, at, parameters)
}

/// The derivatives of the largest value that [`settled`] finds, as [`extremes_by`]. For a motion with contacts they are those of the run
/// from rest to the time of the value, which are those of the settled motion as far as the run has settled.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn settled_by(
    scene: &Scene,
    window: Window,
    settle: Settle,
    settings: &Settings,
    ask: Ask,
    parameters: &[Parameter],
) -> Result<Vec<f64>, SolverError> {
    let Some((system, settings)) = exact(scene, settings, ask)? else {
        return Ok(vec![0.0; parameters.len()]);
    };
    if Plan::of(&system, &settings, Request::Settled) == Plan::Closed {
        let omega = scene.forcing.frequency.get();
        return Ok(parameters.iter().map(|&by| system.steady_by(ask.measure, by, omega)).collect());
    }
    let at = settled(scene, window, settle, &settings, Ask { also: None, ..ask })?.largest;
    by(&system, window, &settings, ask, at, parameters)
}

/// The system, and the settings with the exact method; `None` without a damper.
fn exact(scene: &Scene, settings: &Settings, ask: Ask) -> Result<Option<(Coupled, Settings)>, SolverError> {
    let Some(damper) = scene.damper.as_ref() else { return Ok(None) };
    if scene.forcing.history().is_some() {
        return Err(SolverError::NoDerivatives { t: 0.0 });
    }
    let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
    Ok(Some((system, settings.exact())))
}

fn by(
    system: &Coupled,
    window: Window,
    settings: &Settings,
    ask: Ask,
    at: Extreme,
    parameters: &[Parameter],
) -> Result<Vec<f64>, SolverError> {
    let mut tangent = Tangent::new(system, settings, window.to, parameters);
    gradient_at(system, &mut tangent, window.to, ask.measure, at, parameters)
}
