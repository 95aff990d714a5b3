//! The derivatives of a largest value by parameters: by the envelope theorem those of the value at the time at which it is reached.

use super::observer::{Tangent, Transition};
use crate::error::SolverError;
use crate::extremes::{Ask, maxima, read};
use crate::hybrid::propagator::{Motion, Phase};
use crate::observe::observer::Unobserved;
use crate::response::Extreme;
use crate::run::Follower;
use crate::settings::{Settings, Window};
use retune_model::{Coupled, Measure, Parameter, Side, Source};
use std::f64::consts::TAU;

/// Maxima as near as this share to the largest are ties: each has a gradient of its own.
const TIE: f64 = 1e-9;

/// A maximum is flat, so that its time has half of its digits; the derivatives are not flat. Times are corrected by at most this, s: what is
/// farther from a place of slope zero is no smooth maximum but an end of the window.
const LATE: f64 = 1e-5;

/// A largest value with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// The value, in the unit of the measure, and when it is reached.
    pub at: Extreme,
    /// Its derivatives by each parameter.
    pub by: Vec<f64>,
}

/// The largest value of a measure over a window of the run from its start at t = 0, with its derivatives by parameters. Where maxima of one
/// height are reached in several periods of the force, each has its gradient: the largest value then has a kink, and these span it. The
/// first is that of the largest.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn gradients(
    system: &Coupled,
    window: Window,
    settings: &Settings,
    measure: Measure,
    parameters: &[Parameter],
) -> Result<Vec<Gradient>, SolverError> {
    let start = system.start();
    let start = Motion { t: 0.0, y: start, phase: Phase::of(system, &start) };
    let period = TAU / system.bare().frequency();
    let mut follower = Follower::new(system, settings, window.to);
    let mut now = follower.propagate(start, window.from, &mut Unobserved)?;
    let mut peaks: Vec<Extreme> = Vec::new();
    let count = ((window.to - window.from) / period).ceil().max(1.0);
    for k in 1..=count as usize {
        let end = if k as f64 == count { window.to } else { window.from + k as f64 * period };
        let mut seen = maxima(system, Ask { measure, ..Ask::default() });
        now = follower.propagate(now, end, &mut seen)?;
        peaks.push(read(&seen).largest);
    }
    peaks.sort_by(|a, b| b.value.total_cmp(&a.value));
    let least = peaks.first().map_or(0.0, |peak| peak.value * (1.0 - TIE));
    let mut tangent = Tangent::new(system, settings, window.to, parameters);
    let ties = peaks.into_iter().take_while(|peak| peak.value >= least);
    ties.map(|at| {
        let mut found = tangent.propagate(start, at.time, &mut Unobserved)?;
        let late = lateness(system, measure, &found.end);
        if late != 0.0 && late.abs() <= LATE && at.time - late <= window.to {
            found = tangent.propagate(start, at.time - late, &mut Unobserved)?;
        }
        Ok(Gradient { at, by: derivatives(system, measure, &found, parameters) })
    })
    .collect()
}

/// By how much (s) a moment is later than the maximum beside it: the slope of the measured quantity over its curvature.
fn lateness(system: &Coupled, measure: Measure, now: &Motion) -> f64 {
    let (y, excitation) = (now.y, system.excitation(now.t));
    let rate = system.derivative(excitation, &y);
    let jacobian = system.jacobian(&y);
    let jerk =
        (0..4).map(|j| jacobian[(1, j)] * rate[j]).sum::<f64>() + system.time_derivative(excitation)[1];
    let [_, k1] = system.bare().primary_energy_weights();
    let c1 = system.bare().damping();
    let m1 = system.bare().mass();
    let [slope, curvature] = match measure {
        Measure::Energy => {
            // m1 v1 a1 + k1 x1 v1, and its rate.
            let power = m1 * rate[1] + k1 * y[0];
            [y[1] * power, rate[1] * power + y[1] * (m1 * jerk + k1 * y[1])]
        }
        Measure::Displacement => [y[1], rate[1]],
        Measure::Velocity => [rate[1], jerk],
        Measure::GroundForce => [k1 * y[1] + c1 * rate[1], k1 * rate[1] + c1 * jerk],
        Measure::Stroke | Measure::ContactForce => [y[3] - y[1], rate[3] - rate[1]],
        Measure::Acceleration => return 0.0,
    };
    if curvature == 0.0 { 0.0 } else { slope / curvature }
}

/// The derivatives of a measure's value at the end of a run.
fn derivatives(system: &Coupled, measure: Measure, found: &Transition, parameters: &[Parameter]) -> Vec<f64> {
    let (y, t) = (found.end.y, found.end.t);
    let [m1, k1] = system.bare().primary_energy_weights();
    let c1 = system.bare().damping();
    let jacobian = system.jacobian(&y);
    let rate = system.derivative(system.excitation(t), &y);
    let [near, far] = system.indentation(&y);
    let side = if near > far { Side::Primary } else { Side::Obstacle };
    let depth = near.max(far).max(0.0);
    parameters
        .iter()
        .zip(&found.by)
        .map(|(&parameter, by)| {
            let mut by = *by;
            if parameter == Parameter::D && starts_at_rest(system) {
                // The damper starts at D.
                by = std::array::from_fn(|i| by[i] + found.by_state[2][i]);
            }
            let is = |other: Parameter| f64::from(u8::from(parameter == other));
            let force = y[0] * k1 + y[1] * c1;
            match measure {
                Measure::Energy => {
                    k1 * y[0] * by[0] + m1 * y[1] * by[1] + 0.5 * y[0] * y[0] * is(Parameter::K1)
                }
                Measure::Displacement => y[0].signum() * by[0],
                Measure::Velocity => y[1].signum() * by[1],
                Measure::GroundForce => {
                    let own = y[0] * is(Parameter::K1) + y[1] * is(Parameter::C1);
                    force.signum() * (k1 * by[0] + c1 * by[1] + own)
                }
                Measure::Acceleration => {
                    let contact = system.contact_force_by(parameter, side, depth.sqrt());
                    let [own, _] = system.acceleration_by(parameter, &y, contact);
                    let driven = system.bare().excitation_by(parameter, t)[0] / m1;
                    let along: f64 = (0..4).map(|j| jacobian[(1, j)] * by[j]).sum();
                    rate[1].signum() * (along + own + driven)
                }
                Measure::Stroke => {
                    let stretch = y[2] - y[0] - system.rest_distance();
                    stretch.signum() * (by[2] - by[0] - is(Parameter::D))
                }
                Measure::ContactForce => {
                    let q = depth.sqrt();
                    let [_, own] = system.contact_force_by(parameter, side, q);
                    let slope = 1.5 * system.hertz(side) * q;
                    slope * side.sign() * (by[2] - by[0]) - side.sign() * own
                }
            }
        })
        .collect()
}

/// Whether the damper's spring is at rest at the start.
fn starts_at_rest(system: &Coupled) -> bool {
    match system.bare().source() {
        Source::Decay(start) => start.x2.is_none(),
        _ => true,
    }
}
