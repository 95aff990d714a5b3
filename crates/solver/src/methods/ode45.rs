//! Dormand & Prince 5(4) (J. R. Dormand & P. J. Prince, J. Comput. Appl. Math. 6, 1980), with the step control and the
//! fourth-order dense output of L. F. Shampine & M. W. Reichelt, The MATLAB ODE Suite (SIAM J. Sci. Comput. 18, 1997).
//!
//! Order 5, seven stages, first same as last.

use super::step::{Attempt, OneStep, POWERS};
use crate::system::System;

/// The method.
pub struct Ode45;

/// Nodes.
pub const C: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

/// Runge–Kutta matrix; its last row is the solution of order 5.
#[rustfmt::skip]
pub const A: [[f64; 6]; 7] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Difference of the solutions of order 5 and 4.
pub const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Dense output: weight of stage `i` at power `j + 1` of the step fraction.
#[rustfmt::skip]
pub const DENSE: [[f64; 4]; 7] = [
    [1.0, -183.0 / 64.0, 37.0 / 12.0, -145.0 / 128.0],
    [0.0; 4],
    [0.0, 1500.0 / 371.0, -1000.0 / 159.0, 1000.0 / 371.0],
    [0.0, -125.0 / 32.0, 125.0 / 12.0, -375.0 / 64.0],
    [0.0, 9477.0 / 3392.0, -729.0 / 106.0, 25515.0 / 6784.0],
    [0.0, -11.0 / 7.0, 11.0 / 3.0, -55.0 / 28.0],
    [0.0, 3.0 / 2.0, -4.0, 5.0 / 2.0],
];

impl<const N: usize> OneStep<N> for Ode45 {
    const POWER: f64 = 1.0 / 5.0;
    const EVALUATIONS: u64 = 6;

    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], f: &[f64; N], h: f64) -> Option<Attempt<N>> {
        let mut k = [*f; 7];
        let mut end = *y;
        for stage in 1..7 {
            end = std::array::from_fn(|i| y[i] + h * (0..stage).map(|j| A[stage][j] * k[j][i]).sum::<f64>());
            k[stage] = system.derivative(t + C[stage] * h, &end);
        }
        let weighted = |weights: [f64; 7], i: usize| (0..7).map(|s| weights[s] * k[s][i]).sum::<f64>();
        let mut dense = [[0.0; N]; POWERS];
        for (j, coefficient) in dense[..4].iter_mut().enumerate() {
            *coefficient = std::array::from_fn(|i| weighted(DENSE.map(|row| row[j]), i));
        }
        Some(Attempt { y: end, slope: k[6], error: std::array::from_fn(|i| h * weighted(E, i)), dense })
    }
}
