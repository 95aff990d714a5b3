//! What a study makes small, and what it may set limits on: the largest value of a [`Measure`], stroke and contact force, for any phase
//! of the force. Only those that are asked for are computed.

use crate::energy_bound;
use crate::error::SolverError;
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::displacement_range::DisplacementRange;
use crate::observe::magnitude::Magnitude;
use crate::observe::observer::{Observer, Path, Unobserved};
use crate::observe::quantity::{BareEnergy, PrimaryEnergy};
use crate::observe::running_maximum::RunningMaximum;
use crate::observe::structure::{Structure, StructureMotion};
use crate::recurrence::repeats::follow_until_it_repeats;
use crate::response::Extreme;
use crate::run::follow_bare;
use crate::settings::{Settings, Window};
use crate::simulate::e1_max;
use retune_model::{Bare, Coupled, Measure, Scene};

/// The question put to a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// What is measured.
    pub measure: Measure,
    /// φ of the force `P cos(ωt + φ)`, rad. The run starts at t = 0.
    pub phase: f64,
    /// The time, s, from which on stroke and contact forces are observed too: 0 for the whole run, whatever the window of what is
    /// measured; `None` if they are not needed.
    pub walls: Option<f64>,
    /// The run may end early, with any value above this one, in the unit of what is measured, once that exceeds it.
    pub cutoff: f64,
}

impl Default for Ask {
    fn default() -> Self {
        Self { measure: Measure::Energy, phase: 0.0, walls: None, cutoff: f64::INFINITY }
    }
}

/// The largest values of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest value of what is measured, in its unit, and when.
    pub largest: Extreme,
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m; 0 where it was not asked for, or without a damper.
    pub stroke: f64,
    /// Largest contact force on either wall, N; 0 where it was not asked for, or without a damper.
    pub force: f64,
    /// Whether the motion has settled; true where that was not asked.
    pub settled: bool,
}

/// The largest value of [`Ask::measure`] over a window, and the stroke and the force from [`Ask::walls`] to its end.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn extremes(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    if ask.phase == 0.0 && ask.walls.is_none() && ask.measure == Measure::Energy {
        let largest = e1_max(scene, window, settings, ask.cutoff)?;
        return Ok(Extremes { largest, stroke: 0.0, force: 0.0, settled: true });
    }
    let seen = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing).with_phase(ask.phase);
            in_bare(&system, window, settings, ask)
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
            in_coupled(&system, window, settings, ask)
        }
    };
    let seen = seen.map_err(|error| energy_bound::error(window, error))?;
    let largest = energy_bound::largest(scene, window, settings, ask.measure, seen.largest)?;
    Ok(Extremes { largest, ..seen })
}

fn in_bare(system: &Bare, window: Window, settings: &Settings, ask: Ask) -> Result<Extremes, SolverError> {
    let largest = match observed(ask.measure) {
        Observed::Motion(quantity) => {
            let mut size = Magnitude::new(|sign| quantity(system, sign), ask.cutoff);
            follow_bare(system, window, settings, &mut Unobserved, &mut size)?;
            size.record()
        }
        Observed::Energy => {
            let mut e1 = RunningMaximum::new(BareEnergy::new(system), ask.cutoff);
            follow_bare(system, window, settings, &mut Unobserved, &mut e1)?;
            e1.record()
        }
        // There is no damper that could move or touch.
        Observed::Stroke | Observed::Force => Extreme { value: 0.0, time: window.from },
    };
    Ok(Extremes { largest, stroke: 0.0, force: 0.0, settled: true })
}

fn in_coupled(
    system: &Coupled,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let mut before = ask.walls.map(|from| DisplacementRange::new(system, from, f64::INFINITY));
    let mut seen = maxima(system, ask);
    let late = ask.walls.unwrap_or(window.from);
    follow_until_it_repeats(system, window, late, settings, &mut before, &mut seen)?;
    let ([stroke, force], seen) = (stroke_and_force(before.as_ref()), read(&seen));
    Ok(Extremes { stroke: stroke.max(seen.stroke), force: force.max(seen.force), ..seen })
}

/// What is measured, and the range of the damper where stroke and force are asked for.
pub(crate) type Maxima<'a> = (Peak<'a>, Option<DisplacementRange<'a>>);

pub(crate) fn maxima(system: &Coupled, ask: Ask) -> Maxima<'_> {
    let range = ask.walls.map(|from| DisplacementRange::new(system, from, f64::INFINITY));
    (Peak::new(system, ask.measure, ask.cutoff), range)
}

pub(crate) fn read((peak, range): &Maxima<'_>) -> Extremes {
    let [stroke, force] = stroke_and_force(range.as_ref());
    Extremes { largest: peak.record(), stroke, force, settled: true }
}

/// The stroke, m, and the largest force, N; 0 where they were not asked for.
fn stroke_and_force(range: Option<&DisplacementRange<'_>>) -> [f64; 2] {
    range.map_or([0.0; 2], |range| [range.stroke(), range.force()].map(|largest| largest.value.max(0.0)))
}

/// The observer of a [`Measure`].
pub(crate) enum Peak<'a> {
    Energy(RunningMaximum<PrimaryEnergy<'a>>),
    Motion(Magnitude<StructureMotion<'a, Coupled, 4>>),
    Stroke(DisplacementRange<'a>),
    Force(DisplacementRange<'a>),
}

impl<'a> Peak<'a> {
    fn new(system: &'a Coupled, measure: Measure, cutoff: f64) -> Self {
        match observed(measure) {
            Observed::Energy => Self::Energy(RunningMaximum::new(PrimaryEnergy::new(system), cutoff)),
            Observed::Motion(quantity) => Self::Motion(Magnitude::new(|sign| quantity(system, sign), cutoff)),
            Observed::Stroke => Self::Stroke(DisplacementRange::new(system, 0.0, cutoff)),
            Observed::Force => Self::Force(DisplacementRange::new(system, 0.0, cutoff)),
        }
    }

    fn record(&self) -> Extreme {
        match self {
            Self::Energy(e1) => e1.record(),
            Self::Motion(size) => size.record(),
            Self::Stroke(range) => range.stroke(),
            Self::Force(range) => range.force(),
        }
    }
}

/// What is observed for a measure: of the structure's motion, the quantity whose largest size it is.
enum Observed<Q> {
    Energy,
    Motion(Q),
    Stroke,
    Force,
}

fn observed<'a, S: Structure<N>, const N: usize>(
    measure: Measure,
) -> Observed<fn(&'a S, f64) -> StructureMotion<'a, S, N>> {
    match measure {
        Measure::Energy => Observed::Energy,
        Measure::Displacement => Observed::Motion(StructureMotion::displacement),
        Measure::Velocity => Observed::Motion(StructureMotion::velocity),
        Measure::Acceleration => Observed::Motion(StructureMotion::acceleration),
        Measure::GroundForce => Observed::Motion(StructureMotion::ground_force),
        Measure::Stroke => Observed::Stroke,
        Measure::ContactForce => Observed::Force,
    }
}

impl Observer<4> for Peak<'_> {
    #[inline(always)]
    fn segment(&mut self, segment: &impl Segment<4>) {
        match self {
            Self::Energy(e1) => e1.segment(segment),
            Self::Motion(size) => size.segment(segment),
            Self::Stroke(range) | Self::Force(range) => range.segment(segment),
        }
    }
    #[inline(always)]
    fn path(&mut self, path: &impl Path<4>) {
        match self {
            Self::Energy(e1) => e1.path(path),
            Self::Motion(size) => size.path(path),
            Self::Stroke(range) | Self::Force(range) => range.path(path),
        }
    }
    #[inline(always)]
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        match self {
            Self::Energy(e1) => e1.steps(steps),
            Self::Motion(size) => size.steps(steps),
            Self::Stroke(range) | Self::Force(range) => range.steps(steps),
        }
    }
    fn satisfied(&self) -> bool {
        match self {
            Self::Energy(e1) => Observer::<4>::satisfied(e1),
            Self::Motion(size) => size.satisfied(),
            Self::Stroke(range) => range.stroke().value > range.cutoff(),
            Self::Force(range) => range.force().value > range.cutoff(),
        }
    }
}
