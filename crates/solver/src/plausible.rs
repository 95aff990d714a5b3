//! What no motion can do: the last look at a run before its numbers are believed.

use crate::settings::{Extreme, Method, Response, Settings, SolverError, Window};
use retune_model::{Bare, Scene};

/// Rounding that the bound on the energy is given.
const SLACK: f64 = 1e-6;

/// Passes on a largest energy of the primary structure that can be.
///
/// A run of the exact method that has more than the force can give (see [`Bare::most_energy`]) has lost its digits to parameters too
/// far apart; the other methods are not held
/// to it, for what they make of energy at a fixed step or a loose tolerance is their own.
///
/// # Errors
/// [`SolverError::NonFinite`], [`SolverError::Implausible`].
pub fn energy(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    peak: Extreme,
) -> Result<Extreme, SolverError> {
    let Extreme { value, time } = peak;
    if window.from >= window.to {
        return Ok(peak); // nothing was looked at
    }
    if !value.is_finite() {
        return Err(SolverError::NonFinite { t: window.to });
    }
    let most = most(scene, window);
    let gained = settings.method == Method::Hybrid && value > most * (1.0 + SLACK);
    if gained || value < 0.0 || !(window.from..=window.to).contains(&time) {
        return Err(SolverError::Implausible { t: window.to, value, time, most });
    }
    Ok(peak)
}

/// The most energy that the force can give in a run, J.
fn most(scene: &Scene, window: Window) -> f64 {
    Bare::new(&scene.primary, &scene.forcing).most_energy(window.to)
}

/// Passes on a response of which every number is finite and the energy can be.
///
/// # Errors
/// As [`energy`].
pub fn response(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    found: Response,
) -> Result<Response, SolverError> {
    if window.from >= window.to {
        return Ok(found); // nothing was looked at
    }
    energy(scene, window, settings, found.e1_max)?;
    let Extreme { value, time } = found.e2_max;
    if value.is_finite() && !(window.from..=window.to).contains(&time) {
        return Err(SolverError::Implausible { t: window.to, value, time, most: most(scene, window) });
    }
    let numbers = [found.e2_max.value, found.stroke_max];
    let all = numbers.iter().chain(&found.force_max).chain(&found.final_state);
    if all.copied().all(f64::is_finite) { Ok(found) } else { Err(SolverError::NonFinite { t: window.to }) }
}

/// The same error with a time that can be: where digits are lost, that of a step may be among them.
pub fn error(window: Window, error: SolverError) -> SolverError {
    let sound = |t: f64| if t.is_finite() { t.clamp(0.0, window.to) } else { window.to };
    match error {
        SolverError::StepTooSmall { t, h } => SolverError::StepTooSmall { t: sound(t), h },
        SolverError::TooManySteps { t, limit } => SolverError::TooManySteps { t: sound(t), limit },
        SolverError::NonFinite { t } => SolverError::NonFinite { t: sound(t) },
        SolverError::Implausible { .. } => error,
    }
}
