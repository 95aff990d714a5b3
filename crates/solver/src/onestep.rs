//! The loop of the general-purpose one-step methods: MATLAB's step control, dense output, contacts located or stepped over.

use crate::budget::Budget;
use crate::gap::first_contact;
use crate::observe::{Knot, Observer, Segment};
use crate::polynomial::Polynomial;
use crate::settings::{Contacts, Settings, SolverError, Work};
use crate::system::System;
use retune_model::Side;

/// What a method makes of one step.
pub struct Attempt<const N: usize> {
    /// The solution at the end of the step.
    pub y: [f64; N],
    /// `f` there.
    pub slope: [f64; N],
    /// Estimate of the local error.
    pub error: [f64; N],
    /// Dense output: `y(t + s h) = y + h Σ p_j s^(j+1)`, `0 <= s <= 1`.
    pub dense: [[f64; N]; POWERS],
}

/// Powers of the step fraction in a dense output: as many as that of DOP853 has.
pub const POWERS: usize = 7;

/// The cubic that meets value and slope `(y, f)` at both ends of a step, as a dense output.
pub fn hermite<const N: usize>(
    h: f64,
    (y, f): (&[f64; N], &[f64; N]),
    (end, slope): (&[f64; N], &[f64; N]),
) -> [[f64; N]; POWERS] {
    let mut dense = [[0.0; N]; POWERS];
    for i in 0..N {
        let chord = (end[i] - y[i]) / h;
        dense[0][i] = f[i];
        dense[1][i] = 3.0 * chord - 2.0 * f[i] - slope[i];
        dense[2][i] = f[i] + slope[i] - 2.0 * chord;
    }
    dense
}

/// The error estimate of a method that has none: zero, NaN where the state is not finite.
pub fn unknown_error<const N: usize>(end: &[f64; N]) -> [f64; N] {
    end.map(|v| 0.0 * v)
}

/// A one-step method with an embedded error estimate. It is handed `f(t, y)` and returns `f` at the end of the step.
pub trait OneStep<const N: usize> {
    /// Exponent of the step control, one over the order of the error estimate's method plus one.
    const POWER: f64;
    /// Evaluations per step, the one at its start not counted.
    const EVALUATIONS: u64;
    /// Takes a step of length `h`; `None` if the method's equations have no solution there.
    fn attempt(system: &impl System<N>, t: f64, y: &[f64; N], f: &[f64; N], h: f64) -> Option<Attempt<N>>;
    /// The first step to try, given the longest that may be taken: MATLAB's, from `|y'|`, unless the method has its own.
    fn first_step(
        _system: &impl System<N>,
        _t: f64,
        y: &[f64; N],
        f: &[f64; N],
        tolerance: Tolerance,
        longest: f64,
    ) -> f64 {
        let rate = tolerance.norm(f, y, y) / (0.8 * tolerance.rtol.powf(Self::POWER));
        if longest * rate > 1.0 { 1.0 / rate } else { longest }
    }
}

/// MATLAB's tolerances: a component's error may be `rtol max(|y|, atol / rtol)`.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance over relative tolerance.
    pub threshold: f64,
}

impl Tolerance {
    /// `max_i |e_i| / max(|y_i|, |z_i|, threshold)`.
    pub fn norm<const N: usize>(self, e: &[f64; N], y: &[f64; N], z: &[f64; N]) -> f64 {
        (0..N).fold(0.0, |worst, i| {
            let ratio = e[i].abs() / y[i].abs().max(z[i].abs()).max(self.threshold);
            if ratio.is_nan() || ratio > worst { ratio } else { worst }
        })
    }
}

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
    /// The walls that the damper has lain against since the start: it has not struck them.
    resting: [bool; 2],
    budget: Budget,
    /// Work done so far.
    pub work: Work,
}

struct Piece<'a, S, const N: usize> {
    system: &'a S,
    ends: [Knot<N>; 2],
    h: f64,
    dense: [[f64; N]; POWERS],
}

impl<S: System<N>, const N: usize> Segment<N> for Piece<'_, S, N> {
    fn ends(&self) -> [&Knot<N>; 2] {
        [&self.ends[0], &self.ends[1]]
    }
    fn length(&self) -> f64 {
        self.h
    }
    fn at(&self, theta: f64) -> Knot<N> {
        let (from, s) = (&self.ends[0], theta / self.h);
        let y = std::array::from_fn(|i| {
            from.y[i] + theta * self.dense.iter().rev().fold(0.0, |sum, p| sum * s + p[i])
        });
        let t = from.t + theta;
        Knot { t, drive: self.system.drive(t), y, clock: [1.0, 0.0] }
    }
    fn at_time(&self, t: f64) -> Knot<N> {
        Knot { t, ..self.at(t - self.ends[0].t) }
    }
}

impl<'a, S: System<N>, const N: usize> Run<'a, S, N> {
    /// A run from `y` at time `t` (s); no step will be longer than `longest` (s).
    pub fn new(system: &'a S, settings: &Settings, t: f64, y: [f64; N], longest: f64) -> Self {
        let now = Knot { t, drive: system.drive(t), y, clock: [1.0, 0.0] };
        let z = system.rapprochement(&y);
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
            budget: Budget::new(settings.method, settings.max_steps, 0, [t; 2]),
            work: Work { evaluations: 1, ..Work::default() },
        }
    }

    /// The state reached.
    pub fn state(&self) -> [f64; N] {
        self.now.y
    }

    /// Integrates to time `to` (s) or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    pub fn integrate<M: OneStep<N>>(
        &mut self,
        to: f64,
        observer: &mut impl Observer<N>,
    ) -> Result<(), SolverError> {
        let span = [self.now.t, to];
        self.budget = Budget::new(self.settings.method, self.settings.max_steps, self.work.steps, span);
        while self.now.t < to && !observer.satisfied() {
            let t = self.now.t;
            let (h, attempt) = self.accepted::<M>(to)?;
            let (h, attempt, event) = match self.settings.contacts {
                Contacts::Located => self.located::<M>(h, attempt),
                Contacts::Stepped => (h, attempt, None),
            };
            let end_time = if event.is_none() && h >= to - t { to } else { t + h };
            let end =
                Knot { t: end_time, drive: self.system.drive(end_time), y: attempt.y, clock: [1.0, 0.0] };
            observer.segment(&Piece { system: self.system, ends: [self.now, end], h, dense: attempt.dense });
            (self.now, self.slope) = (end, attempt.slope);
            self.follow_contact(event, observer);
        }
        Ok(())
    }

    /// Keeps account of touch-downs: at an event, or by what can be seen at the ends of steps.
    fn follow_contact(&mut self, event: Option<Side>, observer: &mut impl Observer<N>) {
        let before = self.contact;
        let z = self.system.rapprochement(&self.now.y);
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
            let apart = self.contact != Some(side) && (z[side as usize] < 0.0 || before == Some(side));
            self.resting[side as usize] &= !apart;
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
                self.budget.check(self.work.steps, t)?;
                let growth = 1.0 / (1.25 * (error / self.tolerance.rtol).powf(M::POWER)).max(0.2);
                self.h = Some(if failed { h } else { h * growth });
                return Ok((h, attempt));
            }
            self.work.rejected += 1;
            if self.settings.method.has_fixed_step() {
                return Err(SolverError::Unstable { t }); // all that such a method can notice
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

    /// Shortens a step to the first touch-down or lift-off in it, if there is one.
    ///
    /// The dense output says which wall and about when (double crossings inside the step included); the step itself, taken
    /// again, says exactly: a secant iteration on its length.
    fn located<M: OneStep<N>>(&mut self, h: f64, attempt: Attempt<N>) -> (f64, Attempt<N>, Option<Side>) {
        let first = Side::BOTH
            .into_iter()
            .filter(|&side| self.contact.is_none_or(|touching| touching == side))
            .filter_map(|side| first_contact(self.open_polynomial(side, h, &attempt), 1.0).map(|s| (s, side)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((s, side)) = first else { return (h, attempt, None) };
        let (system, sign) = (self.system, self.open_sign(side));
        let opening = |y: &[f64; N]| sign * system.rapprochement(y)[side as usize];
        let Knot { t, y, .. } = self.now;
        // Both brackets of the secant: the first guess, and its neighbour.
        let shortest = 16.0 * f64::EPSILON * t.max(h);
        let mut length = (s * h).max(shortest);
        let mut best: Option<(f64, Attempt<N>)> = None;
        let mut previous: Option<(f64, f64)> = None;
        for _ in 0..8 {
            self.work.evaluations += M::EVALUATIONS;
            let Some(shorter) = M::attempt(self.system, t, &y, &self.slope, length) else { break };
            let value = opening(&shorter.y);
            let slope = match previous {
                Some((at, old)) if at != length => (value - old) / (length - at),
                _ => {
                    // Relative speed of the walls from the step's own end slopes.
                    let ahead: [f64; N] = std::array::from_fn(|i| shorter.y[i] + 1e-6 * h * shorter.slope[i]);
                    (opening(&ahead) - value) / (1e-6 * h)
                }
            };
            previous = Some((length, value));
            best = Some((length, shorter));
            let next = length - value / slope;
            if !(next > 0.0 && next <= h) || (next - length).abs() <= 4.0 * f64::EPSILON * t.max(h) {
                break;
            }
            length = next;
        }
        match best {
            Some((length, shorter)) => (length, shorter, Some(side)),
            None => (h, attempt, None),
        }
    }

    /// `+1` where a contact ends when the rapprochement falls through zero, `-1` where one begins when it rises.
    fn open_sign(&self, side: Side) -> f64 {
        if self.contact == Some(side) { 1.0 } else { -1.0 }
    }

    /// What keeps the present phase going, as a polynomial over the step: the gap in flight, the rapprochement in contact.
    fn open_polynomial(&self, side: Side, h: f64, attempt: &Attempt<N>) -> Polynomial<2> {
        let (i, sign) = (side as usize, self.open_sign(side));
        let z = |y: &[f64; N]| sign * self.system.rapprochement(y)[i];
        let origin = z(&[0.0; N]);
        let mut p = [0.0; 8];
        p[0] = z(&self.now.y).max(0.0);
        if self.leaving && p[0].abs() < 1e-9 {
            p[0] = 0.0;
        }
        for (c, dense) in p[1..].iter_mut().zip(&attempt.dense) {
            *c = h * (z(dense) - origin); // the rapprochement is affine in the state
        }
        Polynomial::new(&p)
    }
}
