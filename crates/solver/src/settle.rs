//! Settled motions: a run is followed until its state returns after some periods of the force, and what is left of its drift is
//! small.

mod recurrence;

use crate::extremes::{Ask, Extremes, peaks, walls};
use crate::follow::follow_coupled;
use crate::free::Free;
use crate::observe::{Observer, Path, Segment, Unobserved};
use crate::plausible;
use crate::settings::{Extreme, Method, Settings, SolverError, Window};
use crate::steps::Steps;
use recurrence::{Recurrence, Strobe};
use retune_model::{Bare, Coupled, Scene};
use std::f64::consts::TAU;

/// When a motion counts as settled: its state returns after some periods of the force, throughout successive blocks of time.
///
/// States are compared at whole periods of the force: the structure's as a share of the largest `√(m1 v1² + k1 x1²)`, the
/// damper's, relative to the structure, of the largest `√((x2 - x1 - D)² + (v2 - v1)²/ω²)` at these moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// Length of a block in periods of the force, at least 1; the longest period of a motion that can settle.
    pub periods: u32,
    /// How many blocks in a row must agree, at least 2.
    pub blocks: u32,
    /// The most by which the state may still change, as a share of its size: the change from return to return in the last block,
    /// and all that will follow if it keeps falling as it fell from block to block.
    pub tolerance: f64,
}

impl Default for Settle {
    fn default() -> Self {
        Self { periods: 6, blocks: 3, tolerance: 1e-5 }
    }
}

/// The largest E1 once the motion has settled: over the last of the first blocks, counted from t = 0, that agree as `settle`
/// says. A scene whose damper provably stays off both walls is answered in closed form.
///
/// Stroke and force are the largest from the block on in which [`Ask::walls`] lies; those of the settled motion count in any case.
///
/// A motion that has not settled by the end of `window` is told by [`Extremes::settled`]; its E1max is then that of all blocks
/// that begin in the window (of the last block, if none does).
///
/// [`Ask::cutoff`] is not used: a motion may leave a large energy behind and settle at a small one.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn settled(
    scene: &Scene,
    window: Window,
    settle: Settle,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let omega = scene.forcing.frequency.get();
    let closed = |e1_max: f64, stroke: f64| Extremes {
        e1_max: Extreme { value: e1_max, time: window.to },
        stroke,
        force: 0.0,
        settled: true,
    };
    let Some(damper) = &scene.damper else {
        return Ok(closed(Bare::new(&scene.primary, &scene.forcing).steady(omega).e1_max, 0.0));
    };
    let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
    let steady = system.steady(omega);
    let free = Free::new(&system, window.to, settings.max_steps);
    if settings.method == Method::Hybrid && free.clears_walls() && steady.e1_max.is_finite() {
        let Some(from) = ask.walls else { return Ok(closed(steady.e1_max, 0.0)) };
        let mut walls = walls(&system, ask.walls);
        let watched = Window { from: from.min(window.to), ..window };
        follow_coupled(&system, 0.0, watched, settings, &mut Unobserved, &mut walls)?;
        let [transient, _] = walls.reached(&system);
        return Ok(closed(steady.e1_max, steady.stroke().max(transient)));
    }
    let in_a_block = Ask { walls: ask.walls.map(|_| 0.0), cutoff: f64::INFINITY, ..ask };
    let mut blocks = Blocks {
        period: TAU / omega,
        periods: settle.periods,
        from: window.from,
        walls_from: ask.walls.unwrap_or(f64::INFINITY),
        strobe: Strobe::new(TAU / omega, settle),
        recurrence: Recurrence::new(&system, settle, settings),
        now: peaks(&system, in_a_block),
        fresh: || peaks(&system, in_a_block),
        read: |peaks: &_| crate::extremes::Peaks::extremes(peaks, &system),
        done: 0,
        walls: [0.0; 2],
        settled: None,
        unsettled: None,
    };
    let whole = Window { from: 0.0, ..window };
    follow_coupled(&system, 0.0, whole, settings, &mut Unobserved, &mut blocks)?;
    let seen = blocks.verdict();
    plausible::energy(scene, whole, settings, seen.e1_max)?;
    Ok(seen)
}

/// The extremes of one block after the other, until the motion has settled. A piece of the motion belongs to the block that it
/// begins in.
struct Blocks<'a, P, N, R> {
    /// Of the force, s.
    period: f64,
    /// How many of them a block has.
    periods: u32,
    /// When the first block begins that counts though the motion has not settled, s.
    from: f64,
    /// The first block whose stroke and force count ends after this, s.
    walls_from: f64,
    strobe: Strobe,
    recurrence: Recurrence<'a>,
    now: P,
    fresh: N,
    read: R,
    /// Blocks that are finished.
    done: u32,
    /// Largest stroke and force of those that count.
    walls: [f64; 2],
    /// The last block of a motion that has settled.
    settled: Option<Extremes>,
    /// Of a motion that does not settle; and whether these blocks count.
    unsettled: Option<(Extremes, bool)>,
}

impl<P, N: Fn() -> P, R: Fn(&P) -> Extremes> Blocks<'_, P, N, R> {
    /// When a block begins, s.
    fn begin(&self, block: u32) -> f64 {
        (f64::from(block) * f64::from(self.periods)) * self.period
    }

    /// Begins the next block if the present one ends before `t` (s).
    fn roll(&mut self, t: f64) {
        if t < self.begin(self.done + 1) || self.settled.is_some() {
            return;
        }
        let block = std::mem::replace(&mut self.now, (self.fresh)());
        let extremes = (self.read)(&block);
        self.keep(extremes);
        if self.recurrence.has_settled(self.strobe.states()) {
            self.settled = Some(extremes);
        }
    }

    fn keep(&mut self, block: Extremes) {
        let counts = self.begin(self.done) >= self.from;
        self.unsettled = match self.unsettled {
            Some((all, true)) if block.e1_max.value <= all.e1_max.value => Some((all, true)),
            Some((_, true)) => Some((block, true)),
            _ => Some((block, counts)),
        };
        self.done += 1;
        if self.begin(self.done) > self.walls_from {
            self.walls = [self.walls[0].max(block.stroke), self.walls[1].max(block.force)];
        }
    }

    fn verdict(mut self) -> Extremes {
        let found = match self.settled {
            Some(block) => block,
            None => {
                let last = (self.read)(&self.now);
                if last.e1_max.value.is_finite() {
                    self.keep(last); // the block that the end of the run cut short
                }
                Extremes { settled: false, ..self.unsettled.map_or(last, |(all, _)| all) }
            }
        };
        let [stroke, force] = self.walls;
        Extremes { stroke: stroke.max(found.stroke), force: force.max(found.force), ..found }
    }
}

impl<P: Observer<4>, N: Fn() -> P, R: Fn(&P) -> Extremes> Observer<4> for Blocks<'_, P, N, R> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.roll(segment.ends()[0].t);
        self.strobe.segment(segment);
        self.now.segment(segment);
    }
    fn path(&mut self, path: &impl Path<4>) {
        self.strobe.path(path);
        self.now.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.roll(steps.from().t);
        if steps.time(steps.count() - 1) < self.begin(self.done + 1) {
            self.strobe.steps(steps);
            self.now.steps(steps);
        } else {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
    fn satisfied(&self) -> bool {
        self.settled.is_some()
    }
}
