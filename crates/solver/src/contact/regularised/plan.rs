//! The lengths of the steps of a contact, and the scales of their errors.

use super::piece::{Q, V1, W};
use crate::methods::dop853::Step;
use retune_model::{RegularisedContact, RegularisedState};

/// The scales of a contact, and the steps planned for it.
pub struct Plan {
    /// Largest `q` (√m) and speed (m/s), expected or recently seen: errors are measured against them.
    pub q: f64,
    w: f64,
    /// The speed below which `rtol` asks for more digits than rounding leaves.
    rounding: f64,
    /// `(1/m1 + 1/m2) m1`: errors in `v1` are measured against `w` over this.
    mass_ratio: f64,
    /// Step at the deepest point, s/√m.
    pub h: f64,
    steps_taken: u32,
}

impl Plan {
    /// The step at the deepest point for an error of 1e-9, in units of `2 q_max / w`, by the error estimate of DOP853 on the
    /// undisturbed collision.
    const DEEPEST: f64 = 0.118;

    /// Factor on the scales at each step of a sustained contact.
    const FORGET: f64 = 0.8;

    /// Limit on steps of a collision; a contact with more is a sustained contact, whose steps follow the error estimate alone.
    const COLLISION: u32 = 40;

    /// The plan of a contact that begins at `y`, each step of it to `rtol` of its sizes.
    pub fn new(equations: &RegularisedContact, y: &RegularisedState, rtol: f64) -> Self {
        // A contact that begins at an indentation lasts as long as the collision that would reach this indentation.
        let w = y[W].abs().max(equations.speed_at_depth(y[Q]));
        let q = equations.greatest_depth(w);
        let h = Self::DEEPEST * (rtol / 1e-9).powf(1.0 / 8.0) * 2.0 * q / w;
        let mass_ratio = equations.mass_ratio();
        let mut plan = Self { q, w, rounding: 0.0, mass_ratio, h, steps_taken: 0 };
        // A contact lasts about `3 q² / w`.
        plan.estimate_rounding(equations, y, 3.0 * q * q / w, rtol);
        plan
    }

    /// Estimates the rounding error of a speed over `seconds`; the weights of the error estimate add up to about 50.
    fn estimate_rounding(
        &mut self,
        equations: &RegularisedContact,
        y: &RegularisedState,
        seconds: f64,
        rtol: f64,
    ) {
        self.rounding = 50.0 * f64::EPSILON * equations.size_of_terms(y) * seconds * self.mass_ratio / rtol;
    }

    /// The step from a state, s/√m: the nearest singularity of a collision lies above its deepest point, so steps may be longer
    /// towards the wall, about twice as long at the wall itself.
    pub fn step(&self, y: &RegularisedState) -> f64 {
        let height = 1.0 - (y[Q] / self.q).min(1.0);
        let farther = if y[W] > 0.0 { height.powi(3) } else { height * height };
        self.h * (1.0 + 1.1 * farther)
    }

    /// The error allowed of a speed, m/s.
    pub fn least_speed(&self, rtol: f64) -> f64 {
        rtol * self.w.max(self.rounding)
    }

    /// The error of a step over what is allowed, `rtol` of the largest `q` and speeds.
    #[inline(always)]
    pub fn error(&self, h: f64, step: &Step<5>, rtol: f64) -> f64 {
        let rtol = rtol * (self.rounding / self.w).max(1.0);
        let (q, w) = (1.0 / (rtol * self.q), 1.0 / (rtol * self.w));
        step.error(h, [(Q, q), (W, w), (V1, w * self.mass_ratio)])
    }

    /// Adapts to a step that had this error. Within a collision the plan is better than a single estimate; in a sustained contact the time
    /// scale follows the present `q`, however deep the contact was before. The step was `shortened` to this share of the planned one, and
    /// took `seconds`.
    pub fn adapt(
        &mut self,
        equations: &RegularisedContact,
        error: f64,
        (shortened, seconds): (f64, f64),
        y: &RegularisedState,
        rtol: f64,
    ) {
        self.steps_taken += 1;
        if self.steps_taken > Self::COLLISION {
            self.h *= shortened * (0.9 * error.powf(-1.0 / 8.0)).clamp(0.7, 1.5);
            self.q *= Self::FORGET;
            self.w = (self.w * Self::FORGET).max(equations.speed_at_depth(y[Q]));
            self.estimate_rounding(equations, y, seconds, rtol);
        }
        self.q = self.q.max(y[Q].abs());
        self.w = self.w.max(y[W].abs());
    }

    /// Adapts to a step that was rejected, `shortened` as in [`Self::adapt`]: a collision dominated by forces other than Hertz's stays
    /// shallower than an undisturbed one.
    pub fn reject(&mut self, error: f64, shortened: f64, y: &RegularisedState) {
        let factor = if error.is_finite() { (0.9 * error.powf(-1.0 / 8.0)).clamp(0.1, 0.9) } else { 0.1 };
        self.h *= factor * shortened;
        let expected = self.q;
        self.q = self.q.min(y[Q].abs() + 0.5 * y[W].abs() * self.h * f64::from(Self::COLLISION));
        self.rounding *= (self.q / expected).powi(2); // a contact lasts about `3 q² / w`
    }
}
