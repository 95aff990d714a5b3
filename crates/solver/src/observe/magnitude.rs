//! The largest magnitude of a quantity of either sign.

use super::observer::{Impact, Observer, Path};
use super::quantity::Quantity;
use super::running_maximum::RunningMaximum;
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::response::Extreme;

/// The largest `|f|` of a quantity `f`, located to rounding: the running maxima of `f` and `-f`, each of which skips what the other has
/// surpassed.
pub struct Magnitude<Q>([RunningMaximum<Q>; 2]);

impl<Q> Magnitude<Q> {
    /// Observes the quantity with either sign, `quantity(1)` and `quantity(-1)`; the run may end early once it exceeds `cutoff`.
    pub fn new(quantity: impl Fn(f64) -> Q, cutoff: f64) -> Self {
        Self([1.0, -1.0].map(|sign| RunningMaximum::new(quantity(sign), cutoff)))
    }

    /// The largest magnitude so far and its time; `-∞` and NaN before any motion was seen.
    pub fn record(&self) -> Extreme {
        let [plus, minus] = self.0.each_ref().map(RunningMaximum::record);
        if minus.value > plus.value { minus } else { plus }
    }

    /// By how much a value may exceed the record, see [`RunningMaximum::doubt`].
    pub fn doubt(&self) -> f64 {
        let [plus, minus] = self.0.each_ref().map(RunningMaximum::doubt);
        plus.max(minus)
    }

    /// Passes a part of the motion to both maxima, each with the record of both.
    #[inline(always)]
    fn visit_both(&mut self, mut visit: impl FnMut(&mut RunningMaximum<Q>)) {
        let [plus, minus] = &mut self.0;
        plus.raise_record(minus.record());
        visit(plus);
        minus.raise_record(plus.record());
        visit(minus);
    }
}

impl<const N: usize, Q: Quantity<N>> Observer<N> for Magnitude<Q> {
    fn segment(&mut self, segment: &dyn Segment<N>) {
        self.visit_both(|one| one.segment(segment));
    }
    fn path(&mut self, path: &dyn Path<N>) {
        self.visit_both(|one| one.path(path));
    }
    fn steps(&mut self, steps: &Steps<'_, N>) {
        self.visit_both(|one| one.steps(steps));
    }
    fn skips(&self, block: &Block<N>) -> bool {
        let most = self.record().value;
        self.0.iter().all(|one| one.stays_below(block, most))
    }
    fn impact(&mut self, impact: &Impact<N>) {
        self.0.impact(impact);
    }
    fn discontinuity(&mut self) {
        Observer::<N>::discontinuity(&mut self.0);
    }
    fn satisfied(&self) -> bool {
        self.0.iter().any(Observer::satisfied)
    }
    fn search_work(&self) -> u64 {
        Observer::<N>::search_work(&self.0)
    }
}
