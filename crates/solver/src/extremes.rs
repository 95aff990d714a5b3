//! What a study makes small, and what it may set limits on: the largest value of a [`Measure`] in a window, and those of others from a
//! time on, for any phase of the force. Only those that are asked for are computed.

use crate::decay::decay;
use crate::energy_bound;
use crate::error::SolverError;
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::displacement_range::DisplacementRange;
use crate::observe::largest_values::LargestValues;
use crate::observe::magnitude::Magnitude;
use crate::observe::observer::{Impact, Observer, Path, Unobserved};
use crate::observe::quantity::{BareEnergy, PrimaryEnergy};
use crate::observe::running_maximum::RunningMaximum;
use crate::observe::since::Since;
use crate::observe::structure::{Structure, StructureMotion};
use crate::plan::{Plan, Request};
use crate::response::Extreme;
use crate::run::Follow;
use crate::settings::{Settings, Window};
use crate::simulate::e1_max;
use retune_model::{Bare, Coupled, Measure, PerMeasure, Scene};

/// The question put to a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// What is measured.
    pub measure: Measure,
    /// φ of the force `P cos(ωt + φ)`, rad. The run starts at t = 0.
    pub phase: f64,
    /// What is observed too; `None` for nothing.
    pub also: Option<Also>,
    /// The run may end early, with any value above this one, in the unit of what is measured, once that exceeds it.
    pub cutoff: f64,
}

/// Measures that are observed beside the one that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Also {
    /// Which.
    pub measures: PerMeasure<bool>,
    /// From when on, s: 0 for the whole run, whatever the window of what is asked for.
    pub from: f64,
}

impl Also {
    /// Stroke and contact force from a time on, s.
    pub fn walls(from: f64) -> Self {
        Self { measures: [Measure::Stroke, Measure::ContactForce].into_iter().collect(), from }
    }
}

impl Default for Ask {
    fn default() -> Self {
        Self { measure: Measure::Energy, phase: 0.0, also: None, cutoff: f64::INFINITY }
    }
}

/// The largest values of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest value of what is measured, in its unit, and when.
    pub largest: Extreme,
    /// The largest values of [`Ask::also`]; 0 of what was not asked for, and of the damper where there is none.
    pub reached: PerMeasure<f64>,
    /// Whether the motion has settled; true where that was not asked.
    pub settled: bool,
}

impl Extremes {
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m.
    pub fn stroke(&self) -> f64 {
        self.reached.get(Measure::Stroke)
    }

    /// Largest contact force on either wall, N.
    pub fn force(&self) -> f64 {
        self.reached.get(Measure::ContactForce)
    }
}

/// The largest value of [`Ask::measure`] over a window, and those of [`Ask::also`] from its time to the end of the window. A [decay
/// time](crate::decay_time) is that of the whole run, infinite where it is not within it.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn extremes(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let decays = ask.measure == Measure::DecayTime;
    let beside = ask.also.is_some_and(|also| also.measures.get(Measure::DecayTime));
    if !decays && !beside {
        return largest_values(scene, window, settings, ask);
    }
    let never = Extreme { value: f64::INFINITY, time: window.to };
    let decay = decay(scene, window.to, settings)?.unwrap_or(never);
    let mut found = Extremes { largest: decay, reached: PerMeasure::default(), settled: true };
    if ask.also.is_some() {
        let cutoff = if decays { f64::INFINITY } else { ask.cutoff };
        found =
            largest_values(scene, window, settings, Ask { measure: ask.measure.of_run(), cutoff, ..ask })?;
    }
    if decays {
        found.largest = decay;
    }
    if beside {
        found.reached.set(Measure::DecayTime, decay.value);
    }
    Ok(found)
}

/// The same for largest values alone.
fn largest_values(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    if ask.phase == 0.0 && ask.also.is_none() && ask.measure == Measure::Energy {
        let largest = e1_max(scene, window, settings, ask.cutoff)?;
        return Ok(Extremes { largest, reached: PerMeasure::default(), settled: true });
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

/// The largest values of [`Ask::also`] of a structure without a damper.
pub(crate) fn bare_values(
    system: &Bare,
    also: Also,
    to: f64,
    settings: &Settings,
) -> Result<PerMeasure<f64>, SolverError> {
    let mut reached = PerMeasure::default();
    for measure in also.measures.chosen() {
        let ask = Ask { measure, ..Ask::default() };
        let window = Window { from: also.from.min(to), to };
        reached.set(measure, in_bare(system, window, settings, ask)?.largest.value.max(0.0));
    }
    Ok(reached)
}

fn in_bare(system: &Bare, window: Window, settings: &Settings, ask: Ask) -> Result<Extremes, SolverError> {
    let plan = Plan::of(system, settings, Request::Largest { window, late: window.from });
    let largest = match observed(ask.measure) {
        Observed::Motion(quantity) => {
            let mut size = Magnitude::new(|sign| quantity(system, sign), ask.cutoff);
            system.follow(plan, window, settings, &mut Unobserved, &mut size)?;
            size.record()
        }
        Observed::Energy => {
            let mut e1 = RunningMaximum::new(BareEnergy::new(system), ask.cutoff);
            system.follow(plan, window, settings, &mut Unobserved, &mut e1)?;
            e1.record()
        }
        // There is no damper that could move or touch.
        Observed::Damper => Extreme { value: 0.0, time: window.from },
    };
    let also = ask.also.map(|also| bare_values(system, also, window.to, settings)).transpose()?;
    Ok(Extremes { largest, reached: also.unwrap_or_default(), settled: true })
}

fn in_coupled(
    system: &Coupled,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let mut before = beside(system, ask);
    let mut seen = maxima(system, ask);
    let late = ask.also.map_or(window.from, |also| also.from);
    let plan = Plan::of(system, settings, Request::Largest { window, late });
    system.follow_for(plan, window, settings, &mut before, &mut seen)?;
    let (before, seen) = (values(before.as_ref()), read(&seen));
    Ok(Extremes { reached: before.max(seen.reached), ..seen })
}

/// The largest values from a time on.
pub(crate) type Beside<'a> = Since<LargestValues<'a>>;

/// What is asked for, and what is asked for beside it.
pub(crate) type Maxima<'a> = (Peak<'a>, Option<Beside<'a>>);

pub(crate) fn beside(system: &Coupled, ask: Ask) -> Option<Beside<'_>> {
    ask.also.map(|also| Since::new(LargestValues::new(system, also.measures), also.from))
}

pub(crate) fn maxima(system: &Coupled, ask: Ask) -> Maxima<'_> {
    (Peak::new(system, ask.measure, ask.cutoff), beside(system, ask))
}

pub(crate) fn read((peak, beside): &Maxima<'_>) -> Extremes {
    Extremes { largest: peak.record(), reached: values(beside.as_ref()), settled: true }
}

fn values(beside: Option<&Beside<'_>>) -> PerMeasure<f64> {
    beside.map_or_else(PerMeasure::default, |since| since.observer.values())
}

/// The observer of a [`Measure`].
#[expect(clippy::large_enum_variant, reason = "there is one for a run, and a run allocates nothing")]
pub(crate) enum Peak<'a> {
    Energy(RunningMaximum<PrimaryEnergy<'a>>),
    Motion(Magnitude<StructureMotion<'a, Coupled, 4>>),
    Damper(DisplacementRange<'a>, Measure),
}

impl<'a> Peak<'a> {
    fn new(system: &'a Coupled, measure: Measure, cutoff: f64) -> Self {
        match observed(measure) {
            Observed::Energy => Self::Energy(RunningMaximum::new(PrimaryEnergy::new(system), cutoff)),
            Observed::Motion(quantity) => Self::Motion(Magnitude::new(|sign| quantity(system, sign), cutoff)),
            Observed::Damper => Self::Damper(DisplacementRange::new(system, cutoff), measure),
        }
    }

    fn record(&self) -> Extreme {
        match self {
            Self::Energy(e1) => e1.record(),
            Self::Motion(size) => size.record(),
            Self::Damper(range, measure) => range.largest(*measure),
        }
    }
}

/// What is observed for a measure: of the structure's motion, the quantity whose largest size it is; of the damper, the range of its
/// displacement.
enum Observed<Q> {
    Energy,
    Motion(Q),
    Damper,
}

fn observed<'a, S: Structure<N>, const N: usize>(
    measure: Measure,
) -> Observed<fn(&'a S, f64) -> StructureMotion<'a, S, N>> {
    match measure.of_run() {
        Measure::Energy => Observed::Energy,
        Measure::Displacement => Observed::Motion(StructureMotion::displacement),
        Measure::Velocity => Observed::Motion(StructureMotion::velocity),
        Measure::Acceleration => Observed::Motion(StructureMotion::acceleration),
        Measure::GroundForce => Observed::Motion(StructureMotion::ground_force),
        Measure::Stroke
        | Measure::ContactForce
        | Measure::ContactPressure
        | Measure::DecayTime
        | Measure::Stationary(_) => Observed::Damper,
    }
}

impl Observer<4> for Peak<'_> {
    #[inline(always)]
    fn segment(&mut self, segment: &dyn Segment<4>) {
        match self {
            Self::Energy(e1) => e1.segment(segment),
            Self::Motion(size) => size.segment(segment),
            Self::Damper(range, _) => range.segment(segment),
        }
    }
    #[inline(always)]
    fn path(&mut self, path: &dyn Path<4>) {
        match self {
            Self::Energy(e1) => e1.path(path),
            Self::Motion(size) => size.path(path),
            Self::Damper(range, _) => range.path(path),
        }
    }
    #[inline(always)]
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        match self {
            Self::Energy(e1) => e1.steps(steps),
            Self::Motion(size) => size.steps(steps),
            Self::Damper(range, _) => range.steps(steps),
        }
    }
    #[inline(always)]
    fn skips(&self, block: &Block<4>) -> bool {
        match self {
            Self::Energy(e1) => e1.skips(block),
            Self::Motion(size) => size.skips(block),
            Self::Damper(range, _) => range.skips(block),
        }
    }
    fn impact(&mut self, impact: &Impact<4>) {
        match self {
            Self::Energy(e1) => e1.impact(impact),
            Self::Motion(size) => size.impact(impact),
            Self::Damper(range, _) => range.impact(impact),
        }
    }
    fn seam(&mut self) {
        match self {
            Self::Energy(e1) => Observer::<4>::seam(e1),
            Self::Motion(size) => size.seam(),
            Self::Damper(range, _) => range.seam(),
        }
    }
    fn looks(&self) -> u64 {
        match self {
            Self::Energy(e1) => Observer::<4>::looks(e1),
            Self::Motion(size) => size.looks(),
            Self::Damper(range, _) => range.looks(),
        }
    }
    fn satisfied(&self) -> bool {
        match self {
            Self::Energy(e1) => Observer::<4>::satisfied(e1),
            Self::Motion(size) => size.satisfied(),
            Self::Damper(range, measure) => range.largest(*measure).value > range.cutoff(),
        }
    }
}
