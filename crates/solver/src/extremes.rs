//! The largest values of a run beside E1max: those that limits are set on, from any phase of the force. Only what is asked for is
//! looked at.

use crate::follow::{follow_bare, follow_coupled};
use crate::observe::{
    BareEnergy, Form, Knot, Observer, Path, Peak, PrimaryEnergy, RelativePosition, Segment, Unobserved,
};
use crate::plausible;
use crate::run::e1_max;
use crate::settings::{Extreme, Settings, SolverError, Window};
use crate::steps::Steps;
use retune_model::{Bare, Coupled, Scene, Side, hertz_force};

/// What is asked of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// φ of the force `P cos(ωt + φ)`, rad. The run starts at rest at t = 0 as ever.
    pub phase: f64,
    /// From when on the stroke and the contact forces are wanted too, s: 0 for the whole run, whatever the window of E1max;
    /// `None` where they are not wanted.
    pub walls: Option<f64>,
    /// The run may end early, with any value above this one (J), once E1max exceeds it.
    pub cutoff: f64,
}

impl Default for Ask {
    fn default() -> Self {
        Self { phase: 0.0, walls: None, cutoff: f64::INFINITY }
    }
}

/// The largest values of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest energy of the primary structure, J, and when.
    pub e1_max: Extreme,
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m; 0 where it was not asked for, or without a damper.
    pub stroke: f64,
    /// Largest contact force on either wall, N; 0 where it was not asked for, or without a damper.
    pub force: f64,
    /// Whether the motion has settled, where that was asked.
    pub settled: bool,
}

/// The largest E1 over a window, and the stroke and the force from [`Ask::walls`] to its end.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn extremes(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let nothing = |e1_max| Extremes { e1_max, stroke: 0.0, force: 0.0, settled: true };
    if ask.phase == 0.0 && ask.walls.is_none() {
        return Ok(nothing(e1_max(scene, window, settings, ask.cutoff)?));
    }
    let seen = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing).with_phase(ask.phase);
            let mut peak = Peak::new(BareEnergy::new(&system), ask.cutoff);
            follow_bare(&system, 0.0, window, settings, &mut Unobserved, &mut peak)?;
            nothing(peak.record())
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
            let mut before = walls(&system, ask.walls);
            let mut seen = peaks(&system, ask);
            follow_coupled(&system, 0.0, window, settings, &mut before, &mut seen)?;
            let ([stroke, force], seen) = (before.reached(&system), seen.extremes(&system));
            Extremes { stroke: stroke.max(seen.stroke), force: force.max(seen.force), ..seen }
        }
    };
    plausible::energy(scene, window, settings, seen.e1_max)?;
    Ok(seen)
}

/// The ends of the relative displacement `x2 - x1` from a time on, where they are asked for.
pub(crate) struct Walls<'a> {
    from: f64,
    /// Whether that time is over.
    began: bool,
    ends: Option<[Peak<RelativePosition<'a>>; 2]>,
}

pub(crate) fn walls(system: &Coupled, from: Option<f64>) -> Walls<'_> {
    let side = |sign: f64| Peak::new(RelativePosition::new(system, sign), f64::INFINITY);
    Walls {
        from: from.unwrap_or(f64::INFINITY),
        began: from.is_some_and(|from| from <= 0.0),
        ends: from.map(|_| [1.0, -1.0].map(side)),
    }
}

impl Walls<'_> {
    /// The stroke, m, and the largest force, N.
    pub(crate) fn reached(&self, system: &Coupled) -> [f64; 2] {
        let Some([farthest, nearest]) = &self.ends else { return [0.0; 2] };
        let (far, near) = (farthest.record().value, -nearest.record().value);
        if far < near {
            return [0.0; 2]; // nothing was looked at
        }
        let rest = system.rest_distance();
        let force = |side: Side, z: f64| hertz_force(system.hertz(side), z);
        [
            (far - rest).abs().max((near - rest).abs()),
            force(Side::Primary, -near).max(force(Side::Obstacle, far - system.wall(Side::Obstacle))),
        ]
    }
}

impl Observer<4> for Walls<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        let ends = segment.ends().map(|knot| knot.t);
        self.began |= ends[0] >= self.from;
        let peaks = self.ends.iter_mut().flatten();
        if self.began {
            peaks.for_each(|peak| peak.segment(segment));
        } else if ends[1] > self.from {
            let tail = Tail::new(segment, self.from);
            peaks.for_each(|peak| peak.segment(&tail));
        }
    }
    fn path(&mut self, path: &impl Path<4>) {
        if self.began {
            self.ends.iter_mut().flatten().for_each(|peak| peak.path(path));
        } else if self.ends.is_some() {
            (0..path.pieces()).for_each(|piece| path.show(piece, self));
        }
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.began |= steps.from().t >= self.from;
        if self.began {
            self.ends.iter_mut().flatten().for_each(|peak| peak.steps(steps));
        } else if steps.time(steps.count()) > self.from {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
}

/// What follows a moment inside a piece.
struct Tail<'a, S> {
    whole: &'a S,
    skipped: f64,
    begin: Knot<4>,
}

impl<'a, S: Segment<4>> Tail<'a, S> {
    fn new(whole: &'a S, t: f64) -> Self {
        let (mut before, mut skipped) = (0.0, whole.length());
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (before + skipped);
            if whole.at(middle).t < t { before = middle } else { skipped = middle }
        }
        Self { whole, skipped, begin: whole.at(skipped) }
    }
}

impl<S: Segment<4>> Segment<4> for Tail<'_, S> {
    fn ends(&self) -> [&Knot<4>; 2] {
        [&self.begin, self.whole.ends()[1]]
    }
    fn length(&self) -> f64 {
        self.whole.length() - self.skipped
    }
    fn at(&self, theta: f64) -> Knot<4> {
        self.whole.at(self.skipped + theta)
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        self.whole.at_time(t)
    }
    fn in_flight(&self) -> bool {
        self.whole.in_flight()
    }
    fn quintic_error(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64, sharp: bool) -> Option<f64> {
        self.whole.quintic_error(form, ends, h, sharp)
    }
}

/// E1max, and stroke and force where they are asked for.
pub(crate) struct Peaks<'a> {
    e1: Peak<PrimaryEnergy<'a>>,
    walls: Walls<'a>,
}

pub(crate) fn peaks(system: &Coupled, ask: Ask) -> Peaks<'_> {
    Peaks { e1: Peak::new(PrimaryEnergy::new(system), ask.cutoff), walls: walls(system, ask.walls) }
}

impl Peaks<'_> {
    pub(crate) fn extremes(&self, system: &Coupled) -> Extremes {
        let [stroke, force] = self.walls.reached(system);
        Extremes { e1_max: self.e1.record(), stroke, force, settled: true }
    }
}

impl Observer<4> for Peaks<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.e1.segment(segment);
        self.walls.segment(segment);
    }
    fn path(&mut self, path: &impl Path<4>) {
        self.e1.path(path);
        self.walls.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.e1.steps(steps);
        self.walls.steps(steps);
    }
    fn satisfied(&self) -> bool {
        Observer::<4>::satisfied(&self.e1)
    }
}
