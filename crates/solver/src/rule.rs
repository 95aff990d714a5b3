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

mod newton;
mod quadrature;

pub use newton::Newton;

use crate::polynomial::Polynomial;
use nalgebra::DMatrix;
use quadrature::{clock, gauss, legendre, undisturbed_force};
use wide::f64x4;

/// Duration of the undisturbed collision, in units of greatest depth over touch-down speed: `(4/5) B(2/5, 1/2)`.
pub const DURATION: f64 = 2.943_275_184_324_705;

/// `Λ = κ T² √Z` of the undisturbed collision: with `Z` its greatest depth, `(5/4) DURATION²`.
const STIFFNESS: f64 = 1.25 * DURATION * DURATION;

/// Orders of the moments that are kept.
pub const MOMENTS: usize = 10;

/// A number for each of `4 M` nodes.
pub type Nodes<const M: usize> = [f64x4; M];

/// The nodes side by side, of which there are `N = 4 M`.
pub fn packed<const N: usize, const M: usize>(numbers: &[f64; N]) -> Nodes<M> {
    std::array::from_fn(|block| f64x4::new(std::array::from_fn(|lane| numbers[4 * block + lane])))
}

/// The number for node `i`.
#[inline(always)]
pub fn node<const M: usize>(nodes: &Nodes<M>, i: usize) -> f64 {
    nodes[i / 4].to_array()[i % 4]
}

/// Quadrature for forces `f(τ)` on a contact of unit duration, on `N = 4 M` nodes.
pub struct Rule<const N: usize, const M: usize> {
    /// Times of the nodes, `0 < τ < 1`.
    pub times: Nodes<M>,
    /// Clock rates `dτ/du` at the nodes.
    pub rates: Nodes<M>,
    /// Depths of the undisturbed collision at the nodes.
    pub depths: Nodes<M>,
    /// `moments[k][j]` at node `i`: what the force at node `j` adds to `∫₀^τ (τ - s)^k / k! f(s) ds` there.
    pub moments: [[Nodes<M>; N]; MOMENTS],
    /// The same at the end of the contact, `τ = 1`, for each `j`.
    pub last: [Nodes<M>; MOMENTS],
    /// Moments of the undisturbed collision's force at the nodes.
    pub undisturbed: [Nodes<M>; MOMENTS],
    /// The same at the end.
    pub undisturbed_last: [f64; MOMENTS],
    /// `running[j]` at node `i`: what the value at node `j` of a smooth `g` adds to `∫₀^u g du` there.
    pub running: [Nodes<M>; N],
    /// The same at `u = 1`, for each `j`.
    pub whole: Nodes<M>,
    /// The iteration for depths and duration.
    pub newton: Newton<N, M>,
    /// Rows that give the two highest Legendre coefficients of `c`, from the force `ζ^(3/2) c` at the nodes.
    pub tails: [Nodes<M>; 2],
}

/// An array by its components. Unlike `std::array::from_fn` it is a plain loop, which becomes vector instructions.
#[inline(always)]
pub fn each<const N: usize>(f: impl Fn(usize) -> f64) -> [f64; N] {
    let mut array = [0.0; N];
    for i in 0..N {
        array[i] = f(i);
    }
    array
}

/// The first terms of a polynomial, in whole blocks of four, at every node.
#[inline(always)]
pub fn at_nodes<const B: usize, const M: usize>(
    polynomial: &Polynomial<B>,
    terms: usize,
    times: &Nodes<M>,
) -> Nodes<M> {
    let mut sum = [f64x4::ZERO; M];
    for block in polynomial.0.iter().take(terms.div_ceil(4)).rev() {
        for coefficient in block.to_array().into_iter().rev() {
            for i in 0..M {
                sum[i] = sum[i] * times[i] + coefficient;
            }
        }
    }
    sum
}

/// `Σ_j columns[j] vector[j]`, in two chains of dependent operations.
#[inline(always)]
pub fn product<const N: usize, const M: usize>(columns: &[Nodes<M>; N], vector: &Nodes<M>) -> Nodes<M> {
    let (mut sum, mut other) = ([f64x4::ZERO; M], [f64x4::ZERO; M]);
    let mut numbers = [0.0; N];
    for (four, lanes) in numbers.as_chunks_mut().0.iter_mut().zip(vector) {
        *four = lanes.to_array();
    }
    for j in 0..N / 2 {
        for i in 0..M {
            sum[i] += columns[j][i] * numbers[j];
            other[i] += columns[N / 2 + j][i] * numbers[N / 2 + j];
        }
    }
    std::array::from_fn(|i| sum[i] + other[i])
}

/// `Σ a b`, in four chains.
#[inline(always)]
pub fn dot<const M: usize>(a: &Nodes<M>, b: &Nodes<M>) -> f64 {
    let sum = a.iter().zip(b).fold(f64x4::ZERO, |sum, (a, b)| sum + *a * *b);
    let [first, second, third, fourth] = sum.to_array();
    (first + third) + (second + fourth)
}

impl<const N: usize, const M: usize> Rule<N, M> {
    /// Computes the rule. It takes milliseconds: a program does it once.
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
        let moments_of_all = moments.each_ref().map(|moment| moment.each_ref().map(packed));
        let last_of_all = last.each_ref().map(packed);
        let undisturbed = packed(&forces);
        Self {
            times: packed(&times),
            rates: packed(&nodes.map(|u| clock(u)[1])),
            depths: packed(&depths),
            newton: Newton::new(&times, &depths, &moments, &last),
            running: running.each_ref().map(packed),
            whole: packed(&whole),
            undisturbed: moments_of_all.each_ref().map(|moment| product(moment, &undisturbed)),
            undisturbed_last: last_of_all.each_ref().map(|last| dot(last, &undisturbed)),
            tails: [N - 1, N - 2]
                .map(|k| packed::<N, M>(&std::array::from_fn(|j| coefficients[(k, j)] / forces[j]))),
            moments: moments_of_all,
            last: last_of_all,
        }
    }
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
        fn check<const N: usize, const M: usize>() {
            let rule = Rule::<N, M>::new();
            let impulse = STIFFNESS / DURATION * rule.undisturbed_last[0];
            assert!((impulse - 2.0).abs() < 1e-13, "{N}: {impulse}");
            assert!((DURATION - STIFFNESS * rule.undisturbed_last[1]).abs() < 1e-13, "{N}");
            for i in 0..N {
                let depth = DURATION * node(&rule.times, i) - STIFFNESS * node(&rule.undisturbed[1], i);
                let expected = node(&rule.depths, i);
                assert!((depth - expected).abs() < 1e-13, "{N}: {depth} {expected}");
            }
        }
        check::<8, 2>();
        check::<12, 3>();
        check::<16, 4>();
    }

    #[test]
    fn order_moments_of_a_disturbed_force() {
        // f = ζ^(3/2) / (1.2 + u): against the rule of most nodes.
        fn impulse<const N: usize, const M: usize>() -> f64 {
            let rule = Rule::<N, M>::new();
            let (nodes, _) = gauss(N, 4);
            let force: [f64; N] = std::array::from_fn(|i| node(&rule.depths, i).powf(1.5) / (1.2 + nodes[i]));
            dot(&rule.last[0], &packed(&force))
        }
        let exact = impulse::<16, 4>();
        let errors = [impulse::<4, 1>(), impulse::<8, 2>(), impulse::<12, 3>()]
            .map(|value| (value / exact - 1.0).abs());
        assert!(errors[0] < 1e-4 && errors[1] < 1e-8 && errors[2] < 1e-11, "{errors:?}");
        assert!(errors[1] < 1e-2 * errors[0], "{errors:?}");
    }
}
