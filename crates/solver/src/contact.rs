//! One contact, from touch-down to lift-off, in regularised time (see `retune_model::Compression`).
//!
//! The equations are polynomial there, so DOP853 keeps its order through both ends of the contact, and lift-off is a simple
//! root of `q`, reached without iteration by one step with `q` as the independent variable (M. Hénon, Physica D 5, 1982).

use crate::dop853::{self, EVALUATIONS, Step};
use crate::observe::{Knot, Observer, Segment};
use crate::settings::{SolverError, Work};
use retune_model::{Compressed, Compression};

/// How a contact ended.
pub enum End {
    /// The damper left the wall.
    LiftOff(Knot<4>),
    /// The run ended, or the observer had seen enough, with the damper still pressed in.
    Pressed(Knot<4>),
}

// Components of a regularised state.
const Q: usize = 0;
const W: usize = 1;
const TIME: usize = 6;
const THETA: usize = 7;

/// One step. Its interior is reached by shorter steps from its start.
struct Piece<'a> {
    equations: &'a Compression,
    touch_down: f64,
    from: &'a Compressed,
    slope: &'a Compressed,
    length: f64,
    ends: [Knot<4>; 2],
}

fn knot(equations: &Compression, touch_down: f64, y: &Compressed) -> Knot<4> {
    Knot { t: touch_down + y[TIME], drive: [y[4], y[5]], y: equations.expand(y), clock: [y[Q], 0.5 * y[W]] }
}

impl Segment<4> for Piece<'_> {
    fn ends(&self) -> [&Knot<4>; 2] {
        [&self.ends[0], &self.ends[1]]
    }
    fn length(&self) -> f64 {
        self.length
    }
    fn at(&self, theta: f64) -> Knot<4> {
        knot(self.equations, self.touch_down, &step(self.equations, self.from, self.slope, theta).y)
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        let y = at_elapsed(self.equations, self.from, self.slope, self.length, t - self.touch_down);
        knot(self.equations, self.touch_down, &y)
    }
}

/// A step of length `h` in `θ`.
#[inline(always)]
fn step(equations: &Compression, y: &Compressed, slope: &Compressed, h: f64) -> Step<8> {
    dop853::step(|y| equations.derivative(y), y, slope, h)
}

/// The step to the wall, with `q` as the independent variable: `dy/dq = (dy/dθ) / (w/2)`, from `q` to 0.
fn step_to_wall(equations: &Compression, y: &Compressed, slope: &Compressed) -> Step<8> {
    let by_q = |slope: Compressed| slope.map(|s| s / slope[Q]);
    let mut step = dop853::step(|y| by_q(equations.derivative(y)), y, &by_q(*slope), -y[Q]);
    step.y[Q] = 0.0;
    step
}

/// The state when `elapsed` seconds have passed since touch-down, within the step of `length` from `from`: time grows with θ.
fn at_elapsed(
    equations: &Compression,
    from: &Compressed,
    slope: &Compressed,
    length: f64,
    elapsed: f64,
) -> Compressed {
    let (mut lower, mut upper, mut theta) = (0.0, length, 0.5 * length);
    let mut y = step(equations, from, slope, theta).y;
    for _ in 0..100 {
        let excess = y[TIME] - elapsed;
        if excess < 0.0 {
            lower = theta
        } else {
            upper = theta
        }
        let newton = theta - excess / y[Q];
        let next = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        if (next - theta).abs() <= 2.0 * f64::EPSILON * length {
            break;
        }
        theta = next;
        y = step(equations, from, slope, theta).y;
    }
    y[TIME] = elapsed;
    y
}

/// The natural sizes of a contact: errors are measured against the largest `q` and `|w|` that it has seen.
struct Scale {
    q: f64,
    w: f64,
    collision: f64,
}

impl Scale {
    fn new(equations: &Compression, y: &Compressed) -> Self {
        // A contact that begins pressed in, or at rest, is as long as the collision that would reach as deep.
        let speed = y[W].abs().max(equations.speed_at_depth(y[Q]));
        let (collision, q) = equations.collision(speed);
        Self { q, w: speed, collision }
    }

    fn see(&mut self, y: &Compressed) {
        self.q = self.q.max(y[Q].abs());
        self.w = self.w.max(y[W].abs());
    }

    /// The error of a step over what is allowed.
    fn error(&self, h: f64, step: &Step<8>, rtol: f64, mass_ratio: f64) -> f64 {
        let (q, w) = (1.0 / (rtol * self.q), 1.0 / (rtol * self.w));
        step.error(h, &[q, w, 0.0, w * mass_ratio, 0.0, 0.0, 0.0, 0.0], 3.0)
    }
}

/// Steps that a collision takes at a tolerance, from the error constant measured on undisturbed Hertz collisions.
fn steps_of_a_collision(rtol: f64) -> f64 {
    (0.35 * rtol.powf(-1.0 / 8.0)).max(2.0)
}

/// Integrates a contact that begins (or goes on) at `from`, regularised `y`, until lift-off or time `to`.
///
/// `rtol` is the error allowed in a step, relative to the largest `q` and the largest speed of this contact.
///
/// # Errors
/// [`SolverError`] with the time reached: the step underflows, the state is not finite, or the work is more than allowed.
#[inline(always)]
pub fn integrate(
    equations: &Compression,
    from: &Knot<4>,
    mut y: Compressed,
    to: f64,
    (rtol, max_steps): (f64, u64),
    work: &mut Work,
    observer: &mut impl Observer<4>,
) -> Result<End, SolverError> {
    let touch_down = from.t;
    let mass_ratio = equations.mass_ratio();
    let mut scale = Scale::new(equations, &y);
    let shortest = scale.collision * 1e-12;
    let mut h = scale.collision / steps_of_a_collision(rtol);
    let mut start = Knot { clock: [y[Q], 0.5 * y[W]], ..*from };
    loop {
        let slope = equations.derivative(&y);
        let lifting = y[W] < 0.0 && y[Q] < -1.1 * h * slope[Q];
        let tried =
            if lifting { step_to_wall(equations, &y, &slope) } else { step(equations, &y, &slope, h) };
        work.evaluations += EVALUATIONS + 1;
        let length = if lifting { tried.y[THETA] - y[THETA] } else { h };
        let error = scale.error(if lifting { y[Q] } else { h }, &tried, rtol, mass_ratio);
        if !(error <= 1.0 && length > 0.0 && (!lifting || tried.y[W] < 0.0)) {
            work.rejected += 1;
            h *= if error.is_finite() { (0.9 * error.powf(-1.0 / 8.0)).clamp(0.1, 0.7) } else { 0.1 };
            let t = touch_down + y[TIME];
            if !y.iter().all(|v| v.is_finite()) {
                return Err(SolverError::NonFinite { t });
            }
            if h < shortest {
                return Err(SolverError::StepTooSmall { t, h: h * y[Q] });
            }
            continue;
        }
        work.steps += 1;
        if work.steps > max_steps {
            return Err(SolverError::TooManySteps { t: touch_down + y[TIME], limit: max_steps });
        }
        let (mut next, mut lifted) = (tried.y, lifting);
        if next[Q] < 0.0 {
            // The step ran past lift-off, where the polynomial equations still hold: step back to the wall.
            next = step_to_wall(equations, &next, &equations.derivative(&next)).y;
            work.evaluations += EVALUATIONS + 1;
            lifted = true;
        }
        let over = touch_down + next[TIME] >= to;
        if over {
            next = at_elapsed(equations, &y, &slope, next[THETA] - y[THETA], to - touch_down);
        }
        let mut end = knot(equations, touch_down, &next);
        if over {
            end.t = to;
        }
        let piece = Piece {
            equations,
            touch_down,
            from: &y,
            slope: &slope,
            length: next[THETA] - y[THETA],
            ends: [start, end],
        };
        observer.segment(&piece);
        if over || observer.satisfied() {
            return Ok(End::Pressed(end));
        }
        if lifted {
            return Ok(End::LiftOff(end));
        }
        if !lifting {
            h *= (0.9 * error.powf(-1.0 / 8.0)).clamp(0.3, 3.0);
        }
        scale.see(&next);
        y = next;
        start = end;
    }
}
