//! The solver's view of a system: right-hand side, linear part, energy norm.

use nalgebra::{Complex, SMatrix};
use retune_model::{Bare, Coupled, Excitation, Stretch};

/// A first-order system `y' = f(t, y)` of `N` equations that general-purpose methods can integrate.
pub trait System<const N: usize> {
    /// `f(t, y)`.
    fn derivative(&self, t: f64, y: &[f64; N]) -> [f64; N];
    /// `∂f/∂y`.
    fn jacobian(&self, t: f64, y: &[f64; N]) -> SMatrix<f64, N, N>;
    /// `∂f/∂t`.
    fn time_derivative(&self, t: f64, y: &[f64; N]) -> [f64; N];
    /// The force on the system at `t`, which observers receive with every state.
    fn excitation(&self, _t: f64) -> Excitation {
        [0.0; 2]
    }
    /// The indentation of each wall: a contact begins and ends where a component crosses zero.
    fn indentation(&self, _y: &[f64; N]) -> [f64; 2] {
        [-1.0; 2]
    }
}

/// A system whose flow between contacts is linear: `y' = A (y - origin) + b f`, with a force `f` that is harmonic or linear in time.
pub trait LinearSystem<const N: usize>: System<N> {
    /// The primary structure, which the force acts on.
    fn structure(&self) -> &Bare;
    /// This system with the force of one stretch of time, continued indefinitely.
    fn during(&self, stretch: Stretch) -> Self
    where
        Self: Sized;
    /// The coefficients of that flow.
    fn linear(&self) -> Linear<N>;
    /// The state at t = 0.
    fn start(&self) -> [f64; N];
    /// Complex amplitudes of the steady motion about the origin, or `None` if there is none (undamped resonance, a pulse, a record).
    fn steady(&self) -> Option<[Complex<f64>; N]>;
    /// A norm of the deviation of a state from the origin that never grows without force, √J: `√(2E)`.
    fn energy_norm(&self, y: &[f64; N]) -> f64;
    /// Largest growth of that norm under the force, √J/s.
    fn energy_norm_growth(&self) -> f64;
    /// The amplitude of the force, N, or a bound on it.
    fn amplitude(&self) -> f64 {
        if self.structure().history().is_some() {
            return self.structure().force_bounds()[0];
        }
        let [cos, sin] = self.excitation(0.0);
        cos.hypot(sin)
    }
    /// The largest `|row · (y - origin)|` over all states of norm 1; infinite if there is none.
    fn dual_energy_norm(&self, row: &[f64; N]) -> f64;
}

/// A forced linear system.
#[derive(Clone, Copy, Debug)]
pub struct Linear<const N: usize> {
    /// Columns of `A`.
    pub columns: [[f64; N]; N],
    /// `b`.
    pub input: [f64; N],
    /// The input of the force's partner where a decayed fast part of the motion is left out: that part follows the force.
    pub partner: Option<[f64; N]>,
    /// The state of rest.
    pub origin: [f64; N],
    /// ω, rad/s, of `df/dt = -ω s`, with the force `f` and its partner `s`.
    pub frequency: f64,
    /// Its counterpart in `ds/dt = ω f`, rad/s: the same, or 0 where the force is linear in time.
    pub returns: f64,
    /// A bound on the norm of `A` in the energy norm and on ω, 1/s: the flow has no shorter time scale than its inverse.
    pub rate: f64,
    /// The largest contribution to `rate`, in the symbols of a study file.
    pub fastest: &'static str,
}

/// The linear equations while a rigid wall holds the damper: both bodies move as one.
pub(crate) fn held_linear(system: &Coupled) -> Linear<4> {
    let ((a, input), [frequency, returns]) = (system.held_linear_part(), system.bare().turning());
    Linear {
        columns: columns(&a),
        input,
        partner: None,
        origin: [0.0; 4],
        frequency,
        returns,
        rate: system.held_rate(),
        fastest: system.fastest(),
    }
}

fn columns<const N: usize>(a: &SMatrix<f64, N, N>) -> [[f64; N]; N] {
    std::array::from_fn(|j| std::array::from_fn(|i| a[(i, j)]))
}

impl System<2> for Bare {
    fn derivative(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        Bare::derivative(self, Bare::excitation(self, t), y)
    }
    fn jacobian(&self, _t: f64, _y: &[f64; 2]) -> SMatrix<f64, 2, 2> {
        self.linear_part().0
    }
    fn time_derivative(&self, t: f64, _y: &[f64; 2]) -> [f64; 2] {
        Bare::time_derivative(self, Bare::excitation(self, t))
    }
    fn excitation(&self, t: f64) -> Excitation {
        Bare::excitation(self, t)
    }
}

impl System<4> for Coupled {
    fn derivative(&self, t: f64, y: &[f64; 4]) -> [f64; 4] {
        Coupled::derivative(self, Coupled::excitation(self, t), y)
    }
    fn jacobian(&self, _t: f64, y: &[f64; 4]) -> SMatrix<f64, 4, 4> {
        Coupled::jacobian(self, y)
    }
    fn time_derivative(&self, t: f64, _y: &[f64; 4]) -> [f64; 4] {
        Coupled::time_derivative(self, Coupled::excitation(self, t))
    }
    fn excitation(&self, t: f64) -> Excitation {
        Coupled::excitation(self, t)
    }
    fn indentation(&self, y: &[f64; 4]) -> [f64; 2] {
        Coupled::indentation(self, y)
    }
}

impl LinearSystem<2> for Bare {
    fn structure(&self) -> &Bare {
        self
    }
    fn during(&self, stretch: Stretch) -> Self {
        Bare::during(*self, stretch)
    }
    fn linear(&self) -> Linear<2> {
        let ((a, input), [frequency, returns]) = (self.linear_part(), self.turning());
        Linear {
            columns: columns(&a),
            input,
            partner: None,
            origin: self.rest(),
            frequency,
            returns,
            rate: self.rate(),
            fastest: self.fastest(),
        }
    }
    fn start(&self) -> [f64; 2] {
        Bare::start(self)
    }
    fn steady(&self) -> Option<[Complex<f64>; 2]> {
        if self.history().is_some() {
            return None;
        }
        let steady = Bare::steady(self, self.frequency());
        finite([steady.x1], self.frequency()).map(|[x1]| x1)
    }
    fn energy_norm(&self, &[x1, v1]: &[f64; 2]) -> f64 {
        (2.0 * self.primary_energy(x1, v1)).sqrt()
    }
    fn energy_norm_growth(&self) -> f64 {
        Bare::energy_norm_growth(self)
    }
    fn dual_energy_norm(&self, row: &[f64; 2]) -> f64 {
        Bare::dual_energy_norm(self, row)
    }
}

impl LinearSystem<4> for Coupled {
    fn structure(&self) -> &Bare {
        self.bare()
    }
    fn during(&self, stretch: Stretch) -> Self {
        Coupled::during(self, stretch)
    }
    fn linear(&self) -> Linear<4> {
        let ((a, input), [frequency, returns]) = (self.linear_part(), self.bare().turning());
        Linear {
            columns: columns(&a),
            input,
            partner: None,
            origin: self.rest(),
            frequency,
            returns,
            rate: self.rate(),
            fastest: self.fastest(),
        }
    }
    fn start(&self) -> [f64; 4] {
        Coupled::start(self)
    }
    fn steady(&self) -> Option<[Complex<f64>; 4]> {
        if self.bare().history().is_some() {
            return None;
        }
        let omega = self.bare().frequency();
        let steady = Coupled::steady(self, omega);
        finite([steady.x1, steady.x2], omega).map(|[[x1, v1], [x2, v2]]| [x1, v1, x2, v2])
    }
    fn energy_norm(&self, y: &[f64; 4]) -> f64 {
        Coupled::energy_norm(self, y)
    }
    fn energy_norm_growth(&self) -> f64 {
        Coupled::energy_norm_growth(self)
    }
    fn dual_energy_norm(&self, row: &[f64; 4]) -> f64 {
        Coupled::dual_energy_norm(self, row)
    }
}

/// Amplitudes of positions with those of their velocities, `iω` times as large; `None` unless all are finite.
fn finite<const M: usize>(positions: [Complex<f64>; M], omega: f64) -> Option<[[Complex<f64>; 2]; M]> {
    let velocity = Complex::new(0.0, omega);
    positions
        .iter()
        .all(|x| x.re.is_finite() && x.im.is_finite())
        .then(|| positions.map(|x| [x, velocity * x]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_model::{Forcing, NonNegative, Positive, Primary};

    /// A light and soft structure, whose norms are far from 1.
    #[test]
    fn contract_the_energy_norms_of_a_linear_system_are_those_of_the_model() {
        let mass = Positive::new(3e-4).expect("above 0");
        let number = |value| NonNegative::new(value).expect("not below 0");
        let primary = Primary { mass, damping: number(0.1), stiffness: number(7.0) };
        let forcing = Forcing::force(number(5.0), number(2.0));
        let bare = Bare::new(&primary, &forcing);
        let found = [
            LinearSystem::energy_norm(&bare, &[0.3, -2.0]),
            LinearSystem::energy_norm_growth(&bare),
            LinearSystem::dual_energy_norm(&bare, &[4.0, 0.5]),
        ];
        // sqrt(m1 v² + k1 x²), P / sqrt(m1), sqrt(4² / k1 + 0.5² / m1).
        let expected = [
            (3e-4_f64 * 4.0 + 7.0 * 0.09).sqrt(),
            5.0 / 3e-4_f64.sqrt(),
            (16.0_f64 / 7.0 + 0.25 / 3e-4).sqrt(),
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
    }
}
