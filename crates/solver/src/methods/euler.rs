//! Semi-implicit (symplectic) Euler at a fixed step: the velocities first, then the positions with the new velocities, as game
//! physics engines do.
//!
//! Hairer, Lubich & Wanner, Geometric Numerical Integration, 2nd ed. 2006, I.1.2 and VI.3. Order 1, one evaluation, no error
//! estimate. States alternate position and velocity, `[x1, v1, x2, v2]`. Between steps the motion is a straight line.

use super::step::{Attempt, OneStep, POWERS, unknown_error};
use crate::system::System;

/// The method.
pub struct Euler;

impl<const N: usize> OneStep<N> for Euler {
    const POWER: f64 = 1.0;
    const FIXED: bool = true;
    const EVALUATIONS: u64 = 1;

    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], f: &[f64; N], h: f64) -> Option<Attempt<N>> {
        let velocity = |i: usize| y[i] + h * f[i];
        let rate: [f64; N] = std::array::from_fn(|i| if i % 2 == 0 { velocity(i + 1) } else { f[i] });
        let end = std::array::from_fn(|i| y[i] + h * rate[i]);
        let mut dense = [[0.0; N]; POWERS];
        dense[0] = rate;
        Some(Attempt { y: end, slope: system.derivative(t + h, &end), error: unknown_error(&end), dense })
    }
}
