//! Smooth nonlinear problems with exact solutions.

use nalgebra::{Matrix2, SMatrix};
use retune_solver::System;

/// A problem of two equations whose solution is known.
pub trait Problem: System<2> {
    /// The solution at `t`.
    fn exact(&self, t: f64) -> [f64; 2];
}

/// `y' = (1 + cos t) |y|² (-y2, y1)`: a turn at a rate that depends on the radius (which is constant) and on time.
pub struct Turning;

const RADIUS2: f64 = 1.3;

impl System<2> for Turning {
    fn derivative(&self, t: f64, &[a, b]: &[f64; 2]) -> [f64; 2] {
        let rate = (1.0 + t.cos()) * (a * a + b * b);
        [-rate * b, rate * a]
    }
    fn jacobian(&self, t: f64, &[a, b]: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        let rate = 1.0 + t.cos();
        let r2 = a * a + b * b;
        Matrix2::new(-2.0 * a * b, -r2 - 2.0 * b * b, r2 + 2.0 * a * a, 2.0 * a * b) * rate
    }
    fn time_derivative(&self, t: f64, &[a, b]: &[f64; 2]) -> [f64; 2] {
        let rate = -t.sin() * (a * a + b * b);
        [-rate * b, rate * a]
    }
}

impl Problem for Turning {
    fn exact(&self, t: f64) -> [f64; 2] {
        let (sin, cos) = (RADIUS2 * (t + t.sin())).sin_cos();
        [RADIUS2.sqrt() * cos, RADIUS2.sqrt() * sin]
    }
}

/// `y1' = -2 t y1²`, `y2' = -y1 y2`: a rational function and `exp(-atan t)`.
pub struct Decaying;

impl System<2> for Decaying {
    fn derivative(&self, t: f64, &[a, b]: &[f64; 2]) -> [f64; 2] {
        [-2.0 * t * a * a, -a * b]
    }
    fn jacobian(&self, t: f64, &[a, b]: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        Matrix2::new(-4.0 * t * a, 0.0, -b, -a)
    }
    fn time_derivative(&self, _t: f64, &[a, _]: &[f64; 2]) -> [f64; 2] {
        [-2.0 * a * a, 0.0]
    }
}

impl Problem for Decaying {
    fn exact(&self, t: f64) -> [f64; 2] {
        [1.0 / (1.0 + t * t), (-t.atan()).exp()]
    }
}

/// `y' = λ y` for a complex `λ = a + ib`, as two real equations.
pub struct Scalar {
    pub a: f64,
    pub b: f64,
}

impl System<2> for Scalar {
    fn derivative(&self, _t: f64, y: &[f64; 2]) -> [f64; 2] {
        [self.a * y[0] - self.b * y[1], self.b * y[0] + self.a * y[1]]
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        Matrix2::new(self.a, -self.b, self.b, self.a)
    }
    fn time_derivative(&self, _t: f64, _y: &[f64; 2]) -> [f64; 2] {
        [0.0; 2]
    }
}

/// A problem whose stated Jacobian is another.
pub struct WrongJacobian<P>(pub P);

impl<P: System<2>> System<2> for WrongJacobian<P> {
    fn derivative(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        self.0.derivative(t, y)
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        Matrix2::new(-0.4, 0.7, 0.1, -1.2)
    }
    fn time_derivative(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        self.0.time_derivative(t, y)
    }
}

impl<P: Problem> Problem for WrongJacobian<P> {
    fn exact(&self, t: f64) -> [f64; 2] {
        self.0.exact(t)
    }
}
