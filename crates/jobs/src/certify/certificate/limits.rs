//! The limits of a study, at a design and near it.

use retune_optim::{Limit, Limits, PerLimit};
use retune_study::short;
use serde::Serialize;

/// The limits that are broken by the design or near it.
#[derive(Clone, Debug, Serialize)]
pub struct Kept {
    /// The limits that the design itself breaks.
    broken: Vec<Excess>,
    /// For each limit broken near the design (by a neighbour, with 1 % of one parameter, or on the finer band), the case that breaks it
    /// most.
    broken_near: Vec<Excess>,
    neighbours: usize,
}

/// A limit that is broken. SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Excess {
    limit: Limit,
    allowed: f64,
    reached: f64,
    over_percent: f64,
    /// The place in words; empty for the design itself.
    #[serde(skip_serializing_if = "String::is_empty")]
    at: String,
}

/// The largest values at a design near the certified one.
pub struct Near {
    pub at: String,
    pub neighbour: bool,
    pub reached: PerLimit<f64>,
}

impl Kept {
    /// None if the study has no limit. `own` holds the largest values of the design itself.
    pub fn new(limits: &Limits, own: &PerLimit<f64>, near: &[Near]) -> Option<Self> {
        if limits.is_empty() {
            return None;
        }
        let worst = |limit: Limit| {
            let excesses = near.iter().filter_map(|near| Excess::new(limits, limit, &near.reached, &near.at));
            excesses.max_by(|a, b| a.reached.total_cmp(&b.reached))
        };
        let neighbours = near.iter().filter(|near| near.neighbour && limits.violation(&near.reached) > 0.0);
        Some(Self {
            broken: Limit::ALL.into_iter().filter_map(|limit| Excess::new(limits, limit, own, "")).collect(),
            broken_near: Limit::ALL.into_iter().filter_map(worst).collect(),
            neighbours: neighbours.count(),
        })
    }

    /// The limits that the design itself breaks, in words; none if it keeps them.
    pub fn broken(&self) -> Option<String> {
        words(&self.broken, |Excess { limit, allowed, reached, over_percent, .. }| {
            let (reached, allowed, over) = (short(*reached), short(*allowed), short(*over_percent));
            format!("the limit of {limit}: {reached} of {allowed} {}, {over} % over", limit.unit())
        })
    }

    /// The limits that designs near it break, in words; none if all keep them.
    pub fn broken_near(&self) -> Option<String> {
        words(&self.broken_near, |Excess { limit, allowed, reached, over_percent, at }| {
            let (reached, allowed, over) = (short(*reached), short(*allowed), short(*over_percent));
            let unit = limit.unit();
            format!("{limit} is {reached} {unit} {at}, {over} % over its limit of {allowed} {unit}")
        })
    }

    pub fn neighbours(&self) -> usize {
        self.neighbours
    }
}

impl Excess {
    fn new(limits: &Limits, limit: Limit, reached: &PerLimit<f64>, at: &str) -> Option<Self> {
        let (allowed, reached) = (limits.get(limit)?, reached.get(limit));
        let over_percent = 100.0 * (reached / allowed - 1.0);
        (reached > (1.0 + Limits::ROUNDING) * allowed).then(|| Self {
            limit,
            allowed,
            reached,
            over_percent,
            at: at.to_owned(),
        })
    }
}

fn words(excesses: &[Excess], say: impl Fn(&Excess) -> String) -> Option<String> {
    let texts: Vec<String> = excesses.iter().map(say).collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_the_worst_broken_limit_is_reported_with_its_place() {
        let most = |value| retune_model::Positive::new(value).expect("a limit");
        let stroke = Limit::Of(retune_model::Measure::Stroke);
        let limits = Limits::default().with(stroke, most(0.2)).with(Limit::Cavity, most(0.5));
        let reached = |[stroke, force, cavity]: [f64; 3]| {
            PerLimit([0.0, 0.0, 0.0, 0.0, 0.0, stroke, force, 0.0, 0.0, cavity])
        };
        let near = |at: &str, neighbour, seen| Near { at: at.to_owned(), neighbour, reached: reached(seen) };
        let around = [
            near("here", true, [0.2, 9e9, 0.5]),
            near("there", true, [0.201, 0.0, 0.4]),
            near("beyond", false, [0.21, 0.0, 0.4]),
        ];
        let kept = Kept::new(&limits, &reached([0.2, 9e9, 0.5]), &around).expect("limits");
        assert_eq!((kept.broken(), kept.neighbours()), (None, 1));
        let said = kept.broken_near().expect("a limit is broken");
        assert_eq!(said, "stroke is 0.21 m beyond, 5 % over its limit of 0.2 m");
        let kept = Kept::new(&limits, &reached([0.1, 0.0, 0.75]), &[]).expect("limits");
        assert_eq!(kept.broken().as_deref(), Some("the limit of cavity: 0.75 of 0.5 m, 50 % over"));
        assert!(Kept::new(&Limits::default(), &PerLimit::all(1.0), &around).is_none());
    }
}
