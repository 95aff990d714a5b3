//! The loop of the hybrid: flight, contact, flight, …

use super::flight::FlightEnd;
use super::propagator::{Hybrid, Motion, Phase};
use crate::budget::Budget;
use crate::contact::regularised::integrate::End;
use crate::error::SolverError;
use crate::motion::knot::Knot;
use crate::observe::observer::Observer;

impl Hybrid<'_> {
    /// Follows the motion to time `to` (s) or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    pub fn propagate(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut dyn Observer<4>,
    ) -> Result<Motion, SolverError> {
        self.propagate_for(from, to, observer, None)
    }

    /// [`Self::propagate`] compiled for this observer, with an optional second one that is called by dynamic dispatch: compiling for every
    /// observer would make builds longer.
    #[inline(never)]
    pub(crate) fn propagate_for(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
        second: Option<&mut dyn Observer<4>>,
    ) -> Result<Motion, SolverError> {
        let observer = &mut (observer, second);
        self.flow.check_step(from.t, to)?;
        self.budget = Budget::new(
            self.flow.pace(),
            self.max_steps,
            self.work.with_search_work(observer.search_work()),
            [from.t, to],
        );
        self.end = to;
        if self.system.bare().history().is_none() {
            return self.propagate_smooth(from, to, observer);
        }
        let mut now = from;
        loop {
            now = self.fly_over_samples(now, to, observer)?;
            self.stretch = self.system.bare().stretch(now.t);
            self.leave_samples(now.t);
            let end = self.stretch.map_or(to, |stretch| stretch.to.min(to));
            if now.t >= to || observer.satisfied() {
                return Ok(now);
            }
            observer.discontinuity();
            now = self.propagate_smooth(now, end, observer)?;
            if end >= to || observer.satisfied() {
                return Ok(now);
            }
            // A contact may have ended later.
            now.t = now.t.max(end);
        }
    }

    /// [`Self::propagate`] while the force neither jumps nor bends. A contact that ends after `to` stops it there, at lift-off.
    #[inline(always)]
    fn propagate_smooth(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<Motion, SolverError> {
        if let Some(rigid) = self.rigid.take() {
            let end = self.propagate_rigid(&rigid, from, to, observer);
            self.rigid = Some(rigid);
            return end;
        }
        let mut phase = from.phase;
        let mut now = self.knot(from.t, from.y);
        let stopped = |now: Knot<4>, phase| Ok(Motion { t: now.t, y: now.y, phase });
        loop {
            if let Phase::InContact(side) = phase {
                let equations = self.contacts[side as usize].clone();
                let regularised = equations.regularise(&now.y);
                match self.contact(equations, &now, regularised, to, observer)? {
                    End::InContact(end) => return stopped(end, phase),
                    End::LiftOff(end) => now = self.knot(end.t, end.y),
                }
                phase = Phase::Leaving(side);
            }
            match self.flight(now, phase, to, observer)? {
                FlightEnd::Stopped(end) => return stopped(end, Phase::Flight),
                FlightEnd::TouchDown(side, touch) => {
                    // A damper that rests on a wall from the start makes no touch-down.
                    let closing = side.sign() * (touch.y[3] - touch.y[1]);
                    if touch.t > from.t || closing > 0.0 {
                        observer.touch_down(touch.t, side);
                    }
                    let (bends, until) = self.bends(side, &touch);
                    let at_once =
                        self.collisions[side as usize].collide(&self.flow, touch, until, &bends, observer);
                    if let Some((end, evaluations)) = at_once {
                        self.work.steps += 1;
                        self.work.evaluations += evaluations;
                        now = end;
                        phase = Phase::Leaving(side);
                        if observer.satisfied() || now.t >= to {
                            return stopped(now, phase);
                        }
                        continue;
                    }
                    let equations = self.contacts[side as usize].clone();
                    let (begin, regularised) = self.enter_contact(equations.clone(), touch, to, observer)?;
                    if begin.t >= to {
                        return stopped(begin, Phase::InContact(side));
                    }
                    match self.contact(equations, &begin, regularised, to, observer)? {
                        End::InContact(end) => return stopped(end, Phase::InContact(side)),
                        End::LiftOff(end) => now = self.knot(end.t, end.y),
                    }
                    phase = Phase::Leaving(side);
                }
            }
            if observer.satisfied() || now.t >= to {
                return stopped(now, phase);
            }
        }
    }
}
