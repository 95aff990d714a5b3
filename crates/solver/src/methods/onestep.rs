//! The loop of the general-purpose one-step methods: MATLAB's step control, dense output, contacts located or stepped over.

use super::located::Start;
use super::piece::Piece;
use super::step::{Attempt, OneStep, Tolerance};
use crate::budget::{Budget, Pace};
use crate::error::SolverError;
use crate::motion::knot::Knot;
use crate::observe::observer::Observer;
use crate::response::Work;
use crate::settings::{Contacts, Settings};
use crate::system::System;
use retune_model::Side;

/// A run of a one-step method that can be continued.
pub struct Run<'a, S, const N: usize> {
    system: &'a S,
    settings: Settings,
    tolerance: Tolerance,
    longest: f64,
    now: Knot<N>,
    slope: [f64; N],
    h: Option<f64>,
    contact: Option<Side>,
    leaving: bool,
    /// The walls on which the damper has rested since the start: these contacts are no touch-downs.
    resting: [bool; 2],
    budget: Budget,
    /// The time to which the budget extends, s.
    budget_until: f64,
    /// Work done so far.
    pub work: Work,
}

impl<'a, S: System<N>, const N: usize> Run<'a, S, N> {
    /// A run from `y` at time `t` (s); no step will be longer than `longest` (s).
    pub fn new(system: &'a S, settings: &Settings, t: f64, y: [f64; N], longest: f64) -> Self {
        let now = Knot { t, excitation: system.excitation(t), y, clock: [1.0, 0.0] };
        let z = system.indentation(&y);
        Self {
            system,
            settings: *settings,
            tolerance: Tolerance { rtol: settings.rtol, threshold: settings.atol / settings.rtol },
            longest,
            now,
            slope: system.derivative(t, &y),
            h: None,
            contact: Side::BOTH.into_iter().find(|&side| z[side as usize] > 0.0),
            leaving: false,
            resting: z.map(|z| z == 0.0),
            budget: Budget::new(Pace::Steps, settings.max_steps, Work::default(), [t; 2]),
            budget_until: t,
            work: Work { evaluations: 1, ..Work::default() },
        }
    }

    /// The run of another system, continued from the state reached.
    pub fn with_system<'b>(self, system: &'b S) -> Run<'b, S, N> {
        let Knot { t, y, .. } = self.now;
        Run {
            system,
            settings: self.settings,
            tolerance: self.tolerance,
            longest: self.longest,
            now: Knot { excitation: system.excitation(t), ..self.now },
            slope: system.derivative(t, &y),
            h: self.h,
            contact: self.contact,
            leaving: self.leaving,
            resting: self.resting,
            budget: self.budget,
            budget_until: self.budget_until,
            work: Work { evaluations: self.work.evaluations + 1, ..self.work },
        }
    }

    /// Extends the budget to a run to time `to` (s), unless it already covers one.
    pub fn extend_budget(&mut self, to: f64) {
        if to > self.budget_until {
            let span = [self.now.t, to];
            self.budget = Budget::new(Pace::Steps, self.settings.max_steps, self.budgeted_work(), span);
            self.budget_until = to;
        }
    }

    /// The time reached, s.
    pub fn time(&self) -> f64 {
        self.now.t
    }

    /// The state reached.
    pub fn state(&self) -> [f64; N] {
        self.now.y
    }

    /// The work that counts against the budget. Steps of fixed length are known in advance and cheap: for them only steps count.
    fn budgeted_work(&self) -> Work {
        let fixed = self.settings.method.has_fixed_step();
        Work { evaluations: if fixed { 0 } else { self.work.evaluations }, ..self.work }
    }

    /// Integrates to time `to` (s) or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    pub fn integrate<M: OneStep<N>>(
        &mut self,
        to: f64,
        observer: &mut dyn Observer<N>,
    ) -> Result<(), SolverError> {
        self.extend_budget(to);
        while self.now.t < to && !observer.satisfied() {
            let t = self.now.t;
            let (h, attempt) = self.accepted::<M>(to)?;
            let (h, attempt, event) = match self.settings.contacts {
                Contacts::Located => {
                    let Self { system, ref now, ref slope, contact, leaving, .. } = *self;
                    Start { system, now, slope, contact, leaving }.located::<M>(h, attempt, &mut self.work)?
                }
                Contacts::Stepped => (h, attempt, None),
            };
            let end_time = if event.is_none() && h >= to - t { to } else { t + h };
            let end = Knot {
                t: end_time,
                excitation: self.system.excitation(end_time),
                y: attempt.y,
                clock: [1.0, 0.0],
            };
            observer.segment(&Piece { system: self.system, ends: [self.now, end], h, dense: attempt.dense });
            (self.now, self.slope) = (end, attempt.slope);
            self.follow_contact(event, observer);
        }
        Ok(())
    }

    /// Keeps track of touch-downs: at events, or from the states at the ends of steps.
    fn follow_contact(&mut self, event: Option<Side>, observer: &mut dyn Observer<N>) {
        let before = self.contact;
        let z = self.system.indentation(&self.now.y);
        self.leaving = event.is_some();
        if self.settings.contacts == Contacts::Located {
            if let Some(side) = event {
                self.contact = if before == Some(side) { None } else { Some(side) };
            }
        } else {
            self.contact = Side::BOTH.into_iter().find(|&side| z[side as usize] > 0.0);
        }
        if let Some(side) = self.contact
            && before != self.contact
            && !self.resting[side as usize]
        {
            observer.touch_down(self.now.t, side);
        }
        for side in Side::BOTH {
            let has_left = self.contact != Some(side) && (z[side as usize] < 0.0 || before == Some(side));
            self.resting[side as usize] &= !has_left;
        }
    }

    /// A step whose error is within tolerance, with MATLAB's control: shrink by the error once, then halve; grow at most
    /// fivefold, and not after a failure.
    fn accepted<M: OneStep<N>>(&mut self, to: f64) -> Result<(f64, Attempt<N>), SolverError> {
        let Knot { t, y, .. } = self.now;
        let shortest = 16.0 * f64::EPSILON * t.abs().max(f64::MIN_POSITIVE);
        let mut h = match self.h {
            Some(h) => h,
            None => M::first_step(self.system, t, &y, &self.slope, self.tolerance, self.longest),
        }
        .clamp(shortest, self.longest);
        let mut failed = false;
        loop {
            if 1.1 * h >= to - t {
                h = to - t;
            }
            self.work.evaluations += M::EVALUATIONS;
            let attempt = M::attempt(self.system, t, &y, &self.slope, h);
            let error = attempt.as_ref().map_or(f64::NAN, |a| self.tolerance.norm(&a.error, &y, &a.y));
            if let Some(attempt) = attempt
                && error <= self.tolerance.rtol
            {
                self.work.steps += 1;
                self.budget.check(&self.budgeted_work(), t)?;
                let growth = 1.0 / (1.25 * (error / self.tolerance.rtol).powf(M::POWER)).max(0.2);
                self.h = Some(if failed { h } else { h * growth });
                return Ok((h, attempt));
            }
            self.work.rejected += 1;
            if self.settings.method.has_fixed_step() {
                return Err(SolverError::Unstable { t }); // the only failure that a method without error estimate detects
            }
            if h <= shortest {
                let finite = y.iter().all(|v| v.is_finite());
                return Err(if finite {
                    SolverError::StepTooSmall { t, h }
                } else {
                    SolverError::NonFinite { t }
                });
            }
            let shrink = (0.8 * (self.tolerance.rtol / error).powf(M::POWER)).max(0.1);
            h = (h * if failed || shrink.is_nan() { 0.5 } else { shrink }).max(shortest);
            failed = true;
        }
    }
}
