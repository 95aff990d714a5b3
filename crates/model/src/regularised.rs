//! Equation (1) during one contact, regularised: a polynomial system without the kink of `z^(3/2)`.
//!
//! While the damper is in contact with one wall, take `q = √z` for the indentation and a contact time `θ` with `dt = q dθ`
//! (Levi-Civita's regularisation of a collision, for Hertz's law). Hertz's force is then `K q³`, and with `w = dz/dt`
//!
//! ```text
//! dq/dθ = w/2      dw/dθ = q dw/dt      dx1/dθ = q v1      dv1/dθ = q a1      dt/dθ = q
//! ```
//!
//! Every right-hand side is a polynomial, so the motion is analytic in `θ` from before touch-down (`q = 0`, `w > 0`)
//! until after lift-off (`q = 0`, `w < 0`), which is a simple root of `q`. In `t` it is not: `F ~ (t - t0)^(3/2)`.
//! A loss, `K q³ (1 + λ w)`, leaves it polynomial. Where that would pull the force is zero, until the damper has left the wall or is pressed
//! into it again: [`RegularisedContact::set_force`].
//! With the same restitution at every speed the factor is not polynomial but analytic, in `q` too, as it depends on `q⁵` (`crate::loss`).
//! The force is a Taylor polynomial in the time since it was last set ([`RegularisedContact::set_excitation`]), but in a series (`series`).

pub(crate) mod bounds;
pub(crate) mod overdamped;
pub(crate) mod series;

use crate::loss::{Law, Restoring};
use crate::polynomial::{TERMS as WAVE, polynomial};
use crate::{Coupled, Excitation, Side};
use std::ops::Range;
use std::sync::Arc;

/// A regularised state: `[q, w, x1, v1, t]` (√m, m/s, m, m/s, s), with `t` the time since touch-down.
pub type RegularisedState = [f64; 5];

/// Equation (1) in contact with one wall.
#[derive(Clone, Debug)]
pub struct RegularisedContact {
    side: Side,
    sign: f64,
    wall: f64,
    omega: f64,
    returns: f64,    // ω, or 0 where the force is linear in time
    force: [f64; 2], // bounds on the force and its rate, N, N/s
    felt: f64,       // sign, or 0 where the force accelerates both bodies alike
    // Accelerations per unit of each cause.
    primary: [f64; 3],                 // 1/m1, c1/m1, k1/m1
    hertz: [f64; 2],                   // K/m1, K (1/m1 + 1/m2)
    dashpot: [f64; 2],                 // c2/m1, c2 (1/m1 + 1/m2)
    spring: [f64; 2],                  // k2/m1, k2 (1/m1 + 1/m2)
    lambda: f64,                       // λ
    law: [f64; 2], // the factor of Hertz's force is law[0] + law[1] w: 1 + λ w, or 0 without force
    restoring: Option<Arc<Restoring>>, // replaces `law`
    overdamped: bool, // whether w follows the forces (`overdamped`)
    stretch: f64,  // sign (wall - D): the spring's stretch at touch-down, towards the wall
    since: f64,    // the time at which the excitation was set
    amplitude: f64, // a bound on the force from then on, N
    is_far: bool,  // whether the coefficients beyond the first WAVE are in use
    cos: [[f64; WAVE]; 2], // Taylor coefficients of P cos ωt and P sin ωt about that time
    sin: [[f64; WAVE]; 2],
}

impl Coupled {
    /// The regularised equations of contact with `side`.
    pub fn regularised_contact(&self, side: Side) -> RegularisedContact {
        let (_, k2, c2) = self.damper();
        let bare = self.bare();
        let (inv_m1, inv_m) = (1.0 / bare.m1, self.inverse_effective_mass());
        let pair = |factor: f64| [factor * inv_m1, factor * inv_m];
        let (lambda, restoring) = match self.law(side) {
            Law::Damping(lambda) => (*lambda, None),
            Law::Restoring(law) => (0.0, Some(Arc::clone(law))),
        };
        RegularisedContact {
            side,
            sign: side.sign(),
            wall: self.wall(side),
            omega: bare.omega,
            returns: bare.returns,
            force: bare.force_bounds(),
            felt: if bare.moves_with_base() { 0.0 } else { side.sign() },
            primary: [inv_m1, bare.c1 * inv_m1, bare.k1 * inv_m1],
            hertz: pair(self.hertz(side)),
            dashpot: pair(c2),
            spring: pair(k2),
            lambda,
            law: [1.0, lambda],
            restoring,
            overdamped: false,
            stretch: side.sign() * (self.wall(side) - self.rest_distance()),
            since: 0.0,
            amplitude: bare.force_bounds()[0],
            is_far: false,
            cos: [[0.0; WAVE]; 2],
            sin: [[0.0; WAVE]; 2],
        }
    }
}

impl RegularisedContact {
    /// The wall in contact.
    pub fn side(&self) -> Side {
        self.side
    }

    /// Whether contacts lose energy.
    pub fn is_lossy(&self) -> bool {
        self.may_part() || self.restoring.is_some()
    }

    /// The law of a restitution that is the same at every speed.
    pub fn restoring(&self) -> Option<&Arc<Restoring>> {
        self.restoring.as_ref()
    }

    /// λ of the law of Hunt and Crossley, s/m; 0 for any other law.
    pub fn lambda(&self) -> f64 {
        self.lambda
    }

    /// Whether the law may pull: the force then ends while the damper is inside the wall.
    pub fn may_part(&self) -> bool {
        self.lambda != 0.0
    }

    /// `1 + λ w` of a state: the force of the contact ends where it falls through zero.
    pub fn push(&self, w: f64) -> f64 {
        1.0 + self.lambda * w
    }

    /// The speed at which the force ends, `-1/λ`, m/s.
    pub fn parting_speed(&self) -> f64 {
        -1.0 / self.lambda
    }

    /// Sets whether the force of the wall acts while the damper is inside it.
    pub fn set_force(&mut self, acts: bool) {
        self.law = if acts { [1.0, self.lambda] } else { [0.0; 2] };
    }

    /// Whether these are the equations without force of the wall.
    pub fn has_no_force(&self) -> bool {
        self.law[0] == 0.0
    }

    /// The factor of Hertz's force.
    #[inline(always)]
    fn factor(&self, q: f64, w: f64) -> f64 {
        match &self.restoring {
            None => self.law[0] + self.law[1] * w,
            Some(law) => law.push(self.half_square(q), w),
        }
    }

    /// The angle (rad) by which the force may turn after [`Self::set_excitation`]: the first neglected term is below
    /// `0.05⁸ / 8! = 1e-15` of the force.
    pub const TURN: f64 = 0.05;

    /// [`Self::TURN`] after [`Self::carry_excitation`]: below `0.5¹⁶ / 16! = 1e-18`.
    const FAR_TURN: f64 = 0.5;

    /// Sets the force at time `t` (s, since touch-down); it is exact while `ω |t' - t| <= TURN`.
    pub fn set_excitation(&mut self, t: f64, [cos, sin]: Excitation) {
        (self.since, self.is_far) = (t, false);
        (self.cos[0][0], self.sin[0][0]) = (cos, sin);
        self.amplitude = if self.is_linear() { self.force[0] } else { cos.hypot(sin) };
        self.expand(1..WAVE);
    }

    /// Whether the wall is so soft that the force turns by some 2 rad in half a swing of the damper on it, about the depth to which the
    /// force's amplitude presses: steps limited to [`Self::TURN`] are then shorter than a contact needs.
    pub fn is_soft(&self) -> bool {
        let stiffness = self.hertz[0] / self.primary[0];
        let swing = (1.5 * self.hertz[1] * (self.force[0] / stiffness).cbrt()).sqrt();
        swing < 1.5 * self.frequency()
    }

    /// Extends the range of the excitation by twice as many terms, for contacts that last long enough for the force to turn.
    pub fn carry_excitation(&mut self) {
        self.is_far = true;
        self.expand(WAVE..2 * WAVE);
    }

    fn expand(&mut self, orders: Range<usize>) {
        let (cos, sin) = (self.cos.as_flattened_mut(), self.sin.as_flattened_mut());
        for k in orders {
            let [turn, back] = [self.omega / k as f64, self.returns / k as f64];
            (cos[k], sin[k]) = (-turn * sin[k - 1], back * cos[k - 1]);
        }
    }

    /// The angle (rad) by which the force may turn with the terms in use.
    pub fn turn(&self) -> f64 {
        if self.is_far { Self::FAR_TURN } else { Self::TURN }
    }

    /// A component of the force `t` seconds after it was set.
    #[inline(always)]
    fn wave(&self, [near, far]: &[[f64; WAVE]; 2], t: f64) -> f64 {
        let sum = polynomial(near, t);
        if self.is_far { sum + t.powi(WAVE as i32) * polynomial(far, t) } else { sum }
    }

    /// `[P cos ωt, P sin ωt]` at the time of a state, N.
    pub fn excitation(&self, y: &RegularisedState) -> Excitation {
        let t = y[4] - self.since;
        [self.wave(&self.cos, t), self.wave(&self.sin, t)]
    }

    /// Whether the force is linear in time.
    pub(crate) fn is_linear(&self) -> bool {
        self.returns != self.omega
    }

    /// Angular frequency with which the force turns, rad/s; 0 where it is linear in time.
    pub fn frequency(&self) -> f64 {
        self.returns
    }

    /// Accelerations `[dw/dt, a1]` (m/s²). With `s` the side's sign, the spring stretched by `s z + wall - D`
    /// and the net force on the damper `-s (K q³ (1 + λ w) + c2 w + k2 (z + s (wall - D)))`.
    #[inline(always)]
    fn accelerations(&self, y: &RegularisedState) -> [f64; 2] {
        self.accelerations_by(self.contact_over_stiffness(y), y)
    }

    /// `q³` times the factor of a loss: the contact's force over its stiffness K, m^1.5.
    #[inline(always)]
    pub fn contact_over_stiffness(&self, &[q, w, ..]: &RegularisedState) -> f64 {
        q * q * q * self.factor(q, w)
    }

    /// [`Self::accelerations`] from the contact's force over its stiffness.
    #[inline(always)]
    fn accelerations_by(&self, cube: f64, &[q, w, x1, v1, t]: &RegularisedState) -> [f64; 2] {
        self.balance(cube, [q * q + self.stretch, w, x1, v1], self.wave(&self.cos, t - self.since))
    }

    /// [`Self::accelerations`] from the spring's stretch and the force, P cos ωt; linear in all arguments.
    #[inline(always)]
    fn balance(&self, cube: f64, [stretch, w, x1, v1]: [f64; 4], force: f64) -> [f64; 2] {
        // The force's polynomial comes last and alone: it is the longest chain of dependent operations.
        let resisting = self.primary[1] * v1 + self.primary[2] * x1;
        let push = |i: usize| self.hertz[i] * cube + self.dashpot[i] * w + self.spring[i] * stretch;
        let excitation = self.primary[0] * force;
        [
            (self.sign * resisting - push(1)) - self.felt * excitation,
            (self.sign * push(0) - resisting) + excitation,
        ]
    }

    /// The sum of the sizes of the terms that accelerate the PS, m/s², which sets the rounding error of its acceleration.
    pub fn size_of_terms(&self, &[q, w, x1, v1, _]: &RegularisedState) -> f64 {
        let force = if self.is_linear() { self.cos[0][0].abs() } else { self.amplitude };
        self.primary[0] * force
            + self.primary[1] * v1.abs()
            + self.primary[2] * x1.abs()
            + self.hertz[0] * q.abs().powi(3) * self.most(w)
            + self.dashpot[0] * w.abs()
            + self.spring[0] * (q * q + self.stretch).abs()
    }

    /// `S = (2/5) κ q⁵`, m²/s²: half of the square of the touch-down speed of an undisturbed collision without loss that reaches `q`.
    #[inline(always)]
    fn half_square(&self, q: f64) -> f64 {
        0.4 * self.hertz[1] * q.powi(5)
    }

    /// A bound on the factor at speeds up to `w` (m/s).
    fn most(&self, w: f64) -> f64 {
        self.restoring.as_ref().map_or(self.law[0] + self.law[1] * w.abs(), |law| 1.0 + law.chi)
    }

    /// Derivative with respect to `θ` of every component.
    #[inline(always)]
    pub fn derivative(&self, y: &RegularisedState) -> RegularisedState {
        let &[q, w, _, v1, _] = y;
        if self.overdamped {
            let following = self.following(y);
            let [[w, rate, _], [a1, ..]] = [following.speed, following.acceleration];
            return [0.5 * w, q * rate, q * v1, q * a1, q];
        }
        let [rate, a1] = self.accelerations(y);
        [0.5 * w, q * rate, q * v1, q * a1, q]
    }

    /// `dw/dt`, the acceleration into the wall, m/s².
    pub fn acceleration(&self, y: &RegularisedState) -> f64 {
        self.accelerations(y)[0]
    }

    /// The largest `q` (√m) to which the forces of this state but Hertz's would press the damper from rest: `(5 a / 2κ)^(1/3)` with their acceleration
    /// `a` into the wall, 0 if they pull it away. The force is clamped to its amplitude, which its polynomial may exceed long after it was
    /// set.
    pub fn pressed_depth(&self, &[q, w, x1, v1, t]: &RegularisedState) -> f64 {
        let force = self.wave(&self.cos, t - self.since).clamp(-self.amplitude, self.amplitude);
        let [pull, _] = self.balance(0.0, [q * q + self.stretch, w, x1, v1], force);
        (2.5 * pull.max(0.0) / self.hertz[1]).cbrt()
    }

    /// `κ = K (1/m1 + 1/m2)`: the contact force accelerates the bodies apart by `κ z^(3/2)`; m^-0.5 s^-2.
    pub fn hertz_rate(&self) -> f64 {
        self.hertz[1]
    }

    /// The touch-down speed (m/s) of an undisturbed collision that reaches `q` (√m): `w = √(4 κ q⁵ / 5)`.
    pub fn speed_at_depth(&self, q: f64) -> f64 {
        (0.8 * self.hertz[1] * q.powi(5)).sqrt()
    }

    /// The largest of the angular frequencies of the damper on spring and wall at `q`, of the structure on its spring, and of the force,
    /// rad/s.
    pub fn turning(&self, q: f64) -> f64 {
        let damper = self.spring[1] + 1.5 * self.hertz[1] * q;
        damper.max(self.primary[2]).sqrt().max(self.frequency())
    }

    /// `(1/m1 + 1/m2) m1`: the relative acceleration of the two bodies under a contact force, over that of the PS.
    pub fn mass_ratio(&self) -> f64 {
        self.hertz[1] / self.hertz[0]
    }

    /// The state `[x1, v1, x2, v2]` as a regularised one, at t = 0. A damper that is not in contact with this
    /// wall is taken to be just touching it.
    pub fn regularise(&self, &[x1, v1, x2, v2]: &[f64; 4]) -> RegularisedState {
        let z = self.sign * (x2 - x1 - self.wall);
        [z.max(0.0).sqrt(), self.sign * (v2 - v1), x1, v1, 0.0]
    }

    /// The state `[x1, v1, x2, v2]` of a regularised one.
    #[inline]
    pub fn physical(&self, &[q, w, x1, v1, ..]: &RegularisedState) -> [f64; 4] {
        [x1, v1, x1 + self.wall + self.sign * q * q, v1 + self.sign * w]
    }

    /// The largest `q` (√m) of an undisturbed collision at touch-down speed `w` (m/s): `(5 w² / 4κ)^(1/5)`.
    pub fn greatest_depth(&self, w: f64) -> f64 {
        (1.25 * w * w / self.hertz[1]).powf(0.2)
    }

    /// A prediction of the `θ` (s/√m) in which a damper that moves away from the wall will leave it; infinite if it will not.
    ///
    /// With the acceleration beside Hertz's, `a = dw/dt + κ q³`, and the factor of a loss held constant, `w² = v² - (4/5) κ q⁵ + 2 a q²`, and
    /// `θ = ∫₀^q 2 dq / |w|` is expanded in `x = (4/5) κ q⁵ / v²` and `y = 2 a q² / v²`.
    pub fn theta_to_wall(&self, y: &RegularisedState) -> f64 {
        let &[q, w, ..] = y;
        let hertz = self.hertz[1] * self.factor(q, w);
        let depth = 0.8 * hertz * q.powi(5);
        let steady = 2.0 * (self.acceleration(y) + hertz * q.powi(3)) * q * q;
        let v2 = w * w + depth - steady;
        if v2 <= 0.0 {
            return f64::INFINITY;
        }
        let (x, y) = (depth / v2, steady / v2);
        let series = 1.0 + x * (1.0 / 12.0 + x * (3.0 / 88.0 + x * (5.0 / 256.0 + x * (5.0 / 384.0))))
            - y * (1.0 / 6.0 + x * 3.0 / 32.0 - y * 3.0 / 40.0);
        2.0 * q / v2.sqrt() * series
    }
}
