//! The modified Rosenbrock pair of orders 2 and 3 of L. F. Shampine & M. W. Reichelt, The MATLAB ODE Suite (SIAM J. Sci.
//! Comput. 18, 1997), section 3: the paper's method, with its step control and its dense output of order 2.
//!
//! Order 2, three stages, L-stable, first same as last. A W-method: it keeps its order with a wrong Jacobian.

use super::step::{Attempt, OneStep, POWERS, Tolerance};
use crate::system::System;
use nalgebra::{Const, DimMin, SMatrix, SVector};

/// The method.
pub struct Ode23s;

/// `d = 1 / (2 + √2)`.
const D: f64 = 0.292_893_218_813_452_5;
/// `e32 = 6 + √2`.
const E32: f64 = 7.414_213_562_373_095;

impl<const N: usize> OneStep<N> for Ode23s
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    const POWER: f64 = 1.0 / 3.0;
    /// Two of `f` and one of its derivatives.
    const EVALUATIONS: u64 = 3;

    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], f: &[f64; N], h: f64) -> Option<Attempt<N>> {
        let vector = |v: [f64; N]| SVector::<f64, N>::from(v);
        let array = |v: SVector<f64, N>| std::array::from_fn::<f64, N, _>(|i| v[i]);
        let (y0, f0) = (vector(*y), vector(*f));
        let lu = (SMatrix::<f64, N, N>::identity() - system.jacobian(t, y) * (h * D)).lu();
        let time_part = vector(system.time_derivative(t, y)) * (h * D);
        let k1 = lu.solve(&(f0 + time_part))?;
        let f1 = vector(system.derivative(t + 0.5 * h, &array(y0 + k1 * (0.5 * h))));
        let k2 = lu.solve(&(f1 - k1))? + k1;
        let end = array(y0 + k2 * h);
        let slope = system.derivative(t + h, &end);
        let k3 = lu.solve(&(vector(slope) - (k2 - f1) * E32 - (k1 - f0) * 2.0 + time_part))?;
        let (linear, quadratic) = ((k2 * (-2.0 * D) + k1) / (1.0 - 2.0 * D), (k2 - k1) / (1.0 - 2.0 * D));
        let mut dense = [[0.0; N]; POWERS];
        (dense[0], dense[1]) = (array(linear), array(quadratic));
        Some(Attempt { y: end, slope, error: array((k1 - k2 * 2.0 + k3) * (h / 6.0)), dense })
    }

    /// MATLAB's: from `|y'|`, then from an estimate of `|y''|`.
    fn first_step(
        system: &impl System<N>,
        t: f64,
        y: &[f64; N],
        f: &[f64; N],
        tolerance: Tolerance,
        longest: f64,
    ) -> f64 {
        let limited = |rate: f64| if longest * rate > 1.0 { 1.0 / rate } else { longest };
        let second: [f64; N] = {
            let along = system.jacobian(t, y) * SVector::<f64, N>::from(*f);
            let explicit = system.time_derivative(t, y);
            std::array::from_fn(|i| along[i] + explicit[i])
        };
        limited(1.25 * (0.5 * tolerance.norm(&second, y, y) / tolerance.rtol).sqrt())
    }
}
