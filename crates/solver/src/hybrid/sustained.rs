//! Sustained and other unusual contacts, which are followed step by step: how they begin.

use super::propagator::{Hybrid, relative_position};
use crate::contact::regularised::integrate::{End, integrate};
use crate::contact::regularised::series::follow;
use crate::error::SolverError;
use crate::linear::steps::Step;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::observe::observer::Observer;
use retune_model::{RegularisedContact, RegularisedState};

impl Hybrid<'_> {
    /// Follows a contact step by step from a state in it, until lift-off or `to`.
    pub(super) fn contact(
        &mut self,
        equations: RegularisedContact,
        from: &Knot<4>,
        regularised: RegularisedState,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<End, SolverError> {
        let (followed, stiff) = (observer.follows_contacts(), self.reduced.is_some());
        if !equations.is_lossy() && !followed && !stiff {
            let limits = (self.system, self.rtol, self.budget);
            return follow(equations, (*from, regularised), to, limits, &mut self.work, observer);
        }
        let limits = (self.system, self.rtol, self.budget, stiff && !followed);
        integrate(equations, from, regularised, to, limits, (&mut self.work, &self.shared), observer)
    }

    /// Starts a contact at a touch-down. A contact that begins (almost) at rest has no time scale of its own at `q = 0`: the flight
    /// is continued while the contact force is negligible, less than one part in 1e14 of the motion, at most to time `to`.
    pub(super) fn enter_contact(
        &mut self,
        mut equations: RegularisedContact,
        touch: Knot<4>,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<(Knot<4>, RegularisedState), SolverError> {
        let mut regularised = equations.regularise(&touch.y);
        regularised[0] = 0.0;
        let remaining = to - touch.t;
        if remaining <= 0.0 {
            return Ok((touch, regularised));
        }
        equations.set_excitation(0.0, touch.excitation);
        let (speed, pull) = (regularised[1], equations.acceleration(&regularised));
        // After `s` seconds at this speed the force has moved the damper by `κ √z s²` of `z = w s`; a loss may make it larger.
        let rate = equations.hertz_rate() * equations.push(speed.abs());
        let slow = |s: f64| speed <= pull * s;
        if speed > 0.0 && !slow((1e-28 / (rate.powi(2) * speed)).powf(0.2)) {
            return Ok((touch, regularised)); // fast enough to start at q = 0
        }
        let unfelt = |s: f64, z: f64, w: f64| {
            z > 0.0 && equations.hertz_rate() * equations.push(w.abs()) * z.sqrt() * s * s <= 1e-14
        };
        let sign = equations.side().sign();
        let motion = self.flow.expand(touch.excitation, &touch.y);
        let depth = relative_position(&motion, sign);
        let (mean_rate, closing) = (depth.over_s(), depth.derivative());
        let mut s = self.flow.step().min(remaining);
        let energy = self.system.energy_norm(&touch.y) + self.flow.step() * self.system.energy_norm_growth();
        for _ in 0..400 {
            let z = s * mean_rate.at(s);
            if unfelt(s, z, closing.at(s)) {
                let mut step = Step::part(&self.flow, touch, &motion, s, energy);
                step.end().y[2] = step.end().y[0] + self.system.wall(equations.side()) + sign * z;
                observer.segment(&step);
                let end = *step.ends()[1];
                let mut regularised = equations.regularise(&end.y);
                (regularised[0], regularised[1]) = (z.sqrt(), closing.at(s));
                return Ok((end, regularised));
            }
            s *= 0.5;
        }
        if remaining > self.flow.step() {
            return Err(SolverError::Contact { t: touch.t });
        }
        // The run ends before the indentation exceeds rounding.
        let mut step = Step::part(&self.flow, touch, &motion, remaining, energy);
        step.end().t = to;
        observer.segment(&step);
        let end = *step.ends()[1];
        Ok((end, equations.regularise(&end.y)))
    }
}
