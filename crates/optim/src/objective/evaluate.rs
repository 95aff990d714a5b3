//! The value that a search minimises: a quantity composed over frequencies, stiffnesses, an ensemble and several terms, under limits.
//!
//! `value = Σ weight · statistic over the ensemble of (largest over k1 of (largest over ω of the quantity))`. Each level is one
//! function of a cutoff, above which it may stop; every stopping rule is exact: a value not above the cutoff is computed in
//! full.

use super::band::{Band, all_worst_over};
use super::ensemble::SLACK;
use super::evaluation::{Evaluation, Place, Run};
use super::limits::{INFEASIBLE, Limit, Limits, PerLimit, ranked};
use super::spec::{Goal, Objective, Response, Stiffnesses};
use super::unusable::Unusable;
use crate::chunks::in_groups;
use retune_model::{Bare, Coupled, NonNegative, Scene, Worst};
use retune_solver::{Ask, Settings, Window, extremes, settled};
use std::sync::{Mutex, PoisonError};

/// Whether an evaluation goes on.
pub type GoesOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// What is asked before each run of an evaluation in time, and what is given each run.
#[derive(Clone, Copy)]
struct Hooks<'a> {
    goes_on: GoesOn<'a>,
    keep: &'a (dyn Fn(Run) + Sync),
}

/// No questions, and nothing kept.
const FREE: Hooks<'static> = Hooks { goes_on: &|| true, keep: &|_| () };

impl Goal {
    /// Evaluates a scene. The value may be any number above `cutoff` once it is known to exceed it; the rest is then incomplete.
    ///
    /// # Errors
    /// A run could not be finished, or the damper of a steady motion reaches a wall.
    pub fn evaluate(&self, scene: &Scene, settings: &Settings, cutoff: f64) -> Result<Evaluation, Unusable> {
        self.evaluate_with(scene, settings, cutoff, FREE)
    }

    /// The same, and `keep` is given each run, in any order.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn evaluate_and(
        &self,
        scene: &Scene,
        settings: &Settings,
        cutoff: f64,
        keep: impl Fn(Run) + Sync,
    ) -> Result<Evaluation, Unusable> {
        self.evaluate_with(scene, settings, cutoff, Hooks { keep: &keep, ..FREE })
    }

    /// The same as long as `goes_on` says so, which is asked before each run in time.
    ///
    /// # Errors
    /// As [`Self::evaluate`], and [`Unusable::Stopped`].
    pub fn evaluate_while(
        &self,
        scene: &Scene,
        settings: &Settings,
        cutoff: f64,
        goes_on: GoesOn<'_>,
    ) -> Result<Evaluation, Unusable> {
        self.evaluate_with(scene, settings, cutoff, Hooks { goes_on, ..FREE })
    }

    fn evaluate_with(
        &self,
        scene: &Scene,
        settings: &Settings,
        cutoff: f64,
        hooks: Hooks<'_>,
    ) -> Result<Evaluation, Unusable> {
        let cavity = scene.damper.map_or(0.0, |damper| damper.rest_distance.get() + damper.clearance.get());
        let mut watch = Watch::new(self, scene, settings, hooks);
        let seen = watch.seen.get_mut().unwrap_or_else(PoisonError::into_inner);
        seen.reached.set(Limit::Cavity, cavity);
        let reached = seen.reached;
        // A cavity above its limit makes the design infeasible without any run.
        let energy = if cutoff < INFEASIBLE && self.limits.violation(&reached) > 0.0 {
            f64::INFINITY
        } else {
            let cutoff = if cutoff < INFEASIBLE { cutoff } else { f64::INFINITY };
            self.energy(scene, cutoff, &watch)?
        };
        let Seen { reached, worst, runs, unsettled } =
            watch.seen.into_inner().unwrap_or_else(PoisonError::into_inner);
        let violation = self.limits.violation(&reached);
        Ok(Evaluation {
            value: ranked(energy, violation),
            energy,
            violation,
            reached,
            worst,
            runs,
            unsettled,
        })
    }

    /// The worst run of a term at a phase of the force (rad), without limits.
    pub(super) fn worst(
        &self,
        scene: &Scene,
        phase: f64,
        term: Numbered,
        settings: &Settings,
        goes_on: GoesOn<'_>,
    ) -> Result<Place, Unusable> {
        let free = Self { limits: Limits::default(), ..self.clone() };
        let watch = Watch::new(&free, scene, settings, Hooks { goes_on, ..FREE });
        watch.over_k1(scene, phase, term, f64::INFINITY)?;
        Ok(watch.seen.into_inner().unwrap_or_else(PoisonError::into_inner).worst)
    }

    /// The weighted sum, in the unit of the quantity.
    fn energy(&self, scene: &Scene, cutoff: f64, watch: &Watch) -> Result<f64, Unusable> {
        if self.objective.sum.is_empty() {
            return watch.term(scene, (0, &self.objective), cutoff); // the common case, without an allocation
        }
        let terms = self.objective.terms();
        let (mut sum, most) = (0.0, cutoff * SLACK);
        for (i, (weight, term)) in terms.into_iter().enumerate() {
            sum += weight * watch.term(scene, (i, term), (most - sum) / weight)?;
            if sum > most {
                break;
            }
        }
        Ok(sum)
    }
}

/// The largest values so far. They are maxima and counts only, so the order of the threads does not matter.
struct Seen {
    reached: PerLimit<f64>,
    worst: Place,
    runs: u64,
    unsettled: u64,
}

/// The settings of a goal's runs, and the values that are kept of them.
struct Watch<'a> {
    settings: &'a Settings,
    window: Window,
    limits: &'a Limits,
    hooks: Hooks<'a>,
    seen: Mutex<Seen>,
}

/// A term with its number.
pub(super) type Numbered<'a> = (usize, &'a Objective);

/// The largest quantity, stroke (m) and contact force (N) of some runs; all but the first are 0 if no limit needs them.
type Largest = [f64; 3];

impl<'a> Watch<'a> {
    fn new(goal: &'a Goal, scene: &Scene, settings: &'a Settings, hooks: Hooks<'a>) -> Self {
        let worst = Place { largest: f64::NEG_INFINITY, scene: *scene, phase: 0.0, term: 0 };
        let seen = Mutex::new(Seen { reached: PerLimit::default(), worst, runs: 0, unsettled: 0 });
        Self { settings, window: goal.window, limits: &goal.limits, hooks, seen }
    }

    fn term(&self, scene: &Scene, term: Numbered, cutoff: f64) -> Result<f64, Unusable> {
        let Some(ensemble) = &term.1.ensemble else { return Ok(self.over_k1(scene, 0.0, term, cutoff)?[0]) };
        let member = |i: u32, cutoff: f64| {
            let (scene, phase) = ensemble.member(scene, i).map_err(Unusable::Member)?;
            Ok(self.over_k1(&scene, phase, term, cutoff)?[0])
        };
        ensemble.over(member, cutoff)
    }

    fn over_k1(&self, scene: &Scene, phase: f64, term: Numbered, cutoff: f64) -> Result<Largest, Unusable> {
        let own = scene.primary.stiffness.get();
        let at = |k1: f64| -> Result<Largest, Unusable> {
            let mut scene = *scene;
            scene.primary.stiffness = NonNegative::new(k1).map_err(Unusable::Stiffness)?;
            self.over_omega(&scene, phase, term, cutoff)
        };
        match &term.1.k1 {
            None => self.over_omega(scene, phase, term, cutoff),
            Some(Stiffnesses::Range(range)) => self.worst_over(&range.band(), at, cutoff),
            Some(Stiffnesses::Set(set)) => {
                let above = |results: &[Result<Largest, Unusable>]| match results.last() {
                    Some(Ok([largest, ..])) => *largest > cutoff,
                    Some(Err(_)) => true,
                    None => false,
                };
                let k1 = |i: usize| set.get(i).map_or(own, |k1| k1.get());
                let results = in_groups(set.len(), 1, |i, _| at(k1(i)), above);
                let larger = |a: Largest, b: Largest| std::array::from_fn(|i| a[i].max(b[i]));
                results.into_iter().try_fold([0.0; 3], |worst, more| Ok(larger(worst, more?)))
            }
        }
    }

    fn over_omega(
        &self,
        scene: &Scene,
        phase: f64,
        term: Numbered,
        cutoff: f64,
    ) -> Result<Largest, Unusable> {
        let own = scene.forcing.frequency.get();
        let band = term.1.omega.map(|band| band.of(&scene.primary));
        if term.1.response == Response::Steady {
            return self.steady(scene, band.map_or([own; 2], |band| [band.from, band.to]), term);
        }
        let at = |omega: f64| self.run(scene, omega, phase, term, cutoff);
        match band {
            Some(band) => self.worst_over(&band, at, cutoff),
            None => at(own),
        }
    }

    /// The largest of each over a band. Peaks of stroke and force are searched only where they could break a limit.
    fn worst_over(
        &self,
        band: &Band,
        at: impl Fn(f64) -> Result<Largest, Unusable> + Sync,
        cutoff: f64,
    ) -> Result<Largest, Unusable> {
        let beyond = |limit| Some(self.limits.get(limit).unwrap_or(f64::INFINITY));
        let limits = [None, beyond(Limit::Stroke), beyond(Limit::Force)];
        Ok(all_worst_over(band, at, cutoff, limits)?.map(|worst| worst.value))
    }

    fn run(
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
        };
        let largest = found.largest.value;
        self.see(Place { largest, scene, phase, term: number }, found.stroke, found.force, found.settled);
        Ok([largest, found.stroke, found.force])
    }

    fn steady(&self, scene: &Scene, band: [f64; 2], (number, term): Numbered) -> Result<Largest, Unusable> {
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
