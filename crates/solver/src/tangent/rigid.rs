//! Derivatives through an impact with a rigid wall, and along the stretch on which a wall holds the damper.
//!
//! An impact is the map `G` of the state where `r` reaches the wall. A change `δ` moves its time by `s = (δwall - δr) / r'`, so at a fixed
//! time after it the change is `G δ + (G f - f') s`, with the equations' right-hand sides `f` before and `f'` after it, plus the derivative
//! of `G` itself by the parameter: the saltation matrix (`docs/theory.md`, "Rigid walls").

use super::series::sum;
use crate::observe::observer::Impact;
use retune_model::{Coupled, Excitation, Parameter};

/// An impact as a map of small changes.
pub(super) struct ImpactMap<'a> {
    system: &'a Coupled,
    impact: Impact<4>,
    /// `f` before and after it.
    pub rates: [[f64; 4]; 2],
}

impl<'a> ImpactMap<'a> {
    pub(super) fn new(system: &'a Coupled, impact: &Impact<4>) -> Self {
        let Impact { before, after, caught, .. } = impact;
        let flight = |y| system.derivative_under(before.excitation, y, 0.0);
        let rates = [
            flight(&before.y),
            if *caught { system.derivative(after.excitation, &after.y) } else { flight(&after.y) },
        ];
        Self { system, impact: *impact, rates }
    }

    fn wall_by(&self, parameter: Option<Parameter>) -> f64 {
        parameter.map_or(0.0, |parameter| self.system.wall_by(parameter, self.impact.side))
    }

    /// The delay of the impact, s, for a change of the state at its time.
    pub(super) fn delay(&self, change: &[f64; 4], parameter: Option<Parameter>) -> f64 {
        let [_, v1, _, v2] = self.impact.before.y;
        (self.wall_by(parameter) - (change[2] - change[0])) / (v2 - v1)
    }

    /// The change of the state after it, at the time of the impact.
    pub(super) fn carry(&self, change: &[f64; 4], parameter: Option<Parameter>) -> [f64; 4] {
        if self.impact.caught {
            return self.carry_caught(change, parameter);
        }
        let (before, e) = (&self.impact.before.y, self.system.restitution().unwrap_or(1.0));
        let [mapped, direct] = [self.system.struck(e, change), self.system.struck_by(parameter, before)];
        let (delay, [f, after]) = (self.delay(change, parameter), self.rates);
        let mapped_rate = self.system.struck(e, &f);
        sum(sum(mapped, direct), std::array::from_fn(|i| (mapped_rate[i] - after[i]) * delay))
    }

    /// [`Self::carry`] where the wall holds the damper afterwards: only the change of the common motion is left. It does without the delay,
    /// which is undetermined where a chatter ends: the speed there is of the size of rounding.
    fn carry_caught(&self, &[x1, v1, x2, v2]: &[f64; 4], parameter: Option<Parameter>) -> [f64; 4] {
        let ([m1, m2], wall, [_, c1]) =
            (self.system.masses(), self.wall_by(parameter), self.system.bare().ground_force_weights());
        let (m, gap) = (m1 + m2, wall - (x2 - x1));
        let [_, before_1, _, before_2] = self.impact.before.y;
        let by_mass =
            if parameter == Some(Parameter::M2) { m1 * (before_2 - before_1) / (m * m) } else { 0.0 };
        let x = x1 - m2 / m * gap;
        let v = (m1 * v1 + m2 * v2) / m + c1 * m2 / (m * m) * gap + by_mass;
        [x, v, x + wall, v]
    }
}

/// Length of a step of [`hold`] times the rate of the motion, and the terms of its series, as in flight.
const STEP: f64 = 1.25;
const TERMS: u32 = 20;

/// Carries changes along a stretch on which a wall holds the damper, from a state and the time `t` (s) over `seconds`: by Taylor series, whose
/// terms are those of the motion, differentiated. `force_by(number, elapsed)` is the change of the force by a parameter.
pub(super) fn hold(
    system: &Coupled,
    (t, y): (f64, [f64; 4]),
    seconds: f64,
    by_state: &mut [[f64; 4]; 4],
    by: &mut [[f64; 4]],
    parameters: &[Parameter],
    force_by: impl Fn(usize, f64) -> Excitation,
) {
    let steps = (seconds * system.held_rate() / STEP).ceil().max(1.0);
    let (h, omega) = (seconds / steps, system.bare().frequency());
    let acceleration = |force: f64, x: f64, v: f64| system.held_acceleration([force, 0.0], &[x, v, 0.0, 0.0]);
    let (mut x, mut v) = (y[0], y[1]);
    for step in 0..steps as u32 {
        let elapsed = f64::from(step) * h;
        // The motion and each change of it: place, speed, force and its quadrature.
        let [c, s] = system.excitation(t + elapsed);
        let mut motion = [x, v, c, s];
        let mut changes: Vec<(Option<usize>, [f64; 4])> =
            by_state.iter().map(|change| (None, [change[0], change[1], 0.0, 0.0])).collect();
        changes.extend(by.iter().enumerate().map(|(number, change)| {
            let [c, s] = force_by(number, elapsed);
            (Some(number), [change[0], change[1], c, s])
        }));
        let mut sums = (motion, changes.clone());
        for k in 1..=TERMS {
            let share = h / f64::from(k);
            for ((number, term), (_, sum)) in changes.iter_mut().zip(&mut sums.1) {
                let parameter = number.map(|number| parameters[number]);
                let [dx, dv, dc, ds] = *term;
                let by_omega = if parameter == Some(Parameter::Omega) { 1.0 } else { 0.0 };
                let direct = parameter.map_or(0.0, |parameter| {
                    system.held_acceleration_by(
                        parameter,
                        [motion[2], motion[3]],
                        &[motion[0], motion[1], 0.0, 0.0],
                    )
                });
                *term = [
                    dv,
                    acceleration(dc, dx, dv) + direct,
                    -omega * ds - by_omega * motion[3],
                    omega * dc + by_omega * motion[2],
                ]
                .map(|rate| rate * share);
                *sum = super::series::sum(*sum, *term);
            }
            let [ox, ov, oc, os] = motion;
            motion = [ov, acceleration(oc, ox, ov), -omega * os, omega * oc].map(|rate| rate * share);
            sums.0 = sum(sums.0, motion);
        }
        [x, v, ..] = sums.0;
        let columns = by_state.iter_mut().chain(by.iter_mut());
        for (column, (_, end)) in columns.zip(&sums.1) {
            let wall = column[2] - column[0];
            *column = [end[0], end[1], end[0] + wall, end[1]];
        }
    }
}
