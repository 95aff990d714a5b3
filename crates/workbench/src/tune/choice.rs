//! The last choice among the ends of refinements: of designs that are as good, one that keeps its value from other starts than rest.

use super::refine::{Refined, Run};
use crate::Error;
use crate::amount::Amount;
use crate::certify::{Certificate, Verdict, certify};
use retune_study::{PerVariable, Study};
use serde::Serialize;

/// Designs whose values differ by less than this share are as good.
const SAME: f64 = 0.01;

/// A design that was passed over, though its value is the smaller.
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

/// Chooses the best end of the refinements that no other motion makes much worse, if there is one within 1 % of the best, else the best. The
/// certificate of the choice, and what it passes over.
///
/// # Errors
/// As [`certify`].
pub(super) fn choose(study: &Study, refined: &mut Refined) -> Result<(Certificate, Vec<PassedOver>), Error> {
    let best = refined.best().minimum.value;
    let mut order: Vec<usize> = (0..refined.runs.len()).collect();
    order.retain(|&i| refined.runs[i].minimum.value <= (1.0 + SAME) * best);
    order.sort_by(|&a, &b| {
        let value = |i: usize| refined.runs[i].minimum.value;
        value(a).total_cmp(&value(b)).then((a != refined.winner).cmp(&(b != refined.winner)))
    });
    let mut passed: Vec<PassedOver> = Vec::new();
    let mut first: Option<Certificate> = None;
    for number in order {
        let Run { minimum, .. } = &refined.runs[number];
        let scene = refined.objective.scene(&minimum.x)?;
        let certificate = certify(&Study { scene, ..study.clone() })?;
        if certificate.verdict != Some(Verdict::FromRest) {
            refined.winner = number;
            return Ok((certificate, passed));
        }
        passed.push(PassedOver {
            start: number + 1,
            design: PerVariable::of(refined.objective.variables(), &minimum.x),
            value: Amount::new(study.quantity(), retune_optim::energy(minimum.value)),
            words: certificate.words.clone(),
        });
        first.get_or_insert(certificate);
    }
    match first {
        Some(certificate) => Ok((certificate, Vec::new())),
        None => {
            let scene = refined.objective.scene(&refined.best().minimum.x)?;
            Ok((certify(&Study { scene, ..study.clone() })?, Vec::new()))
        }
    }
}
