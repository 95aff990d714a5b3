//! The value that a search minimises: a quantity composed over frequencies, stiffnesses, an ensemble and several terms, under limits.
//!
//! `value = Σ weight · statistic over records of statistic over the ensemble of (largest over k1 of (largest over ω of the quantity))`. Each level is one
//! function of a cutoff, above which it may stop; every stopping rule is exact: a value not above the cutoff is computed in
//! full.

use super::band::{Band, all_worst_over};
use super::ensemble::{SLACK, statistic_over};
use super::evaluation::{Evaluation, Place};
use super::limits::{INFEASIBLE, Limits, PerLimit, ranked};
use super::motions::{Known, MotionSearch};
use super::runs::{Hooks, Largest, NO_HOOKS, Numbered, Observed, Proceed, Runs, Seen};
use super::spec::{Goal, Response, Stiffnesses};
use super::unusable::Unusable;
use crate::chunks::in_groups;
use retune_model::{NonNegative, PerMeasure, Scene};
use retune_solver::Settings;
use std::sync::{Mutex, PoisonError};

impl Goal {
    /// Evaluates a scene. The value may be any number above `cutoff` once it is known to exceed it; the rest is then incomplete.
    ///
    /// # Errors
    /// A run could not be finished, or the damper of a steady motion reaches a wall.
    pub fn evaluate(&self, scene: &Scene, settings: &Settings, cutoff: f64) -> Result<Evaluation, Unusable> {
        self.evaluate_with(scene, settings, cutoff, NO_HOOKS)
    }

    /// [`Self::evaluate`] as long as `proceed` is true, which is called before each run in time.
    ///
    /// # Errors
    /// As [`Self::evaluate`], and [`Unusable::Stopped`].
    pub fn evaluate_while(
        &self,
        scene: &Scene,
        settings: &Settings,
        cutoff: f64,
        proceed: Proceed<'_>,
    ) -> Result<Evaluation, Unusable> {
        self.evaluate_with(scene, settings, cutoff, Hooks { proceed, ..NO_HOOKS })
    }

    /// [`Self::evaluate`] where a goal over all motions is limited to those that runs from rest lead to and those continued from `known`.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn evaluate_following(
        &self,
        scene: &Scene,
        settings: &Settings,
        known: &Known,
    ) -> Result<Evaluation, Unusable> {
        self.evaluate_with(
            scene,
            settings,
            f64::INFINITY,
            Hooks { motion_search: MotionSearch::Followed(known), ..NO_HOOKS },
        )
    }

    /// Whether it covers motions from other starts than rest, over a band: then a search continues known motions from one design to the
    /// next.
    pub fn follows_motions(&self) -> bool {
        self.objective
            .terms()
            .iter()
            .any(|(_, term)| term.response == Response::Motions && term.omega.is_some())
    }

    /// The motions of a scene that a search continues to other dampers, and the evaluation with all motions found.
    ///
    /// # Errors
    /// As [`Goal::evaluate`].
    pub fn known(&self, scene: &Scene, settings: &Settings) -> Result<(Evaluation, Known), Unusable> {
        let known = Mutex::default();
        let hooks = Hooks { motion_search: MotionSearch::Stored(&known), ..NO_HOOKS };
        let found = self.evaluate_with(scene, settings, f64::INFINITY, hooks)?;
        Ok((found, known.into_inner().unwrap_or_else(PoisonError::into_inner)))
    }

    pub(super) fn evaluate_with(
        &self,
        scene: &Scene,
        settings: &Settings,
        cutoff: f64,
        hooks: Hooks<'_>,
    ) -> Result<Evaluation, Unusable> {
        let cavity = scene.damper.map_or(0.0, |damper| damper.rest_distance.get() + damper.clearance.get());
        let runs = Runs::new(self, scene, settings, Observed::limits(&self.limits), hooks);
        let with_cavity = |PerMeasure(reached): PerMeasure<f64>| {
            PerLimit(std::array::from_fn(|i| reached.get(i).copied().unwrap_or(cavity)))
        };
        // A cavity above its limit makes the design infeasible without any run.
        let too_wide = self.limits.violation(&with_cavity(PerMeasure::default())) > 0.0;
        let value = if cutoff < INFEASIBLE && too_wide {
            f64::INFINITY
        } else {
            let cutoff = if cutoff < INFEASIBLE { cutoff } else { f64::INFINITY };
            self.sum(scene, cutoff, &runs)?
        };
        let Seen { reached, worst, runs, unsettled } =
            runs.seen.into_inner().unwrap_or_else(PoisonError::into_inner);
        let reached = with_cavity(reached);
        let violation = self.limits.violation(&reached);
        Ok(Evaluation { ranked: ranked(value, violation), value, violation, reached, worst, runs, unsettled })
    }

    /// The worst run of a term at a phase of the force (rad), without limits.
    pub(super) fn worst(
        &self,
        scene: &Scene,
        phase: f64,
        term: Numbered,
        settings: &Settings,
        proceed: Proceed<'_>,
    ) -> Result<Place, Unusable> {
        let free = Self { limits: Limits::default(), ..self.clone() };
        let observed = Observed::limits(&free.limits);
        let runs = Runs::new(&free, scene, settings, observed, Hooks { proceed, ..NO_HOOKS });
        runs.over_losses(scene, phase, term, f64::INFINITY)?;
        Ok(runs.seen.into_inner().unwrap_or_else(PoisonError::into_inner).worst)
    }

    /// The weighted sum, in the unit of the quantity.
    pub(super) fn sum(&self, scene: &Scene, cutoff: f64, runs: &Runs) -> Result<f64, Unusable> {
        if self.objective.sum.is_empty() {
            return runs.term(scene, (0, &self.objective), cutoff); // the common case, without an allocation
        }
        let terms = self.objective.terms();
        let (mut sum, most) = (0.0, cutoff * SLACK);
        for (i, (weight, term)) in terms.into_iter().enumerate() {
            sum += weight * runs.term(scene, (i, term), (most - sum) / weight)?;
            if sum > most {
                break;
            }
        }
        Ok(sum)
    }
}

impl Runs<'_> {
    fn term(&self, scene: &Scene, term: Numbered, cutoff: f64) -> Result<f64, Unusable> {
        let records = &term.1.records;
        if records.is_empty() {
            return self.under_forcing(scene, term, cutoff);
        }
        let each = |i: usize, cutoff: f64| {
            self.under_forcing(&Scene { forcing: records[i], ..*scene }, term, cutoff)
        };
        statistic_over(term.1.over_records(), records.len(), &each, cutoff)
    }

    /// The value under the forcing of the scene.
    fn under_forcing(&self, scene: &Scene, term: Numbered, cutoff: f64) -> Result<f64, Unusable> {
        let Some(ensemble) = &term.1.ensemble else {
            return Ok(self.over_losses(scene, 0.0, term, cutoff)?[0]);
        };
        let member = |i: u32, cutoff: f64| {
            let (scene, phase) = ensemble.member(scene, i).map_err(Unusable::Member)?;
            Ok(self.over_losses(&scene, phase, term, cutoff)?[0])
        };
        ensemble.over(member, cutoff)
    }

    fn over_losses(
        &self,
        scene: &Scene,
        phase: f64,
        term: Numbered,
        cutoff: f64,
    ) -> Result<Largest, Unusable> {
        if term.1.restitution.is_none() {
            return self.over_k1(scene, phase, term, cutoff); // the common case, without an allocation
        }
        let all = term.1.scenes(scene)?;
        worst_of(all.len(), &|i| self.over_k1(&all[i], phase, term, cutoff), cutoff)
    }

    fn over_k1(&self, scene: &Scene, phase: f64, term: Numbered, cutoff: f64) -> Result<Largest, Unusable> {
        let nominal = scene.primary.stiffness.get();
        let at = |k1: f64| -> Result<Largest, Unusable> {
            let mut scene = *scene;
            scene.primary.stiffness = NonNegative::new(k1).map_err(Unusable::Stiffness)?;
            self.over_omega(&scene, phase, term, cutoff)
        };
        match &term.1.k1 {
            None => self.over_omega(scene, phase, term, cutoff),
            Some(Stiffnesses::Range(range)) => self.worst_over(&range.band(), &at, cutoff),
            Some(Stiffnesses::Set(set)) => {
                worst_of(set.len(), &|i| at(set.get(i).map_or(nominal, |k1| k1.get())), cutoff)
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
        let nominal = scene.forcing.frequency.get();
        let band = term.1.omega.map(|band| band.of(&scene.primary));
        if term.1.response == Response::Steady {
            return self.steady(scene, band.map_or([nominal; 2], |band| [band.from, band.to]), term);
        }
        if term.1.response == Response::Motions {
            return self.motions(
                scene,
                band.map_or((nominal, nominal, 1), |band| (band.from, band.to, band.samples)),
                term,
            );
        }
        let at = |omega: f64| self.run(scene, omega, phase, term, cutoff);
        match band {
            Some(band) => self.worst_over(&band, &at, cutoff),
            None => at(nominal),
        }
    }

    /// The largest of each quantity over a band. Peaks of measures beside the objective's are searched only where they matter.
    fn worst_over(
        &self,
        band: &Band,
        at: &(dyn Fn(f64) -> Result<Largest, Unusable> + Sync),
        cutoff: f64,
    ) -> Result<Largest, Unusable> {
        let limits =
            std::array::from_fn(|i| i.checked_sub(1).map(|measure| self.observed.matters.0[measure]));
        Ok(all_worst_over(band, at, cutoff, limits, self.peaks)?.map(|worst| worst.value))
    }
}

/// The largest of each quantity over `count` cases, until one is above the cutoff.
fn worst_of(
    count: usize,
    at: &(dyn Fn(usize) -> Result<Largest, Unusable> + Sync),
    cutoff: f64,
) -> Result<Largest, Unusable> {
    let above = |results: &[Result<Largest, Unusable>]| match results.last() {
        Some(Ok([largest, ..])) => *largest > cutoff,
        Some(Err(_)) => true,
        None => false,
    };
    let larger = |a: Largest, b: Largest| std::array::from_fn(|i| a[i].max(b[i]));
    let results = in_groups(count, 1, &|i, _| at(i), &above);
    results.into_iter().try_fold(Largest::default(), |worst, more| Ok(larger(worst, more?)))
}
