//! The undisturbed Hertz collision, and quadrature made for forces that are nearly its own.
//!
//! Two bodies that meet at speed `w` and feel nothing but Hertz's force obey `z'' = -κ z^(3/2)`. In units of the greatest depth
//! `Z = (5 w² / 4κ)^(2/5)` and the duration `T = 2.943 Z/w` every such collision is the same, `ζ'' = -Λ ζ^(3/2)` with
//! `ζ(0) = ζ(1) = 0`. Real contacts differ from it by percents, so their force is `ζ^(3/2) c`, with `c` nearly constant, and
//! [`Rule`] integrates such forces on few nodes: exactly if `c` is a polynomial in the clock `u`, `τ = u² (3 - 2u)`.
//!
//! That clock makes the force analytic at both ends, where it goes like `τ^(3/2) ~ u³`, and moves its singularities (of the
//! undisturbed collision: `τ = 1/2 ± 1.539 i`) farther from the contact than any other cubic can: an interpolant on `n` nodes
//! converges like `2.95^-n`. With the impulse `∫ F dτ`, whose weight is `u⁴ (1 - u)⁴`, in mind, the nodes are Gauss's for
//! that weight.

use crate::dop853;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Duration of the undisturbed collision, in units of greatest depth over touch-down speed: `(4/5) B(2/5, 1/2)`.
pub const DURATION: f64 = 2.943_275_184_324_705;

/// `Λ = κ T² √Z` of the undisturbed collision: with `Z` its greatest depth, `(5/4) DURATION²`.
const STIFFNESS: f64 = 1.25 * DURATION * DURATION;

/// Orders of the moments that are kept.
pub const MOMENTS: usize = 10;

/// Nodes and weights for forces `f(τ)` on a contact of unit duration. Rows that belong to nodes run fastest.
pub struct Rule<const N: usize> {
    /// Times of the nodes, `0 < τ < 1`.
    pub times: [f64; N],
    /// Clock rates `dτ/du` at the nodes.
    pub rates: [f64; N],
    /// Depths of the undisturbed collision at the nodes.
    pub depths: [f64; N],
    /// `moments[k][j][i]`: what the force at node `j` adds to `∫₀^τ (τ - s)^k / k! f(s) ds` at node `i`.
    pub moments: [[[f64; N]; N]; MOMENTS],
    /// The same at the end of the contact, `τ = 1`.
    pub last: [[f64; N]; MOMENTS],
    /// Moments of the undisturbed collision's force at the nodes.
    pub undisturbed: [[f64; N]; MOMENTS],
    /// The same at the end.
    pub undisturbed_last: [f64; MOMENTS],
    /// `∫₀^u g du` at node `i`, from the values at node `j` of a smooth `g`.
    pub running: [[f64; N]; N],
    /// The same at `u = 1`.
    pub whole: [f64; N],
    /// Inverse Jacobian, at the undisturbed collision, of the residuals (at the nodes, then at the end) with respect to the
    /// depths at the nodes and the duration in units of that collision's.
    pub inverse: Bordered<N>,
    /// Rows that give the two highest Legendre coefficients of `c`, from the force `ζ^(3/2) c` at the nodes.
    pub tails: [[f64; N]; 2],
}

/// A matrix of `N + 1` rows and columns: `body[j][i]`, the last column `column[i]`, the last row `row[j]`, and the corner.
pub struct Bordered<const N: usize> {
    body: [[f64; N]; N],
    column: [f64; N],
    row: [f64; N],
    corner: f64,
}

impl<const N: usize> Bordered<N> {
    /// The product with a vector and its last component.
    #[inline(always)]
    pub fn times(&self, vector: &[f64; N], last: f64) -> ([f64; N], f64) {
        let body = product(&self.body, vector);
        let column = self.column.map(|c| c * last);
        (std::array::from_fn(|i| body[i] + column[i]), dot(&self.row, vector) + self.corner * last)
    }
}

/// `Σ_j columns[j] vector[j]`, in two chains of dependent operations.
#[inline(always)]
pub fn product<const N: usize>(columns: &[[f64; N]; N], vector: &[f64; N]) -> [f64; N] {
    let mut sums = [[0.0; N]; 2];
    for j in (0..N).step_by(2) {
        for i in 0..N {
            sums[0][i] += columns[j][i] * vector[j];
            sums[1][i] += columns[j + 1][i] * vector[j + 1];
        }
    }
    std::array::from_fn(|i| sums[0][i] + sums[1][i])
}

/// `Σ a b`, in four chains.
#[inline(always)]
pub fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut lanes = [0.0; 4];
    for i in (0..N).step_by(4) {
        for lane in 0..4 {
            lanes[lane] += a[i + lane] * b[i + lane];
        }
    }
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
}

/// `τ` and `dτ/du` of the clock.
fn clock(u: f64) -> [f64; 2] {
    [u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)]
}

impl<const N: usize> Rule<N> {
    /// Computes the rule, for `N` a multiple of 4. It takes milliseconds: a program does it once.
    pub fn new() -> Self {
        let force = undisturbed_force();
        let (nodes, _) = gauss(N, 4);
        let nodes: [f64; N] = std::array::from_fn(|i| nodes[i]);
        let forces = nodes.map(&force);
        let depths = forces.map(|f| f.powf(2.0 / 3.0));
        let times = nodes.map(|u| clock(u)[0]);
        let cardinal = |j: usize, u: f64| {
            let factor = |i: usize| if i == j { 1.0 } else { (u - nodes[i]) / (nodes[j] - nodes[i]) };
            (0..N).map(factor).product::<f64>()
        };
        // Integrals from 0 to each node and to 1 by Gauss's rule on 40 nodes, all at once for each abscissa.
        let (abscissae, weights) = gauss(40, 0);
        let (mut moments, mut last) = ([[[0.0; N]; N]; MOMENTS], [[0.0; N]; MOMENTS]);
        let (mut running, mut whole) = ([[0.0; N]; N], [0.0; N]);
        for i in 0..=N {
            let end = if i < N { nodes[i] } else { 1.0 };
            for (x, weight) in abscissae.iter().zip(&weights) {
                let (u, du) = (end * x, end * weight);
                let [time, rate] = clock(u);
                let (lag, shape) = (clock(end)[0] - time, force(u) * rate * du);
                for j in 0..N {
                    let cardinal = cardinal(j, u);
                    *(if i < N { &mut running[j][i] } else { &mut whole[j] }) += cardinal * du;
                    let mut term = shape / forces[j] * cardinal;
                    for k in 0..MOMENTS {
                        *(if i < N { &mut moments[k][j][i] } else { &mut last[k][j] }) += term;
                        term *= lag / (k + 1) as f64;
                    }
                }
            }
        }
        let legendre = DMatrix::from_fn(N, N, |i, k| legendre(k, 2.0 * nodes[i] - 1.0));
        let coefficients = legendre.try_inverse().expect("distinct nodes determine a polynomial");
        Self {
            times,
            rates: nodes.map(|u| clock(u)[1]),
            depths,
            inverse: inverse_jacobian(&times, &depths, &moments[1], &last[1]),
            running,
            whole,
            undisturbed: moments.each_ref().map(|moment| product(moment, &forces)),
            undisturbed_last: last.each_ref().map(|last| dot(last, &forces)),
            tails: [N - 1, N - 2].map(|k| std::array::from_fn(|j| coefficients[(k, j)] / forces[j])),
            moments,
            last,
        }
    }
}

/// Of the residual `ζ - DURATION σ τ + Λ σ² ∬ ζ^(3/2)` with respect to `ζ` at the nodes and `σ`, where `σ = 1`.
fn inverse_jacobian<const N: usize>(
    times: &[f64; N],
    depths: &[f64; N],
    twice: &[[f64; N]; N],
    twice_last: &[f64; N],
) -> Bordered<N> {
    let weight = |i: usize, j: usize| if i < N { twice[j][i] } else { twice_last[j] };
    let time = |i: usize| if i < N { times[i] } else { 1.0 };
    let jacobian = DMatrix::from_fn(N + 1, N + 1, |i, j| {
        if j < N {
            f64::from(i == j) + STIFFNESS * weight(i, j) * 1.5 * depths[j].sqrt()
        } else {
            let force = (0..N).map(|j| weight(i, j) * depths[j].powf(1.5)).sum::<f64>();
            2.0 * STIFFNESS * force - DURATION * time(i)
        }
    });
    let inverse = jacobian.try_inverse().expect("the undisturbed collision is an isolated solution");
    Bordered {
        body: std::array::from_fn(|j| std::array::from_fn(|i| inverse[(i, j)])),
        column: std::array::from_fn(|i| inverse[(i, N)]),
        row: std::array::from_fn(|j| inverse[(N, j)]),
        corner: inverse[(N, N)],
    }
}

/// The force `ζ^(3/2)` of the undisturbed collision as a function of the clock, to rounding: `u³ (1 - u)³` times a polynomial
/// that meets it on 40 nodes.
fn undisturbed_force() -> impl Fn(f64) -> f64 {
    const NODES: usize = 40;
    let ends = |u: f64| (u * (1.0 - u)).powi(3);
    let (nodes, _) = gauss(NODES, 0);
    // In units of Z and Z/w the regularised collision is q' = w/2, w' = -(5/4) q⁴, t' = q (see `retune_model::Compression`).
    let slope = |&[q, w, _]: &[f64; 3]| [0.5 * w, -1.25 * q.powi(4), q];
    let advance = |y: &[f64; 3], h: f64| dop853::step(slope, y, &slope(y), h).y;
    let mut y = [0.0, 1.0, 0.0];
    // It is the same backwards: what leaves is the mirror image of what came.
    let mut values: Vec<f64> = nodes[..NODES / 2]
        .iter()
        .map(|&u| {
            let time = DURATION * clock(u)[0];
            // Newton's iteration for the end of the last of some short steps; time grows at the rate q.
            while time - y[2] > 0.05 * y[0].max(0.05) {
                y = advance(&y, 0.04);
            }
            let mut h = 0.0;
            let mut at = y;
            for _ in 0..50 {
                let correction = (time - at[2]) / at[0].max(1e-3);
                h += correction;
                at = advance(&y, h);
                if correction.abs() < 1e-16 {
                    break;
                }
            }
            y = at;
            y[0].powi(3) / ends(u)
        })
        .collect();
    values.extend(values.clone().into_iter().rev());
    let weights: Vec<f64> = (0..NODES)
        .map(|j| (0..NODES).filter(|&i| i != j).map(|i| 0.25 / (nodes[j] - nodes[i])).product())
        .collect();
    move |u| {
        let (mut above, mut below) = (0.0, 0.0);
        for ((node, weight), value) in nodes.iter().zip(&weights).zip(&values) {
            if u == *node {
                return ends(u) * value;
            }
            above += weight / (u - node) * value;
            below += weight / (u - node);
        }
        ends(u) * above / below
    }
}

/// Gauss's rule for the weight `(4u (1 - u))^power` on `[0, 1]` (weights for `power` 0 only), by the eigenvalues of the
/// recurrence of Gegenbauer's polynomials (G. H. Golub & J. H. Welsch, Mathematics of Computation 23, 1969).
fn gauss(count: usize, power: u32) -> (Vec<f64>, Vec<f64>) {
    let beta = |n: f64| {
        let a = f64::from(power);
        (n * (n + 2.0 * a) / ((2.0 * n + 2.0 * a - 1.0) * (2.0 * n + 2.0 * a + 1.0))).sqrt()
    };
    let recurrence =
        DMatrix::from_fn(count, count, |i, j| if i.abs_diff(j) == 1 { beta(i.max(j) as f64) } else { 0.0 });
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(recurrence);
    let first: DVector<f64> = eigenvectors.row(0).transpose();
    let mut rule: Vec<_> =
        eigenvalues.iter().zip(first.iter()).map(|(x, v)| (0.5 * (1.0 + x), v * v)).collect();
    rule.sort_by(|a, b| a.0.total_cmp(&b.0));
    rule.into_iter().unzip()
}

/// Legendre's polynomial of a degree.
fn legendre(degree: usize, x: f64) -> f64 {
    let (mut before, mut now) = (0.0, 1.0);
    for n in 0..degree {
        let n = n as f64;
        (before, now) = (now, ((2.0 * n + 1.0) * x * now - n * before) / (n + 1.0));
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_undisturbed_collision() {
        // (4/5) B(2/5, 1/2) by Γ(2/5), Γ(1/2), Γ(9/10)
        let beta = 2.218_159_543_757_688 * std::f64::consts::PI.sqrt() / 1.068_628_702_119_319;
        assert!((0.8 * beta / DURATION - 1.0).abs() < 1e-14, "{}", 0.8 * beta);
        let force = undisturbed_force();
        // At the deepest point ζ = 1; half-way in time back to it the energy law 1 - ζ^(5/2) = (dζ/dt)² holds.
        assert!((force(0.5) - 1.0).abs() < 1e-14, "{}", force(0.5));
        for u in [0.05, 0.2, 0.35] {
            let depth = |u: f64| force(u).powf(2.0 / 3.0);
            let h = 1e-4;
            let slope = (depth(u - 2.0 * h) - 8.0 * depth(u - h) + 8.0 * depth(u + h) - depth(u + 2.0 * h))
                / (12.0 * h);
            let speed = slope / (DURATION * clock(u)[1]);
            assert!((speed * speed + depth(u).powf(2.5) - 1.0).abs() < 1e-10, "{u}");
        }
    }

    #[test]
    fn exact_moments_of_the_undisturbed_collision() {
        // It leaves as fast as it came, so the impulse is 2 and ζ(1) = 0: DURATION - Λ ∬ ζ^(3/2) = 0.
        fn check<const N: usize>() {
            let rule = Rule::<N>::new();
            let impulse = STIFFNESS / DURATION * rule.undisturbed_last[0];
            assert!((impulse - 2.0).abs() < 1e-13, "{N}: {impulse}");
            assert!((DURATION - STIFFNESS * rule.undisturbed_last[1]).abs() < 1e-13, "{N}");
            for i in 0..N {
                let depth = DURATION * rule.times[i] - STIFFNESS * rule.undisturbed[1][i];
                assert!((depth - rule.depths[i]).abs() < 1e-13, "{N}: {depth} {}", rule.depths[i]);
            }
        }
        check::<8>();
        check::<12>();
        check::<16>();
    }

    #[test]
    fn order_moments_of_a_disturbed_force() {
        // f = ζ^(3/2) / (1.2 + u): against the rule of most nodes.
        fn impulse<const N: usize>() -> f64 {
            let rule = Rule::<N>::new();
            let (nodes, _) = gauss(N, 4);
            let force: [f64; N] = std::array::from_fn(|i| rule.depths[i].powf(1.5) / (1.2 + nodes[i]));
            dot(&rule.last[0], &force)
        }
        let exact = impulse::<16>();
        let errors =
            [impulse::<4>(), impulse::<8>(), impulse::<12>()].map(|value| (value / exact - 1.0).abs());
        assert!(errors[0] < 1e-4 && errors[1] < 1e-8 && errors[2] < 1e-11, "{errors:?}");
        assert!(errors[1] < 1e-2 * errors[0], "{errors:?}");
    }
}
