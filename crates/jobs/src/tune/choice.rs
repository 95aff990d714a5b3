//! The final choice among the refined designs: of designs with practically equal values, the one whose value is least sensitive to small
//! errors and to the initial state.

use super::refine::{Refined, Run};
use crate::amount::Amount;
use crate::certify::{Certificate, Verdict, certify, complete, judge};
use crate::tune::objective::worst;
use crate::{Error, Observer};
use retune_model::{Measure, PerVariable};
use retune_optim::Limit;
use retune_study::Study;
use serde::Serialize;

/// Designs whose values differ by less than this share are equally good.
const SAME: f64 = 0.01;

/// Designs whose values differ by less than this share lie in one valley.
const VALLEY: f64 = 1e-3;

/// A design that was passed over, though its value is smaller.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PassedOver {
    /// The number of its start, from 1.
    start: usize,
    #[serde(flatten)]
    design: PerVariable<f64>,
    #[serde(flatten)]
    value: Amount,
    words: String,
}

impl PassedOver {
    pub(super) fn words(&self) -> String {
        let Self { start, value, words, .. } = self;
        format!("note: passed over for it: start {start}, {}, {words}", value.words())
    }
}

/// Resolution of the margin of the force: margins are rounded to multiples of it before they are compared.
const SAME_MARGIN: f64 = 0.01;

/// The index of the chosen design, from designs sorted by value: of the robust ones the one with the largest margin of the force; else the
/// first for which no other motion is much worse than the one from rest; else the first.
fn place(all: &[(Option<Verdict>, f64)]) -> usize {
    let rank = |place: usize| rank(all[place].0, all[place].1);
    (0..all.len()).reduce(|best, other| if rank(other) < rank(best) { other } else { best }).unwrap_or(0)
}

/// Sort key, smaller is better: the verdict, then for robust designs the margin of the force.
fn rank(verdict: Option<Verdict>, safe_to: f64) -> (u8, f64) {
    match verdict {
        Some(Verdict::Robust) => (0, -(safe_to / SAME_MARGIN).round()),
        Some(Verdict::FromRest) => (2, 0.0),
        _ => (1, 0.0),
    }
}

/// The largest contact force, N, and stroke, m, of a design; none where it cannot be run.
fn burden(study: &Study) -> Option<[f64; 2]> {
    let reached = worst(study)?.reached;
    Some([Measure::ContactForce, Measure::Stroke].map(|measure| reached.get(Limit::Of(measure))))
}

/// Whether `other` loads the damper less than `own`: a contact force smaller by more than [`SAME`], or an equal force and a smaller stroke.
fn is_less(other: &[f64; 2], reference: &[f64; 2]) -> bool {
    let less = |i: usize| other[i] < (1.0 - SAME) * reference[i];
    let more = |i: usize| other[i] > (1.0 + SAME) * reference[i];
    less(0) || !more(0) && less(1)
}

/// Among designs in the valley of `certified[chosen]`, the index of the one with the least contact force, then stroke, that is at least as
/// safe. Designs without a certificate are certified here and appended to `certified`.
fn least_loaded(
    chosen: usize,
    certified: &mut Vec<(usize, Certificate)>,
    as_good: &[usize],
    values: &[f64],
    of: &impl Fn(usize) -> Result<Study, Error>,
) -> Result<usize, Error> {
    let (number, certificate) = &certified[chosen];
    let burden =
        |number: usize| of(number).ok().and_then(|study| burden(&study)).unwrap_or([f64::INFINITY; 2]);
    let reference = burden(*number);
    let in_valley = |other: &usize| values[*other] <= (1.0 + VALLEY) * values[*number];
    let mut lighter: Vec<(usize, [f64; 2])> =
        as_good.iter().copied().filter(in_valley).map(|other| (other, burden(other))).collect();
    lighter.retain(|(_, other)| is_less(other, &reference));
    lighter.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let required = rank(certificate.judged.verdict, certificate.safe_to());
    for (number, _) in lighter {
        let known = certified.iter().position(|(other, _)| *other == number);
        if known.is_none() {
            certified.push((number, judge(&of(number)?)?));
        }
        let index = known.unwrap_or(certified.len() - 1);
        let certificate = &certified[index].1;
        if rank(certificate.judged.verdict, certificate.safe_to()) <= required {
            return Ok(index);
        }
    }
    Ok(chosen)
}

/// Chooses among the refined designs within 1 % of the best value: the best verdict first; if robust, the largest margin of the force; then
/// the smallest value. Among designs within 0.1 % of that one it takes the least contact force, then stroke. Returns the certificate of the
/// choice and the designs with smaller values that were passed over. Values are compared at the study's tolerance, whatever that of its
/// search.
pub(super) fn choose(
    study: &Study,
    refined: &mut Refined,
    watch: &dyn Observer,
) -> Result<(Certificate, Vec<PassedOver>), Error> {
    let settings = study.solver.settings();
    let value = |Run { minimum, .. }: &Run| {
        if settings == *refined.objective.settings() && !study.goal().follows_motions() {
            return minimum.value;
        }
        let scene = refined.objective.scene(&minimum.x);
        let found = scene.and_then(|scene| study.goal().evaluate(&scene, &settings, f64::INFINITY));
        found.map_or(f64::INFINITY, |found| found.ranked)
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
    let mut certified: Vec<(usize, Certificate)> = Vec::new();
    let of = |number: usize| -> Result<Study, Error> {
        let scene = refined.objective.scene(&refined.runs[number].minimum.x)?;
        Ok(Study { scene, ..study.clone() })
    };
    let as_good = order.clone();
    let bar = watch.progress("certificates", order.len() as u64);
    for number in order {
        certified.push((number, judge(&of(number)?)?));
        bar.inc(1);
        if certified.last().is_some_and(|(_, certificate)| certificate.is_safest()) {
            break;
        }
    }
    let all: Vec<(Option<Verdict>, f64)> = certified
        .iter()
        .map(|(_, certificate)| (certificate.judged.verdict, certificate.safe_to()))
        .collect();
    let chosen = least_loaded(place(&all), &mut certified, &as_good, &values, &of)?;
    let chosen_rank = rank(certified[chosen].1.judged.verdict, certified[chosen].1.safe_to());
    let smaller = |(number, _): &&(usize, Certificate)| values[*number] < values[certified[chosen].0];
    let passed = certified.iter().filter(smaller).map(|(number, certificate)| PassedOver {
        start: number + 1,
        design: PerVariable::of(refined.objective.variables(), &refined.runs[*number].minimum.x),
        value: Amount::new(study.quantity(), retune_optim::value_of(values[*number])),
        words: if rank(certificate.judged.verdict, certificate.safe_to()) > chosen_rank {
            certificate.reason().to_owned()
        } else {
            "as good, but it needs a larger contact force or stroke".to_owned()
        },
    });
    let passed = passed.collect();
    let (number, certificate) = certified.swap_remove(chosen);
    let design = of(number)?;
    let certificate = if certificate.is_whole() { complete(&design, certificate) } else { certify(&design)? };
    bar.finish();
    refined.winner = number;
    Ok((certificate, passed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_in_a_valley_the_least_force_is_chosen_then_the_least_stroke() {
        let own = [1000.0, 0.5];
        assert!(is_less(&[980.0, 0.7], &own) && is_less(&[1005.0, 0.4], &own));
        assert!(!is_less(&[995.0, 0.5], &own) && !is_less(&[1100.0, 0.1], &own) && !is_less(&own, &own));
    }

    #[test]
    fn contract_the_robust_design_with_the_largest_margin_is_chosen() {
        use Verdict::{FromRest, Robust, Sensitive};
        let choice = |all: &[(Verdict, f64)]| {
            place(&all.iter().map(|(verdict, safe_to)| (Some(*verdict), *safe_to)).collect::<Vec<_>>())
        };
        assert_eq!(choice(&[(Sensitive, 0.0), (FromRest, 1.0), (Robust, 1.05)]), 2);
        assert_eq!(choice(&[(FromRest, 1.0), (Sensitive, 0.0), (Sensitive, 0.0)]), 1);
        assert_eq!(choice(&[(FromRest, 1.0), (FromRest, 1.0)]), 0);
        assert_eq!(choice(&[(Robust, 1.101), (Robust, 1.104), (Robust, 1.19), (Robust, 1.191)]), 2);
        assert_eq!(place(&[(Some(FromRest), 1.0), (None, 0.0)]), 1);
    }
}
