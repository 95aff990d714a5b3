//! Displacement, velocity, acceleration of the primary structure, and its force on the ground.

use super::quantity::Quantity;
use crate::motion::form::Form;
use crate::system::LinearSystem;
use retune_model::{Bare, Coupled, Excitation};
use wide::f64x4;

/// A system with a primary structure, whose `x1` and `v1` are the first components of the state.
pub trait Structure<const N: usize>: LinearSystem<N> {
    /// `[x1, v1, a1, da1/dt, d²a1/dt²]`, in m, m/s, …
    fn motion(&self, excitation: Excitation, y: &[f64; N]) -> [f64; 5];
    /// [`Self::motion`] at moments of flight side by side.
    fn motion_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; N]) -> [f64x4; 5];
    /// `[k1, c1]`: the weights of `x1` and `v1` in the force on the ground.
    fn ground_force_weights(&self) -> [f64; 2];
    /// Whether the base moves in fixed coordinates: the force on the structure then acts through the ground.
    fn through_ground(&self) -> bool {
        self.structure().is_on_moving_base()
    }
    /// The weights of the rates of the state in the sum of the bodies' inertia forces, kg.
    fn masses(&self) -> [f64; N];
    /// What contact forces add to the magnitudes of the terms of `a1`, m/s².
    fn contact_size(&self, _y: &[f64; N]) -> f64 {
        0.0
    }
}

impl Structure<2> for Bare {
    fn motion(&self, excitation: Excitation, y: &[f64; 2]) -> [f64; 5] {
        self.primary_motion(excitation, y)
    }
    fn motion_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 2]) -> [f64x4; 5] {
        self.primary_motion_in_flight(excitation, y)
    }
    fn ground_force_weights(&self) -> [f64; 2] {
        Bare::ground_force_weights(self)
    }
    fn masses(&self) -> [f64; 2] {
        [0.0, self.mass()]
    }
}

impl Structure<4> for Coupled {
    #[inline(always)]
    fn motion(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 5] {
        self.primary_motion(excitation, y)
    }
    #[inline(always)]
    fn motion_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 5] {
        self.primary_motion_in_flight(excitation, y)
    }
    fn ground_force_weights(&self) -> [f64; 2] {
        self.bare().ground_force_weights()
    }
    fn masses(&self) -> [f64; 4] {
        let [m1, m2] = Coupled::masses(self);
        [0.0, m1, 0.0, m2]
    }
    fn contact_size(&self, y: &[f64; 4]) -> f64 {
        Coupled::contact_size(self, y)
    }
}

/// A linear combination of `x1`, `v1`, `a1` and the force on the structure.
pub struct StructureMotion<'a, S, const N: usize> {
    system: &'a S,
    weights: [f64; 3],
    /// The weight of the force, and the rates of its rotation as in `Bare::turning`, rad/s.
    force: [f64; 3],
    form: Form<N>,
}

impl<'a, S: Structure<N>, const N: usize> StructureMotion<'a, S, N> {
    /// `weights · (x1, v1, a1)`. Hertz's force enters `a1`: the bounds of a quantity that weights it are those of its form with the
    /// rate of the state.
    pub fn new(system: &'a S, weights: [f64; 3]) -> Self {
        let [x1, v1, a1] = weights;
        let (mut row, mut rated) = ([0.0; N], [0.0; N]);
        [row[0], row[1], rated[1]] = [x1, v1, a1];
        let form = if a1 == 0.0 { Form::linear(system, row) } else { Form::rated(system, row, rated) };
        Self { system, weights, force: [0.0; 3], form }
    }

    /// `sign x1`, m.
    pub fn displacement(system: &'a S, sign: f64) -> Self {
        Self::new(system, [sign, 0.0, 0.0])
    }

    /// `sign v1`, m/s.
    pub fn velocity(system: &'a S, sign: f64) -> Self {
        Self::new(system, [0.0, sign, 0.0])
    }

    /// `sign a1`, m/s². In coordinates that move with an accelerated base it is still the absolute acceleration: the one relative to the
    /// base less `f/m1`, which is minus that of the base.
    pub fn acceleration(system: &'a S, sign: f64) -> Self {
        let in_base_frame = Self::new(system, [0.0, 0.0, sign]);
        if !system.structure().moves_with_base() {
            return in_base_frame;
        }
        let [omega, returns] = system.structure().turning();
        let form = in_base_frame.form.unforced(system);
        Self { force: [-sign / system.structure().mass(), omega, returns], form, ..in_base_frame }
    }

    /// `sign` times the force on the ground, N: `k1 x1 + c1 v1`, and where the ground moves less the force that it exerts on the
    /// structure. Then it is also the sum of the inertia forces, `-(m1 a1 + m2 a2)`, and has the bounds of that.
    pub fn ground_force(system: &'a S, sign: f64) -> Self {
        let [k1, c1] = system.ground_force_weights();
        let fixed = Self::new(system, [sign * k1, sign * c1, 0.0]);
        if !system.through_ground() {
            return fixed;
        }
        let [omega, returns] = system.structure().turning();
        let form = Form::rated(system, [0.0; N], system.masses().map(|mass| -sign * mass));
        Self { force: [-sign, omega, returns], form, ..fixed }
    }
}

impl<S, const N: usize> StructureMotion<'_, S, N> {
    /// The contribution of the force, with its first two time derivatives.
    #[inline(always)]
    fn force_rates<T>(&self, [cos, sin]: [T; 2]) -> [T; 3]
    where
        T: Copy + std::ops::Mul<f64, Output = T>,
    {
        let [weight, omega, returns] = self.force;
        [cos * weight, sin * (-weight * omega), cos * (-weight * omega * returns)]
    }
}

impl<S: Structure<N>, const N: usize> Quantity<N> for StructureMotion<'_, S, N> {
    #[inline(always)]
    fn rates(&self, excitation: Excitation, y: &[f64; N]) -> [f64; 3] {
        let motion = self.system.motion(excitation, y);
        let [a, b, c] = self.weights;
        if self.force[0] != 0.0 {
            let force = self.force_rates(excitation);
            return [0, 1, 2].map(|i| {
                let of_state = a * motion[i] + b * motion[i + 1];
                (if c == 0.0 { of_state } else { of_state + c * motion[i + 2] }) + force[i]
            });
        }
        // An acceleration's rates may be infinite, and 0 ∞ is no number.
        if c == 0.0 {
            return [0, 1, 2].map(|i| a * motion[i] + b * motion[i + 1]);
        }
        [0, 1, 2].map(|i| a * motion[i] + b * motion[i + 1] + c * motion[i + 2])
    }
    #[inline(always)]
    fn rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; N]) -> [f64x4; 3] {
        let motion = self.system.motion_in_flight(excitation, y);
        let [a, b, c] = self.weights;
        if self.force[0] != 0.0 {
            let force = self.force_rates(*excitation);
            return [0, 1, 2].map(|i| {
                let of_state = motion[i] * a + motion[i + 1] * b;
                (if c == 0.0 { of_state } else { of_state + motion[i + 2] * c }) + force[i]
            });
        }
        [0, 1, 2].map(|i| motion[i] * a + motion[i + 1] * b + motion[i + 2] * c)
    }
    fn form(&self) -> &Form<N> {
        &self.form
    }
    #[inline(always)]
    fn is_forced(&self) -> bool {
        self.weights[2] != 0.0 || self.force[0] != 0.0
    }
    fn size(&self, y: &[f64; N]) -> f64 {
        self.form.size(y) + self.weights[2].abs() * self.system.contact_size(y)
    }
}
