//! Energies, momentum and relative displacement of the coupled system, with the rates at which they change.

use super::Coupled;
use crate::{Bare, Excitation, Side, hertz_energy, hertz_force};
use wide::f64x4;

impl Coupled {
    /// `[E1, dE1/dt, d²E1/dt²]` of the primary structure in J, W, W/s (see [`Bare::primary_energy_rates`]);
    /// here `G = P cos ωt - c1 v1 + c2 (v2 - v1) + k2 (x2 - x1 - D) - F_con(z1) + F_con(z2)`.
    #[inline]
    pub fn primary_energy_rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        at_one_moment(excitation, y, |excitation, y| {
            self.primary_energy_rates_by(y, self.accelerations_at_walls(excitation, y))
        })
    }

    /// [`Self::primary_energy_rates`] of four moments side by side at which the damper touches no wall.
    #[inline(always)]
    pub fn primary_energy_rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 3] {
        self.primary_energy_rates_by(y, self.accelerations(excitation, y, self.no_wall_forces()))
    }

    #[inline(always)]
    fn primary_energy_rates_by(&self, y: &[f64x4; 4], accelerations: Accelerations) -> [f64x4; 3] {
        let &[x1, v1, ..] = y;
        let Bare { m1, k1, .. } = self.bare;
        let Accelerations { a: [a1, _], force: [g, _], force_rate: [g_rate, _] } = accelerations;
        [(v1 * v1 * m1 + x1 * x1 * k1) * 0.5, v1 * g, a1 * g + v1 * g_rate]
    }

    /// The paper's damper energy `E2 = (m2 v2² + k2 (x2 - D)²) / 2` with its first two time derivatives, in J, W, W/s.
    ///
    /// Not the energy stored in the damper: its spring is stretched by `x2 - x1 - D` (see [`Self::total_energy`]).
    #[inline]
    pub fn damper_energy_rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        at_one_moment(excitation, y, |excitation, y| {
            self.damper_energy_rates_by(y, self.accelerations_at_walls(excitation, y))
        })
    }

    /// [`Self::damper_energy_rates`] of four moments side by side at which the damper touches no wall.
    #[inline(always)]
    pub fn damper_energy_rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 3] {
        self.damper_energy_rates_by(y, self.accelerations(excitation, y, self.no_wall_forces()))
    }

    #[inline(always)]
    fn damper_energy_rates_by(&self, y: &[f64x4; 4], accelerations: Accelerations) -> [f64x4; 3] {
        let &[_, _, x2, v2] = y;
        let Accelerations { a: [_, a2], force: [_, force], force_rate: [_, rate] } = accelerations;
        let (m2, k2, x) = (self.m2, self.k2, x2 - self.d);
        let net = force + x * k2;
        [(v2 * v2 * m2 + x * x * k2) * 0.5, v2 * net, a2 * net + v2 * (rate + v2 * k2)]
    }

    /// `[m2, k2]`: the weights of `v2²` and `(x2 - D)²` in twice the paper's damper energy.
    pub fn damper_energy_weights(&self) -> [f64; 2] {
        [self.m2, self.k2]
    }

    /// `[k2, c2]`: the weights of the stretch and of its rate in the force of spring and dashpot on the damper, N.
    pub fn damper_force_weights(&self) -> [f64; 2] {
        [self.k2, self.c2]
    }

    /// Relative position `r = x2 - x1` with its first two time derivatives, in m, m/s, m/s².
    #[inline]
    pub fn relative_position_rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        at_one_moment(excitation, y, |excitation, y| {
            relative_position_rates_by(y, self.accelerations_at_walls(excitation, y))
        })
    }

    /// [`Self::relative_position_rates`] of four moments side by side at which the damper touches no wall.
    #[inline(always)]
    pub fn relative_position_rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 3] {
        relative_position_rates_by(y, self.accelerations(excitation, y, self.no_wall_forces()))
    }

    /// Equation (1) and its time derivative.
    #[inline(always)]
    pub(super) fn accelerations(
        &self,
        &[cos, sin]: &[f64x4; 2],
        &[x1, v1, x2, v2]: &[f64x4; 4],
        walls: WallForces,
    ) -> Accelerations {
        let Bare { m1, c1, k1, omega, .. } = self.bare;
        let (stretch, stretch_rate) = (x2 - x1 - self.d, v2 - v1);
        let on_damper = walls.net - stretch_rate * self.c2 - stretch * self.k2;
        let g = cos - v1 * c1 - on_damper;
        let (a1, mut a2) = ((g - x1 * k1) / m1, on_damper / self.m2);
        if self.carried > 0.0 {
            a2 += cos / m1;
        }
        let on_damper_rate = -walls.slope * stretch_rate - (a2 - a1) * walls.drag - stretch_rate * self.k2;
        let g_rate = sin * -omega - a1 * c1 - on_damper_rate;
        let (mut force, mut rate) = (on_damper, on_damper_rate);
        if self.carried > 0.0 {
            force += cos * self.carried;
            rate += sin * (-omega * self.carried);
        }
        Accelerations { a: [a1, a2], force: [g, force], force_rate: [g_rate, rate] }
    }

    /// [`Self::accelerations`] with the forces of walls: those of a contact, or of a rigid wall that holds the damper.
    #[inline(always)]
    pub(super) fn accelerations_at_walls(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> Accelerations {
        if self.is_rigid() {
            let (force, state) =
                (excitation.map(|lanes| lanes.to_array()[0]), y.map(|lanes| lanes.to_array()[0]));
            if self.holding(force, &state).is_some() {
                return self.held_accelerations(force, &state);
            }
        }
        self.accelerations(excitation, y, self.wall_forces(y))
    }

    /// The contact forces of both walls on the damper.
    #[inline(always)]
    pub(super) fn wall_forces(&self, y: &[f64x4; 4]) -> WallForces {
        let y = y.map(|lanes| lanes.to_array()[0]);
        let ([f1, f2], [slope, drag]) = (self.contact_forces(&y), self.wall_slopes(&y));
        let [net, slope, drag] = [f1 - f2, slope, self.c2 + drag].map(f64x4::splat);
        WallForces { net, slope, drag }
    }

    /// [`WallForces`] of a damper that touches no wall.
    #[inline(always)]
    pub(super) fn no_wall_forces(&self) -> WallForces {
        WallForces { net: f64x4::ZERO, slope: f64x4::ZERO, drag: f64x4::splat(self.c2) }
    }

    /// The power that contacts lose, W: `(F - K z^(3/2)) ż`, what the force does to the bodies beyond what it stores.
    pub fn contact_loss(&self, y: &[f64; 4]) -> f64 {
        if !self.is_lossy() {
            return 0.0;
        }
        let (forces, depths) = (self.contact_forces(y), self.indentation(y));
        let lost = |side: Side| {
            let rate = side.sign() * (y[3] - y[1]);
            (forces[side as usize] - hertz_force(self.hertz(side), depths[side as usize])) * rate
        };
        Side::BOTH.map(lost).iter().sum()
    }

    /// The power that the damper's dashpot dissipates, W: `c2 (v2 - v1)²`.
    pub fn damper_loss(&self, y: &[f64; 4]) -> f64 {
        self.c2 * (y[3] - y[1]).powi(2)
    }

    /// Kinetic energy of both bodies, J.
    pub fn kinetic_energy(&self, y: &[f64; 4]) -> f64 {
        0.5 * (self.bare.m1 * y[1] * y[1] + self.m2 * y[3] * y[3])
    }

    /// True mechanical energy, J: kinetic, both springs (the damper's by its own stretch), and `(2/5) K z^(5/2)` a contact.
    ///
    /// Constant when `P = c1 = c2 = 0` and contacts lose nothing.
    pub fn total_energy(&self, y: &[f64; 4]) -> f64 {
        let &[x1, v1, x2, v2] = y;
        let [z1, z2] = self.indentation(y);
        let stretch = x2 - x1 - self.d;
        self.bare.primary_energy(x1, v1)
            + 0.5 * (self.m2 * v2 * v2 + self.k2 * stretch * stretch)
            + hertz_energy(self.hertz[0], z1)
            + hertz_energy(self.hertz[1], z2)
    }

    /// Momentum `m1 v1 + m2 v2`, kg·m/s. Constant when `P = c1 = k1 = 0`.
    pub fn momentum(&self, y: &[f64; 4]) -> f64 {
        self.bare.m1 * y[1] + self.m2 * y[3]
    }
}

#[inline(always)]
fn relative_position_rates_by(&[x1, v1, x2, v2]: &[f64x4; 4], accelerations: Accelerations) -> [f64x4; 3] {
    let Accelerations { a: [a1, a2], .. } = accelerations;
    [x2 - x1, v2 - v1, a2 - a1]
}

/// The net contact force on the damper, N, the sum of both contact stiffnesses, N/m, and the sum of the damping coefficients of both
/// contacts and the dashpot, N·s/m.
#[derive(Clone, Copy)]
pub(super) struct WallForces {
    pub net: f64x4,
    pub slope: f64x4,
    pub drag: f64x4,
}

/// For the structure and for the damper: the acceleration, the sum of the forces (on the structure without its own spring's), and the rate
/// of this sum.
pub(super) struct Accelerations {
    pub a: [f64x4; 2],
    pub force: [f64x4; 2],
    pub force_rate: [f64x4; 2],
}

/// Evaluates at one moment a formula that is written for four moments side by side.
#[inline(always)]
pub(super) fn at_one_moment<const N: usize, const K: usize>(
    excitation: Excitation,
    y: &[f64; N],
    rates: impl Fn(&[f64x4; 2], &[f64x4; N]) -> [f64x4; K],
) -> [f64; K] {
    rates(&excitation.map(f64x4::splat), &y.map(f64x4::splat)).map(|lanes| lanes.to_array()[0])
}
