//! The energy bound check: no motion has more energy than the force can have supplied. The last check of every run.

use crate::error::SolverError;
use crate::response::{Extreme, Response};
use crate::settings::{Settings, Window};
use retune_model::{Bare, Coupled, Measure, Scene};

/// Relative tolerance of the energy bound: for rounding, and for the error of a general method, which gains spurious energy at a fixed step
/// or a loose tolerance.
const SLACK: [f64; 2] = [1e-6, 1.0];

/// Relative difference, in units of ε, between a position in the search for touch-downs and in that for the largest relative displacement.
const ROUNDINGS: f64 = 64.0;

/// Returns the largest energy of the primary structure if it is within the bound.
///
/// A run with more energy than the force can supply (see [`Bare::most_energy`]) has lost all digits: its parameters are too many orders of
/// magnitude apart, or the step or the tolerances of a general method do not suit them.
///
/// # Errors
/// [`SolverError::NonFinite`], [`SolverError::Implausible`].
pub fn check_energy(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    maximum: Extreme,
) -> Result<Extreme, SolverError> {
    let Extreme { value, time } = maximum;
    if window.from >= window.to {
        return Ok(maximum); // an empty window
    }
    if !value.is_finite() {
        return Err(SolverError::NonFinite { t: window.to });
    }
    let most = energy_limit(scene, window);
    let gained = value > most * (1.0 + SLACK[usize::from(!settings.method.is_exact())]);
    if gained || value < 0.0 || !(window.from..=window.to).contains(&time) {
        return Err(SolverError::Implausible { t: window.to, value, time, most });
    }
    Ok(maximum)
}

/// Returns the largest value of a measure if it is within the bound. A displacement or a velocity is checked by the least energy that it
/// implies. A time that rounding has put outside the window is moved to its end.
///
/// # Errors
/// As [`check_energy`].
pub fn check_largest(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    measure: Measure,
    maximum: Extreme,
) -> Result<Extreme, SolverError> {
    let Extreme { value, time } = maximum;
    if measure == Measure::Energy {
        return check_energy(scene, window, settings, maximum);
    }
    if window.from >= window.to {
        return Ok(maximum); // an empty window
    }
    if !value.is_finite() {
        return Err(SolverError::NonFinite { t: window.to });
    }
    let time = time.clamp(window.from, window.to);
    let bare = Bare::new(&scene.primary, &scene.forcing);
    let at_least = match measure {
        Measure::Displacement => bare.primary_energy(value, 0.0),
        Measure::Velocity => bare.primary_energy(0.0, value),
        _ => 0.0,
    };
    check_energy(scene, window, settings, Extreme { value: at_least, time })?;
    Ok(Extreme { value, time })
}

/// The largest possible energy at the end of a run, J.
fn energy_limit(scene: &Scene, window: Window) -> f64 {
    match &scene.damper {
        None => Bare::new(&scene.primary, &scene.forcing).most_energy(window.to),
        Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).most_energy(window.to),
    }
}

/// Returns a response if its numbers are all finite (but for forces of rigid walls) and its energy is within the bound.
///
/// # Errors
/// As [`check_energy`].
pub fn check_response(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    found: Response,
) -> Result<Response, SolverError> {
    if window.from >= window.to {
        return Ok(found); // an empty window
    }
    check_energy(scene, window, settings, found.e1_max)?;
    let Extreme { value, time } = found.e2_max;
    if value.is_finite() && !(window.from..=window.to).contains(&time) {
        return Err(SolverError::Implausible {
            t: window.to,
            value,
            time,
            most: energy_limit(scene, window),
        });
    }
    let numbers = [found.e2_max.value, found.relative_displacement_max, found.spring_deflection_max];
    let structure = found.structure.all().map(|largest| largest.value);
    let rigid = scene.damper.and_then(|damper| damper.contact).is_some_and(|walls| walls.rigid().is_some());
    let forces = found.force_max.iter().filter(|_| !rigid);
    let all = numbers.iter().chain(forces).chain(&found.final_state).chain(&structure);
    if all.copied().all(f64::is_finite) { Ok(found) } else { Err(SolverError::NonFinite { t: window.to }) }
}

/// The indentation, m, of a wall that was never touched, which must be zero or negative. At positions of this size, m, rounding alone may
/// put the damper slightly inside; the result is then zero.
///
/// # Errors
/// [`SolverError::Missed`]: the indentation is larger than rounding can explain.
pub fn check_untouched(depth: f64, position: f64, t: f64) -> Result<f64, SolverError> {
    if depth > ROUNDINGS * f64::EPSILON * position {
        return Err(SolverError::Missed { t, depth });
    }
    Ok(depth.min(0.0))
}

/// The error with its time clamped to the run: where digits are lost, the time of a step may be wrong too.
pub fn clamp_error_time(window: Window, error: SolverError) -> SolverError {
    let clamped = |t: f64| if t.is_finite() { t.clamp(0.0, window.to) } else { window.to };
    match error {
        SolverError::StepTooSmall { t, h } => SolverError::StepTooSmall { t: clamped(t), h },
        SolverError::TooFast { t, h, remedy } => SolverError::TooFast { t: clamped(t), h, remedy },
        SolverError::Contact { t } => SolverError::Contact { t: clamped(t) },
        SolverError::TooManySteps { t, limit, evaluations } => {
            SolverError::TooManySteps { t: clamped(t), limit, evaluations }
        }
        SolverError::TooSlow { t, steps, needed, limit, remedy } => {
            SolverError::TooSlow { t: clamped(t), steps, needed, limit, remedy }
        }
        SolverError::Unstable { t } => SolverError::Unstable { t: clamped(t) },
        SolverError::NonFinite { t } => SolverError::NonFinite { t: clamped(t) },
        SolverError::RigidWalls { t } => SolverError::RigidWalls { t: clamped(t) },
        SolverError::Grazing { t } => SolverError::Grazing { t: clamped(t) },
        SolverError::NoPeriod { .. } | SolverError::NoDerivatives { .. } => error,
        SolverError::Missed { t, depth } => SolverError::Missed { t: clamped(t), depth },
        SolverError::Implausible { .. } => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Method;
    use retune_model::{Forcing, NonNegative, Positive, Primary};

    /// 2 kg pushed by 4 N for 3 s have 36 J at most.
    #[test]
    fn contract_energy_that_the_force_cannot_supply_is_refused_of_every_method() {
        let number = |value| NonNegative::new(value).expect("a number");
        let mass = Positive::new(2.0).expect("a mass");
        let scene = Scene {
            primary: Primary { mass, damping: number(0.0), stiffness: number(0.0) },
            forcing: Forcing::force(number(4.0), number(0.0)),
            damper: None,
        };
        let window = Window { from: 1.0, to: 3.0 };
        let ask = |value, time, method| {
            check_energy(&scene, window, &Settings { method, ..Settings::default() }, Extreme { value, time })
        };
        assert!(ask(36.0, 3.0, Method::Hybrid).is_ok());
        let refused = ask(36.1, 3.0, Method::Hybrid);
        let Err(SolverError::Implausible { t, value, time, most }) = refused else {
            panic!("{refused:?}");
        };
        assert!((t, value, time) == (3.0, 36.1, 3.0) && (most - 36.0).abs() < 1e-12);
        for method in Method::ALL.into_iter().filter(|method| *method != Method::Hybrid) {
            assert!(ask(71.9, 3.0, method).is_ok(), "{method:?} has an error of its own");
            assert!(matches!(ask(72.1, 3.0, method), Err(SolverError::Implausible { .. })), "{method:?}");
        }
        assert!(matches!(ask(-1.0, 3.0, Method::Euler), Err(SolverError::Implausible { .. })));
        assert!(matches!(ask(1.0, 0.5, Method::Hybrid), Err(SolverError::Implausible { time: 0.5, .. })));
        assert_eq!(ask(f64::NAN, 3.0, Method::Hybrid), Err(SolverError::NonFinite { t: 3.0 }));
    }

    #[test]
    fn contract_a_wall_that_was_never_touched_is_indented_by_rounding_alone() {
        assert_eq!(check_untouched(-0.5, 1.0, 3.0), Ok(-0.5));
        assert_eq!(check_untouched(1e-16, 1.0, 3.0), Ok(0.0));
        assert_eq!(check_untouched(1e-12, 1.0, 3.0), Err(SolverError::Missed { t: 3.0, depth: 1e-12 }));
    }
}
