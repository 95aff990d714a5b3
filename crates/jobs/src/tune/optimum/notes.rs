//! The objective and the limits in `optimum.json`.

use super::super::global::Explored;
use super::super::refine::{Refined, Run};
use super::super::surf::Surf;
use super::super::valley::Valley;
use retune_model::Scene;
use retune_optim::{Bounds, Evaluation, FrequencyBand, Limit, Limits, Objective, Parameter, Response};
use retune_study::{Search, Study};
use serde::{Serialize, Serializer};

/// The objective, and the ω at which the best design has its value, rad/s.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Goal {
    #[serde(flatten)]
    objective: Objective,
    pub(super) worst_omega: f64,
    /// The stiffness k1 at which it is reached, N/m, if the objective has several.
    #[serde(skip_serializing_if = "Option::is_none")]
    worst_k1: Option<f64>,
    /// The restitution at which it is reached, if the objective has several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) worst_restitution: Option<f64>,
    /// Runs of the best design that should have settled and did not; their E1max is that of the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) unsettled: Option<u64>,
    /// Number of runs behind its value; a steady response in closed form counts as one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) runs: Option<u64>,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct LimitNote {
    pub(crate) allowed: Limits,
    /// The largest value of each limited quantity in any run of the objective, SI units.
    #[serde(flatten, serialize_with = "by_name")]
    pub(crate) reached: Vec<(Limit, f64)>,
    pub(crate) feasible: bool,
    /// Whether it is proven that no design within the bounds keeps the limits: the least D + C exceeds that of the cavity.
    #[serde(rename = "none_exists", skip_serializing_if = "retune_study::is_default")]
    pub(crate) proven: bool,
    /// The sum of reached / limit - 1 over the limits that are broken.
    violation: f64,
    /// The limits that are broken, or reached to within 1 %: they determine the optimum.
    pub(crate) active: Vec<Limit>,
    /// Designs that were evaluated, and those among them that were found to break a limit.
    pub(crate) evaluations: u64,
    pub(crate) infeasible: u64,
}

fn by_name<S: Serializer>(reached: &[(Limit, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(reached.iter().map(|(limit, value)| (limit, value)))
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Met {
    pub(crate) variable: Parameter,
    #[serde(skip)]
    pub(crate) bound: f64,
}

impl Goal {
    /// The band of frequencies of its first term, if it has one.
    pub(super) fn band(&self) -> Option<FrequencyBand> {
        self.objective.terms().first().and_then(|(_, term)| term.omega)
    }

    pub(super) fn new(study: &Study, evaluation: &Evaluation) -> Self {
        let objective = study.objective();
        let any = |is: fn(&Objective) -> bool| objective.terms().iter().any(|(_, term)| is(term));
        let Scene { primary, forcing, .. } = evaluation.worst.scene;
        let settles = any(|term| term.response == Response::Settled);
        Self {
            objective: objective.clone(),
            worst_omega: forcing.frequency.get(),
            worst_k1: any(|term| term.k1.is_some()).then_some(primary.stiffness.get()),
            worst_restitution: any(|term| term.restitution.is_some())
                .then(|| Parameter::Restitution.of(&evaluation.worst.scene))
                .flatten(),
            unsettled: settles.then_some(evaluation.unsettled),
            runs: settles.then_some(evaluation.runs),
        }
    }
}

impl LimitNote {
    pub(super) fn new(
        (study, search): (&Study, &Search),
        evaluation: &Evaluation,
        surf: Option<&Surf>,
        explored: Option<&Explored>,
        refined: &Refined,
    ) -> Option<Self> {
        let allowed = study.optimize.as_ref()?.limits;
        let Evaluation { reached, violation, .. } = *evaluation;
        let counts = [surf.map(|surf| surf.counts), explored.map(|explored| explored.counts)];
        let counts = || counts.iter().flatten().copied().chain([refined.objective.counts()]);
        (!allowed.is_empty()).then(|| Self {
            allowed,
            reached: allowed.set().map(|limit| (limit, reached.get(limit))).collect(),
            feasible: violation == 0.0,
            proven: allowed.get(Limit::Cavity).is_some_and(|most| least_cavity(search) > most),
            violation,
            active: allowed.active(&reached),
            evaluations: counts().map(|counts| counts.evaluations).sum(),
            infeasible: counts().map(|counts| counts.infeasible).sum(),
        })
    }
}

/// The least D + C within the bounds of a search, m.
fn least_cavity(search: &Search) -> f64 {
    let least = |gap: Parameter| match search.variables.iter().position(|variable| *variable == gap) {
        Some(place) => search.options.bounds[place].lower.unwrap_or(0.0),
        None => gap.get(&search.damper),
    };
    least(Parameter::D) + least(Parameter::C)
}

/// The parameters in which the best point of the grid lies at its edge, and not on a bound.
pub(super) fn on_edge(search: &Search, surf: &Surf) -> Vec<Parameter> {
    let best = surf.point(surf.best);
    let mut steps = vec![0; surf.grid.dim()];
    surf.grid.steps(surf.best, &mut steps);
    let is_edge = |&i: &usize| {
        let points = surf.grid.axes()[i].points();
        let at_end = points > 1 && (steps[i] == 0 || steps[i] + 1 == points);
        let place = search.variables.iter().position(|variable| *variable == surf.variables[i]);
        let bounds = place.map(|place| search.options.bounds[place]);
        at_end && bounds.is_none_or(|bounds| met(best[i], best[i], bounds).is_none())
    };
    (0..surf.variables.len()).filter(is_edge).map(|i| surf.variables[i]).collect()
}

/// Parameters that ended on a bound: to a thousandth of the larger of their first and last value, or to within rounding
/// of the distance between the bounds. One in whose direction the objective is flat could as well have ended elsewhere: its bound costs little.
pub(super) fn on_bound(search: &Search, run: &Run, valleys: &[Valley]) -> Vec<Met> {
    let Some(first) = run.rows.first() else { return Vec::new() };
    let ended = |i: usize| {
        let variable = search.variables[i];
        let bound = met(run.minimum.x[i], first.best[i], search.options.bounds[i])?;
        // No parameter is below zero, however flat the objective is there.
        let is_flat = |valley: &Valley| valley.variable == variable && valley.is_flat();
        (bound == 0.0 || !valleys.iter().any(is_flat)).then_some(Met { variable, bound })
    };
    (0..search.variables.len()).filter_map(ended).collect()
}

/// The bound that a value lies on, if any, after a search from `start`.
fn met(value: f64, start: f64, Bounds { lower, upper }: Bounds) -> Option<f64> {
    /// Share of a distance that counts as rounding.
    const ROUNDING: f64 = 1e-9;
    // Without an upper bound the distance is taken as 1 (N/m, N·s/m or m): 1e-9 of that is negligible in each of these units.
    let apart = upper.zip(lower).map_or(1.0, |(upper, lower)| upper - lower);
    let near = (1e-3 * value.abs().max(start.abs())).max(ROUNDING * apart);
    [lower, upper].into_iter().flatten().find(|bound| (value - bound).abs() <= near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_bound_met_to_within_rounding_is_met() {
        let open = Bounds { lower: Some(0.0), upper: None };
        let closed = Bounds { lower: Some(10.0), upper: Some(600.0) };
        // A search that was given a start on the bound: both the start and the end are zero to within rounding.
        assert_eq!(met(1.3388507403093525e-16, 2.6e-16, open), Some(0.0));
        assert_eq!(met(7.6e-16, 1e-16, Bounds { upper: Some(2.0), ..open }), Some(0.0));
        assert_eq!(met(599.83, 600.0, closed), Some(600.0));
        assert_eq!(met(10.0 + 1e-8, 10.0, closed), Some(10.0));
        assert_eq!([met(590.0, 300.0, closed), met(1e-4, 2e-4, open)], [None, None]);
        let on_zero = Met { variable: Parameter::D, bound: 0.0 };
        assert_eq!(serde_json::to_string(&on_zero).ok().as_deref(), Some("\"D\""));
    }
}
