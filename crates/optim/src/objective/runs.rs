//! The runs behind a value: makes each, and records the values that it reaches.

use super::evaluation::{Place, Run};
use super::limits::{Limit, Limits};
use super::motions::{MotionSearch, Outcome, largest_motion};
use super::spec::{Goal, Objective, Response};
use super::unusable::Unusable;
use retune_model::{
    Bare, Coupled, Measure, NonNegative, Parameter, PerMeasure, Rms, Scene, Stationary, Worst,
};
use retune_solver::{Also, Ask, Settings, Window, extremes, settled};
use std::sync::{Mutex, PoisonError};

/// Whether an evaluation may continue; once it returns false, the evaluation is cancelled.
pub type Proceed<'a> = &'a (dyn Fn() -> bool + Sync);

/// Callbacks of an evaluation: `proceed` before each run in time, `keep` after each run; and the motions to evaluate.
#[derive(Clone, Copy)]
pub(super) struct Hooks<'a> {
    pub proceed: Proceed<'a>,
    pub keep: &'a (dyn Fn(Run) + Sync),
    pub motion_search: MotionSearch<'a>,
}

/// Hooks that neither cancel nor keep anything.
pub(super) const NO_HOOKS: Hooks<'static> =
    Hooks { proceed: &|| true, keep: &|_| (), motion_search: MotionSearch::All };

/// The largest values so far. They are maxima and counts only, so the order of the threads does not matter.
pub(super) struct Seen {
    pub reached: PerMeasure<f64>,
    pub worst: Place,
    pub runs: u64,
    pub unsettled: u64,
}

/// The measures to observe besides the quantity, and for each the value above which its peaks between samples are searched.
#[derive(Clone, Copy)]
pub(super) struct Observed {
    pub also: Option<Also>,
    /// Whether they are observed only in the part of the response that the objective covers.
    pub response_only: bool,
    pub matters: PerMeasure<f64>,
}

impl Observed {
    /// The measures that limits need.
    pub(super) fn limits(limits: &Limits) -> Self {
        let matters = Measure::OF_RUN.map(|measure| limits.get(Limit::Of(measure)).unwrap_or(f64::INFINITY));
        Self { also: limits.also(), response_only: false, matters: PerMeasure(matters) }
    }
}

/// The settings of a goal's runs, and the values recorded of them.
pub(super) struct Runs<'a> {
    pub settings: &'a Settings,
    window: Window,
    pub observed: Observed,
    pub peaks: bool,
    hooks: Hooks<'a>,
    pub seen: Mutex<Seen>,
}

/// A term with its number.
pub(super) type Numbered<'a> = (usize, &'a Objective);

/// The largest quantity of some runs, and their largest value of each measure; 0 for those that are not observed.
pub(super) type Largest = [f64; Measure::OF_RUN.len() + 1];

fn largest_of(quantity: f64, PerMeasure(reached): PerMeasure<f64>) -> Largest {
    std::array::from_fn(|i| if i == 0 { quantity } else { reached[i - 1] })
}

impl<'a> Runs<'a> {
    pub(super) fn new(
        goal: &'a Goal,
        scene: &Scene,
        settings: &'a Settings,
        observed: Observed,
        hooks: Hooks<'a>,
    ) -> Self {
        let worst = Place { largest: f64::NEG_INFINITY, scene: *scene, phase: 0.0, term: 0 };
        let seen = Mutex::new(Seen { reached: PerMeasure::default(), worst, runs: 0, unsettled: 0 });
        Self { settings, window: goal.window, observed, peaks: goal.peaks, hooks, seen }
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
        if !(self.hooks.proceed)() {
            return Err(Unusable::Stopped);
        }
        let response_from = if term.response == Response::Settled { f64::INFINITY } else { self.window.from };
        let from = |also: Also| if self.observed.response_only { response_from } else { also.from };
        let also = self.observed.also.map(|also| Also { from: from(also), ..also });
        let ask = Ask { measure: term.quantity, phase, also, cutoff };
        let found = match term.response {
            Response::Settled => settled(&scene, self.window, term.settle, self.settings, ask)?,
            Response::Window => extremes(&scene, self.window, self.settings, ask)?,
            Response::Steady => return self.steady(&scene, [omega; 2], (number, term)),
            Response::Motions => return self.motions(&scene, (omega, omega, 1), (number, term)),
        };
        let largest = found.largest.value;
        let decay = if term.quantity == Measure::DecayTime { largest } else { 0.0 };
        if decay.max(found.reached.get(Measure::DecayTime)).is_infinite() {
            return Err(Unusable::NotDecayed { to: self.window.to });
        }
        self.record(Place { largest, scene, phase, term: number }, found.reached, found.settled);
        Ok(largest_of(largest, found.reached))
    }

    /// The measures that are observed.
    fn measures(&self) -> PerMeasure<bool> {
        self.observed.also.map(|also| also.measures).unwrap_or_default()
    }

    /// The largest over all motions in a band with `samples` samples. Its place may not be of a run from rest.
    pub(super) fn motions(
        &self,
        scene: &Scene,
        (from, to, samples): (f64, f64, usize),
        (number, term): Numbered,
    ) -> Result<Largest, Unusable> {
        if scene.damper.is_none() {
            return self.steady(scene, [from, to], (number, term));
        }
        let Outcome { largest, also, settled } = largest_motion(
            scene,
            (from, to, samples),
            term,
            (self.measures(), self.hooks.motion_search),
            self.settings,
        )?;
        self.record_each(scene, number, largest, &also, settled)
    }

    /// The mean of a stationary random motion under the spectrum of a scene.
    fn stationary(&self, scene: &Scene, rms: Rms, term: usize) -> Result<Largest, Unusable> {
        let found = Stationary::new(scene, self.settings.rtol).ok_or(Unusable::NotStationary)?;
        let quantity = Worst { value: found.get(rms), frequency: 0.0 };
        self.record_each(scene, term, quantity, &[], true)
    }

    pub(super) fn steady(
        &self,
        scene: &Scene,
        band: [f64; 2],
        (number, term): Numbered,
    ) -> Result<Largest, Unusable> {
        if let Measure::Stationary(rms) = term.quantity {
            return self.stationary(scene, rms, number);
        }
        let Scene { primary, forcing, damper } = scene;
        let bare = Bare::new(primary, forcing);
        let coupled = damper.map(|damper| (Coupled::new(primary, forcing, &damper), damper));
        let max = |measure| match &coupled {
            None => bare.steady_max(measure, band),
            Some((system, _)) => system.steady_max(measure, band),
        };
        let mut also: Vec<_> = self.measures().chosen().map(|measure| (measure, max(measure))).collect();
        if let Some((system, damper)) = &coupled {
            let worst = system.steady_stroke_max(band);
            let Worst { value: stroke, frequency: omega } = worst;
            let gaps = damper.rest_distance.get().min(damper.clearance.get());
            let room = if damper.contact.is_some() { gaps } else { f64::INFINITY };
            if stroke.is_infinite() {
                return Err(Unusable::Resonates { omega });
            }
            if stroke >= room {
                return Err(Unusable::Touches { omega, stroke, room });
            }
            if !self.measures().get(Measure::Stroke) {
                also.push((Measure::Stroke, worst));
            }
        }
        self.record_each(scene, number, max(term.quantity), &also, true)
    }

    /// Records the largest values of one evaluation over a band, each at its own frequency, as if of a run there; counts one run.
    fn record_each(
        &self,
        scene: &Scene,
        term: usize,
        quantity: Worst,
        also: &[(Measure, Worst)],
        settled: bool,
    ) -> Result<Largest, Unusable> {
        let at = |worst: &Worst| -> Result<Scene, Unusable> {
            let mut scene = *scene;
            scene.forcing.frequency = NonNegative::new(worst.frequency).map_err(Unusable::Frequency)?;
            Ok(scene)
        };
        let mut all = PerMeasure::default();
        for (measure, worst) in also {
            let mut reached = PerMeasure::default();
            reached.set(*measure, worst.value);
            all.set(*measure, worst.value);
            // The quantity there is not known, and it is not the largest.
            let place = Place { largest: f64::NEG_INFINITY, scene: at(worst)?, phase: 0.0, term };
            (self.hooks.keep)(Run { place, reached });
        }
        let place = Place { largest: quantity.value, scene: at(&quantity)?, phase: 0.0, term };
        (self.hooks.keep)(Run { place, reached: PerMeasure::default() });
        self.count(place, all, settled);
        Ok(largest_of(quantity.value, all))
    }

    fn record(&self, place: Place, reached: PerMeasure<f64>, settled: bool) {
        (self.hooks.keep)(Run { place, reached });
        self.count(place, reached, settled);
    }

    fn count(&self, place: Place, reached: PerMeasure<f64>, settled: bool) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.runs += 1;
        seen.unsettled += u64::from(!settled);
        seen.reached = seen.reached.max(reached);
        let key = |place: &Place| {
            let Scene { primary, forcing, .. } = place.scene;
            let e = Parameter::Restitution.of(&place.scene).unwrap_or(1.0);
            let (omega, k1) = (forcing.frequency.get(), primary.stiffness.get());
            let history = forcing.history().map_or([0.0; 3], |history| {
                let [most, slope] = history.course.bounds();
                [history.course.end(), most, slope]
            });
            let [a, b, c] = history;
            [-place.largest, place.term as f64, omega, k1, e, place.phase, a, b, c]
        };
        // On a tie the first by term, ω, k1, restitution, phase and record.
        let order =
            key(&place).iter().zip(&key(&seen.worst)).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne());
        if order.is_some_and(|order| order.is_lt()) {
            seen.worst = place;
        }
    }
}
