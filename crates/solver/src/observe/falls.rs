//! Finds where a rate falls through zero: a maximum of the quantity with this rate.

/// A place and the rate there.
pub type Place = (f64, f64);

/// Consecutive steps that may fail to halve the bracket of a root before a bisection.
const PATIENCE: u32 = 3;
/// Limit on steps: to rounding, even if every halving takes as many as it may.
const STEPS: u32 = 53 * (PATIENCE + 1);

/// Where a rate that is positive at the one end and not at the other falls through zero, to rounding of the later end: regula falsi with
/// the value at a retained end scaled down (N. Anderson and A. Bjorck, 1973), safeguarded by bisection.
pub fn falls(rate: impl Fn(f64) -> f64, mut from: Place, mut to: Place) -> f64 {
    // No step ends nearer to an end than this, so that the last ones close the bracket about the root.
    let least = f64::EPSILON * to.0;
    let (mut last, mut slow) = (None, 0);
    for _ in 0..STEPS {
        let width = to.0 - from.0;
        if width <= 2.0 * least {
            break;
        }
        let crossing = from.0 + width * (from.1 / (from.1 - to.1));
        let inside = crossing.max(from.0 + least).min(to.0 - least);
        let at = if slow < PATIENCE { inside } else { from.0 + 0.5 * width };
        let value = rate(at);
        let is_above = value > 0.0;
        let (end, other) = if is_above { (&mut from, &mut to) } else { (&mut to, &mut from) };
        if last == Some(is_above) {
            let left = 1.0 - value / end.1;
            other.1 *= if left > 0.0 { left } else { 0.5 };
        }
        *end = (at, value);
        last = Some(is_above);
        slow = if to.0 - from.0 <= 0.5 * width { 0 } else { slow + 1 };
    }
    to.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// By halving alone, until no number is left between the ends.
    fn halved(rate: impl Fn(f64) -> f64, [mut from, mut to]: [f64; 2]) -> f64 {
        loop {
            let middle = 0.5 * (from + to);
            if middle <= from || middle >= to {
                return to;
            }
            if rate(middle) > 0.0 { from = middle } else { to = middle }
        }
    }

    /// The place that is found, and after how many evaluations.
    fn found(rate: impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> (f64, u32) {
        let count = Cell::new(0);
        let counted = |at: f64| {
            count.set(count.get() + 1);
            rate(at)
        };
        (falls(counted, (from, rate(from)), (to, rate(to))), count.get())
    }

    #[test]
    fn exact_a_maximum_is_where_halving_finds_it() {
        let mut most = 0;
        for i in 1..2000_u32 {
            let share = |k: u32| f64::from(i * k % 2003) / 2003.0;
            let (root, bend, wave) = (0.01 + 0.08 * share(7), 40.0 * share(11) - 20.0, 9.0 * share(13));
            let rate =
                |s: f64| (root - s) * (1.0 + bend * (s - root) / 2.0 + wave * (s - root).powi(2)) * 1e3;
            let ends = [0.1 * share(17) * root, 0.1];
            if rate(ends[0]) <= 0.0 || rate(ends[1]) > 0.0 {
                continue;
            }
            let (place, evaluations) = found(rate, ends);
            let expected = halved(rate, ends);
            assert!((place - expected).abs() <= 2.0 * f64::EPSILON * ends[1], "{i}: {place:e} {expected:e}");
            most = most.max(evaluations);
        }
        assert!(most < 16, "{most} evaluations");
    }

    /// A step, a root of high order, a root at an end, rates that are not finite: slow, but never wrong, and never without end.
    #[test]
    fn exact_a_rate_that_misleads_the_secant_is_halved() {
        let step = |s: f64| if s < 0.07 { 1.0 } else { -1e-9 };
        let flat = |s: f64| (0.03 - s).powi(9);
        let steep = |s: f64| 1e-12 - s.powi(20);
        let late = |s: f64| 0.1 - s;
        let endless = |s: f64| if s < 0.02 { f64::INFINITY } else { f64::NAN };
        let all: [&dyn Fn(f64) -> f64; 5] = [&step, &flat, &steep, &late, &endless];
        for (number, rate) in all.into_iter().enumerate() {
            let (place, evaluations) = found(rate, [0.0, 0.1]);
            let expected = halved(rate, [0.0, 0.1]);
            assert!((place - expected).abs() <= 1e-16, "{number}: {place:e} {expected:e}");
            assert!(evaluations <= 4 * 53, "{number}: {evaluations}"); // four for each halving
        }
    }
}
