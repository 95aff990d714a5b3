//! Rigid walls: Newton's impact, and the motion of a damper that a wall holds (`docs/theory.md`, "Rigid walls").

use super::energies::Accelerations;
use super::{Coupled, Side};
use crate::{Bare, Excitation, Parameter};
use nalgebra::SMatrix;
use wide::f64x4;

/// Distance from a wall, in roundings of the two positions, within which a damper is on it.
const ON_WALL: f64 = 8.0;

impl Coupled {
    /// The restitution of rigid walls; none with Hertz's surfaces or without walls.
    pub fn restitution(&self) -> Option<f64> {
        self.restitution
    }

    /// Whether the walls are rigid.
    pub fn is_rigid(&self) -> bool {
        self.restitution.is_some()
    }

    /// The state after an impact with the restitution `e`: the relative speed `w = v2 - v1` becomes `-e w`, the momentum is kept.
    pub fn struck(&self, e: f64, &[x1, v1, x2, v2]: &[f64; 4]) -> [f64; 4] {
        let ([m1, m2], closing) = (self.masses(), v2 - v1);
        let after = v1 + (1.0 + e) * m2 / (m1 + m2) * closing;
        // The relative speed is that of the law to its own last place: the next bounces of a chatter depend on it.
        [x1, after, x2, after - e * closing]
    }

    /// The derivative of the state after an impact by a parameter, at a fixed state before it; zero for `None`.
    pub fn struck_by(&self, parameter: Option<Parameter>, &[_, v1, _, v2]: &[f64; 4]) -> [f64; 4] {
        let ([m1, m2], w, e) = (self.masses(), v2 - v1, self.restitution.unwrap_or(1.0));
        let m = m1 + m2;
        match parameter {
            Some(Parameter::Restitution) => [0.0, m2 / m * w, 0.0, -m1 / m * w],
            Some(Parameter::M2) => {
                let both = (1.0 + e) * m1 / (m * m) * w;
                [0.0, both, 0.0, both]
            }
            _ => [0.0; 4],
        }
    }

    /// The state in which a wall holds the damper: both bodies have the speed of their common momentum.
    pub fn caught(&self, side: Side, y: &[f64; 4]) -> [f64; 4] {
        let [x1, v, _, _] = self.struck(0.0, y);
        [x1, v, x1 + self.wall(side), v]
    }

    /// Whether the damper rests on a wall, with no relative velocity.
    pub fn rests_on(&self, side: Side, y: &[f64; 4]) -> bool {
        let size = y[0].abs() + y[2].abs();
        y[1] == y[3] && self.indentation(y)[side as usize].abs() <= ON_WALL * f64::EPSILON * size
    }

    /// The wall that holds the damper in a state under a force: the damper rests on it and is pressed on it. Always `None` for Hertz's
    /// surfaces.
    #[inline]
    pub fn holding(&self, excitation: Excitation, y: &[f64; 4]) -> Option<Side> {
        let holds = |&side: &Side| self.rests_on(side, y) && self.held_force(side, excitation, y) >= 0.0;
        Side::BOTH.into_iter().filter(|_| self.is_rigid()).find(holds)
    }

    /// Structure and damper as one body.
    fn joined(&self) -> Bare {
        self.bare.with_mass(self.bare.m1 + self.m2)
    }

    /// The force on both bodies as one.
    fn on_both(&self, excitation: Excitation) -> Excitation {
        excitation.map(|part| part * (1.0 + self.carried))
    }

    /// The force between a wall and the damper that it holds, N.
    fn held_force(&self, side: Side, excitation: Excitation, y: &[f64; 4]) -> f64 {
        let a = self.held_acceleration(excitation, y) - self.frame_acceleration(excitation);
        self.holding_force(side, a)
    }

    /// The acceleration of both bodies while a wall holds the damper, m/s².
    pub fn held_acceleration(&self, excitation: Excitation, y: &[f64; 4]) -> f64 {
        self.joined().derivative(self.on_both(excitation), &[y[0], y[1]])[1]
    }

    /// `[weight, constant]` of the force between the wall and the damper that it holds, N: `weight a + constant` at the common acceleration
    /// `a`, that of the base included. It balances spring and inertia. The wall can only push, so the damper is held while it is not
    /// negative.
    pub fn holding_force_weights(&self, side: Side) -> [f64; 2] {
        let sign = -side.sign();
        [sign * self.m2, sign * self.k2 * (self.wall(side) - self.d)]
    }

    /// The force between a wall and the damper that it holds at a common acceleration (m/s²), N.
    pub fn holding_force(&self, side: Side, acceleration: f64) -> f64 {
        let [weight, constant] = self.holding_force_weights(side);
        weight * acceleration + constant
    }

    /// The linear part of the motion while a wall holds the damper, as [`Self::linear_part`]: `A` and `b` about zero.
    pub fn held_linear_part(&self) -> (SMatrix<f64, 4, 4>, [f64; 4]) {
        let Bare { m1: m, c1, k1, .. } = self.joined();
        #[rustfmt::skip]
        let rows = [
            0.0, 1.0, 0.0, 0.0,
            -k1 / m, -c1 / m, 0.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
            -k1 / m, -c1 / m, 0.0, 0.0,
        ];
        let input = (1.0 + self.carried) / m;
        (SMatrix::<f64, 4, 4>::from_row_slice(&rows), [0.0, input, 0.0, input])
    }

    /// [`Self::rate`] while a wall holds the damper, 1/s.
    pub fn held_rate(&self) -> f64 {
        self.joined().rate()
    }

    /// `[x1, v1, a1, da1/dt, d²a1/dt²]` while a wall holds the damper.
    pub(super) fn held_motion(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 5] {
        self.joined().primary_motion(self.on_both(excitation), &[y[0], y[1]])
    }

    /// [`Accelerations`] while a wall holds the damper.
    pub(super) fn held_accelerations(&self, excitation: Excitation, y: &[f64; 4]) -> Accelerations {
        let ([x1, v1, a, jerk, _], [m1, m2], k1) =
            (self.held_motion(excitation, y), self.masses(), self.bare.k1);
        let splat = |pair: [f64; 2]| pair.map(f64x4::splat);
        Accelerations {
            a: splat([a; 2]),
            force: splat([m1 * a + k1 * x1, m2 * a]),
            force_rate: splat([m1 * jerk + k1 * v1, m2 * jerk]),
        }
    }

    /// The forces of the walls on the damper in a state under a force, N, none negative: Hertz's, or that of a rigid wall that holds it.
    /// The impulses of impacts with a rigid wall are not included.
    pub fn wall_reactions(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 2] {
        let mut forces = self.contact_forces(y);
        if let Some(side) = self.holding(excitation, y) {
            forces[side as usize] = self.held_force(side, excitation, y);
        }
        forces
    }

    /// The derivative of [`Self::held_acceleration`] by a parameter at a fixed state and force, m/s² per unit.
    pub fn held_acceleration_by(&self, parameter: Parameter, excitation: Excitation, y: &[f64; 4]) -> f64 {
        let m = self.joined().m1;
        match parameter {
            Parameter::K1 => -y[0] / m,
            Parameter::C1 => -y[1] / m,
            Parameter::M2 => -self.held_acceleration(excitation, y) / m,
            _ => 0.0,
        }
    }
}
