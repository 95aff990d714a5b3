//! Bogacki & Shampine 3(2) (P. Bogacki & L. F. Shampine, Appl. Math. Lett. 2, 1989), with the step control and the cubic
//! Hermite output of L. F. Shampine & M. W. Reichelt, The MATLAB ODE Suite (SIAM J. Sci. Comput. 18, 1997).
//!
//! Order 3, four stages, first same as last.

use super::step::{Attempt, OneStep, hermite};
use crate::system::System;

/// The method.
pub struct Ode23;

/// Nodes.
pub const C: [f64; 4] = [0.0, 1.0 / 2.0, 3.0 / 4.0, 1.0];

/// Runge–Kutta matrix; its last row is the solution of order 3.
pub const A: [[f64; 3]; 4] =
    [[0.0; 3], [1.0 / 2.0, 0.0, 0.0], [0.0, 3.0 / 4.0, 0.0], [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0]];

/// Difference of the solutions of order 3 and 2.
pub const E: [f64; 4] = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];

impl<const N: usize> OneStep<N> for Ode23 {
    const POWER: f64 = 1.0 / 3.0;
    const EVALUATIONS: u64 = 3;

    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], f: &[f64; N], h: f64) -> Option<Attempt<N>> {
        let mut k = [*f; 4];
        let mut end = *y;
        for stage in 1..4 {
            end = std::array::from_fn(|i| y[i] + h * (0..stage).map(|j| A[stage][j] * k[j][i]).sum::<f64>());
            k[stage] = system.derivative(t + C[stage] * h, &end);
        }
        Some(Attempt {
            y: end,
            slope: k[3],
            error: std::array::from_fn(|i| h * (0..4).map(|s| E[s] * k[s][i]).sum::<f64>()),
            dense: hermite(h, (y, f), (&end, &k[3])),
        })
    }
}
