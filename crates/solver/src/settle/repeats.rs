//! Runs that end when their motion repeats: what is left of a window is then whole periods that have been seen.
//!
//! A motion repeats if its states at whole periods of the force return for a while, and all that they will still change by, extrapolated
//! from how these changes fall, is below the tolerance of the run. So a run is not longer than its transient and a few periods, and what it
//! finds differs from what the whole run finds by no more than that tolerance allows the run itself (`just hunt-repeats` measures it).

use super::recurrence::{Recurrence, Settle};
use super::section::PoincareSection;
use crate::error::SolverError;
use crate::hybrid::propagator::{Hybrid, Motion, Phase};
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Path};
use crate::run::follow_coupled;
use crate::settings::{Method, Settings, Window};
use retune_model::Coupled;
use std::f64::consts::TAU;

/// The longest period of a motion that is seen to repeat, in periods of the force.
const LONGEST: usize = 6;
/// Blocks of periods in which states must return.
const BLOCKS: u32 = 3;
/// Share of a state by which it differs from an earlier one at most if the motion may soon repeat.
const NEAR: f64 = 0.02;
/// A motion that returns less closely than this may be irregular, whatever the tolerance of the run.
const LOOSEST: f64 = 1e-5;

/// Whether a motion repeats, while it is followed.
struct Repeats<'a> {
    system: &'a Coupled,
    tolerance: f64,
    section: PoincareSection,
    /// States that have been looked at.
    seen: f64,
    /// The state [`LONGEST`] periods ago, as long as the motion is far from repeating; every period is then not worth a look.
    far: Option<[f64; 4]>,
    /// Periods after which it repeats.
    periods: Option<usize>,
}

impl<'a> Repeats<'a> {
    fn new(system: &'a Coupled, settings: &Settings) -> Self {
        let section = PoincareSection::new(TAU / system.bare().frequency(), BLOCKS as usize * LONGEST);
        let far = Some([f64::INFINITY; 4]);
        Self { system, tolerance: settings.rtol.min(LOOSEST), section, seen: 0.0, far, periods: None }
    }

    fn look(&mut self) {
        if self.section.count() == self.seen || self.periods.is_some() {
            return;
        }
        let omega = self.system.bare().frequency();
        let states = self.section.states();
        let Some((&latest, earlier)) = states.split_last() else { return };
        if let Some(before) = &mut self.far {
            if is_near(&latest, before, omega, NEAR) {
                self.far = None;
            } else {
                *before = latest;
                self.section.skip((LONGEST - 1) as f64);
            }
        } else {
            let nearest = |share: f64| {
                earlier.iter().rev().take(LONGEST).position(|earlier| is_near(&latest, earlier, omega, share))
            };
            if let Some(back) = nearest(4.0 * self.tolerance) {
                let periods = (back + 1).max(2);
                let settle = Settle { periods: periods as u32, blocks: BLOCKS, tolerance: self.tolerance };
                let latest = &states[states.len().saturating_sub(BLOCKS as usize * periods)..];
                let test = Recurrence::to_the_end(self.system, settle);
                self.periods = test.has_settled(latest).then_some(periods);
            } else if earlier.len() >= LONGEST && nearest(NEAR).is_none() {
                self.far = Some(latest);
                self.section.skip((LONGEST - 1) as f64);
            }
        }
        self.seen = self.section.count();
    }
}

/// Whether two states differ by less than a share of their sizes, `ω |x| + |v|` of both bodies.
fn is_near(a: &[f64; 4], b: &[f64; 4], omega: f64, share: f64) -> bool {
    let size = |[x1, v1, x2, v2]: [f64; 4]| omega * (x1.abs() + x2.abs()) + v1.abs() + v2.abs();
    size(std::array::from_fn(|i| a[i] - b[i])) <= share * size(*a)
}

impl Observer<4> for Repeats<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.section.segment(segment);
        self.look();
    }
    /// A moment within a contact of some milliseconds is put off to its end, period after period: it would cost more to look inside.
    fn path(&mut self, _path: &impl Path<4>) {}
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.section.steps(steps);
        self.look();
    }
    fn satisfied(&self) -> bool {
        self.periods.is_some()
    }
}

/// Follows a structure and its damper as [`follow_coupled`] does, to the end of the window or until the motion repeats; it is then observed
/// from `late` (s) on, or from the start of the window, whichever is later, for as many periods as it takes to repeat.
#[inline(always)]
pub fn follow_until_it_repeats(
    system: &Coupled,
    window: Window,
    late: f64,
    settings: &Settings,
    before: &mut impl Observer<4>,
    observer: &mut impl Observer<4>,
) -> Result<(), SolverError> {
    let period = TAU / system.bare().frequency();
    let from = window.from.max(late);
    let has_room = from + (LONGEST + 1) as f64 * period < window.to;
    if settings.method != Method::Hybrid || !system.has_walls() || !has_room {
        return follow_coupled(system, window, settings, before, observer).map(|_| ());
    }
    let mut hybrid = Hybrid::new(system, settings.rtol, window.to, settings.max_steps);
    let mut repeats = Repeats::new(system, settings);
    let y = system.start();
    let mut now = Motion { t: 0.0, y, phase: Phase::of(system, &y) };
    if window.from > 0.0 {
        now = hybrid.propagate(now, window.from, &mut (before, &mut repeats))?;
    }
    if repeats.periods.is_none() {
        now = hybrid.propagate(now, window.to, &mut (&mut *observer, &mut repeats))?;
    }
    let Some(periods) = repeats.periods.filter(|_| !observer.satisfied()) else {
        return Ok(());
    };
    let span = periods as f64 * period;
    let [begin, end] = if now.t < from {
        // After whole periods of the force it moves as it does now.
        let begin = now.t + ((from - now.t) / period).ceil() * period;
        [begin, begin + span]
    } else {
        [now.t, from + span]
    };
    if begin < end {
        hybrid.propagate(Motion { t: begin, ..now }, end, observer)?;
    }
    Ok(())
}
