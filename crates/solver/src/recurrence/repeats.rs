//! Runs that end when their motion repeats: the rest of a window would only repeat periods that have been observed.
//!
//! A motion repeats if its states at whole periods of the force recur for a while, and the sum of all future changes, extrapolated from
//! their decay, is below the tolerance of the run. So a run is no longer than its transient and a few periods, and its results differ from
//! those of the whole run by no more than the error that the tolerance allows the run itself (`just lab hunt-repeats` measures it). A run
//! that converges to such a motion need not be followed until it does (`ahead`).

use super::ahead::{Converging, Extrapolation};
use super::section::Periods;
use super::test::{Recurrence, Settle};
use crate::error::SolverError;
use crate::hybrid::propagator::{Hybrid, Motion};
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Path, Unobserved};
use crate::response::Work;
use crate::settings::{Settings, Window};
use retune_model::Coupled;
use std::f64::consts::TAU;

/// The longest period of a motion that is detected, in periods of the force.
const LONGEST: usize = 6;
/// Blocks of periods in which states must return.
const BLOCKS: usize = 3;
/// Largest relative change of a state from an earlier one at which the motion may soon repeat.
const NEAR: f64 = 0.02;
/// A motion that returns less closely than this may be irregular, whatever the tolerance of the run.
const LOOSEST: f64 = 1e-5;

/// What has been detected of a motion.
#[derive(Clone, Copy)]
enum Outcome {
    /// It repeats after this many periods.
    Repeats(usize),
    /// It will repeat; where it is when the window begins.
    Converges(Converging),
}

/// Detects whether a motion repeats while it is followed.
struct RepeatDetector<'a> {
    system: &'a Coupled,
    tolerance: f64,
    periods: Periods,
    /// The latest states at whole periods, and how many there are. (A run allocates nothing.)
    states: [[f64; 4]; BLOCKS * LONGEST],
    count: usize,
    /// Whether the motion is far from repeating. Then only the states [`LONGEST`] periods apart are compared.
    far: bool,
    /// The extrapolation, if the rest of the run before the window may be skipped.
    ahead: Option<Extrapolation<'a>>,
    outcome: Option<Outcome>,
}

impl<'a> RepeatDetector<'a> {
    fn new(system: &'a Coupled, settings: &Settings, ahead: Option<Extrapolation<'a>>) -> Self {
        let periods = Periods::of(TAU / system.bare().frequency());
        let (tolerance, states) = (settings.rtol.min(LOOSEST), [[0.0; 4]; BLOCKS * LONGEST]);
        Self { system, tolerance, periods, states, count: 0, far: true, ahead, outcome: None }
    }

    /// Stores a state at a time, s, and tests whether the motion repeats.
    fn push_state(&mut self, t: f64, state: [f64; 4]) {
        if self.count == self.states.len() {
            self.states.rotate_left(1);
            self.count -= 1;
        }
        let omega = self.system.bare().frequency();
        let latest = self.states[..self.count].iter().rev().take(if self.far { 1 } else { LONGEST });
        let nearest = |share| latest.clone().position(|earlier| is_near(&state, earlier, omega, share));
        let (near, back) = (nearest(NEAR).is_some(), nearest(4.0 * self.tolerance));
        let close = self.ahead.as_ref().and_then(|ahead| nearest(ahead.close));
        self.states[self.count] = state;
        self.count += 1;
        // A motion whose period is several of the force's is not near to itself after one.
        if self.far == near && (near || self.count > LONGEST) {
            self.far = !near;
            self.states[0] = state;
            self.count = 1;
        } else if let Some(motion) =
            close.filter(|_| !self.far).and_then(|back| self.extrapolate(t, back + 1))
        {
            self.outcome = Some(Outcome::Converges(motion));
        } else if let Some(back) = back.filter(|_| !self.far) {
            let periods = (back + 1).max(2);
            let settle = Settle { periods: periods as u32, blocks: BLOCKS as u32, tolerance: self.tolerance };
            let latest = &self.states[self.count.saturating_sub(BLOCKS * periods)..self.count];
            let test = Recurrence::exhaustive(self.system, settle);
            self.outcome = test.has_settled(latest).then_some(Outcome::Repeats(periods));
        }
        if self.far {
            self.periods.skip(LONGEST - 1);
        }
    }
}

/// Whether two states differ by less than a share of their sizes, `ω |x| + |v|` of both bodies.
fn is_near(a: &[f64; 4], b: &[f64; 4], omega: f64, share: f64) -> bool {
    let size = |[x1, v1, x2, v2]: [f64; 4]| omega * (x1.abs() + x2.abs()) + v1.abs() + v2.abs();
    size(std::array::from_fn(|i| a[i] - b[i])) <= share * size(*a)
}

impl RepeatDetector<'_> {
    /// Extrapolates from the latest state, at `t` (s), which nearly repeats after `periods` periods.
    #[inline(never)]
    fn extrapolate(&mut self, t: f64, periods: usize) -> Option<Converging> {
        self.ahead.as_mut()?.extrapolate(t, &self.states[..self.count], periods)
    }

    /// Stores the states at whole periods within some steps.
    #[inline(never)]
    fn scan_steps(&mut self, steps: &Steps<'_, 4>) {
        for number in 0..steps.count() {
            if self.periods.is_due_by(steps.time(number + 1)) {
                self.segment(&steps.step(number));
            }
        }
    }
}

impl Observer<4> for RepeatDetector<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let mut latest = None;
        let t = self.periods.states(segment, |state| latest = Some(state));
        if let Some(state) = latest.filter(|_| self.outcome.is_none()) {
            self.push_state(t, state);
        }
    }
    /// A period that ends within a contact of some milliseconds is sampled at the end of the contact, in every period alike: looking inside
    /// would cost more.
    fn path(&mut self, _path: &dyn Path<4>) {}
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        if self.periods.is_due_by(steps.time(steps.count())) {
            self.scan_steps(steps);
        }
    }
    fn satisfied(&self) -> bool {
        self.outcome.is_some()
    }
}

/// Whether a run to `to` (s) that is observed from `from` (s) on is long enough for repetition to be detected, with a force of this period,
/// s.
pub fn has_room(period: f64, from: f64, to: f64) -> bool {
    from + (LONGEST + 1) as f64 * period < to
}

/// Follows a structure and its damper from their start at t = 0 to the end of the window or until the motion repeats; it is then observed
/// for one repetition from `late` (s) on, or from the start of the window, whichever is later. Returns the last state reached, and the
/// work.
pub fn follow_until_it_repeats(
    system: &Coupled,
    window: Window,
    late: f64,
    settings: &Settings,
    before: &mut dyn Observer<4>,
    observer: &mut (impl Observer<4> + ?Sized),
) -> Result<([f64; 4], Work), SolverError> {
    let period = TAU / system.bare().frequency();
    let from = window.from.max(late);
    let mut hybrid = Hybrid::new(system, settings.rtol, window.to, settings.max_steps);
    // The motion before the window is not skipped if it is observed, too.
    let ahead = if late == window.from { Extrapolation::new(system, window, settings) } else { None };
    let mut repeats = RepeatDetector::new(system, settings, ahead);
    let mut now = Motion::start(system);
    if window.from > 0.0 {
        now = hybrid.propagate_for(now, window.from, before, Some(&mut repeats))?;
    }
    if repeats.outcome.is_none() {
        now = hybrid.propagate_for(now, window.to, observer, Some(&mut repeats))?;
    }
    match repeats.outcome.filter(|_| !observer.satisfied()) {
        None => {}
        Some(Outcome::Converges(Converging { late, repeats })) => {
            now = hybrid.propagate(late, window.from, &mut Unobserved)?;
            now = hybrid.propagate_for(now, repeats, observer, None)?;
        }
        Some(Outcome::Repeats(periods)) => {
            let span = periods as f64 * period;
            let [begin, end] = if now.t < from {
                // A whole number of periods of the force later, the motion is the same.
                let begin = now.t + ((from - now.t) / period).ceil() * period;
                [begin, begin + span]
            } else {
                [now.t, from + span]
            };
            if begin < end {
                now = hybrid.propagate_for(Motion { t: begin, ..now }, end, observer, None)?;
            }
        }
    }
    Ok((now.y, hybrid.work))
}
