//! π, sine and cosine in intervals.

use crate::Interval;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// Terms of the Taylor series of sine and cosine.
const TERMS: u32 = 12;
/// Arguments wider than this give [-1, 1].
const WIDE: f64 = 4.0;

/// π/2: the double is below it (it is 1.570796326794896558, π/2 is 1.570796326794896619).
pub fn half_pi() -> Interval {
    Interval::new(FRAC_PI_2, FRAC_PI_2.next_up())
}

/// π.
pub fn pi() -> Interval {
    Interval::point(2.0) * half_pi()
}

/// `[cos x, sin x]` of all `x`.
///
/// At the middle by Taylor's series after a reduction by quarter turns; elsewhere both change by no more than `x` does.
pub fn cos_sin(x: Interval) -> [Interval; 2] {
    let all = Interval::new(-1.0, 1.0);
    if !x.is_bounded() || x.width() > WIDE {
        return [all, all];
    }
    let middle = Interval::point(x.mid());
    let away = Interval::around_zero((x - middle).magnitude());
    let quarters = (x.mid() * FRAC_2_PI).round();
    let [cos, sin] = near_zero(middle - Interval::point(quarters) * half_pi(), TERMS);
    let turned = match quarters.rem_euclid(4.0) {
        0.0 => [cos, sin],
        1.0 => [-sin, cos],
        2.0 => [-cos, -sin],
        _ => [sin, -cos],
    };
    turned.map(|value| (value + away).meet(all).unwrap_or(all))
}

/// `[cos x, sin x]` by Taylor's series. Its terms alternate and, for `|x| < 1`, decrease, so the truncation error is at most the first
/// omitted term.
fn near_zero(x: Interval, terms: u32) -> [Interval; 2] {
    if x.magnitude() >= 1.0 {
        return [Interval::new(-1.0, 1.0); 2];
    }
    let minus_square = -x.square();
    let series = |first: Interval, offset: u32| {
        let mut all = vec![first];
        for k in 0..terms {
            let n = f64::from(2 * k + offset);
            all.push(all[k as usize] * minus_square / Interval::point((n + 1.0) * (n + 2.0)));
        }
        // Smallest first: only the last sum rounds at the size of the result.
        let left_out = all.pop().map_or(1.0, Interval::magnitude);
        all.into_iter().rev().fold(Interval::around_zero(left_out), |sum, term| sum + term)
    };
    [series(Interval::ONE, 0), series(x, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `[x, cos x, sin x]`, the last two as sums of two doubles: mpmath with 60 digits, `tests/reference/cos_sin.py`.
    fn reference() -> Vec<[f64; 5]> {
        serde_json::from_str(include_str!("../../../tests/reference/cos_sin.json")).expect("a table")
    }

    /// Whether a number, given as a sum of two doubles, is in an interval.
    fn holds(interval: Interval, [first, rest]: [f64; 2]) -> bool {
        let is_below = interval.lo() < first || (interval.lo() == first && rest >= 0.0);
        let is_above = interval.hi() > first || (interval.hi() == first && rest <= 0.0);
        is_below && is_above
    }

    #[test]
    fn reference_mpmaths_cosine_and_sine_are_enclosed() {
        for [x, c, c_rest, s, s_rest] in reference() {
            let [cos, sin] = cos_sin(Interval::point(x));
            assert!(holds(cos, [c, c_rest]), "cos {x:e} = {c:e} + {c_rest:e}: {cos}");
            assert!(holds(sin, [s, s_rest]), "sin {x:e} = {s:e} + {s_rest:e}: {sin}");
            let most = 1e-15 * (1.0 + x.abs());
            assert!(cos.width() < most && sin.width() < most, "{x:e}: {cos} {sin}");
        }
    }

    /// With few terms, so that the truncation error is far above rounding.
    #[test]
    fn reference_mpmaths_cosine_and_sine_are_enclosed_by_short_series() {
        for [x, c, c_rest, s, s_rest] in reference().into_iter().filter(|[x, ..]| x.abs() < 1.0) {
            for terms in 1..TERMS {
                let [cos, sin] = near_zero(Interval::point(x), terms);
                assert!(holds(cos, [c, c_rest]) && holds(sin, [s, s_rest]), "{x:e} {terms}: {cos} {sin}");
            }
        }
    }

    #[test]
    fn reference_cosine_and_sine_of_wide_intervals_hold_those_of_their_numbers() {
        for (k, [x, c, c_rest, s, s_rest]) in reference().into_iter().enumerate() {
            let (left, right) = (0.01 * (k % 17) as f64, 0.1 * (k % 23) as f64);
            let [cos, sin] = cos_sin(Interval::new(x - left, x + right));
            assert!(holds(cos, [c, c_rest]) && holds(sin, [s, s_rest]), "{x:e} {left} {right}: {cos} {sin}");
        }
        assert_eq!(cos_sin(Interval::ENTIRE)[0], Interval::new(-1.0, 1.0));
    }

    /// It contains 2 π/2: 3.14159265358979311600 is the double below π, 1.2246467991473532e-16 the remainder.
    #[test]
    fn exact_pi() {
        assert!(holds(pi(), [std::f64::consts::PI, 1.224_646_799_147_353_2e-16]) && pi().width() < 2e-15);
    }
}
