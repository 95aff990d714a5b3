//! The first contact of an exact flight: no crossing is skipped, however short, down to rounding.

use crate::flow::TERMS;
use crate::rule::each;

/// A polynomial `Σ c_k s^k` on one flight step: the gap to a wall, positive in flight.
type Polynomial = [f64; TERMS];

/// Least of the Bernstein coefficients of the cubic that meets `(value, slope)` at both ends of an interval of length `h`:
/// the cubic stays above it.
#[inline(always)]
pub fn cubic_floor(h: f64, a: [f64; 2], b: [f64; 2]) -> f64 {
    let third = h / 3.0;
    least(least(a[0], a[0] + third * a[1]), least(b[0] - third * b[1], b[0]))
}

/// The smaller of two numbers, neither of them NaN: one instruction, where `f64::min` needs three.
#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The first `s` in `(0, to]` at which the gap becomes negative, or `None`.
///
/// `Some(0.0)` means that the gap is closed at the start and closing. A gap of zero that opens is in flight.
pub fn first_contact(gap: &Polynomial, to: f64) -> Option<f64> {
    // At s = 0 the damper may just have left the wall (or rest on it): the root there is divided out.
    let order = gap.iter().position(|&c| c != 0.0)?;
    let mut p = [0.0; TERMS];
    p[..TERMS - order].copy_from_slice(&gap[order..]);
    if p[0] < 0.0 {
        return Some(0.0);
    }
    let derivative = differentiated(&p);
    let at = |s: f64| [value(&p, s), value(&derivative, s)];
    search(&at, fourth_derivative_bound(&p, to), to * 1e-15, (0.0, [p[0], p[1]]), (to, at(to)))
}

/// Left half first, so that what is found is the first; an interval ends the search when it is certified open, when it holds
/// one simple crossing, or when it is too short to matter.
fn search(
    at: &impl Fn(f64) -> [f64; 2],
    fourth: f64,
    shortest: f64,
    (a, left): (f64, [f64; 2]),
    (b, right): (f64, [f64; 2]),
) -> Option<f64> {
    let h = b - a;
    // |p - cubic| <= h⁴/384 max|p⁗|
    if cubic_floor(h, left, right) >= h.powi(4) / 384.0 * fourth {
        return None;
    }
    // |p' - cubic'| <= √3 h³/216 max|p⁗|; the cubic's slope stays below the largest of its Bernstein coefficients.
    let middle = 3.0 * (right[0] - left[0]) / h - left[1] - right[1];
    let steepest = left[1].max(middle).max(right[1]) + 0.009 * h.powi(3) * fourth;
    if right[0] < 0.0 && steepest < 0.0 {
        return Some(root(at, (a, left), (b, right)));
    }
    let mid = 0.5 * (a + b);
    if h < shortest || mid <= a || mid >= b {
        return (right[0] < 0.0).then_some(b); // else it touches to rounding, with no force
    }
    let centre = at(mid);
    search(at, fourth, shortest, (a, left), (mid, centre))
        .or_else(|| search(at, fourth, shortest, (mid, centre), (b, right)))
}

/// The root of a function that falls from positive to negative over `[a, b]`: Newton, kept inside by bisection, from the root
/// of the cubic that meets value and slope at both ends.
fn root(
    at: &impl Fn(f64) -> [f64; 2],
    (mut a, left): (f64, [f64; 2]),
    (mut b, right): (f64, [f64; 2]),
) -> f64 {
    let mut s = a + cubic_root(b - a, left, right);
    let mut before = b - a;
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
        // Each step is the square of the one before times a constant: so will the next be, which is left undone if too small.
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

/// `Σ c_k s^k`: four sums in powers of `s⁴`, side by side.
#[inline(always)]
fn value(p: &Polynomial, s: f64) -> f64 {
    let (square, mut lanes) = (s * s, [0.0; 4]);
    let fourth = square * square;
    for block in p.chunks_exact(4).rev() {
        for lane in 0..4 {
            lanes[lane] = lanes[lane] * fourth + block[lane];
        }
    }
    (lanes[0] + s * lanes[1]) + square * (lanes[2] + s * lanes[3])
}

fn differentiated(p: &Polynomial) -> Polynomial {
    each(|k| if k + 1 < TERMS { (k + 1) as f64 * p[k + 1] } else { 0.0 })
}

/// A bound on `|p''''|` over `[0, to]` from the coefficients alone.
fn fourth_derivative_bound(p: &Polynomial, to: f64) -> f64 {
    const FACTORS: Polynomial = {
        let (mut factors, mut k) = ([0.0; TERMS], 0);
        while k + 4 < TERMS {
            factors[k] = ((k + 4) * (k + 3) * (k + 2) * (k + 1)) as f64;
            k += 1;
        }
        factors
    };
    let mut sizes = [0.0; TERMS];
    for k in 4..TERMS {
        sizes[k - 4] = FACTORS[k - 4] * p[k].abs();
    }
    value(&sizes, to)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(c: &[f64]) -> Polynomial {
        std::array::from_fn(|k| c.get(k).copied().unwrap_or(0.0))
    }

    #[test]
    fn exact_first_of_two_crossings_inside_a_step() {
        // (s - 0.3)(s - 0.3 - d): positive at both ends, below zero only for a moment.
        for d in [1e-1, 1e-3, 1e-6] {
            let p = polynomial(&[0.3 * (0.3 + d), -0.6 - d, 1.0]);
            let s = first_contact(&p, 1.0).expect("a crossing");
            assert!((s - 0.3).abs() < 1e-15 / d.max(1e-6) * 10.0, "{d} {s}");
        }
    }

    #[test]
    fn exact_no_contact_when_the_gap_only_nearly_closes() {
        let p = polynomial(&[0.09 + 1e-14, -0.6, 1.0]);
        assert_eq!(first_contact(&p, 1.0), None);
    }

    #[test]
    fn exact_leaving_a_wall_is_not_a_contact_but_returning_is() {
        assert_eq!(first_contact(&polynomial(&[0.0, 1.0]), 1.0), None);
        let back = first_contact(&polynomial(&[0.0, 1.0, -4.0]), 1.0).expect("returns");
        assert!((back - 0.25).abs() < 1e-15);
        assert_eq!(first_contact(&polynomial(&[0.0, -1.0, 4.0]), 1.0), Some(0.0));
        assert_eq!(first_contact(&polynomial(&[0.0, 0.0, -4.0]), 1.0), Some(0.0));
        assert_eq!(first_contact(&polynomial(&[0.0]), 1.0), None);
    }

    #[test]
    fn exact_tiny_bounces_are_found_at_their_own_scale() {
        let back = first_contact(&polynomial(&[0.0, 1e-12, -1.0]), 0.1).expect("returns");
        assert!((back / 1e-12 - 1.0).abs() < 1e-12, "{back}");
    }
}
