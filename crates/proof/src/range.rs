//! The range of a quantity during a step, from its Taylor series with the last coefficient enclosed over the whole step.

use crate::equations::at;
use crate::{Interval, Taylor};

/// Maximum depth of bisection of a step.
const DEPTH: u32 = 24;
/// A bound is sharp enough if it exceeds a value by no more than the first share of itself, plus the second share of the width over a
/// family.
const SHARP: [f64; 2] = [1e-12, 1e-3];

/// A quantity over a step from 0 to 1.
///
/// For each motion it is `Σ cₖ tᵏ` with the coefficients in their intervals, the last one depending on `t`. Its derivative is
/// `Σ k cₖ tᵏ⁻¹` in the same sense, since the remainder of the derivative has `N c_N` at some time in the step.
#[derive(Clone, Debug)]
pub struct Range {
    series: Vec<Taylor>,
    hulls: Vec<Interval>,
    slope: Vec<Interval>,
}

impl Range {
    /// The range of a quantity with this series.
    pub fn new(series: Vec<Taylor>) -> Self {
        let hulls: Vec<Interval> = series.iter().map(|c| c.hull()).collect();
        let slope = hulls.iter().enumerate().skip(1).map(|(k, c)| Interval::point(k as f64) * *c).collect();
        Self { series, hulls, slope }
    }

    /// Its value at a time, which may depend on the parameter of a family.
    pub fn at(&self, t: Taylor) -> Taylor {
        at(self.series.iter().copied(), t)
    }

    /// Its derivative.
    pub fn slope_at(&self, t: Taylor) -> Taylor {
        at(self.series.iter().enumerate().skip(1).map(|(k, c)| *c * Taylor::point(k as f64)), t)
    }

    fn value(&self, t: f64) -> Interval {
        self.at(Taylor::point(t)).hull()
    }

    /// Its derivatives over an interval of time.
    fn slope(&self, t: Interval) -> Interval {
        at(self.slope.iter().copied(), t)
    }

    /// Its values over an interval of time, directly and by the mean value theorem, which is sharper on a short one.
    fn over(&self, [a, b]: [f64; 2]) -> Interval {
        let (t, middle) = (Interval::new(a, b), 0.5 * (a + b));
        let from_middle = self.value(middle) + self.slope(t) * (t - Interval::point(middle));
        let direct = at(self.hulls.iter().copied(), t);
        from_middle.meet(direct).unwrap_or(direct)
    }

    /// Whether it is proven positive during the step, except at the beginning if it `starts` at zero, and up to a single crossing near the
    /// end if the segment `ends` there.
    pub fn is_positive(&self, starts: bool, ends: bool) -> bool {
        self.is_positive_in([0.0, 1.0], [starts, ends], DEPTH)
    }

    fn is_positive_in(&self, [a, b]: [f64; 2], [starts, ends]: [bool; 2], depth: u32) -> bool {
        let t = Interval::new(a, b);
        if self.over([a, b]).is_positive()
            || (starts && a == 0.0 && self.slope(t).is_positive())
            || (ends && b == 1.0 && self.slope(t).is_negative())
        {
            return true;
        }
        let middle = 0.5 * (a + b);
        depth > 0
            && self.is_positive_in([a, middle], [starts, ends], depth - 1)
            && self.is_positive_in([middle, b], [starts, ends], depth - 1)
    }

    /// Updates `most`, which encloses the largest value so far, to include this step. Motions are known to be in the step up to `sure`.
    pub fn raise(&self, most: &mut Interval, sure: f64) {
        self.raise_in([0.0, 1.0], most, sure, DEPTH);
    }

    fn raise_in(&self, [a, b]: [f64; 2], most: &mut Interval, sure: f64, depth: u32) {
        let (t, middle) = (Interval::new(a, b), 0.5 * (a + b));
        let slope = self.slope(t);
        let mut width = f64::INFINITY;
        let mut lower = |t: f64| {
            let value = self.value(t);
            width = value.width();
            if t <= sure {
                *most = most.max(Interval::new(value.lo(), most.hi().max(value.lo())));
            }
            value.hi()
        };
        let ends = lower(a).max(lower(b));
        let inner = lower(middle).max(ends);
        let bound = if slope.is_positive() || slope.is_negative() { ends } else { self.over([a, b]).hi() };
        let sharp = SHARP[0] * bound.abs() + SHARP[1] * width;
        // Where the slope has one sign the bound is the value at an end.
        if bound <= most.hi() || bound - inner <= sharp || depth == 0 {
            *most = most.max(Interval::new(most.lo(), bound.max(most.lo())));
        } else {
            self.raise_in([a, middle], most, sure, depth - 1);
            self.raise_in([middle, b], most, sure, depth - 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The range over a step of length `h`.
    fn range(series: &[f64], h: f64) -> Range {
        Range::new(series.iter().enumerate().map(|(k, c)| Taylor::point(c * h.powi(k as i32))).collect())
    }

    /// `t (1 - t) (2 - t)` on [0, 1] is largest at `1 - 1/√3`, with `2/(3√3)`; on [0, 3] at the end.
    #[test]
    fn exact_the_largest_value_of_a_cubic() {
        for (h, largest) in [(1.0, 2.0 / 27.0_f64.sqrt()), (3.0, 6.0)] {
            let mut most = Interval::ZERO;
            range(&[0.0, 2.0, -3.0, 1.0], h).raise(&mut most, 1.0);
            assert!(most.wider(1e-15).contains(largest) && most.width() < 3e-12 * largest, "{most}");
        }
    }

    /// Beyond the time to which motions are sure to last no value is known to be reached.
    #[test]
    fn exact_what_is_not_surely_reached_is_no_lower_bound() {
        let mut most = Interval::ZERO;
        range(&[0.0, 1.0], 2.0).raise(&mut most, 0.5);
        assert!(most.lo() <= 1.0 && most.hi() >= 2.0, "{most}");
    }

    #[test]
    fn exact_a_touch_is_no_gap() {
        assert!(range(&[0.1, -1.0, 3.0], 1.0).is_positive(false, false));
        assert!(!range(&[0.25, -1.0, 1.0], 1.0).is_positive(false, false), "(t - 1/2)²");
        assert!(!range(&[0.25, -1.0, 0.9], 1.0).is_positive(false, false));
        let rises = range(&[0.0, 1.0, 1.0], 1.0);
        assert!(rises.is_positive(true, false) && !rises.is_positive(false, false));
        let falls = range(&[1.0, -1.0], 1.0);
        assert!(falls.is_positive(false, true) && !falls.is_positive(false, false));
        // It decreases at first.
        assert!(!range(&[0.0, -1.0, 3.0], 1.0).is_positive(true, false));
    }
}
