//! The largest size of a quantity of either sign.

use super::observer::{Impact, Observer, Path};
use super::quantity::Quantity;
use super::running_maximum::RunningMaximum;
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::response::Extreme;

/// The largest `|f|` of a quantity `f`, located to rounding: the running maxima of `f` and `-f`, each of which drops what the other
/// has surpassed.
pub struct Magnitude<Q>([RunningMaximum<Q>; 2]);

impl<Q> Magnitude<Q> {
    /// Watches the quantity of either sign that `quantity` gives for 1 and for -1; the run may end early once it exceeds `cutoff`.
    pub fn new(quantity: impl Fn(f64) -> Q, cutoff: f64) -> Self {
        Self([1.0, -1.0].map(|sign| RunningMaximum::new(quantity(sign), cutoff)))
    }

    /// The largest size so far and its time; `-∞` and NaN before any motion was seen.
    pub fn record(&self) -> Extreme {
        let [plus, minus] = self.0.each_ref().map(RunningMaximum::record);
        if minus.value > plus.value { minus } else { plus }
    }

    /// By how much a value may exceed the record, see [`RunningMaximum::doubt`].
    pub fn doubt(&self) -> f64 {
        let [plus, minus] = self.0.each_ref().map(RunningMaximum::doubt);
        plus.max(minus)
    }

    /// Lets each look at a part of the motion with the record of both.
    #[inline(always)]
    fn each(&mut self, mut look: impl FnMut(&mut RunningMaximum<Q>)) {
        let [plus, minus] = &mut self.0;
        plus.raise(minus.record());
        look(plus);
        minus.raise(plus.record());
        look(minus);
    }
}

impl<const N: usize, Q: Quantity<N>> Observer<N> for Magnitude<Q> {
    fn segment(&mut self, segment: &dyn Segment<N>) {
        self.each(|one| one.segment(segment));
    }
    fn path(&mut self, path: &dyn Path<N>) {
        self.each(|one| one.path(path));
    }
    fn steps(&mut self, steps: &Steps<'_, N>) {
        self.each(|one| one.steps(steps));
    }
    fn skips(&self, block: &Block<N>) -> bool {
        let most = self.record().value;
        self.0.iter().all(|one| one.stays_below(block, most))
    }
    fn impact(&mut self, impact: &Impact<N>) {
        self.0.impact(impact);
    }
    fn seam(&mut self) {
        Observer::<N>::seam(&mut self.0);
    }
    fn satisfied(&self) -> bool {
        self.0.iter().any(Observer::satisfied)
    }
    fn looks(&self) -> u64 {
        Observer::<N>::looks(&self.0)
    }
}
