//! A contact without loss whose dashpot is so strong that the speed into the wall follows the forces: the fast part of the motion has decayed.
//!
//! With `Λ = c2 (1/m1 + 1/m2)` and the acceleration `g` into the wall by all other forces, `dw/dt = g - Λ w`. Once `e^(-Λ t)` is gone,
//!
//! ```text
//! w = (g - w')/Λ      w' = (g' - w'')/Λ      w'' = g''/Λ
//! ```
//!
//! with `g'` and `g''` along the motion, so that `g'''` alone is left out: `(ρ/Λ)³` of the forces, with the greatest rate `ρ` of the structure, of the
//! force and of `z`, and more near the wall, where `u = |w|/z` is large. These equations have no fast rate: the cost of a contact follows its motion.

use super::bounds::product;
use super::{RegularisedContact, RegularisedState};

/// The speed into the wall and the acceleration of the primary structure, each with two time derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Following {
    /// `w`, m/s, m/s², m/s³.
    pub speed: [f64; 3],
    /// `a1`, m/s², m/s³, m/s⁴.
    pub acceleration: [f64; 3],
}

/// Iterations for [`Following`]: each multiplies the error by `ρ/Λ`.
const PASSES: usize = 3;

impl RegularisedContact {
    /// Sets whether the speed into the wall follows the forces.
    pub fn set_overdamped(&mut self, follows: bool) {
        self.overdamped = follows;
    }

    /// Whether the speed into the wall follows the forces.
    pub fn is_overdamped(&self) -> bool {
        self.overdamped
    }

    /// Truncation error of the speed that follows the forces, relative to the sum of the sizes of the forces between the bodies. Infinite
    /// or NaN at the wall, for contacts that lose energy, and under forces linear in time.
    ///
    /// A derivative of `g` adds the rate `ρ`; one of Hertz's force adds its slope `s Λ`, and then `u`, as `z` is in the denominator:
    /// `d³z^(3/2)/dt³ = 3/2 √z (w'' + 3/2 w' u - 1/4 w u²)`.
    pub fn error_of_following(&self, y: &RegularisedState, following: &Following) -> f64 {
        let ([_, damping, stiffness], fast) = (self.primary, self.dashpot[1]);
        if self.is_lossy() || self.is_linear() {
            return f64::INFINITY;
        }
        let [speed, rate, _] = following.speed.map(f64::abs);
        let (slope, nearing) = (self.stiffness(1, y[0]) / fast, (speed + rate / fast) / (y[0] * y[0]));
        let rate = self.omega.max(damping).max(stiffness.sqrt()).max(slope);
        (rate.powi(3) + slope * (rate + nearing).powi(2)) / fast.powi(3)
    }

    /// The slope of the wall's and the spring's acceleration in `z`, 1/s²: that of the primary structure (0), and that into the wall (1).
    fn stiffness(&self, body: usize, q: f64) -> f64 {
        1.5 * self.hertz[body] * q + self.spring[body]
    }

    /// The speed into the wall that follows the forces; that of the state is not used.
    pub fn following(&self, &[q, _, x1, v1, t]: &RegularisedState) -> Following {
        let (z, [_, p1, p2]) = (q * q, self.primary);
        let (cube, stretch, bend) = (z * q, z + self.stretch, 0.75 / q);
        let turning = self.primary[0] * self.wave(&self.cos, t - self.since);
        let turned = -self.omega * self.primary[0] * self.wave(&self.sin, t - self.since);
        let force = [turning, turned, -self.omega * self.returns * turning];
        let [held, pressed] = [0, 1].map(|i| self.hertz[i] * cube + self.spring[i] * stretch);
        let [stiff, stiffness] = [0, 1].map(|i| self.stiffness(i, q));
        let [drag, fast] = self.dashpot;
        let Following { speed: mut w, acceleration: mut a } = Following::default();
        for _ in 0..PASSES {
            let resisting = p1 * v1 + p2 * x1;
            w[0] = (self.sign * resisting - self.felt * force[0] - pressed - w[1]) / fast;
            a[0] = force[0] - resisting + self.sign * (held + drag * w[0]);
            let resisting = p1 * a[0] + p2 * v1;
            w[1] = (self.sign * resisting - self.felt * force[1] - stiffness * w[0] - w[2]) / fast;
            a[1] = force[1] - resisting + self.sign * (stiff * w[0] + drag * w[1]);
            let resisting = p1 * a[1] + p2 * a[0];
            let [bent, bends] = self.hertz.map(|hertz| hertz * bend * w[0] * w[0]);
            w[2] = (self.sign * resisting - self.felt * force[2] - stiffness * w[1] - bends) / fast;
            a[2] = force[2] - resisting + self.sign * (stiff * w[1] + bent + drag * w[2]);
        }
        Following { speed: w, acceleration: a }
    }

    /// The deviation of the state `[x1, v1, x2, v2]` from rest and its first three time derivatives, and the force with its first two (N, N/s,
    /// N/s²), where the speed into the wall follows the forces; the third derivative of that speed is left out.
    pub fn jet(&self, y: &RegularisedState) -> ([[f64; 4]; 4], [f64; 3]) {
        let &[q, _, x1, v1, t] = y;
        let Following { speed: [w0, w1, w2], acceleration: [a0, a1, a2] } = self.following(y);
        let s = self.sign;
        let states = [
            [x1, v1, x1 + s * (q * q + self.stretch), v1 + s * w0],
            [v1, a0, v1 + s * w0, a0 + s * w1],
            [a0, a1, a0 + s * w1, a1 + s * w2],
            [a1, a2, a1 + s * w2, a2],
        ];
        let [cos, sin] = [&self.cos, &self.sin].map(|of| self.wave(of, t - self.since));
        (states, [cos, -self.omega * sin, -self.omega * self.returns * cos])
    }

    /// Term `k` of the series of `w`, `w'` and `w''`, and of `a1` and `a1'`, from those of q, x1, v1 and 1/q up to it and from term `k` of q³,
    /// of the stretch, and of what the force adds to `a1`: [`Self::following`] with every term by its size.
    pub(super) fn follow<const K: usize>(
        &self,
        k: usize,
        [cube, stretch, forced]: [f64; 3],
        [q, x1, v1, by_q]: [&[f64; K]; 4],
        [w, rate, faster]: [&mut [f64; K]; 3],
        [a1, jerk]: [&mut [f64; K]; 2],
    ) {
        let ([_, p1, p2], [drag, fast]) = (self.primary, self.dashpot);
        let (felt, turned) = (self.felt.abs() * forced, self.omega * forced);
        let [held, pressed] = [0, 1].map(|i| self.hertz[i] * cube + self.spring[i] * stretch);
        for _ in 0..PASSES {
            let resisting = p1 * v1[k] + p2 * x1[k];
            w[k] = (resisting + felt + pressed + rate[k]) / fast;
            a1[k] = forced + resisting + held + drag * w[k];
            let (resisting, moved) = (p1 * a1[k] + p2 * v1[k], 1.5 * product(q, w, k));
            let [stiff, stiffness] = [0, 1].map(|i| self.hertz[i] * moved + self.spring[i] * w[k]);
            rate[k] = (resisting + self.omega * felt + stiffness + faster[k]) / fast;
            jerk[k] = turned + resisting + stiff + drag * rate[k];
            // w²/q of the terms of w up to this one.
            let bent: f64 = (0..=k).map(|i| product(w, w, i) * by_q[k - i]).sum();
            let moved = 1.5 * product(q, rate, k) + 0.75 * bent;
            let resisting = p1 * jerk[k] + p2 * a1[k] + self.hertz[1] * moved + self.spring[1] * rate[k];
            faster[k] = (resisting + self.omega * self.omega * felt) / fast;
        }
    }
}
