//! The derivatives of a largest value by parameters: by the envelope theorem those of the value at the time at which it is reached.

use super::observer::{Tangent, Transition};
use crate::error::SolverError;
use crate::hybrid::propagator::Motion;
use crate::observe::observer::Unobserved;
use crate::observe::quantity::Quantity;
use crate::observe::structure::StructureMotion;
use crate::response::Extreme;
use retune_model::{Coupled, Measure, Parameter, Side};

/// A maximum is flat, so its time has only half of the digits; the derivatives are not flat. Times are corrected by at most this, s: a
/// value farther from a zero of the slope is no smooth maximum but at an end of the window.
const LATE: f64 = 1e-5;

/// The derivatives of a largest value that a run from its start at t = 0, until `last` (s), reaches at a known time.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub(crate) fn gradient_at(
    system: &Coupled,
    tangent: &mut Tangent<'_>,
    last: f64,
    measure: Measure,
    at: Extreme,
    parameters: &[Parameter],
) -> Result<Vec<f64>, SolverError> {
    let start = Motion::start(system);
    if let Some(by) = at_impact(system, tangent, last, measure, at, parameters)? {
        return Ok(by);
    }
    let mut found = tangent.propagate(start, at.time, &mut Unobserved)?;
    let late = time_past_maximum(system, measure, &found.end);
    if late != 0.0 && late.abs() <= LATE && at.time - late <= last {
        found = tangent.propagate(start, at.time - late, &mut Unobserved)?;
    }
    Ok(derivatives(system, measure, &found, parameters))
}

/// A largest value is taken as reached at an impact if their times differ by at most this, s, and their values by at most this share.
const AT_IMPACT: f64 = 1e-9;
const SAME: f64 = 1e-12;

/// The derivatives of a largest value that is reached at an impact with a rigid wall, just before or just after it: those at the time of
/// the impact, which moves; `None` if it is reached elsewhere.
fn at_impact(
    system: &Coupled,
    tangent: &mut Tangent<'_>,
    last: f64,
    measure: Measure,
    at: Extreme,
    parameters: &[Parameter],
) -> Result<Option<Vec<f64>>, SolverError> {
    if !system.is_rigid() {
        return Ok(None);
    }
    let within = AT_IMPACT * at.time.max(1.0);
    let impact = tangent.first_impact(Motion::start(system), at.time - within, last.min(at.time + within))?;
    let Some(impact) = impact else { return Ok(None) };
    let [before, after] = impact.sides.each_ref().map(|side| rates(system, measure, &side.end)[0].abs());
    let side = if before > after { &impact.sides[0] } else { &impact.sides[1] };
    if before.max(after) < at.value * (1.0 - SAME) {
        return Ok(None);
    }
    let mut by = derivatives(system, measure, side, parameters);
    if measure == Measure::Acceleration {
        // The acceleration also depends on the force, which changes while the impact is delayed.
        let (t, y) = (side.end.t, &side.end.y);
        let (now, [a, ..]) = (system.excitation(t), rates(system, measure, &side.end));
        let turned = [-system.bare().frequency() * now[1], 0.0];
        let pushed = system.derivative(turned, y)[1] - system.derivative([0.0; 2], y)[1];
        for ((by, delay), &parameter) in by.iter_mut().zip(&impact.delays).zip(parameters) {
            let moves = parameter == Parameter::D && system.starts_at_rest_distance();
            let delay = delay + if moves { impact.delays_by_state[2] } else { 0.0 };
            *by += a.signum() * pushed * delay;
        }
    }
    Ok(Some(by))
}

/// By how much (s) a moment is later than the nearest maximum: the slope of the measured quantity over its curvature.
fn time_past_maximum(system: &Coupled, measure: Measure, now: &Motion) -> f64 {
    let [_, slope, curvature] = rates(system, measure, now);
    if curvature == 0.0 { 0.0 } else { slope / curvature }
}

/// The quantity whose magnitude is measured, with its slope and curvature in time.
fn rates(system: &Coupled, measure: Measure, now: &Motion) -> [f64; 3] {
    let excitation = system.excitation(now.t);
    let motion = || system.primary_motion(excitation, &now.y);
    let of_motion = |i: usize| {
        let motion = motion();
        [motion[i], motion[i + 1], motion[i + 2]]
    };
    match measure.of_run() {
        Measure::Energy => system.primary_energy_rates(excitation, &now.y),
        Measure::Displacement => of_motion(0),
        Measure::Velocity => of_motion(1),
        Measure::Acceleration => of_motion(2),
        Measure::GroundForce => StructureMotion::ground_force(system, 1.0).rates(excitation, &now.y),
        Measure::ContactForce if system.is_lossy() => {
            let [near, far] = Side::BOTH.map(|side| system.contact_force_rates(excitation, &now.y, side));
            if near[0] > far[0] { near } else { far }
        }
        Measure::Stroke
        | Measure::ContactForce
        | Measure::ContactPressure
        | Measure::DecayTime
        | Measure::Stationary(_) => {
            let [place, slope, curvature] = system.relative_position_rates(excitation, &now.y);
            [place - system.rest_distance(), slope, curvature]
        }
    }
}

/// The derivatives of a measure's value at the end of a run, per unit of each parameter.
fn derivatives(system: &Coupled, measure: Measure, found: &Transition, parameters: &[Parameter]) -> Vec<f64> {
    let by_start = |parameter: Parameter, by: [f64; 4]| -> [f64; 4] {
        // The damper starts at D.
        let moves = parameter == Parameter::D && system.starts_at_rest_distance();
        std::array::from_fn(|i| if moves { by[i] + found.by_state[2][i] } else { by[i] })
    };
    let all = parameters.iter().zip(&found.by);
    let at = &found.end;
    all.map(|(&parameter, by)| system.measure_by(measure, parameter, at.t, &at.y, &by_start(parameter, *by)))
        .collect()
}
