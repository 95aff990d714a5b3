//! Extrapolation: predicts where a run will be when the window begins, from the periodic motion to which it converges.

use super::limit::{Limit, LimitOptions, NEGLECTED, limit};
use super::test::{Recurrence, Settle};
use crate::hybrid::propagator::{Hybrid, Motion, Phase};
use crate::observe::observer::Unobserved;
use crate::settings::{Settings, Window};
use retune_model::Coupled;
use std::f64::consts::TAU;

/// Largest relative change of a state from an earlier one for the first attempt, and the factor on it for the next one.
const CLOSE: f64 = 1e-3;
const CLOSER: f64 = 0.1;
/// The longest period that is sought, in periods of the force. An attempt follows seven or eight such periods of the motion.
const PERIODS: usize = 2;
/// The number of periods of the motion that must be left before the window for an attempt to pay.
const WORTH: u32 = 12;
/// The loosest tolerance at which an attempt pays.
const LOOSEST: f64 = 1e-7;

/// Predicts where a run will be at the start of a window.
pub struct Extrapolation<'a> {
    system: &'a Coupled,
    window: Window,
    settings: Settings,
    /// Largest relative change of a state from an earlier one for the next attempt.
    pub close: f64,
}

/// A run that converges to a periodic motion.
#[derive(Clone, Copy)]
pub struct Converging {
    /// A moment of the run less than a few periods before the start of the window.
    pub late: Motion,
    /// The time, s, from which on the run only repeats what has been observed in the window; at most the end of the window.
    pub repeats: f64,
}

impl<'a> Extrapolation<'a> {
    /// For a run to a window; `None` at tolerances so loose that following the run is less work.
    pub fn new(system: &'a Coupled, window: Window, settings: &Settings) -> Option<Self> {
        (settings.rtol <= LOOSEST).then_some(Self { system, window, settings: *settings, close: CLOSE })
    }

    /// Predicts a run that has these states at whole periods of the force, the last at `t` (s), and nearly repeats after `periods` of them;
    /// `None` if that is impossible or not worth the work.
    pub fn extrapolate(&mut self, t: f64, states: &[[f64; 4]], periods: usize) -> Option<Converging> {
        let Self { system, window, ref settings, .. } = *self;
        let omega = system.bare().frequency();
        let span = periods as f64 * TAU / omega;
        let counts = [window.from - t, window.to - window.from].map(|time| (time / span) as u32);
        let last = states.len() - 1;
        if periods > PERIODS || counts[0] < WORTH || last < 2 * periods {
            return None;
        }
        let test = Recurrence::exhaustive(system, Settle::default());
        let size = test.size(&states[last + 1 - periods..]);
        let change = |i: usize| test.change(&states[i], &states[i - periods], size);
        let returns = last / periods - 1;
        let fall = (change(last) / change(last - returns * periods)).powf(1.0 / returns as f64);
        // Each map may be wrong by the root of the tolerance, relative to the transient that will be left, which is extrapolated from the
        // decay of the changes so far.
        let left = change(last) * fall.powi(counts[0] as i32);
        if f64::from(counts[0]) * left > NEGLECTED * settings.rtol.sqrt() {
            return None;
        }
        self.close *= CLOSER;
        let now = states[last];
        let rates = [omega, 1.0, omega, 1.0];
        let speed = now.iter().zip(rates).map(|(y, rate)| rate * y.abs()).fold(0.0, f64::max);
        let options = LimitOptions {
            counts,
            share: |change: &[f64; 4]| test.change(change, &[0.0; 4], size),
            tolerance: settings.rtol,
            scales: rates.map(|rate| speed / rate),
        };
        // A separate propagator, so that the extrapolation does not affect the observed run.
        let mut hybrid = Hybrid::new(system, settings.rtol, span, settings.max_steps);
        let moment = |t: f64, y: [f64; 4]| Motion { t, y, phase: Phase::of(system, &y) };
        let map = |y| hybrid.propagate(moment(t, y), t + span, &mut Unobserved).ok().map(|end| end.y);
        let Limit { state, left, more } = limit(map, now, &options)?;
        let late = moment(t + f64::from(counts[0]) * span, std::array::from_fn(|i| state[i] + left[i]));
        Some(Converging { late, repeats: window.to.min(window.from + f64::from(more + 1) * span) })
    }
}
