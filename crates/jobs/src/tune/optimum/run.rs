//! A refinement in `optimum.json`, and the descent that followed it.

use super::super::refine::{Descended, Run};
use crate::amount::Amount;
use retune_model::Measure;
use retune_model::PerVariable;
use retune_optim::{Minimum, Stop, value_of};
use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub(super) struct RunNote {
    pub(super) start: PerVariable<f64>,
    #[serde(flatten)]
    pub(super) at_start: Amount,
    pub(super) found: PerVariable<f64>,
    #[serde(flatten)]
    pub(super) value: Amount,
    pub(super) iterations: u64,
    pub(super) func_count: u64,
    pub(super) stop: Stop,
    /// The descent by derivatives that went on from there, where it found a better design.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) descent: Option<DescentNote>,
}

#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct DescentNote {
    #[serde(flatten)]
    pub(super) from: Amount,
    pub(super) evaluations: u64,
}

impl RunNote {
    pub(super) fn new(run: &Run, quantity: Measure, over: impl Fn(&[f64]) -> PerVariable<f64>) -> Self {
        let Minimum { x, value, iterations, func_count, stop, .. } = &run.minimum;
        let (start, at_start) = match run.rows.first() {
            Some(row) => (over(&row.best), value_of(row.value)),
            None => (PerVariable::default(), f64::NAN),
        };
        let (iterations, func_count) = (*iterations, *func_count);
        Self {
            start,
            at_start: Amount::of(quantity, "_start", at_start),
            found: over(x),
            value: Amount::new(quantity, value_of(*value)),
            iterations,
            func_count,
            stop: *stop,
            descent: run.descent.map(|Descended { from, evaluations }| DescentNote {
                from: Amount::of(quantity, "_before", value_of(from)),
                evaluations,
            }),
        }
    }
}
