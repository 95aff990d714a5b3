//! The last choice among the ends of refinements: of designs that are as good, one that keeps its value where others do not: off by a
//! little, or from other starts than rest.

use super::refine::{Refined, Run};
use crate::Error;
use crate::amount::Amount;
use crate::certify::{Certificate, Verdict, certify, judge};
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

/// The place of the choice among designs in the order of their values: the first that is robust; else the first of which no other motion is much
/// worse than that from rest; else the first.
fn place(verdicts: &[Option<Verdict>]) -> usize {
    let rank = |verdict: Option<Verdict>| match verdict {
        Some(Verdict::Robust) => 0,
        Some(Verdict::FromRest) => 2,
        _ => 1,
    };
    (0..verdicts.len()).min_by_key(|&i| rank(verdicts[i])).unwrap_or(0)
}

/// Chooses, of the ends of the refinements within 1 % of the best, one of the best verdict, and of those the best. The certificate of the
/// choice, and what it passes over. Ends are compared at the study's tolerance, whatever that of its search.
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
    let of = |number: usize| -> Result<Study, Error> {
        let scene = refined.objective.scene(&refined.runs[number].minimum.x)?;
        Ok(Study { scene, ..study.clone() })
    };
    for number in order {
        let certificate = judge(&of(number)?)?;
        let is_robust = certificate.verdict == Some(Verdict::Robust);
        seen.push((number, certificate));
        if is_robust {
            break;
        }
    }
    let verdicts: Vec<Option<Verdict>> = seen.iter().map(|(_, certificate)| certificate.verdict).collect();
    let chosen = place(&verdicts);
    let passed = seen.iter().take(chosen).map(|(number, certificate)| PassedOver {
        start: number + 1,
        design: PerVariable::of(refined.objective.variables(), &refined.runs[*number].minimum.x),
        value: Amount::new(study.quantity(), retune_optim::energy(values[*number])),
        words: certificate.words.clone(),
    });
    let passed = passed.collect();
    let (number, certificate) = seen.swap_remove(chosen);
    let certificate = if certificate.is_whole() { certificate } else { certify(&of(number)?)? };
    refined.winner = number;
    Ok((certificate, passed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_the_best_robust_design_is_chosen() {
        use Verdict::{FromRest, Robust, Sensitive};
        let choice = |verdicts: &[Verdict]| place(&verdicts.iter().copied().map(Some).collect::<Vec<_>>());
        assert_eq!(choice(&[Sensitive, FromRest, Robust]), 2);
        assert_eq!(choice(&[FromRest, Sensitive, Sensitive]), 1);
        assert_eq!(choice(&[FromRest, FromRest]), 0);
        assert_eq!(choice(&[Robust]), 0);
        assert_eq!(place(&[Some(FromRest), None]), 1);
    }
}
