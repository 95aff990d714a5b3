//! The classical Runge–Kutta method (W. Kutta, Z. Math. Phys. 46, 1901) at a fixed step, with cubic Hermite output.
//!
//! Order 4, four stages, no error estimate: a step that is too long goes unnoticed.

use super::step::{Attempt, OneStep, hermite, unknown_error};
use crate::system::System;

/// The method.
pub struct Rk4;

impl<const N: usize> OneStep<N> for Rk4 {
    const POWER: f64 = 1.0;
    const FIXED: bool = true;
    const EVALUATIONS: u64 = 4;

    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], k1: &[f64; N], h: f64) -> Option<Attempt<N>> {
        let along = |k: &[f64; N], h: f64| std::array::from_fn::<f64, N, _>(|i| y[i] + h * k[i]);
        let k2 = system.derivative(t + 0.5 * h, &along(k1, 0.5 * h));
        let k3 = system.derivative(t + 0.5 * h, &along(&k2, 0.5 * h));
        let k4 = system.derivative(t + h, &along(&k3, h));
        let end = along(&std::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0), h);
        let slope = system.derivative(t + h, &end);
        Some(Attempt {
            y: end,
            slope,
            error: unknown_error(&end),
            dense: hermite(h, (y, k1), (&end, &slope)),
        })
    }
}
