//! What a solver needs to know of a system. The only file here that meets the model's equations by name.

use nalgebra::SMatrix;
use retune_model::{Bare, Coupled, Drive, Side};

/// A first-order system `y' = f(t, y)` of `N` equations that general-purpose methods can integrate.
pub trait System<const N: usize> {
    /// `f(t, y)`.
    fn derivative(&self, t: f64, y: &[f64; N]) -> [f64; N];
    /// `∂f/∂y`.
    fn jacobian(&self, t: f64, y: &[f64; N]) -> SMatrix<f64, N, N>;
    /// `∂f/∂t`.
    fn time_derivative(&self, t: f64, y: &[f64; N]) -> [f64; N];
    /// The force on the system at `t`, handed on to observers with every state.
    fn drive(&self, _t: f64) -> Drive {
        [0.0; 2]
    }
    /// How far the system has pressed into each wall: a contact begins and ends where a component crosses zero.
    fn rapprochement(&self, _y: &[f64; N]) -> [f64; 2] {
        [-1.0; 2]
    }
}

/// A system whose flow between contacts is linear: `y' = A (y - origin) + b P cos ωt`.
pub trait LinearSystem<const N: usize> {
    /// The numbers of that flow.
    fn linear(&self) -> Linear<N>;
}

/// A forced linear system.
#[derive(Clone, Copy, Debug)]
pub struct Linear<const N: usize> {
    /// Columns of `A`.
    pub columns: [[f64; N]; N],
    /// `b`.
    pub input: [f64; N],
    /// The state of rest.
    pub origin: [f64; N],
    /// ω, rad/s.
    pub frequency: f64,
    /// A bound on the norm of `A` in the energy norm and on ω, 1/s: the flow has no shorter time scale than its inverse.
    pub rate: f64,
}

fn columns<const N: usize>(a: &SMatrix<f64, N, N>) -> [[f64; N]; N] {
    std::array::from_fn(|j| std::array::from_fn(|i| a[(i, j)]))
}

impl System<2> for Bare {
    fn derivative(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        Bare::derivative(self, Bare::drive(self, t), y)
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        self.linear_part().0
    }
    fn time_derivative(&self, t: f64, _y: &[f64; 2]) -> [f64; 2] {
        Bare::time_derivative(self, Bare::drive(self, t))
    }
    fn drive(&self, t: f64) -> Drive {
        Bare::drive(self, t)
    }
}

impl System<4> for Coupled {
    fn derivative(&self, t: f64, y: &[f64; 4]) -> [f64; 4] {
        Coupled::derivative(self, Coupled::drive(self, t), y)
    }
    fn jacobian(&self, _t: f64, y: &[f64; 4]) -> SMatrix<f64, 4, 4> {
        Coupled::jacobian(self, y)
    }
    fn time_derivative(&self, t: f64, _y: &[f64; 4]) -> [f64; 4] {
        Coupled::time_derivative(self, Coupled::drive(self, t))
    }
    fn drive(&self, t: f64) -> Drive {
        Coupled::drive(self, t)
    }
    fn rapprochement(&self, y: &[f64; 4]) -> [f64; 2] {
        Coupled::rapprochement(self, y)
    }
}

impl LinearSystem<2> for Bare {
    fn linear(&self) -> Linear<2> {
        let (a, input) = self.linear_part();
        Linear {
            columns: columns(&a),
            input,
            origin: self.rest(),
            frequency: self.frequency(),
            rate: self.rate(),
        }
    }
}

impl LinearSystem<4> for Coupled {
    fn linear(&self) -> Linear<4> {
        let (a, input) = self.linear_part();
        Linear {
            columns: columns(&a),
            input,
            origin: self.rest(),
            frequency: self.bare().frequency(),
            rate: self.rate(),
        }
    }
}

/// Both walls with the sign of the gap to each: `gap = sign_gap (r - wall)`, positive in flight.
pub(crate) fn gap(system: &Coupled, side: Side, r: f64) -> f64 {
    -side.sign() * (r - system.wall(side))
}
