//! The hybrid propagator: exact linear flight between contacts, regularised contacts, both ends located to rounding.
//!
//! Flight steps are exact whatever their length, so the only error made is that of the contact phase (see `contact`), and a
//! flight step must only be short enough to *see* a contact: a certified bound on the gap over the step decides at once in
//! nearly all cases, an exact polynomial search (`gap`) in the rest.

use crate::collision::Collisions;
use crate::contact;
use crate::flow::{Expansion, Flow, Series, TERMS};
use crate::gap::{cubic_floor, first_contact};
use crate::observe::{Knot, Observer, Segment};
use crate::rule::each;
use crate::settings::{SolverError, Work};
use crate::system::{Linear, LinearSystem, gap};
use retune_model::{Compression, Coupled, Side};
use std::cell::OnceCell;

/// What the damper is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Between the walls.
    Flight,
    /// Between the walls, having just left one, where the gap is zero by definition rather than by arithmetic.
    Leaving(Side),
    /// Pressed into a wall.
    Pressed(Side),
}

/// A moment from which the motion can be continued.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Time, s.
    pub t: f64,
    /// `[x1, v1, x2, v2]`.
    pub y: [f64; 4],
    /// What the damper is doing.
    pub phase: Phase,
}

/// The propagator of one coupled system. Preparing it costs about as much as a hundred flight steps; it allocates nothing.
pub struct Hybrid<'a> {
    system: &'a Coupled,
    flow: Flow<4>,
    stroke: Series<4>,
    contacts: [Compression; 2],
    collisions: [Collisions; 2],
    /// `|d⁴r/dt⁴| <= fourth[0] e + fourth[1]` at energy norm `e` (√J), m/s⁴.
    fourth: [f64; 2],
    rtol: f64,
    max_steps: u64,
    /// Work done so far.
    pub work: Work,
}

enum FlightEnd {
    TouchDown(Side, Knot<4>),
    Stopped(Knot<4>),
}

/// Steps after which the energy, which bounds how the gap can bend, is looked up.
const LOOKS: f64 = 4.0;

/// The row that picks `r = x2 - x1` from a state.
const STROKE: [f64; 4] = [-1.0, 0.0, 1.0, 0.0];

struct Flight<'a> {
    flow: &'a Flow<4>,
    ends: [&'a Knot<4>; 2],
    length: f64,
    expansion: &'a OnceCell<Expansion<4>>,
}

impl Segment<4> for Flight<'_> {
    fn ends(&self) -> [&Knot<4>; 2] {
        self.ends
    }
    fn length(&self) -> f64 {
        self.length
    }
    fn at(&self, theta: f64) -> Knot<4> {
        let from = self.ends[0];
        let expansion = self.expansion.get_or_init(|| self.flow.expand(from.drive, &from.y));
        flight_knot(self.flow, from, expansion, theta)
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        Knot { t, ..self.at(t - self.ends[0].t) }
    }
}

fn flight_knot(flow: &Flow<4>, from: &Knot<4>, expansion: &Expansion<4>, s: f64) -> Knot<4> {
    Knot { t: from.t + s, drive: flow.drive_after(from.drive, s), y: expansion.at(s), clock: [1.0, 0.0] }
}

impl<'a> Hybrid<'a> {
    /// Prepares the propagator. `rtol` is the relative error allowed in a step of a contact, `longest` (s) the longest
    /// flight step, `max_steps` the most steps a run may take.
    pub fn new(system: &'a Coupled, rtol: f64, longest: f64, max_steps: u64) -> Self {
        let linear = system.linear();
        let flow = Flow::new(linear, longest);
        Self {
            system,
            collisions: Side::BOTH.map(|side| Collisions::new(system, side, &flow, rtol)),
            stroke: flow.series(&STROKE),
            flow,
            contacts: Side::BOTH.map(|side| system.compression(side)),
            fourth: fourth_derivative_bound(system, &linear),
            rtol,
            max_steps,
            work: Work::default(),
        }
    }

    /// Follows the motion to time `to` (s) or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    #[inline(always)]
    pub fn propagate(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<Motion, SolverError> {
        self.flow.check_step(from.t, to)?;
        let mut phase = from.phase;
        let mut now = self.knot(from.t, from.y);
        let stopped = |now: Knot<4>, phase| Ok(Motion { t: now.t, y: now.y, phase });
        loop {
            if let Phase::Pressed(side) = phase {
                let equations = self.contacts[side as usize];
                let pressed = equations.compress(&now.y);
                match self.contact(equations, &now, pressed, to, observer)? {
                    contact::End::Pressed(end) => return stopped(end, phase),
                    contact::End::LiftOff(end) => now = self.knot(end.t, end.y),
                }
                phase = Phase::Leaving(side);
            }
            match self.flight(now, phase, to, observer)? {
                FlightEnd::Stopped(end) => return stopped(end, Phase::Flight),
                FlightEnd::TouchDown(side, touch) => {
                    // A damper that rests on a wall from the start has not struck it.
                    let closing = side.sign() * (touch.y[3] - touch.y[1]);
                    if touch.t > from.t || closing > 0.0 {
                        observer.touch_down(touch.t, side);
                    }
                    if let Some((t, y, evaluations)) =
                        self.collisions[side as usize].collide(&self.flow, touch, to, observer)
                    {
                        self.work.steps += 1;
                        self.work.evaluations += evaluations;
                        now = self.knot(t, y);
                        phase = Phase::Leaving(side);
                        if observer.satisfied() {
                            return stopped(now, phase);
                        }
                        continue;
                    }
                    let equations = self.contacts[side as usize];
                    let (begin, pressed) = self.press_in(equations, touch, observer)?;
                    match self.contact(equations, &begin, pressed, to, observer)? {
                        contact::End::Pressed(end) => return stopped(end, Phase::Pressed(side)),
                        contact::End::LiftOff(end) => now = self.knot(end.t, end.y),
                    }
                    phase = Phase::Leaving(side);
                }
            }
            if observer.satisfied() || now.t >= to {
                return stopped(now, phase);
            }
        }
    }

    fn knot(&self, t: f64, y: [f64; 4]) -> Knot<4> {
        Knot { t, drive: self.system.drive(t), y, clock: [1.0, 0.0] }
    }

    fn contact(
        &mut self,
        equations: Compression,
        from: &Knot<4>,
        pressed: retune_model::Compressed,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<contact::End, SolverError> {
        contact::integrate(
            equations,
            from,
            pressed,
            to,
            (self.rtol, self.max_steps),
            &mut self.work,
            observer,
        )
    }

    /// Flies until a touch-down, until `to`, or until the observer is satisfied.
    #[inline(always)]
    fn flight(
        &mut self,
        from: Knot<4>,
        phase: Phase,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<FlightEnd, SolverError> {
        let whole = self.flow.step();
        let slack = whole.powi(4) / 384.0;
        let growth = self.system.energy_norm_growth() * whole;
        let mut energy = 0.0; // a bound, looked up again after a few steps
        let mut now = from;
        let mut count = 0.0; // steps since `from`: time is counted, not accumulated
        let mut leaving = if let Phase::Leaving(side) = phase { Some(side) } else { None };
        loop {
            let remaining = to - now.t;
            if remaining <= 0.0 {
                return Ok(FlightEnd::Stopped(now));
            }
            self.work.steps += 1;
            if self.work.steps > self.max_steps {
                return Err(SolverError::TooManySteps { t: now.t, limit: self.max_steps });
            }
            let (drive, y) = self.flow.advance(now.drive, &now.y);
            if count % LOOKS == 0.0 {
                energy = self.system.energy_norm(&now.y);
                if !energy.is_finite() {
                    return Err(SolverError::NonFinite { t: now.t });
                }
            }
            energy += growth;
            count += 1.0;
            let mut end = Knot { t: from.t + count * whole, drive, y, clock: [1.0, 0.0] };
            let margin = slack * (self.fourth[0] * energy + self.fourth[1]);
            let rates = |y: &[f64; 4]| [y[2] - y[0], y[3] - y[1]];
            let ([r0, w0], [r1, w1]) = (rates(&now.y), rates(&end.y));
            let open = Side::BOTH.map(|side| {
                let sign = -side.sign();
                let ends = [[gap(self.system, side, r0), sign * w0], [gap(self.system, side, r1), sign * w1]];
                cubic_floor(whole, ends[0], ends[1]) > margin
            });
            let expansion = OnceCell::new();
            let mut length = whole;
            let mut touched = None;
            if open != [true; 2] || remaining < whole {
                length = whole.min(remaining);
                let stroke = self.stroke.expand(now.drive, &now.y);
                for side in Side::BOTH.into_iter().filter(|&side| !open[side as usize]) {
                    if let Some(s) = first_contact(&self.gap_polynomial(&stroke, side, leaving), length) {
                        (length, touched) = (s, Some(side));
                    }
                }
                if length < whole {
                    let motion = self.flow.expand(now.drive, &now.y);
                    end = flight_knot(&self.flow, &now, &motion, length);
                    if touched.is_none() {
                        end.t = to;
                    }
                    let _ = expansion.set(motion);
                }
            }
            if length > 0.0 {
                observer.segment(&Flight {
                    flow: &self.flow,
                    ends: [&now, &end],
                    length,
                    expansion: &expansion,
                });
            }
            if let Some(side) = touched {
                end.y[2] = end.y[0] + self.system.wall(side);
                return Ok(FlightEnd::TouchDown(side, end));
            }
            if observer.satisfied() {
                return Ok(FlightEnd::Stopped(end));
            }
            now = end;
            leaving = None;
        }
    }

    /// The gap to a wall over the next step as a polynomial. A damper on the wall, by definition or to rounding, has none.
    fn gap_polynomial(&self, stroke: &[f64; TERMS], side: Side, leaving: Option<Side>) -> [f64; TERMS] {
        let mut p: [f64; TERMS] = each(|k| -side.sign() * stroke[k]);
        p[0] =
            if leaving == Some(side) { 0.0 } else { (p[0] + side.sign() * self.system.wall(side)).max(0.0) };
        p
    }

    /// Starts a contact at a touch-down. One that begins (almost) at rest has no time scale of its own at `q = 0`: it is flown
    /// on for the moment in which the contact force cannot be felt, less than one part in 1e14 of the motion.
    fn press_in(
        &mut self,
        mut equations: Compression,
        touch: Knot<4>,
        observer: &mut impl Observer<4>,
    ) -> Result<(Knot<4>, retune_model::Compressed), SolverError> {
        let mut pressed = equations.compress(&touch.y);
        pressed[0] = 0.0;
        equations.set_drive(0.0, touch.drive);
        let (speed, pull) = (pressed[1], equations.acceleration(&pressed));
        // After `s` seconds at this speed the force has moved the damper by `κ √z s²` of `z = w s`.
        let slow = |s: f64| speed <= pull * s;
        if speed > 0.0 && !slow((1e-28 / (equations.hertz_rate().powi(2) * speed)).powf(0.2)) {
            return Ok((touch, pressed)); // fast enough to start at q = 0
        }
        let unfelt = |s: f64, z: f64| z > 0.0 && equations.hertz_rate() * z.sqrt() * s * s <= 1e-14;
        let motion = self.flow.expand(touch.drive, &touch.y);
        let stroke = self.stroke.expand(touch.drive, &touch.y);
        let rate: [f64; TERMS - 1] = std::array::from_fn(|k| (k + 1) as f64 * stroke[k + 1]);
        let sign = equations.side().sign();
        let value = |p: &[f64], s: f64| sign * p.iter().rev().fold(0.0, |sum, c| sum * s + c);
        let mut s = self.flow.step();
        for _ in 0..400 {
            let z = s * value(&stroke[1..], s);
            if unfelt(s, z) {
                let mut end = flight_knot(&self.flow, &touch, &motion, s);
                end.y[2] = end.y[0] + self.system.wall(equations.side()) + sign * z;
                let mut pressed = equations.compress(&end.y);
                (pressed[0], pressed[1]) = (z.sqrt(), value(&rate, s));
                let expansion = OnceCell::from(motion);
                observer.segment(&Flight {
                    flow: &self.flow,
                    ends: [&touch, &end],
                    length: s,
                    expansion: &expansion,
                });
                return Ok((end, pressed));
            }
            s *= 0.5;
        }
        Err(SolverError::StepTooSmall { t: touch.t, h: s })
    }
}

/// Coefficients of a bound on `|d⁴r/dt⁴|` in flight, from `r⁗ = ρ A⁴ (y - y0) + P-terms`, with ρ the row of `r`:
/// the dual energy norm of `ρ A⁴`, and `P (|ρA³b| + ω |ρA²b| + ω² |ρAb| + ω³ |ρb|)`.
fn fourth_derivative_bound(system: &Coupled, linear: &Linear<4>) -> [f64; 2] {
    let amplitude = system.drive(0.0)[0];
    let dot = |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut row, mut forced) = (STROKE, 0.0);
    for _ in 0..4 {
        forced = forced * linear.frequency + dot(&row, &linear.input).abs();
        row = linear.columns.map(|column| dot(&row, &column));
    }
    [system.dual_energy_norm(&row), amplitude * forced]
}
