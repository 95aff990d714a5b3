//! The motion of the primary structure with its time derivatives, for the largest displacement, velocity, acceleration and force on
//! the ground.

use super::Coupled;
use super::energies::{Accelerations, WallForces, at_one_moment};
use crate::loss::Factor;
use crate::{Bare, Excitation, Side, hertz_force, hertz_force_curvature, hertz_force_slope};
use wide::f64x4;

impl Bare {
    /// `[x1, v1, a1, da1/dt, d²a1/dt²]` of the structure without a damper, in m, m/s, …: equation (1) and its time derivatives.
    #[inline]
    pub fn primary_motion(&self, excitation: Excitation, y: &[f64; 2]) -> [f64; 5] {
        at_one_moment(excitation, y, |excitation, y| self.primary_motion_in_flight(excitation, y))
    }

    /// [`Self::primary_motion`] of four moments side by side.
    #[inline(always)]
    pub fn primary_motion_in_flight(&self, &[cos, sin]: &[f64x4; 2], &[x1, v1]: &[f64x4; 2]) -> [f64x4; 5] {
        let Self { m1, c1, k1, omega, returns, .. } = *self;
        let a1 = (cos - v1 * c1 - x1 * k1) / m1;
        let jerk = (sin * -omega - a1 * c1 - v1 * k1) / m1;
        [x1, v1, a1, jerk, (cos * (-omega * returns) - jerk * c1 - a1 * k1) / m1]
    }

    /// `[k1, c1]`: the weights of `x1` and `v1` in the force that the structure transmits to the ground, `k1 x1 + c1 v1`, N.
    pub fn ground_force_weights(&self) -> [f64; 2] {
        [self.k1, self.c1]
    }
}

impl Coupled {
    /// `[x1, v1, a1, da1/dt, d²a1/dt²]` of the structure, in m, m/s, …: equation (1) and its time derivatives. At a wall the last one
    /// grows without bound as a contact begins or ends, for Hertz's force goes with `z^(3/2)`; it is finite at `z = 0` itself, where
    /// the wall is taken to be out of reach.
    #[inline]
    pub fn primary_motion(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 5] {
        if self.holding(excitation, y).is_some() {
            return self.held_motion(excitation, y);
        }
        at_one_moment(excitation, y, |excitation, lanes| {
            let bends = self.wall_bends(y).map(f64x4::splat);
            self.primary_motion_under(excitation, lanes, self.wall_forces(lanes), bends)
        })
    }

    /// [`Self::primary_motion`] of four moments side by side at which the damper touches no wall.
    #[inline(always)]
    pub fn primary_motion_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 5] {
        self.primary_motion_under(excitation, y, self.no_wall_forces(), [f64x4::ZERO; 3])
    }

    /// `∂²N/∂r²`, N/m², `2 ∂²N/∂r∂ṙ`, N·s/m², and `∂²N/∂ṙ²`, N·s²/m², of `N = F_con(z1) - F_con(z2)`.
    fn wall_bends(&self, y: &[f64; 4]) -> [f64; 3] {
        let ([z1, z2], rate) = (self.indentation(y), y[3] - y[1]);
        let (near, far) = (self.bends(Side::Primary, z1, -rate), self.bends(Side::Obstacle, z2, rate));
        std::array::from_fn(|i| near[i] - far[i])
    }

    /// `∂²F/∂z²`, N/m², `2 ∂²F/∂z∂w`, N·s/m², and `∂²F/∂w²`, N·s²/m², of [`Self::wall_force`].
    fn bends(&self, side: Side, z: f64, w: f64) -> [f64; 3] {
        if z <= 0.0 {
            return [0.0; 3];
        }
        let hertz = self.hertz(side);
        let Factor { f, by_z, by_w, by_zz, by_zw, by_ww, .. } = self.wall_factor(side, z.sqrt(), w);
        let [force, slope] = [hertz_force(hertz, z), hertz_force_slope(hertz, z)];
        [
            hertz_force_curvature(hertz, z) * f + (2.0 * slope * by_z + force * by_zz / z) / z,
            2.0 * (slope * by_w + force * by_zw / z),
            force * by_ww,
        ]
    }

    /// The contact force on a wall with its first two time derivatives, N, N/s, N/s².
    pub fn contact_force_rates(&self, excitation: Excitation, y: &[f64; 4], side: Side) -> [f64; 3] {
        // The second and third derivatives of r.
        let [apart, jerk] = at_one_moment(excitation, y, |excitation, y| {
            let Accelerations { a: [a1, a2], force_rate: [g_rate, rate], .. } =
                self.accelerations(excitation, y, self.wall_forces(y));
            [a2 - a1, rate / self.m2 - (g_rate - y[1] * self.bare.k1) / self.bare.m1]
        });
        let (z, sign) = (self.indentation(y)[side as usize], side.sign());
        let [w, rate, bend] = [y[3] - y[1], apart, jerk].map(|of| sign * of);
        let ([force, by_z, by_w], [curved, mixed, fast]) =
            (self.wall_force(side, z, w), self.bends(side, z, w));
        let curvature = (curved * w + mixed * rate) * w + fast * rate * rate + by_z * rate + by_w * bend;
        [force, by_z * w + by_w * rate, curvature]
    }

    #[inline(always)]
    fn primary_motion_under(
        &self,
        excitation: &[f64x4; 2],
        y: &[f64x4; 4],
        walls: WallForces,
        [bend, twist, warp]: [f64x4; 3],
    ) -> [f64x4; 5] {
        let &[x1, v1, _, v2] = y;
        let Bare { m1, c1, k1, omega, returns, .. } = self.bare;
        let Accelerations { a: [a1, a2], force_rate: [g_rate, on_damper_rate], .. } =
            self.accelerations(excitation, y, walls);
        let (jerk, jerk_2) = ((g_rate - v1 * k1) / m1, on_damper_rate / self.m2);
        let (speed, apart) = (v2 - v1, a2 - a1);
        let on_damper_bend = (bend * speed + twist * apart) * speed + warp * apart * apart
            - walls.slope * apart
            - (jerk_2 - jerk) * walls.drag
            - apart * self.k2;
        let g_bend = excitation[0] * (-omega * returns) - jerk * c1 - on_damper_bend;
        [x1, v1, a1, jerk, (g_bend - a1 * k1) / m1]
    }

    /// What the contact forces add to the sizes of the terms of `a1`, m/s²: they follow from an indentation that is a difference of
    /// positions, whose rounding they magnify.
    pub fn contact_size(&self, y: &[f64; 4]) -> f64 {
        let [z1, z2] = self.indentation(y);
        let position = y[0].abs() + y[2].abs();
        // The sum of the sizes of the terms of the law.
        let most = |side: Side| self.law(side).most(y[1].abs() + y[3].abs());
        let loss = most(Side::Primary).max(most(Side::Obstacle));
        let size = |hertz: f64, z: f64, wall: f64| {
            if z > 0.0 { hertz_force(hertz, z) * (1.0 + 1.5 * (position + wall) / z) } else { 0.0 }
        };
        (size(self.hertz[0], z1, 0.0) + size(self.hertz[1], z2, self.walls[1])) * loss / self.bare.m1
    }
}
