//! Downward zero crossings of a polynomial, by bisection: on an interval its Bernstein coefficients change sign at least as often as
//! it has roots, and one change means exactly one root (Descartes' rule of signs; R. T. Farouki, The Bernstein polynomial basis, Comput.
//! Aided Geom. Des. 29, 2012). Bisection adds no sign changes, so of all intervals of one length at most three need another one.

/// Visits every downward zero crossing in `[0, 1]` of a polynomial given by its Bernstein coefficients, accurate to rounding relative
/// to its distance from 0, however small.
pub fn falls<const N: usize>(w: [f64; N], visit: &mut impl FnMut(f64)) {
    fall(w, [0.0, 1.0], visit);
}

/// Length of an interval, relative to its distance from 0, within which roots are not separated: a quantity whose factors have no zeros
/// inside it varies by less than rounding.
const SHORT: f64 = 4.0 * f64::EPSILON;

fn fall<const N: usize>(w: [f64; N], [a, b]: [f64; 2], visit: &mut impl FnMut(f64)) {
    let mut signs = w.into_iter().filter(|c| *c != 0.0).map(|c| c > 0.0);
    let Some(first) = signs.next() else { return };
    let (_, changes) =
        signs.fold((first, 0), |(last, changes), sign| (sign, changes + u32::from(sign != last)));
    let middle = 0.5 * (a + b);
    if changes == 1 && first {
        visit(a + (b - a) * root(&w));
    } else if changes > 1 && (b - a <= SHORT * b || b < f64::MIN_POSITIVE) {
        visit(middle);
    } else if changes > 1 {
        let (mut left, mut right) = (w, w);
        for level in 1..N {
            for i in (level..N).rev() {
                left[i] = 0.5 * (left[i - 1] + left[i]);
            }
            right[N - 1 - level] = left[N - 1]; // the last of this level of de Casteljau's triangle
        }
        if left[N - 1] == 0.0 {
            visit(middle);
        }
        fall(left, [a, middle], visit);
        fall(right, [middle, b], visit);
    }
}

/// The only root, on [0, 1], of a polynomial that is positive before it and negative after: Newton steps, bisection where they
/// leave the bracket.
fn root<const N: usize>(w: &[f64; N]) -> f64 {
    let degree = (N - 1) as f64;
    let (mut lower, mut upper) = (0.0, 1.0);
    // Near 0 the first two coefficients determine the root.
    let first = w[0] / (degree * (w[0] - w[1]));
    let mut t = if first > 0.0 && first < 0.5 { first } else { 0.5 };
    // Newton's method takes a handful of steps; bisection down to the smallest number would take a thousand.
    for _ in 0..1100 {
        let mut triangle = *w;
        for level in 1..N - 1 {
            for i in 0..N - level {
                triangle[i] += t * (triangle[i + 1] - triangle[i]);
            }
        }
        let slope = triangle[1] - triangle[0]; // the derivative over the degree
        let value = triangle[0] + t * slope;
        if value > 0.0 {
            lower = t;
        } else {
            upper = t;
        }
        let newton = t - value / (degree * slope);
        let next = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        if (next - t).abs() <= f64::EPSILON * next {
            return next;
        }
        t = next;
    }
    t
}

/// The product of two polynomials by their coefficients of `(1-s)^(n-i) s^i`; `C = A + B - 1`.
#[inline(always)]
pub fn product<const A: usize, const B: usize, const C: usize>(a: &[f64; A], b: &[f64; B]) -> [f64; C] {
    const { assert!(C + 1 == A + B) };
    let mut product = [0.0; C];
    for i in 0..A {
        for j in 0..B {
            product[i + j] += a[i] * b[j];
        }
    }
    product
}

/// The sum of two polynomials of one degree.
#[inline(always)]
pub fn sum<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// A polynomial times a number.
#[inline(always)]
pub fn times<const N: usize>(a: &[f64; N], factor: f64) -> [f64; N] {
    a.map(|c| c * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein coefficients of `Π (r - s)` over six roots.
    fn with_roots(roots: [f64; 6]) -> [f64; 7] {
        let mut w = vec![1.0];
        for r in roots {
            let wider = |i: usize| {
                r * w.get(i).copied().unwrap_or(0.0) + (r - 1.0) * if i > 0 { w[i - 1] } else { 0.0 }
            };
            w = (0..=w.len()).map(wider).collect();
        }
        let choose = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
        std::array::from_fn(|i| w[i] / choose[i])
    }

    #[test]
    fn exact_falls_are_every_other_root_and_nothing_else() {
        for roots in [
            [0.1, 0.23, 0.31, 0.47, 0.66, 0.9],
            [1e-6, 0.2, 0.51, 0.53, 0.77, 1.5],
            [-0.4, -0.1, 0.3, 2.0, 2.5, 4.0],
        ] {
            let mut found = Vec::new();
            falls(with_roots(roots), &mut |s| found.push(s));
            let expected: Vec<f64> =
                roots.into_iter().step_by(2).filter(|r| (0.0..=1.0).contains(r)).collect();
            assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
            }
        }
    }
}
