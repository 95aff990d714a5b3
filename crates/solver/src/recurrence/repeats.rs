//! Runs that end when their motion repeats: what is left of a window is then whole periods that have been seen.
//!
//! A motion repeats if its states at whole periods of the force return for a while, and all that they will still change by, extrapolated
//! from how these changes fall, is below the tolerance of the run. So a run is not longer than its transient and a few periods, and what it
//! finds differs from what the whole run finds by no more than that tolerance allows the run itself (`just lab hunt-repeats` measures it).
//! One that converges to such a motion need not be followed to it (`ahead`).

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

/// The longest period of a motion that is seen to repeat, in periods of the force.
const LONGEST: usize = 6;
/// Blocks of periods in which states must return.
const BLOCKS: usize = 3;
/// Share of a state by which it differs from an earlier one at most if the motion may soon repeat.
const NEAR: f64 = 0.02;
/// A motion that returns less closely than this may be irregular, whatever the tolerance of the run.
const LOOSEST: f64 = 1e-5;

/// What is known of a motion.
#[derive(Clone, Copy)]
enum Known {
    /// It repeats after so many periods.
    Repeats(usize),
    /// It will, and where it is when the window begins.
    Converges(Converging),
}

/// Whether a motion repeats, while it is followed.
struct Repeats<'a> {
    system: &'a Coupled,
    tolerance: f64,
    passing: Periods,
    /// The latest states at whole periods, and how many there are. (A run allocates nothing.)
    states: [[f64; 4]; BLOCKS * LONGEST],
    held: usize,
    /// Whether the motion is far from repeating. Then only the state after every so many periods is compared.
    far: bool,
    /// The extrapolation, if what is left before the window may be passed over.
    ahead: Option<Extrapolation<'a>>,
    known: Option<Known>,
}

impl<'a> Repeats<'a> {
    fn new(system: &'a Coupled, settings: &Settings, ahead: Option<Extrapolation<'a>>) -> Self {
        let passing = Periods::of(TAU / system.bare().frequency());
        let (tolerance, states) = (settings.rtol.min(LOOSEST), [[0.0; 4]; BLOCKS * LONGEST]);
        Self { system, tolerance, passing, states, held: 0, far: true, ahead, known: None }
    }

    /// Keeps a state at a time, s, and tells whether it is one of a motion that repeats.
    fn keep(&mut self, t: f64, state: [f64; 4]) {
        if self.held == self.states.len() {
            self.states.rotate_left(1);
            self.held -= 1;
        }
        let omega = self.system.bare().frequency();
        let latest = self.states[..self.held].iter().rev().take(if self.far { 1 } else { LONGEST });
        let nearest = |share| latest.clone().position(|earlier| is_near(&state, earlier, omega, share));
        let (near, back) = (nearest(NEAR).is_some(), nearest(4.0 * self.tolerance));
        let close = self.ahead.as_ref().and_then(|ahead| nearest(ahead.close));
        self.states[self.held] = state;
        self.held += 1;
        // A motion of several periods is not near to itself after one.
        if self.far == near && (near || self.held > LONGEST) {
            self.far = !near;
            self.states[0] = state;
            self.held = 1;
        } else if let Some(motion) = close.filter(|_| !self.far).and_then(|back| self.converges(t, back + 1))
        {
            self.known = Some(Known::Converges(motion));
        } else if let Some(back) = back.filter(|_| !self.far) {
            let periods = (back + 1).max(2);
            let settle = Settle { periods: periods as u32, blocks: BLOCKS as u32, tolerance: self.tolerance };
            let latest = &self.states[self.held.saturating_sub(BLOCKS * periods)..self.held];
            let test = Recurrence::to_the_end(self.system, settle);
            self.known = test.has_settled(latest).then_some(Known::Repeats(periods));
        }
        if self.far {
            self.passing.skip(LONGEST - 1);
        }
    }
}

/// Whether two states differ by less than a share of their sizes, `ω |x| + |v|` of both bodies.
fn is_near(a: &[f64; 4], b: &[f64; 4], omega: f64, share: f64) -> bool {
    let size = |[x1, v1, x2, v2]: [f64; 4]| omega * (x1.abs() + x2.abs()) + v1.abs() + v2.abs();
    size(std::array::from_fn(|i| a[i] - b[i])) <= share * size(*a)
}

impl Repeats<'_> {
    /// Extrapolates from the latest state, at `t` (s), that returns closely after some periods.
    #[inline(never)]
    fn converges(&mut self, t: f64, periods: usize) -> Option<Converging> {
        self.ahead.as_mut()?.converges(t, &self.states[..self.held], periods)
    }

    /// Keeps the states among some steps.
    #[inline(never)]
    fn among(&mut self, steps: &Steps<'_, 4>) {
        for number in 0..steps.count() {
            if self.passing.pass_by(steps.time(number + 1)) {
                self.segment(&steps.step(number));
            }
        }
    }
}

impl Observer<4> for Repeats<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let mut latest = None;
        let t = self.passing.states(segment, |state| latest = Some(state));
        if let Some(state) = latest.filter(|_| self.known.is_none()) {
            self.keep(t, state);
        }
    }
    /// A moment within a contact of some milliseconds is put off to its end, period after period: it would cost more to look inside.
    fn path(&mut self, _path: &dyn Path<4>) {}
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        if self.passing.pass_by(steps.time(steps.count())) {
            self.among(steps);
        }
    }
    fn satisfied(&self) -> bool {
        self.known.is_some()
    }
}

/// Whether a run to `to` (s) that is observed from `from` (s) on is longer than it takes to see that its motion repeats, with a force of
/// this period, s.
pub fn has_room(period: f64, from: f64, to: f64) -> bool {
    from + (LONGEST + 1) as f64 * period < to
}

/// Follows a structure and its damper from their start at t = 0 to the end of the window or until the motion repeats; it is then observed
/// from `late` (s) on, or from the start of the window, whichever is later, for as many periods as it takes to repeat. Returns the last state
/// that was reached, and the work.
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
    // Nothing before the window is passed over if it is observed, too.
    let ahead = if late == window.from { Extrapolation::new(system, window, settings) } else { None };
    let mut repeats = Repeats::new(system, settings, ahead);
    let mut now = Motion::start(system);
    if window.from > 0.0 {
        now = hybrid.propagate_for(now, window.from, before, Some(&mut repeats))?;
    }
    if repeats.known.is_none() {
        now = hybrid.propagate_for(now, window.to, observer, Some(&mut repeats))?;
    }
    match repeats.known.filter(|_| !observer.satisfied()) {
        None => {}
        Some(Known::Converges(Converging { late, repeats })) => {
            now = hybrid.propagate(late, window.from, &mut Unobserved)?;
            now = hybrid.propagate_for(now, repeats, observer, None)?;
        }
        Some(Known::Repeats(periods)) => {
            let span = periods as f64 * period;
            let [begin, end] = if now.t < from {
                // After whole periods of the force it moves as it does now.
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
