//! The objective as a function of a design, as searches call it.

use super::evaluation::{Evaluation, Run};
use super::limits::INFEASIBLE;
use super::motions::{Known, MotionSearch};
use super::runs::{Hooks, NO_HOOKS, Proceed};
use super::spec::Goal;
use super::unusable::Unusable;
use crate::search::minimax::{Height, Piece};
use retune_model::{Damper, Parameter, Scene, den_hartog};
use retune_solver::Settings;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// The designs that could not be evaluated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Failures {
    /// How many evaluations failed.
    pub count: u64,
    /// One of them with its reason: the lowest in lexicographic order of the parameters, so that the choice does not depend on
    /// which thread failed first.
    pub example: Option<Box<(Vec<f64>, Unusable)>>,
}

/// Numbers of designs evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Evaluations of the objective.
    pub evaluations: u64,
    /// Of these, designs that were found to break a limit. A design whose evaluation stopped at the cutoff before that is
    /// not counted.
    pub infeasible: u64,
}

impl Counts {
    /// The sum of the counts of two stages.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            evaluations: self.evaluations + other.evaluations,
            infeasible: self.infeasible + other.infeasible,
        }
    }
}

/// The goal of a search as a function of a design, which has a value for each varied parameter of the damper. Threads may share it.
///
/// A design that cannot be evaluated has the value +∞ and is recorded in [`Self::failures`].
#[derive(Debug)]
pub struct DesignObjective {
    pub(super) scene: Scene,
    damper: Damper,
    variables: Vec<Parameter>,
    goal: Goal,
    settings: Settings,
    failures: Mutex<Failures>,
    counts: [AtomicU64; 2],
    /// The known motions to continue; none if all are searched for at each design.
    known: Option<Known>,
    /// Most evaluations of a descent.
    pub(super) patience: u64,
}

impl DesignObjective {
    /// The objective over `variables` of `damper`, which replaces the damper of `scene`, if any.
    pub fn new(
        scene: Scene,
        damper: Damper,
        variables: Vec<Parameter>,
        goal: impl Into<Goal>,
        settings: Settings,
    ) -> Self {
        let goal = goal.into();
        let (failures, counts, known) = Default::default();
        Self { scene, damper, variables, goal, settings, failures, counts, known, patience: u64::MAX }
    }

    /// The goal.
    pub fn goal(&self) -> &Goal {
        &self.goal
    }

    /// The settings of its runs.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The varied parameters, in the order of a design.
    pub fn variables(&self) -> &[Parameter] {
        &self.variables
    }

    /// Den Hartog's spring and dashpot for the damper's mass, N/m and N·s/m.
    pub(super) fn den_hartog(&self) -> [f64; 2] {
        den_hartog(&self.scene.primary, self.damper.mass.get())
    }

    /// The damper of `design`: one value for each of [`Self::variables`], SI units; the other parameters are unchanged.
    ///
    /// # Errors
    /// A value out of its parameter's range.
    pub fn damper(&self, design: &[f64]) -> Result<Damper, Unusable> {
        let mut damper = self.damper;
        for (&parameter, &value) in self.variables.iter().zip(design) {
            let set = parameter.set_damper(&mut damper, value);
            set.map_err(|source| Unusable::Value { parameter, source })?;
        }
        Ok(damper)
    }

    /// The scene of `design`.
    ///
    /// # Errors
    /// A value out of its parameter's range.
    pub fn scene(&self, design: &[f64]) -> Result<Scene, Unusable> {
        Ok(Scene { damper: Some(self.damper(design)?), ..self.scene })
    }

    /// The number that searches minimise: the goal's value of `design`, or a number above [`INFEASIBLE`] if it breaks a
    /// limit; any number above `cutoff` once the value is known to exceed it; +∞ if there is no value.
    pub fn value(&self, design: &[f64], cutoff: f64) -> f64 {
        self.value_as(design, cutoff, |found| (found.ranked, found.violation > 0.0))
    }

    /// [`Self::value`] capped at `most`. A capped design is not counted as infeasible unless `most` is above [`INFEASIBLE`].
    pub fn value_up_to(&self, design: &[f64], most: f64) -> f64 {
        self.value_as(design, most, |found| {
            (found.ranked.min(most), found.violation > 0.0 && most > INFEASIBLE)
        })
    }

    /// Evaluates a design; `of` gives the value of the evaluation, and whether it counts as infeasible.
    fn value_as(&self, design: &[f64], cutoff: f64, of: impl FnOnce(Evaluation) -> (f64, bool)) -> f64 {
        self.counts[0].fetch_add(1, Relaxed);
        match self.scene(design).and_then(|scene| self.evaluate(&scene, cutoff)) {
            Ok(found) => {
                let (value, breaks_a_limit) = of(found);
                self.counts[1].fetch_add(u64::from(breaks_a_limit), Relaxed);
                value
            }
            Err(reason) => {
                self.note(design, reason);
                f64::INFINITY
            }
        }
    }

    /// The largest value and the violation behind [`Self::value`], with the runs; failures are not recorded.
    pub fn height_and_runs(&self, design: &[f64], cutoff: f64) -> (Height, Vec<Run>) {
        self.counts[0].fetch_add(1, Relaxed);
        let runs = Mutex::new(Vec::new());
        let keep = |run| runs.lock().unwrap_or_else(PoisonError::into_inner).push(run);
        let hooks = Hooks { keep: &keep, ..NO_HOOKS };
        let found = self.scene(design);
        let found = found.and_then(|scene| self.goal.evaluate_with(&scene, &self.settings, cutoff, hooks));
        let height = found.map_or(Height { worst: f64::INFINITY, violation: 0.0 }, |found| Height {
            worst: found.value,
            violation: found.violation,
        });
        self.counts[1].fetch_add(u64::from(height.violation > 0.0), Relaxed);
        (height, runs.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// The peaks of the `runs` of [`Self::height_and_runs`], with their derivatives.
    pub fn pieces(&self, design: &[f64], runs: &[Run]) -> Vec<Piece> {
        let scene = self.scene(design).ok();
        let pieces = |scene| self.goal.pieces(&scene, &self.settings, runs, &self.variables);
        scene.map_or_else(Vec::new, pieces)
    }

    /// Counts a value that [`Self::value`] returned in an earlier run of the same search, so that [`Self::counts`] are those of an
    /// uninterrupted one.
    pub fn recall(&self, value: f64) {
        self.counts[0].fetch_add(1, Relaxed);
        self.counts[1].fetch_add(u64::from(value > INFEASIBLE), Relaxed);
    }

    /// Counts what a descent evaluated in an earlier run of the same search.
    pub fn recall_all(&self, Counts { evaluations, infeasible }: Counts) {
        self.counts[0].fetch_add(evaluations, Relaxed);
        self.counts[1].fetch_add(infeasible, Relaxed);
    }

    /// The objective for a search: where its goal is over all motions, only those that runs from rest lead to and those that it
    /// [learns](Self::learn) are evaluated, in a small part of the time.
    #[must_use]
    pub fn following(self) -> Self {
        Self { known: Some(Known::default()), ..self }
    }

    /// The objective with [descents](Self::descend) that end after `patience` evaluations.
    #[must_use]
    pub fn within(self, patience: u64) -> Self {
        Self { patience, ..self }
    }

    /// Learns the motions at a design, which are then continued to other designs; returns the evaluation with all motions found there.
    ///
    /// # Errors
    /// As [`Goal::evaluate`].
    pub fn learn(&mut self, design: &[f64]) -> Result<Evaluation, Unusable> {
        let (found, known) = self.goal.known(&self.scene(design)?, &self.settings)?;
        self.known = Some(known);
        Ok(found)
    }

    /// Evaluates a scene with this objective's goal and settings; see [`Goal::evaluate`] and [`Self::learn`].
    ///
    /// # Errors
    /// As [`Goal::evaluate`].
    pub fn evaluate(&self, scene: &Scene, cutoff: f64) -> Result<Evaluation, Unusable> {
        self.goal.evaluate_with(
            scene,
            &self.settings,
            cutoff,
            Hooks { motion_search: self.motion_search(), ..NO_HOOKS },
        )
    }

    /// [`Self::evaluate`] as long as `proceed` is true; see [`Goal::evaluate_while`].
    ///
    /// # Errors
    /// As [`Goal::evaluate_while`].
    pub fn evaluate_while(
        &self,
        scene: &Scene,
        cutoff: f64,
        proceed: Proceed<'_>,
    ) -> Result<Evaluation, Unusable> {
        self.goal.evaluate_with(
            scene,
            &self.settings,
            cutoff,
            Hooks { proceed, motion_search: self.motion_search(), ..NO_HOOKS },
        )
    }

    fn motion_search(&self) -> MotionSearch<'_> {
        self.known.as_ref().map_or(MotionSearch::All, MotionSearch::Followed)
    }

    /// The failed evaluations so far.
    pub fn failures(&self) -> Failures {
        self.failures.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The numbers of designs evaluated so far.
    pub fn counts(&self) -> Counts {
        let [evaluations, infeasible] = [0, 1].map(|i| self.counts[i].load(Relaxed));
        Counts { evaluations, infeasible }
    }

    fn note(&self, design: &[f64], reason: Unusable) {
        let mut failures = self.failures.lock().unwrap_or_else(PoisonError::into_inner);
        failures.count += 1;
        if failures.example.as_ref().is_none_or(|lowest| design < lowest.0.as_slice()) {
            failures.example = Some(Box::new((design.to_vec(), reason)));
        }
    }
}
