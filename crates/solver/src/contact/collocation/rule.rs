//! Quadrature for contact forces that are close to those of the undisturbed Hertz collision (see `undisturbed`).
//!
//! Real contacts differ from it by a few percent, so their force is `ζ^(3/2) c`, with `c` nearly constant, and [`Rule`] integrates
//! such forces on few nodes: exactly if `c` is a polynomial in the clock `u`, `τ = u² (3 - 2u)`.
//!
//! That clock makes the force analytic at both ends, where it goes like `τ^(3/2) ~ u³`, and moves its singularities (of the
//! undisturbed collision: `τ = 1/2 ± 1.539 i`) farther from the contact than any other cubic can: an interpolant on `n` nodes
//! converges like `2.95^-n`. With the impulse `∫ F dτ`, whose weight is `u⁴ (1 - u)⁴`, in mind, the nodes are Gauss's for
//! that weight.

use super::nodes::{Nodes, dot, packed, product};
use super::quadrature::{gauss, legendre};
use crate::motion::linearised::MOMENTS;
use nalgebra::DMatrix;

/// The error of the end of a contact over `tail^1.25`, for each rule, where the tail of its force's expansion is the root of the
/// sum of squares of the two highest coefficients. Calibrated on contacts drawn at random; the test
/// `reference_contacts_at_once_agree_with_contacts_step_by_step` checks the resulting errors.
pub const TAIL: [f64; 3] = [1.8e-3, 3.5e-4, 2.9e-4];

/// Quadrature for forces `f(τ)` on a contact of unit duration, on `N = 4 M` nodes.
#[repr(C, align(64))]
pub struct Rule<const N: usize, const M: usize> {
    /// `moments[k][j]` at node `i`: the contribution of the force at node `j` to `∫₀^τ (τ - s)^k / k! f(s) ds` there.
    pub moments: [[Nodes<M>; N]; MOMENTS],
    /// Times of the nodes, `0 < τ < 1`.
    pub times: Nodes<M>,
    /// Clock rates `dτ/du` at the nodes.
    pub rates: Nodes<M>,
    /// Depths of the undisturbed collision at the nodes.
    pub depths: Nodes<M>,
    /// The moments at the end of the contact, `τ = 1`, for each `j`.
    pub last: [Nodes<M>; MOMENTS],
    /// Moments of the undisturbed collision's force at the nodes.
    pub undisturbed: [Nodes<M>; MOMENTS],
    /// Moments of the undisturbed collision's force at the end.
    pub undisturbed_last: [f64; MOMENTS],
    /// `running[j]` at node `i`: the contribution of the value at node `j` of a smooth `g` to `∫₀^u g du` there.
    pub running: [Nodes<M>; N],
    /// That integral at `u = 1`, for each `j`.
    pub whole: Nodes<M>,
    /// Rows that give the two highest Legendre coefficients of `c`, from the force `ζ^(3/2) c` at the nodes.
    pub tails: [Nodes<M>; 2],
}

impl<const N: usize, const M: usize> Rule<N, M> {
    /// Computes the rule for a collision with this force and these depths over the clock, with its integrals. It takes milliseconds: a
    /// program does it once for each law.
    pub fn new(
        clock: impl Fn(f64) -> [f64; 2],
        force: impl Fn(f64) -> f64,
        depth: impl Fn(f64) -> f64,
    ) -> (Self, Integrals<N>) {
        let (nodes, _) = gauss(N, 4);
        let nodes: [f64; N] = std::array::from_fn(|i| nodes[i]);
        let forces = nodes.map(&force);
        let depths = nodes.map(depth);
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
        let rule = Self {
            times: packed(&times),
            rates: packed(&nodes.map(|u| clock(u)[1])),
            depths: packed(&depths),
            running: running.each_ref().map(packed),
            whole: packed(&whole),
            undisturbed: moments_of_all.each_ref().map(|moment| product(moment, &undisturbed)),
            undisturbed_last: last_of_all.each_ref().map(|last| dot(last, &undisturbed)),
            tails: [N - 1, N - 2]
                .map(|k| packed::<N, M>(&std::array::from_fn(|j| coefficients[(k, j)] / forces[j]))),
            moments: moments_of_all,
            last: last_of_all,
        };
        (rule, Integrals { times, depths, forces, moments, last })
    }
}

/// The entries of a rule as single numbers.
pub struct Integrals<const N: usize> {
    pub times: [f64; N],
    pub depths: [f64; N],
    pub forces: [f64; N],
    /// As those of the rule.
    pub moments: [[[f64; N]; N]; MOMENTS],
    pub last: [[f64; N]; MOMENTS],
}

impl<const N: usize> Integrals<N> {
    /// The contribution of node `j` to moment `k` at node `i`, or at the end for `i = N`.
    pub fn moment(&self, k: usize, i: usize, j: usize) -> f64 {
        if i < N { self.moments[k][j][i] } else { self.last[k][j] }
    }

    /// Moment `k` of the undisturbed collision's force there.
    pub fn whole(&self, k: usize, i: usize) -> f64 {
        (0..N).map(|j| self.moment(k, i, j) * self.forces[j]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::nodes::node;
    use super::super::undisturbed::{DURATION, clock, undisturbed_force};
    use super::*;

    /// `Λ = κ T² √Z` of the undisturbed collision with the greatest depth Z.
    const STIFFNESS: f64 = 1.25 * DURATION * DURATION;

    fn rule<const N: usize, const M: usize>() -> Rule<N, M> {
        let force = undisturbed_force();
        Rule::new(clock, &force, |u| force(u).powf(2.0 / 3.0)).0
    }

    #[test]
    fn exact_moments_of_the_undisturbed_collision() {
        // It leaves as fast as it came, so the impulse is 2 and ζ(1) = 0: DURATION - Λ ∬ ζ^(3/2) = 0.
        fn check<const N: usize, const M: usize>() {
            let rule = rule::<N, M>();
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
            let rule = rule::<N, M>();
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
