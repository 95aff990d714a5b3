//! The largest values of a run beside E1max: those that limits are set on, from any phase of the force, in a window or once the
//! motion has settled. Only what is asked for is looked at.

use crate::follow::{follow_bare, follow_coupled};
use crate::free::Free;
use crate::observe::{
    BareEnergy, Observer, Path, Peak, PrimaryEnergy, RelativePosition, Segment, Unobserved,
};
use crate::plausible;
use crate::run::e1_max;
use crate::settings::{Extreme, Method, Settings, SolverError, Window};
use crate::steps::Steps;
use retune_model::{Bare, Coupled, Scene, Side, hertz_force};
use std::f64::consts::TAU;

/// What is asked of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// φ of the force `P cos(ωt + φ)`, rad. The run starts at rest at t = 0 as ever; any other value than 0 needs ω > 0.
    pub phase: f64,
    /// Whether the stroke and the contact forces are wanted too.
    pub walls: bool,
    /// The run may end early, with any value above this one (J), once E1max exceeds it.
    pub cutoff: f64,
}

impl Default for Ask {
    fn default() -> Self {
        Self { phase: 0.0, walls: false, cutoff: f64::INFINITY }
    }
}

/// The largest values of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest energy of the primary structure, J, and when.
    pub e1_max: Extreme,
    /// Largest `|x2 - x1 - D|`, m; 0 where it was not asked for, or without a damper.
    pub stroke: f64,
    /// Largest contact force on either wall, N; 0 where it was not asked for, or without a damper.
    pub force: f64,
    /// Whether the motion has settled, where that was asked.
    pub settled: bool,
}

/// When a motion counts as settled: the E1max of successive blocks of time agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// Length of a block in periods of the force, at least 1. It must be no shorter than the motion's own period.
    pub periods: u32,
    /// How many blocks in a row must agree, at least 2.
    pub blocks: u32,
    /// Largest difference of their E1max, as a share of the largest of them.
    pub tolerance: f64,
}

impl Default for Settle {
    fn default() -> Self {
        Self { periods: 6, blocks: 3, tolerance: 1e-5 }
    }
}

/// The largest values over a window.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn extremes(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    if ask.phase == 0.0 && !ask.walls {
        let e1_max = e1_max(scene, window, settings, ask.cutoff)?;
        return Ok(Extremes { e1_max, stroke: 0.0, force: 0.0, settled: true });
    }
    let start = start(scene, ask.phase);
    let later = Window { from: start + window.from, to: start + window.to };
    let mut seen = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing);
            let mut peak = Peak::new(BareEnergy::new(&system), ask.cutoff);
            follow_bare(&system, start, later, settings, &mut Unobserved, &mut peak)?;
            Extremes { e1_max: peak.record(), stroke: 0.0, force: 0.0, settled: true }
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            let mut peaks = peaks(&system, ask);
            follow_coupled(&system, start, later, settings, &mut Unobserved, &mut peaks)?;
            peaks.extremes(&system)
        }
    };
    seen.e1_max.time -= start;
    plausible::energy(scene, window, settings, seen.e1_max)?;
    Ok(seen)
}

/// The largest values once the motion has settled: over the first blocks, counted from t = 0, that agree as `settle` says. A
/// scene whose damper provably stays off both walls is answered in closed form.
///
/// A motion that has not settled by the end of `window` is told by [`Extremes::settled`]; its values are then those of all
/// blocks that begin in the window (of the last block, if none does).
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
    let (start, omega) = (start(scene, ask.phase), scene.forcing.frequency.get());
    let block = f64::from(settle.periods) * TAU / omega;
    let whole = Window { from: start, to: start + window.to };
    let timing = Timing { block, start, from: start + window.from, settle };
    let ask = Ask { cutoff: f64::INFINITY, ..ask };
    let closed = |e1_max: f64, stroke: f64| Extremes {
        e1_max: Extreme { value: e1_max, time: window.to },
        stroke: if ask.walls { stroke } else { 0.0 },
        force: 0.0,
        settled: true,
    };
    let mut seen = match &scene.damper {
        None => {
            let steady = Bare::new(&scene.primary, &scene.forcing).steady(omega);
            return Ok(closed(steady.e1_max, 0.0));
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            let steady = system.steady(omega);
            let free = Free::new(&system, window.to, settings.max_steps).started(start);
            if settings.method == Method::Hybrid && free.clears_walls() && steady.e1_max.is_finite() {
                return Ok(closed(steady.e1_max, steady.stroke()));
            }
            let mut blocks = Blocks::new(timing, || peaks(&system, ask), |peaks| peaks.extremes(&system));
            follow_coupled(&system, start, whole, settings, &mut Unobserved, &mut blocks)?;
            blocks.verdict()
        }
    };
    seen.e1_max.time -= start;
    plausible::energy(scene, Window { from: 0.0, ..window }, settings, seen.e1_max)?;
    Ok(seen)
}

/// The time at which the force `P cos ωt` has a phase, s: where a run starts that is to have it at its beginning.
fn start(scene: &Scene, phase: f64) -> f64 {
    let omega = scene.forcing.frequency.get();
    if phase == 0.0 || omega == 0.0 { 0.0 } else { phase / omega }
}

/// E1max and, where they are asked for, the ends of the stroke.
struct Peaks<'a> {
    e1: Peak<PrimaryEnergy<'a>>,
    stroke: Option<[Peak<RelativePosition<'a>>; 2]>,
}

fn peaks(system: &Coupled, ask: Ask) -> Peaks<'_> {
    let side = |sign: f64| Peak::new(RelativePosition::new(system, sign), f64::INFINITY);
    Peaks {
        e1: Peak::new(PrimaryEnergy::new(system), ask.cutoff),
        stroke: ask.walls.then(|| [1.0, -1.0].map(side)),
    }
}

impl Peaks<'_> {
    fn extremes(&self, system: &Coupled) -> Extremes {
        let Some([farthest, nearest]) = &self.stroke else {
            return Extremes { e1_max: self.e1.record(), stroke: 0.0, force: 0.0, settled: true };
        };
        let (far, near) = (farthest.record().value, -nearest.record().value);
        let rest = system.rest_distance();
        let force = |side: Side, z: f64| hertz_force(system.hertz(side), z);
        Extremes {
            e1_max: self.e1.record(),
            stroke: (far - rest).abs().max((near - rest).abs()),
            force: force(Side::Primary, -near).max(force(Side::Obstacle, far - system.wall(Side::Obstacle))),
            settled: true,
        }
    }
}

impl Observer<4> for Peaks<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.e1.segment(segment);
        self.stroke.iter_mut().flatten().for_each(|peak| peak.segment(segment));
    }
    fn path(&mut self, path: &impl Path<4>) {
        self.e1.path(path);
        self.stroke.iter_mut().flatten().for_each(|peak| peak.path(path));
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.e1.steps(steps);
        self.stroke.iter_mut().flatten().for_each(|peak| peak.steps(steps));
    }
    fn satisfied(&self) -> bool {
        Observer::<4>::satisfied(&self.e1)
    }
}

/// When blocks begin and which of them count.
struct Timing {
    /// Length of a block, s.
    block: f64,
    /// When the first begins, s.
    start: f64,
    /// When the first begins that counts though the motion has not settled, s.
    from: f64,
    settle: Settle,
}

/// The extremes of one block after the other, until they agree. A piece of the motion belongs to the block that it begins in.
struct Blocks<P, N, R> {
    timing: Timing,
    now: P,
    fresh: N,
    read: R,
    /// Blocks that are finished; of those that do not matter any more only the largest values are kept.
    done: u32,
    last: Vec<Extremes>,
    /// Of a motion that does not settle; and whether these blocks count.
    unsettled: Option<(Extremes, bool)>,
}

impl<P, N: Fn() -> P, R: Fn(&P) -> Extremes> Blocks<P, N, R> {
    fn new(timing: Timing, fresh: N, read: R) -> Self {
        Self { timing, now: fresh(), fresh, read, done: 0, last: Vec::new(), unsettled: None }
    }

    /// Begins the next block if the present one ends before `t` (s).
    fn roll(&mut self, t: f64) {
        if t < self.timing.start + f64::from(self.done + 1) * self.timing.block {
            return;
        }
        let block = std::mem::replace(&mut self.now, (self.fresh)());
        let extremes = (self.read)(&block);
        self.keep(extremes);
    }

    fn keep(&mut self, block: Extremes) {
        let counts = self.timing.start + f64::from(self.done) * self.timing.block >= self.timing.from;
        self.unsettled = match self.unsettled {
            Some((all, true)) => Some((larger(all, block), true)),
            _ => Some((block, counts)),
        };
        self.done += 1;
        if self.last.len() == self.timing.settle.blocks as usize {
            self.last.remove(0);
        }
        self.last.push(block);
    }

    fn agree(&self) -> bool {
        let energies = || self.last.iter().map(|block| block.e1_max.value);
        let (low, high) = (energies().fold(f64::INFINITY, f64::min), energies().fold(0.0, f64::max));
        self.last.len() == self.timing.settle.blocks as usize
            && high - low <= self.timing.settle.tolerance * high
    }

    fn verdict(mut self) -> Extremes {
        if self.agree() {
            let all = self.last.iter().copied().reduce(larger);
            return all.unwrap_or_else(|| (self.read)(&self.now));
        }
        let last = (self.read)(&self.now);
        if last.e1_max.value.is_finite() {
            self.keep(last); // the block that the end of the run cut short
        }
        Extremes { settled: false, ..self.unsettled.map_or(last, |(all, _)| all) }
    }
}

fn larger(a: Extremes, b: Extremes) -> Extremes {
    Extremes {
        e1_max: if b.e1_max.value > a.e1_max.value { b.e1_max } else { a.e1_max },
        stroke: a.stroke.max(b.stroke),
        force: a.force.max(b.force),
        settled: a.settled && b.settled,
    }
}

impl<P: Observer<4>, N: Fn() -> P, R: Fn(&P) -> Extremes> Observer<4> for Blocks<P, N, R> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.roll(segment.ends()[0].t);
        if !self.agree() {
            self.now.segment(segment);
        }
    }
    fn path(&mut self, path: &impl Path<4>) {
        self.now.path(path);
    }
    fn satisfied(&self) -> bool {
        self.agree()
    }
}
