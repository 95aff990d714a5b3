//! The runs behind a value: each is made, and what it reaches is kept.

use super::evaluation::{Place, Run};
use super::limits::{Limit, Limits, PerLimit};
use super::motions::{Found, largest_motion};
use super::spec::{Goal, Objective, Response};
use super::unusable::Unusable;
use retune_model::{Bare, Coupled, NonNegative, Scene, Worst};
use retune_solver::{Ask, Settings, Window, extremes, settled};
use std::sync::{Mutex, PoisonError};

/// Whether an evaluation goes on.
pub type GoesOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// What is asked before each run of an evaluation in time, and what is given each run.
#[derive(Clone, Copy)]
pub(super) struct Hooks<'a> {
    pub goes_on: GoesOn<'a>,
    pub keep: &'a (dyn Fn(Run) + Sync),
}

/// No questions, and nothing kept.
pub(super) const FREE: Hooks<'static> = Hooks { goes_on: &|| true, keep: &|_| () };

/// The largest values so far. They are maxima and counts only, so the order of the threads does not matter.
pub(super) struct Seen {
    pub reached: PerLimit<f64>,
    pub worst: Place,
    pub runs: u64,
    pub unsettled: u64,
}

/// The settings of a goal's runs, and the values that are kept of them.
pub(super) struct Watch<'a> {
    pub settings: &'a Settings,
    window: Window,
    pub limits: &'a Limits,
    pub peaks: bool,
    hooks: Hooks<'a>,
    pub seen: Mutex<Seen>,
}

/// A term with its number.
pub(super) type Numbered<'a> = (usize, &'a Objective);

/// The largest quantity, stroke (m) and contact force (N) of some runs; all but the first are 0 if no limit needs them.
pub(super) type Largest = [f64; 3];

impl<'a> Watch<'a> {
    pub(super) fn new(goal: &'a Goal, scene: &Scene, settings: &'a Settings, hooks: Hooks<'a>) -> Self {
        let worst = Place { largest: f64::NEG_INFINITY, scene: *scene, phase: 0.0, term: 0 };
        let seen = Mutex::new(Seen { reached: PerLimit::default(), worst, runs: 0, unsettled: 0 });
        Self { settings, window: goal.window, limits: &goal.limits, peaks: goal.peaks, hooks, seen }
    }

    pub(super) fn run(
        &self,
        scene: &Scene,
        omega: f64,
        phase: f64,
        (number, term): Numbered,
        cutoff: f64,
    ) -> Result<Largest, Unusable> {
        let mut scene = *scene;
        scene.forcing.frequency = NonNegative::new(omega).map_err(Unusable::Frequency)?;
        if !(self.hooks.goes_on)() {
            return Err(Unusable::Stopped);
        }
        let ask = Ask { measure: term.quantity, phase, walls: self.limits.walls_from(), cutoff };
        let found = match term.response {
            Response::Settled => settled(&scene, self.window, term.settle, self.settings, ask)?,
            Response::Window => extremes(&scene, self.window, self.settings, ask)?,
            Response::Steady => return self.steady(&scene, [omega; 2], (number, term)),
            Response::Motions => return self.motions(&scene, (omega, omega, 1), (number, term)),
        };
        let largest = found.largest.value;
        self.see(Place { largest, scene, phase, term: number }, found.stroke, found.force, found.settled);
        Ok([largest, found.stroke, found.force])
    }

    /// The largest over all motions in a band of so many samples. The place is that of the largest, which may not be of a run from rest.
    pub(super) fn motions(
        &self,
        scene: &Scene,
        (from, to, samples): (f64, f64, usize),
        (number, term): Numbered,
    ) -> Result<Largest, Unusable> {
        if scene.damper.is_none() {
            return self.steady(scene, [from, to], (number, term));
        }
        let Found { at, largest: [largest, stroke, force], settled } =
            largest_motion(scene, (from, to, samples), term, self.settings)?;
        let mut scene = *scene;
        scene.forcing.frequency = NonNegative::new(at).map_err(Unusable::Frequency)?;
        let place = Place { largest, scene, phase: 0.0, term: number };
        self.see(place, stroke, force, settled);
        Ok([largest, stroke, force])
    }

    pub(super) fn steady(
        &self,
        scene: &Scene,
        band: [f64; 2],
        (number, term): Numbered,
    ) -> Result<Largest, Unusable> {
        let Scene { primary, forcing, damper } = scene;
        let (worst, stroke) = match damper {
            None => (Bare::new(primary, forcing).steady_max(term.quantity, band), 0.0),
            Some(damper) => {
                let system = Coupled::new(primary, forcing, damper);
                let Worst { value: stroke, frequency: omega } = system.steady_stroke_max(band);
                let gaps = damper.rest_distance.get().min(damper.clearance.get());
                let room = if damper.contact.is_some() { gaps } else { f64::INFINITY };
                if stroke >= room {
                    return Err(Unusable::Touches { omega, stroke, room });
                }
                (system.steady_max(term.quantity, band), stroke)
            }
        };
        let mut scene = *scene;
        scene.forcing.frequency = NonNegative::new(worst.frequency).map_err(Unusable::Frequency)?;
        let place = Place { largest: worst.value, scene, phase: 0.0, term: number };
        self.see(place, stroke, 0.0, true);
        Ok([worst.value, stroke, 0.0])
    }

    fn see(&self, place: Place, stroke: f64, force: f64, settled: bool) {
        (self.hooks.keep)(Run { place, reached: [place.largest, stroke, force] });
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.runs += 1;
        seen.unsettled += u64::from(!settled);
        for (limit, value) in [(Limit::Stroke, stroke), (Limit::Force, force)] {
            let largest = seen.reached.get(limit).max(value);
            seen.reached.set(limit, largest);
        }
        let key = |place: &Place| {
            let Scene { primary, forcing, .. } = place.scene;
            [-place.largest, place.term as f64, forcing.frequency.get(), primary.stiffness.get(), place.phase]
        };
        // Of equal ones the first by term, ω, k1 and phase.
        let order =
            key(&place).iter().zip(&key(&seen.worst)).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne());
        if order.is_some_and(|order| order.is_lt()) {
            seen.worst = place;
        }
    }
}
