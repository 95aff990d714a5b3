//! The first contact of an exact flight: no crossing is missed, however short, down to rounding.

use crate::motion::polynomial::Polynomial;
use wide::f64x4;

/// Bernstein coefficients of the cubic that meets `(value, slope)` at both ends of an interval of length `h`: it stays between the least
/// and the largest of them, and deviates from the function by at most [`CUBIC`]` h⁴ max|f⁗|`.
#[inline(always)]
pub fn cubic(h: f64x4, a: [f64x4; 2], b: [f64x4; 2]) -> [f64x4; 4] {
    let third = h / 3.0;
    [a[0], a[0] + a[1] * third, b[0] - b[1] * third, b[0]]
}

/// Share of `h⁴ max|f⁗|` by which the [`cubic`] may deviate from the function: `s² (h - s)² / 4!` at `s = h/2`.
pub const CUBIC: f64 = 1.0 / 384.0;

/// Least of four numbers, in each lane.
#[inline(always)]
pub fn floor([a, b, c, d]: [f64x4; 4]) -> f64x4 {
    a.fast_min(b).fast_min(c.fast_min(d))
}

/// Largest of four numbers, in each lane.
#[inline(always)]
pub fn ceiling([a, b, c, d]: [f64x4; 4]) -> f64x4 {
    a.fast_max(b).fast_max(c.fast_max(d))
}

/// A lower bound of a gap that is zero at the start of an interval, in such units that the gap is open on all of it if the bound is more
/// than `CUBIC h⁴ max|f⁗|`: its cubic over `s` is a quadratic with Bernstein coefficients `[3 b1, 3/2 b2, b3] / h`, which deviates from the
/// gap over `s` by at most `s (h - s)² / 4! <= h³/162` times `max|f⁗|`.
#[inline(always)]
pub fn opening_floor([_, b1, b2, b3]: [f64x4; 4]) -> f64x4 {
    (b1 * 3.0).fast_min(b2 * 1.5).fast_min(b3) * (162.0 * CUBIC)
}

/// Limit on halvings of a step in the search for a contact. Some tens are common, and a thousand are many.
const HALVINGS: u32 = 100_000;

/// The search for a contact has lost all digits to rounding or overflow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecisionLost;

/// The first `s` in `(0, to]` at which the gap becomes negative, or `None`.
///
/// `Some(0.0)` means that the gap is closed at the start and closing. A gap of zero that opens is in flight.
///
/// # Errors
/// [`PrecisionLost`]: the coefficients are not finite, or the gap is so close to zero throughout that no bound decides.
pub fn first_contact<const B: usize>(mut gap: Polynomial<B>, to: f64) -> Result<Option<f64>, PrecisionLost> {
    // At s = 0 the damper may just have left the wall (or rest on it): the root there is divided out.
    for _ in 0..4 * B {
        if gap.coefficient(0) != 0.0 {
            break;
        }
        gap = gap.over_s();
    }
    let start = gap.coefficient(0);
    if start <= 0.0 {
        return Ok((start < 0.0).then_some(0.0));
    }
    let fourth = gap.fourth_derivative_bound(to);
    if !(start + fourth).is_finite() {
        return Err(PrecisionLost);
    }
    let derivative = gap.derivative();
    let at = |s: f64| [gap.at(s), derivative.at(s)];
    let ends = ((0.0, [start, gap.coefficient(1)]), (to, at(to)));
    Search { at, fourth, shortest: to * 1e-15, halvings: HALVINGS }.search(ends.0, ends.1)
}

struct Search<F> {
    /// Value and slope.
    at: F,
    /// A bound on the fourth derivative.
    fourth: f64,
    shortest: f64,
    /// Halvings left.
    halvings: u32,
}

impl<F: Fn(f64) -> [f64; 2]> Search<F> {
    /// Left half first, so that the first crossing is found first. An interval ends the search when it is certified open, when it
    /// holds one simple crossing, or when it is too short to matter.
    fn search(
        &mut self,
        (a, left): (f64, [f64; 2]),
        (b, right): (f64, [f64; 2]),
    ) -> Result<Option<f64>, PrecisionLost> {
        let h = b - a;
        let [left_lanes, right_lanes] = [left, right].map(|end| end.map(f64x4::splat));
        if floor(cubic(h.into(), left_lanes, right_lanes)).to_array()[0] >= CUBIC * h.powi(4) * self.fourth {
            return Ok(None);
        }
        // |p' - cubic'| <= √3 h³/216 max|p⁗|; the cubic's slope stays below the largest of its Bernstein coefficients.
        let middle = 3.0 * (right[0] - left[0]) / h - left[1] - right[1];
        let steepest = left[1].max(middle).max(right[1]) + 0.009 * h.powi(3) * self.fourth;
        if right[0] < 0.0 && steepest < 0.0 {
            return Ok(Some(root(&self.at, (a, left), (b, right))));
        }
        let mid = 0.5 * (a + b);
        if h < self.shortest || mid <= a || mid >= b {
            return Ok((right[0] < 0.0).then_some(b)); // otherwise it touches to rounding, without force
        }
        self.halvings = self.halvings.checked_sub(1).ok_or(PrecisionLost)?;
        let centre = (self.at)(mid);
        match self.search((a, left), (mid, centre))? {
            Some(found) => Ok(Some(found)),
            None => self.search((mid, centre), (b, right)),
        }
    }
}

/// The root of a function that falls from positive to negative over `[a, b]`: Newton's iteration safeguarded by bisection, from the root of
/// the cubic that meets value and slope at both ends.
fn root(
    at: &impl Fn(f64) -> [f64; 2],
    (mut a, left): (f64, [f64; 2]),
    (mut b, right): (f64, [f64; 2]),
) -> f64 {
    let mut s = a + cubic_root(b - a, left, right);
    // No step has been made yet, so nothing is known of how steps shrink.
    let mut before = 0.0;
    for _ in 0..100 {
        let [value, slope] = at(s);
        if value > 0.0 {
            a = s
        } else {
            b = s
        }
        let newton = s - value / slope;
        let inside = (a..=b).contains(&newton);
        let next = if inside { newton } else { 0.5 * (a + b) };
        let step = (next - s).abs();
        // Convergence is quadratic: the next step is left out if its predicted size is below rounding.
        if inside && step.powi(3) <= f64::EPSILON * s * before * before || next == s {
            return next;
        }
        (before, s) = (step, next);
    }
    s
}

/// The root of the cubic that falls from positive to negative over an interval of length `h`, after some steps of Newton.
fn cubic_root(h: f64, [value, slope]: [f64; 2], [value_end, slope_end]: [f64; 2]) -> f64 {
    let fall = value_end - value;
    let (c1, c2, c3) =
        (h * slope, 3.0 * fall - h * (2.0 * slope + slope_end), h * (slope + slope_end) - 2.0 * fall);
    let mut x = value / (value - value_end);
    for _ in 0..3 {
        let next = x - (value + x * (c1 + x * (c2 + x * c3))) / (c1 + x * (2.0 * c2 + x * 3.0 * c3));
        x = next.clamp(0.0, 1.0);
    }
    if x.is_nan() { 0.5 * h } else { x * h }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[f64]) -> Polynomial<1> {
        Polynomial::new(coefficients)
    }

    fn first(gap: Polynomial<1>, to: f64) -> Option<f64> {
        first_contact(gap, to).expect("enough digits")
    }

    #[test]
    fn exact_first_of_two_crossings_inside_a_step() {
        // (s - 0.3)(s - 0.3 - d): positive at both ends, below zero only for a moment.
        for d in [1e-1, 1e-3, 1e-6] {
            let p = polynomial(&[0.3 * (0.3 + d), -0.6 - d, 1.0]);
            let s = first(p, 1.0).expect("a crossing");
            assert!((s - 0.3).abs() < 1e-15 / d.max(1e-6) * 10.0, "{d} {s}");
        }
    }

    /// Falling at both ends, and yet not all the way: one crossing is proven only by the slope between the ends.
    #[test]
    fn exact_first_of_three_crossings() {
        // (0.2 - s) (s - 0.5) (s - 0.8).
        let s = first(polynomial(&[0.08, -0.66, 1.5, -1.0]), 1.0).expect("a crossing");
        assert!((s - 0.2).abs() < 1e-15, "{s}");
    }

    #[test]
    fn exact_no_contact_when_the_gap_only_nearly_closes() {
        let p = polynomial(&[0.09 + 1e-14, -0.6, 1.0]);
        assert_eq!(first(p, 1.0), None);
    }

    #[test]
    fn contract_leaving_a_wall_is_not_a_contact_but_returning_is() {
        assert_eq!(first(polynomial(&[0.0, 1.0]), 1.0), None);
        let back = first(polynomial(&[0.0, 1.0, -4.0]), 1.0).expect("returns");
        assert!((back - 0.25).abs() < 1e-15);
        assert_eq!(first(polynomial(&[0.0, -1.0, 4.0]), 1.0), Some(0.0));
        assert_eq!(first(polynomial(&[0.0, 0.0, -4.0]), 1.0), Some(0.0));
        assert_eq!(first(polynomial(&[0.0]), 1.0), None);
    }

    /// Found by the hunt: where the wall is approached slowly, a first step of Newton's method that was small was taken for the last.
    #[test]
    fn exact_a_slow_touch_down_is_found_to_rounding() {
        for i in 1..4000_u32 {
            let share = |k: u32| f64::from(i * k % 4001) / 4001.0;
            // (c - s) (w + b (c - s)) + q s² (c - s)²: it closes at c, with the speed w.
            let (c, w, b, q) =
                (0.02 + 0.2 * share(7), 0.01 + 0.1 * share(11), 4.0 * share(13), 0.1 * share(17));
            let closing = [c * (w + b * c), -w - 2.0 * b * c, b + q * c * c, -2.0 * q * c, q];
            let found = first_contact(Polynomial::<2>::new(&closing), 0.25)
                .expect("enough digits")
                .expect("it closes");
            let rounding = 1e-15 * closing[0] / w;
            assert!((found - c).abs() <= rounding, "{i}: {:e} at {c}, rounding {rounding:e}", found - c);
        }
    }

    #[test]
    fn exact_tiny_bounces_are_found_at_their_own_scale() {
        let back = first(polynomial(&[0.0, 1e-12, -1.0]), 0.1).expect("returns");
        assert!((back / 1e-12 - 1.0).abs() < 1e-12, "{back}");
    }

    /// Once searched without end: a bound that is NaN decides nothing about any half, however short.
    #[test]
    fn contract_a_gap_beyond_numbers_or_an_endless_search_is_lost() {
        for beyond in [f64::INFINITY, f64::NAN, 1e308] {
            assert_eq!(
                first_contact(Polynomial::<2>::new(&[1.0, -1.0, 0.0, 0.0, beyond]), 1.0),
                Err(PrecisionLost)
            );
        }
        // Zero throughout, with a bound that allows for more.
        let mut search = Search { at: |_| [0.0, 0.0], fourth: 1.0, shortest: 1e-15, halvings: HALVINGS };
        assert_eq!(search.search((0.0, [0.0; 2]), (1.0, [0.0; 2])), Err(PrecisionLost));
    }
}
