//! The energy bound check: no motion has more energy than the force can have supplied. The last check of every run.

use crate::error::SolverError;
use crate::response::{Extreme, Response};
use crate::settings::{Settings, Window};
use retune_model::{Bare, Coupled, Measure, Scene};

/// Allowance in the bound on the energy, relative: for rounding; and for the error of a general method, which at a fixed step or a loose
/// tolerance gains energy by itself.
const SLACK: [f64; 2] = [1e-6, 1.0];

/// Roundings by which the search for touch-downs and that for the largest relative displacement may differ in a position.
const ROUNDINGS: f64 = 64.0;

/// Returns a largest energy of the primary structure that is within the bound.
///
/// A run with more energy than the force can supply (see [`Bare::most_energy`]) has lost all digits: its parameters are too many orders
/// of magnitude apart, or, of a general method, its step or its tolerances do not suit them.
///
/// # Errors
/// [`SolverError::NonFinite`], [`SolverError::Implausible`].
pub fn energy(
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
    let most = most(scene, window);
    let gained = value > most * (1.0 + SLACK[usize::from(!settings.method.is_exact())]);
    if gained || value < 0.0 || !(window.from..=window.to).contains(&time) {
        return Err(SolverError::Implausible { t: window.to, value, time, most });
    }
    Ok(maximum)
}

/// Returns a largest value of what is measured that is within the bound: an energy, or a displacement or a velocity by the energy
/// that the structure has at least there. Rounding may not put its time outside the window.
///
/// # Errors
/// As [`energy`].
pub fn largest(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    measure: Measure,
    maximum: Extreme,
) -> Result<Extreme, SolverError> {
    let Extreme { value, time } = maximum;
    if measure == Measure::Energy {
        return energy(scene, window, settings, maximum);
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
    energy(scene, window, settings, Extreme { value: at_least, time })?;
    Ok(Extreme { value, time })
}

/// The most energy that there can be at the end of a run, J.
fn most(scene: &Scene, window: Window) -> f64 {
    match &scene.damper {
        None => Bare::new(&scene.primary, &scene.forcing).most_energy(window.to),
        Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).most_energy(window.to),
    }
}

/// Returns a response whose numbers are all finite and whose energy is within the bound.
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
        return Ok(found); // an empty window
    }
    energy(scene, window, settings, found.e1_max)?;
    let Extreme { value, time } = found.e2_max;
    if value.is_finite() && !(window.from..=window.to).contains(&time) {
        return Err(SolverError::Implausible { t: window.to, value, time, most: most(scene, window) });
    }
    let numbers = [found.e2_max.value, found.relative_displacement_max, found.spring_deflection_max];
    let structure = found.structure.all().map(|largest| largest.value);
    let rigid = scene.damper.and_then(|damper| damper.contact).is_some_and(|walls| walls.rigid().is_some());
    let forces = found.force_max.iter().filter(|_| !rigid);
    let all = numbers.iter().chain(forces).chain(&found.final_state).chain(&structure);
    if all.copied().all(f64::is_finite) { Ok(found) } else { Err(SolverError::NonFinite { t: window.to }) }
}

/// The indentation, m, of a wall that was never touched, which is zero or negative. At positions of this size, m, rounding alone
/// may put the damper slightly inside.
///
/// # Errors
/// [`SolverError::Missed`]: the indentation is larger than rounding can explain.
pub fn untouched(depth: f64, position: f64, t: f64) -> Result<f64, SolverError> {
    if depth > ROUNDINGS * f64::EPSILON * position {
        return Err(SolverError::Missed { t, depth });
    }
    Ok(depth.min(0.0))
}

/// The same error with its time limited to the run: where digits are lost, the time of a step may be wrong too.
pub fn error(window: Window, error: SolverError) -> SolverError {
    let sound = |t: f64| if t.is_finite() { t.clamp(0.0, window.to) } else { window.to };
    match error {
        SolverError::StepTooSmall { t, h } => SolverError::StepTooSmall { t: sound(t), h },
        SolverError::TooFast { t, h, remedy } => SolverError::TooFast { t: sound(t), h, remedy },
        SolverError::Contact { t } => SolverError::Contact { t: sound(t) },
        SolverError::TooManySteps { t, limit, evaluations } => {
            SolverError::TooManySteps { t: sound(t), limit, evaluations }
        }
        SolverError::TooSlow { t, steps, needed, limit, remedy } => {
            SolverError::TooSlow { t: sound(t), steps, needed, limit, remedy }
        }
        SolverError::Unstable { t } => SolverError::Unstable { t: sound(t) },
        SolverError::NonFinite { t } => SolverError::NonFinite { t: sound(t) },
        SolverError::RigidWalls { t } => SolverError::RigidWalls { t: sound(t) },
        SolverError::Grazing { t } => SolverError::Grazing { t: sound(t) },
        SolverError::NoPeriod { .. } | SolverError::NoDerivatives { .. } => error,
        SolverError::Missed { t, depth } => SolverError::Missed { t: sound(t), depth },
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
            energy(&scene, window, &Settings { method, ..Settings::default() }, Extreme { value, time })
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
        assert_eq!(untouched(-0.5, 1.0, 3.0), Ok(-0.5));
        assert_eq!(untouched(1e-16, 1.0, 3.0), Ok(0.0));
        assert_eq!(untouched(1e-12, 1.0, 3.0), Err(SolverError::Missed { t: 3.0, depth: 1e-12 }));
    }
}
