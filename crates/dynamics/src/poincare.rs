//! The stroboscopic map, which samples the motion once per period of the force, and orbit diagrams.

use crate::parameter::Error;
use retune_model::{Coupled, Parameter, Scene};
use retune_solver::observe::{Observer, PrimaryEnergy, RunningMaximum, TouchDowns, Unobserved};
use retune_solver::{Follower, Motion, Phase, Settings, SolverError};
use std::f64::consts::TAU;

/// The equations of a scene that has a damper.
///
/// # Errors
/// [`Error::NoDamper`], or [`Error::NoPeriod`] under a constant force.
pub fn coupled(scene: &Scene) -> Result<Coupled, Error> {
    let damper = scene.damper.as_ref().ok_or(Error::NoDamper)?;
    if scene.forcing.frequency.get() == 0.0 {
        return Err(Error::NoPeriod);
    }
    Ok(Coupled::new(&scene.primary, &scene.forcing, damper))
}

/// The map of the state over one period of the force, from a crest of `P cos ωt` to the next.
///
/// Time starts at 0 in each period, so the map is the same at every step.
pub struct PoincareMap<'a> {
    follower: Follower<'a>,
    period: f64,
}

impl<'a> PoincareMap<'a> {
    /// Prepares the map with the method in `settings`. A period may take [`Settings::max_steps`] steps.
    pub fn new(system: &'a Coupled, settings: &Settings) -> Self {
        let period = TAU / system.bare().frequency();
        Self { follower: Follower::new(system, settings, period), period }
    }

    /// Period of the force, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// The motion one period later.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached in the period.
    pub fn next(&mut self, from: Motion, observer: &mut dyn Observer<4>) -> Result<Motion, SolverError> {
        let end = self.follower.propagate(Motion { t: 0.0, ..from }, self.period, observer)?;
        Ok(Motion { t: 0.0, ..end })
    }
}

/// The paper's start: at rest.
pub fn at_rest(system: &Coupled) -> Motion {
    Motion { t: 0.0, y: system.rest(), phase: Phase::Flight }
}

/// The motion that continues from the state `y` at a crest of the force, for instance the last of an [`Orbit`].
///
/// # Errors
/// As [`coupled`].
pub fn resumed(scene: &Scene, y: [f64; 4]) -> Result<Motion, Error> {
    Ok(Motion { t: 0.0, y, phase: Phase::of(&coupled(scene)?, &y) })
}

/// The stroboscopic samples of a motion at one value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// The parameter's value.
    pub value: f64,
    /// `[x1, v1, x2, v2]` at each crest of the force.
    pub samples: Vec<[f64; 4]>,
    /// Largest energy of the primary structure over the samples' periods, J.
    pub e1_max: f64,
    /// Impacts over the samples' periods, on the structure and on the obstacle.
    pub impacts: [u64; 2],
}

/// Numbers of periods to settle in and to record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Periods {
    /// Periods that are discarded.
    pub settle: usize,
    /// Periods that are recorded.
    pub record: usize,
}

/// Computes one orbit; returns its samples and its final state.
///
/// # Errors
/// The system cannot be run there.
pub(crate) fn orbit(
    system: &Coupled,
    value: f64,
    start: Motion,
    periods: Periods,
    settings: &Settings,
) -> Result<(Orbit, Motion), Error> {
    let mut map = PoincareMap::new(system, settings);
    let mut motion = start;
    for _ in 0..periods.settle {
        motion = map.next(motion, &mut Unobserved)?;
    }
    let mut samples = Vec::with_capacity(periods.record);
    let (mut e1_max, mut impacts) = (0.0_f64, [0; 2]);
    for _ in 0..periods.record {
        let peak = RunningMaximum::new(PrimaryEnergy::new(system), f64::INFINITY);
        let mut seen = (peak, TouchDowns::default());
        motion = map.next(motion, &mut seen)?;
        samples.push(motion.y);
        let (peak, TouchDowns(touches)) = seen;
        e1_max = e1_max.max(peak.record().value);
        impacts = [0, 1].map(|side| impacts[side] + touches[side]);
    }
    Ok((Orbit { value, samples, e1_max, impacts }, motion))
}

/// Sweeps the parameter through `values` in their order by continuation: the first motion starts from rest, each other where the previous one ended, at a
/// crest of the force, so that the sweep stays on one branch as long as it exists.
///
/// # Errors
/// See [`Error`].
pub fn continuation(
    scene: &Scene,
    parameter: Parameter,
    values: &[f64],
    periods: Periods,
    settings: &Settings,
    done: impl Fn() + Sync,
) -> Result<Vec<Orbit>, Error> {
    let mut last: Option<Motion> = None;
    let mut orbits = Vec::with_capacity(values.len());
    for &value in values {
        let system = coupled(&parameter.at(*scene, value)?)?;
        let (found, end) =
            orbit(&system, value, last.unwrap_or_else(|| at_rest(&system)), periods, settings)?;
        orbits.push(found);
        last = Some(end);
        done();
    }
    Ok(orbits)
}
