//! The last choice among the ends of refinements: of designs that are as good, one that keeps its value where others do not: off by a little, or from other starts than rest.

use super::refine::{Refined, Run};
use crate::Error;
use crate::amount::Amount;
use crate::certify::{Certificate, Verdict, certify};
use retune_study::{PerVariable, Study};
use serde::Serialize;

/// Designs whose values differ by less than this share are as good.
const SAME: f64 = 0.01;

/// A design that was passed over, though its value is smaller.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PassedOver {
    /// The number of its start, from 1.
    start: usize,
    #[serde(flatten)]
    design: PerVariable<f64>,
    #[serde(flatten)]
    value: Amount,
    /// Why.
    words: String,
}

impl PassedOver {
    /// A note on screen.
    pub(super) fn words(&self) -> String {
        let Self { start, value, words, .. } = self;
        format!("note: passed over for it: start {start}, {}, {words}", value.words())
    }
}

/// Chooses, of the ends of the refinements within 1 % of the best, the best that is robust; if none is, the best that no other motion makes
/// much worse; else the best. The certificate of the choice, and what it passes over. Ends are compared at the study's tolerance, whatever
/// that of its search.
///
/// # Errors
/// As [`certify`].
pub(super) fn choose(study: &Study, refined: &mut Refined) -> Result<(Certificate, Vec<PassedOver>), Error> {
    let settings = study.solver.settings();
    let value = |Run { minimum, .. }: &Run| {
        if settings == *refined.objective.settings() {
            return minimum.value;
        }
        let scene = refined.objective.scene(&minimum.x);
        let found = scene.and_then(|scene| study.goal().evaluate(&scene, &settings, f64::INFINITY));
        found.map_or(f64::INFINITY, |found| found.value)
    };
    let values: Vec<f64> = refined.runs.iter().map(value).collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| {
        let number = |i: usize| (i != refined.winner, i);
        values[a].total_cmp(&values[b]).then(number(a).cmp(&number(b)))
    });
    refined.winner = order.first().copied().unwrap_or(refined.winner);
    let best = values[refined.winner];
    order.retain(|&i| i == refined.winner || values[i] <= (1.0 + SAME) * best);
    let mut seen: Vec<(usize, Certificate)> = Vec::new();
    for number in order {
        let scene = refined.objective.scene(&refined.runs[number].minimum.x)?;
        seen.push((number, certify(&Study { scene, ..study.clone() })?));
        if seen.last().is_some_and(|(_, certificate)| certificate.verdict == Some(Verdict::Robust)) {
            break;
        }
    }
    let safe = |(_, certificate): &(usize, Certificate)| certificate.verdict != Some(Verdict::FromRest);
    let robust = seen.iter().position(|(_, certificate)| certificate.verdict == Some(Verdict::Robust));
    let chosen = robust.or_else(|| seen.iter().position(safe)).unwrap_or(0);
    let passed = seen.iter().take(chosen).map(|(number, certificate)| PassedOver {
        start: number + 1,
        design: PerVariable::of(refined.objective.variables(), &refined.runs[*number].minimum.x),
        value: Amount::new(study.quantity(), retune_optim::energy(values[*number])),
        words: certificate.words.clone(),
    });
    let passed = passed.collect();
    let (number, certificate) = seen.swap_remove(chosen);
    refined.winner = number;
    Ok((certificate, passed))
}
