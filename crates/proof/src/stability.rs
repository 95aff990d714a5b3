//! The stability of a motion: bounds on its multipliers, the eigenvalues of the product of all segments' derivatives.

use crate::number::{Block, FREE, matrix, times};
use crate::segment::Passage;
use crate::{Failure, Interval, Multiplier, Taylor};
use nalgebra::{Complex, Matrix4, SMatrix};
use serde::Serialize;
use std::array;

/// Bounds to try, as shares of the way from the largest computed multiplier to 1.
const SHARP: [f64; 7] = [1e-6, 1e-4, 1e-2, 0.1, 0.5, 0.8, 0.95];

/// Least size of a multiplier for scaling.
const LEAST: f64 = 1e-6;

/// Maximum depth of bisection of a family's range.
const DEPTH: u32 = 6;

/// The proven statement on the multipliers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    /// All are smaller in size than this, which is at most 1.
    Stable(f64),
    /// One is larger in size than 1; the largest, as computed.
    Unstable(Multiplier),
    /// Neither is proven.
    Open(Multiplier),
}

impl Stability {
    /// The bound on all multipliers.
    ///
    /// # Errors
    /// It is not proven to be stable.
    pub fn stable(self) -> Result<f64, Failure> {
        match self {
            Self::Stable(bound) => Ok(bound),
            Self::Unstable(largest) | Self::Open(largest) => Err(Failure::NotStable(largest)),
        }
    }
}

/// Whether a motion, or each of a family, is stable, from its segments.
pub fn stability(passages: &[Passage]) -> Stability {
    let segments: Vec<Block> = passages.iter().map(|passage| passage.by).collect();
    let is_constant = segments.iter().flatten().flatten().all(|x| x.is_constant());
    stability_over(&segments, [0.0, 1.0], if is_constant { 0 } else { DEPTH })
}

/// The stability of the part of a family from `middle - half` to `middle + half`.
fn stability_over(segments: &[Block], [middle, half]: [f64; 2], depth: u32) -> Stability {
    let part = |m: &Block| m.map(|row| row.map(|x| x.part([middle, half])));
    let whole = stability_of(&segments.iter().map(part).collect::<Vec<_>>());
    if !matches!(whole, Stability::Open(_)) || depth == 0 {
        return whole;
    }
    let quarter = 0.5 * half;
    let parts =
        [middle - quarter, middle + quarter].map(|m| stability_over(segments, [m, quarter], depth - 1));
    match parts {
        [Stability::Stable(a), Stability::Stable(b)] => Stability::Stable(a.max(b)),
        [Stability::Unstable(largest), Stability::Unstable(_)] => Stability::Unstable(largest),
        _ => whole,
    }
}

/// Whether all multipliers are below 1 for all matrices in the enclosures, or one is above 1 for each of them.
fn stability_of(segments: &[Block]) -> Stability {
    let product = segments.iter().fold(Matrix4::identity(), |product, m| middle(m) * product);
    let larger = |most: Complex<f64>, x: &Complex<f64>| if x.norm() > most.norm() { *x } else { most };
    let Complex { re, im } = product.complex_eigenvalues().iter().fold(Complex::default(), larger);
    let widths = segments.iter().flatten().flatten().map(|x| x.hull().width());
    let computed = Multiplier { re, im: im.abs(), derivatives: widths.fold(0.0, f64::max) };
    let largest = Complex { re, im }.norm();
    // The bound on the multipliers is the product of equal shares, one for each segment.
    let share = |x: f64| x.max(LEAST).powf(1.0 / segments.len() as f64);
    if largest > 1.0 {
        let above = share(largest.sqrt()).max(1.0);
        let is_unstable = are_below(segments, above, above) == Some(false);
        return if is_unstable { Stability::Unstable(computed) } else { Stability::Open(computed) };
    }
    // The forms decrease most if scaled half-way between the multipliers and the bound.
    let is_stable =
        |bound: f64| are_below(segments, share(bound), share((largest * bound).sqrt())) == Some(true);
    let power = |bound: f64| {
        segments.iter().fold(Interval::ONE, |power, _| power * Interval::point(share(bound))).hi()
    };
    // The root of 1 must be 1; checked, so that no library is relied on.
    if power(1.0) > 1.0 || !is_stable(1.0) {
        return Stability::Open(computed);
    }
    let tried = SHARP.iter().map(|to_one| largest + to_one * (1.0 - largest));
    let found = tried.filter(|bound| is_stable(*bound)).map(power).find(|bound| *bound < 1.0);
    Stability::Stable(found.unwrap_or(1.0))
}

fn middle(of: &Block) -> Matrix4<f64> {
    Matrix4::from_fn(|i, j| of[i][j].mid())
}

fn points(of: &Matrix4<f64>) -> Block {
    matrix(|i, j| Taylor::point(of[(i, j)]))
}

/// Whether all multipliers of the product of the matrices, each divided by `bound`, are proven below 1 (true), or one above (false); none
/// if neither is. The forms used are those of the matrices divided by `between`.
///
/// Let symmetric `V₀, …, Vₘ = V₀` have positive definite `Vₖ - Nₖᵀ Vₖ₊₁ Nₖ`. Then `V₀ - Nᵀ V₀ N` is positive definite for the product `N` too, so `xᵀ V₀ x`
/// decreases along `x, N x, N² x, …`, and no multiplier has the size 1, as `v* V₀ v` would not decrease for its eigenvector. If `V₀` is
/// positive definite itself, all are below 1 (P. Stein, 1952). If `xᵀ V₀ x` is negative for some `x`, it stays so and keeps decreasing:
/// `Nᵏ x` does not tend to zero, and one is above 1.
fn are_below(segments: &[Block], bound: f64, between: f64) -> Option<bool> {
    let over = Taylor::from(Interval::ONE / Interval::point(bound));
    let scaled: Vec<Block> = segments.iter().map(|m| m.map(|row| row.map(|x| x * over))).collect();
    // Any symmetric matrices that pass the test will do.
    let forms = forms(&segments.iter().map(|m| middle(m) / between).collect::<Vec<_>>())?;
    if are_falling(&scaled, &forms) { is_positive(&forms[0]) } else { None }
}

/// The symmetric matrices `Vₖ` with `Vₖ - Nₖᵀ Vₖ₊₁ Nₖ = 1`, in doubles.
fn forms(middles: &[Matrix4<f64>]) -> Option<Vec<Matrix4<f64>>> {
    let before =
        |k: usize, v: &Matrix4<f64>| symmetric(Matrix4::identity() + middles[k].transpose() * v * middles[k]);
    let segments = 0..middles.len();
    let product = middles.iter().fold(Matrix4::identity(), |product, n| n * product);
    let right = segments.clone().rev().fold(Matrix4::zeros(), |v, k| before(k, &v));
    let equations = SMatrix::<f64, 16, 16>::identity() - product.transpose().kronecker(&product.transpose());
    let solution = equations.lu().solve(&SMatrix::<f64, 16, 1>::from_column_slice(right.as_slice()))?;
    let first = symmetric(Matrix4::from_column_slice(solution.as_slice()));
    let mut all = vec![first; middles.len()];
    for k in segments.skip(1).rev() {
        all[k] = before(k, &all[(k + 1) % middles.len()]);
    }
    Some(all)
}

fn symmetric(a: Matrix4<f64>) -> Matrix4<f64> {
    (a + a.transpose()) * 0.5
}

/// Whether all `Vₖ - Nₖᵀ Vₖ₊₁ Nₖ` are proven positive definite. Tested as `Cᵀ (…) C`, near the identity for a suitable `C`: if this is
/// positive definite, `C` is regular, since `Cᵀ (…) C` vanishes on its kernel.
fn are_falling(scaled: &[Block], forms: &[Matrix4<f64>]) -> bool {
    scaled.iter().enumerate().all(|(k, n)| {
        let (v, next) = (&forms[k], &forms[(k + 1) % forms.len()]);
        let falls = v - middle(n).transpose() * next * middle(n);
        let root = symmetric(falls).cholesky().and_then(|root| root.l().transpose().try_inverse());
        root.map(|c| points(&c)).is_some_and(|c| {
            let (before, after) = (congruent(&points(v), &c), congruent(&points(next), &times(n, &c)));
            is_positive_definite(&matrix(|i, j| before[i][j] - after[i][j]))
        })
    })
}

/// The congruence transform `Cᵀ V C` of a form.
fn congruent(form: &Block, c: &Block) -> Block {
    times(&times(&matrix(|i, j| c[j][i]), form), c)
}

/// Whether a symmetric matrix is proven positive definite (true), or negative in some direction (false); none if neither.
fn is_positive(form: &Matrix4<f64>) -> Option<bool> {
    let v = points(form);
    if is_positive_definite(&v) {
        return Some(true);
    }
    let axes = form.symmetric_eigen();
    let lowest = axes.eigenvectors.column(axes.eigenvalues.imin());
    let x: [Interval; FREE] = array::from_fn(|i| Interval::point(lowest[i]));
    let terms = (0..FREE).flat_map(|i| (0..FREE).map(move |j| x[i] * v[i][j].hull() * x[j]));
    terms.fold(Interval::ZERO, |sum, term| sum + term).is_negative().then_some(false)
}

/// Whether all symmetric matrices in an enclosure are positive definite: all pivots of Gaussian elimination are positive.
fn is_positive_definite(matrix: &Block) -> bool {
    let mut a = matrix.map(|row| row.map(Taylor::hull));
    for k in 0..FREE {
        if !a[k][k].is_positive() {
            return false;
        }
        for i in k + 1..FREE {
            for j in k + 1..FREE {
                a[i][j] = a[i][j] - a[i][k] * a[k][j] / a[k][k];
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block-triangular matrix with the eigenvalues `a`, `b` and `r e^{±iα}`, in other coordinates.
    fn with(a: f64, b: f64, r: f64, angle: f64) -> Block {
        let (c, s) = (r * angle.cos(), r * angle.sin());
        let m = [[a, 3.0, 0.0, 7.0], [0.0, b, 5.0, 0.0], [0.0, 0.0, c, -s], [0.0, 0.0, s, c]];
        let m: Block = m.map(|row| row.map(Taylor::point));
        let mut shear: Block =
            array::from_fn(|i| array::from_fn(|j| Taylor::point(if i == j { 1.0 } else { 0.0 })));
        (shear[3][0], shear[2][1]) = (Taylor::point(2.0), Taylor::point(-1.0));
        let mut back = shear;
        (back[3][0], back[2][1]) = (Taylor::point(-2.0), Taylor::point(1.0));
        times(&times(&shear, &m), &back)
    }

    #[test]
    fn exact_the_bound_is_just_above_the_largest_multiplier() {
        for (matrix, largest) in [(with(0.5, -0.3, 0.2, 1.0), 0.5), (with(0.1, -0.9, 0.99, 2.0), 0.99)] {
            let Stability::Stable(bound) = stability_of(&[matrix]) else { panic!("not stable") };
            assert!(bound >= largest && bound < 1.03 * largest, "{bound} {largest}");
        }
    }

    #[test]
    fn exact_what_is_unstable_is_not_called_stable() {
        for matrix in [with(1.01, 0.5, 0.5, 1.0), with(0.2, -1.5, 0.5, 1.0), with(0.3, 0.1, 1.001, 1.0)] {
            assert!(matches!(stability_of(&[matrix]), Stability::Unstable(_)));
        }
        for matrix in [with(1.0, 0.5, 0.5, 1.0), with(0.2, -1.0, 0.5, 1.0), with(0.3, 0.1, 1.0, 1.0)] {
            let wide = matrix.map(|row| row.map(|x| Taylor::from(x.hull().wider(1e-9))));
            let Stability::Open(largest) = stability_of(&[wide]) else { panic!("decided") };
            assert!((largest.re.hypot(largest.im) - 1.0).abs() < 1e-9, "{largest}");
            assert!((2e-9..2.1e-9).contains(&largest.derivatives), "{largest}");
        }
    }

    /// Two matrices that are each unstable with a stable product, and the reverse.
    #[test]
    fn exact_of_several_segments_the_product_counts() {
        let diagonal = |d: [f64; 4]| -> Block {
            array::from_fn(|i| array::from_fn(|j| Taylor::point(if i == j { d[i] } else { 0.0 })))
        };
        let pair = [diagonal([4.0, 0.1, 0.2, 0.3]), diagonal([0.125, 5.0, 0.2, 0.3])];
        let Stability::Stable(bound) = stability_of(&pair) else { panic!("not stable") };
        assert!((0.5..0.51).contains(&bound), "{bound}");
        let pair = [diagonal([4.0, 0.1, 0.2, 0.3]), diagonal([0.26, 5.0, 0.2, 0.3])];
        assert!(matches!(stability_of(&pair), Stability::Unstable(_)));
    }

    /// A multiplier that changes along a family, from 0.5 to 0.9 and to 1.1.
    #[test]
    fn exact_all_of_a_family_are_stable_or_not() {
        for (middle, half, stable) in [(0.7, 0.2, true), (0.7, 0.4, false)] {
            let mut family = with(0.1, 0.2, 0.3, 1.0).map(|row| row.map(|_| Taylor::ZERO));
            (0..FREE).for_each(|i| family[i][i] = Taylor::point(0.1));
            (family[0][0], family[0][1]) = (Taylor::line(middle, half), Taylor::point(3.0));
            match stability_over(&[family], [0.0, 1.0], DEPTH) {
                Stability::Stable(bound) => assert!(stable && (0.9..1.0).contains(&bound), "{bound}"),
                other => assert!(!stable && matches!(other, Stability::Open(_)), "{other:?}"),
            }
        }
    }
}
