//! What was made small and how limits were kept, as `optimum.json` tells it.

use super::super::global::Explored;
use super::super::log::short;
use super::super::refine::Refined;
use super::super::surf::Surf;
use crate::study::{LimitsGiven, Objective, Study};
use retune_model::Scene;
use retune_optim::{Evaluation, Limit, When};
use serde::Serialize;

/// What was made small, and the ω at which E1max of the best design is reached, rad/s.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Goal {
    #[serde(flatten)]
    objective: Objective,
    worst_omega: f64,
    /// The stiffness k1 at which it is reached, N/m, where several were looked at.
    #[serde(skip_serializing_if = "Option::is_none")]
    worst_k1: Option<f64>,
    /// Of the runs of the best design, those that were to settle and did not; their E1max is that of the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) unsettled: Option<u64>,
    /// Runs that its value is made of; a steady response in closed form counts as one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) runs: Option<u64>,
}

/// How the limits are kept by the best design.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LimitNote {
    allowed: LimitsGiven,
    /// The largest values in any run of the objective, SI units.
    stroke: f64,
    force: f64,
    cavity: f64,
    feasible: bool,
    /// The sum of reached / limit - 1 over the limits that are broken.
    violation: f64,
    /// The limits that are broken, or reached to within 1 %: they decide the optimum.
    active: Vec<Limit>,
    /// Designs that were evaluated, and those among them that were seen to break a limit.
    evaluations: u64,
    infeasible: u64,
}

impl Goal {
    pub(super) fn new(study: &Study, evaluation: &Evaluation) -> Self {
        let goal = study.goal();
        let Scene { primary, forcing, .. } = evaluation.worst.scene;
        let settles = goal.terms.iter().any(|term| matches!(term.when, When::Settled(..)));
        Self {
            objective: study.objective(),
            worst_omega: forcing.frequency.get(),
            worst_k1: goal.terms.iter().any(|term| term.k1.is_some()).then_some(primary.stiffness.get()),
            unsettled: settles.then_some(evaluation.unsettled),
            runs: settles.then_some(evaluation.runs),
        }
    }
}

impl LimitNote {
    pub(super) fn new(
        study: &Study,
        evaluation: &Evaluation,
        surf: Option<&Surf>,
        explored: Option<&Explored>,
        refined: &Refined,
    ) -> Option<Self> {
        let allowed = study.optimize.as_ref()?.limits;
        let limits = allowed.limits();
        let Evaluation { reached, violation, .. } = *evaluation;
        let counts = [surf.map(|surf| surf.counts), explored.map(|explored| explored.counts)];
        let counts = || counts.iter().flatten().copied().chain([refined.objective.counts()]);
        (!limits.is_empty()).then(|| Self {
            allowed,
            stroke: reached.get(Limit::Stroke),
            force: reached.get(Limit::Force),
            cavity: reached.get(Limit::Cavity),
            feasible: violation == 0.0,
            violation,
            active: limits.active(&reached),
            evaluations: counts().map(|counts| counts.evaluations).sum(),
            infeasible: counts().map(|counts| counts.infeasible).sum(),
        })
    }

    pub(super) fn report(&self) -> String {
        let Self { allowed, feasible, active, evaluations, infeasible, .. } = self;
        let limits = allowed.limits();
        let reached = [self.stroke, self.force, self.cavity];
        let words = Limit::ALL.into_iter().zip(reached).filter_map(|(limit, reached)| {
            let allowed = limits.get(limit)?;
            let active = if active.contains(&limit) { ", active" } else { "" };
            Some(format!("{limit} {} of {} {}{active}", short(reached), short(allowed), limit.unit()))
        });
        let kept = if *feasible { "limits kept" } else { "NO DESIGN KEEPS THE LIMITS; the nearest" };
        format!(
            "{kept}: {}; {infeasible} of {evaluations} evaluations broke one",
            words.collect::<Vec<_>>().join("; ")
        )
    }
}
