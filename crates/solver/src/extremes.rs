//! What a study minimises and may set limits on: the largest value of a [`Measure`] in a window, and those of additional measures from a
//! time on, for any phase of the force. Only requested values are computed.

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

/// What to compute in a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// The measure.
    pub measure: Measure,
    /// φ of the force `P cos(ωt + φ)`, rad. The run starts at t = 0.
    pub phase: f64,
    /// Additional measures to observe, if any.
    pub also: Option<Also>,
    /// The run may end early, with any value above this one, in the unit of the measure, once the measure exceeds it.
    pub cutoff: f64,
}

/// Measures that are observed in addition to [`Ask::measure`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Also {
    /// The measures.
    pub measures: PerMeasure<bool>,
    /// Start of their observation, s: 0 for the whole run, whatever the window of [`Ask::measure`].
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
    /// Largest value of the measure, in its unit, and when.
    pub largest: Extreme,
    /// The largest values of [`Ask::also`]; 0 for a measure that was not requested, and for those of the damper where there is none.
    pub reached: PerMeasure<f64>,
    /// Whether the motion has settled; true where this was not tested.
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
/// time](crate::decay_time) is that of the whole run, infinite where the motion does not decay within it.
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
    let additional = ask.also.is_some_and(|also| also.measures.get(Measure::DecayTime));
    if !decays && !additional {
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
    if additional {
        found.reached.set(Measure::DecayTime, decay.value);
    }
    Ok(found)
}

/// [`extremes`] without decay times.
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
            bare_extremes(&system, window, settings, ask)
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
            coupled_extremes(&system, window, settings, ask)
        }
    };
    let seen = seen.map_err(|error| energy_bound::clamp_error_time(window, error))?;
    let largest = energy_bound::check_largest(scene, window, settings, ask.measure, seen.largest)?;
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
        reached.set(measure, bare_extremes(system, window, settings, ask)?.largest.value.max(0.0));
    }
    Ok(reached)
}

fn bare_extremes(
    system: &Bare,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
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

fn coupled_extremes(
    system: &Coupled,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let mut before = additional_maxima(system, ask);
    let mut seen = maxima(system, ask);
    let late = ask.also.map_or(window.from, |also| also.from);
    let plan = Plan::of(system, settings, Request::Largest { window, late });
    system.follow_for(plan, window, settings, &mut before, &mut seen)?;
    let (before, seen) = (values(before.as_ref()), read_maxima(&seen));
    Ok(Extremes { reached: before.max(seen.reached), ..seen })
}

/// Observes the largest values of the additional measures from a time on.
pub(crate) type AdditionalMaxima<'a> = Since<LargestValues<'a>>;

/// Observers of the requested measure and of the additional ones.
pub(crate) type Maxima<'a> = (Peak<'a>, Option<AdditionalMaxima<'a>>);

pub(crate) fn additional_maxima(system: &Coupled, ask: Ask) -> Option<AdditionalMaxima<'_>> {
    ask.also.map(|also| Since::new(LargestValues::new(system, also.measures), also.from))
}

pub(crate) fn maxima(system: &Coupled, ask: Ask) -> Maxima<'_> {
    (Peak::new(system, ask.measure, ask.cutoff), additional_maxima(system, ask))
}

pub(crate) fn read_maxima((peak, additional): &Maxima<'_>) -> Extremes {
    Extremes { largest: peak.record(), reached: values(additional.as_ref()), settled: true }
}

fn values(additional: Option<&AdditionalMaxima<'_>>) -> PerMeasure<f64> {
    additional.map_or_else(PerMeasure::default, |since| since.observer.values())
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

/// What is observed for a measure: the quantity of the structure's motion whose largest magnitude it is, or the range of the damper's
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
    fn discontinuity(&mut self) {
        match self {
            Self::Energy(e1) => Observer::<4>::discontinuity(e1),
            Self::Motion(size) => size.discontinuity(),
            Self::Damper(range, _) => range.discontinuity(),
        }
    }
    fn search_work(&self) -> u64 {
        match self {
            Self::Energy(e1) => Observer::<4>::search_work(e1),
            Self::Motion(size) => size.search_work(),
            Self::Damper(range, _) => range.search_work(),
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
