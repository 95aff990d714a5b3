//! One contact, from touch-down to lift-off, in regularised time (equations: `retune_model::Compression`).
//!
//! The equations are polynomial there, so DOP853 keeps its order through both ends of the contact. Steps are planned from the
//! undisturbed Hertz collision, whose shape is the same for every speed, and the error estimate checks each. Lift-off is a
//! simple root of `q`: a step aimed at it and a last short one with `q` as the independent variable (M. Hénon, Physica D 5,
//! 1982) reach it without iteration.

mod plan;

use crate::budget::Budget;
use crate::dop853::{self, EVALUATIONS, Step};
use crate::observe::{Form, Knot, Observer, Segment};
use crate::peak::QUINTIC;
use crate::settings::{SolverError, Work};
use plan::Plan;
use retune_model::{Compressed, Compression, ORDERS};

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
const V1: usize = 3;
const TIME: usize = 4;

/// A piece of a contact. Its interior is reached by steps from its start, shorter than those that would reach its end.
pub struct Piece<'a> {
    pub equations: &'a Compression,
    /// Time from which the regularised state counts, s.
    pub touch_down: f64,
    pub from: &'a Compressed,
    /// Derivative there.
    pub slope: &'a Compressed,
    /// Length in θ.
    pub length: f64,
    /// Steps in which it is reached.
    pub steps: u32,
    pub ends: [Knot<4>; 2],
}

fn knot(equations: &Compression, touch_down: f64, y: &Compressed) -> Knot<4> {
    Knot {
        t: touch_down + y[TIME],
        drive: equations.drive(y),
        y: equations.expand(y),
        clock: [y[Q], 0.5 * y[W]],
    }
}

#[inline(always)]
fn step(equations: &Compression, y: &Compressed, slope: &Compressed, h: f64) -> Step<5> {
    dop853::step(|y| equations.derivative(y), y, slope, h)
}

impl Segment<4> for Piece<'_> {
    fn ends(&self) -> [&Knot<4>; 2] {
        [&self.ends[0], &self.ends[1]]
    }
    fn length(&self) -> f64 {
        self.length
    }
    fn at(&self, theta: f64) -> Knot<4> {
        knot(self.equations, self.touch_down, &self.advance(theta))
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        let (_, y) = at_elapsed(|theta| self.advance(theta), self.length, t - self.touch_down);
        Knot { t, ..knot(self.equations, self.touch_down, &y) }
    }
    fn quintic_error(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64, _sharp: bool) -> Option<f64> {
        // `q` is on the clock: in the state it has lost digits.
        let [from, to] = ends.map(|knot| {
            let [_, w, x1, v1, _] = self.equations.compress(&knot.y);
            [knot.clock[0], w, x1, v1, 0.0]
        });
        let growth = self.equations.growth(h, &from, &to);
        Some(QUINTIC * 720.0 * h.powi(6) * form.in_contact::<ORDERS>(&growth, 6)) // 6! of a Taylor coefficient
    }
}

impl Piece<'_> {
    fn advance(&self, theta: f64) -> Compressed {
        let h = theta / f64::from(self.steps);
        let mut y = step(self.equations, self.from, self.slope, h).y;
        for _ in 1..self.steps {
            y = step(self.equations, &y, &self.equations.derivative(&y), h).y;
        }
        y
    }
}

/// The `θ` and the state when `elapsed` seconds have passed since touch-down, within a piece of `length`: time grows with
/// θ, so Newton's iteration kept inside by bisection finds it.
fn at_elapsed(advance: impl Fn(f64) -> Compressed, length: f64, elapsed: f64) -> (f64, Compressed) {
    let (mut lower, mut upper, mut theta) = (0.0, length, 0.5 * length);
    let mut y = advance(theta);
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
        y = advance(theta);
    }
    (theta, y)
}

/// Integrates a contact that begins (or goes on) at `from`, regularised `y`, until lift-off or time `to`.
///
/// `rtol` is the error allowed in a step, relative to the largest `q` and the largest speed of this contact; in a long press, to
/// those of late.
///
/// # Errors
/// [`SolverError`] with the time reached: the step underflows, the state is not finite, or the work is more than allowed.
#[inline(always)]
pub fn integrate(
    mut equations: Compression,
    from: &Knot<4>,
    mut y: Compressed,
    to: f64,
    (rtol, budget): (f64, Budget),
    work: &mut Work,
    observer: &mut impl Observer<4>,
) -> Result<End, SolverError> {
    let touch_down = from.t;
    equations.set_drive(y[TIME], from.drive);
    let mut plan = Plan::new(&equations, &y, rtol);
    let shortest = plan.h * 1e-12;
    let mut start = Knot { clock: [y[Q], 0.5 * y[W]], ..*from };
    loop {
        // The force is a polynomial about the start of the step: the step is planned not to outrun it, and checked.
        equations.set_drive(y[TIME], start.drive);
        let reach = Compression::TURN / (equations.frequency() * plan.q);
        // A step aimed at the wall if it is near enough; the aim need not be good (see `reach_wall`).
        let unhindered = plan.step(&y);
        let planned = unhindered.min(reach);
        let left = if y[W] < 0.0 { equations.theta_to_wall(&y) } else { f64::INFINITY };
        let h = if left < (1.2 * planned).min(reach) { left } else { planned };
        let slope = equations.derivative(&y);
        let tried = step(&equations, &y, &slope, h);
        work.evaluations += EVALUATIONS + 1;
        let error = plan.error(h, &tried, rtol);
        let t = touch_down + y[TIME];
        let shortened = (h / unhindered).min(1.0);
        let lifting = tried.y[W] < 0.0 && tried.y[Q] < 0.02 * plan.q;
        let wall = if lifting { reach_wall(&equations, &tried.y, &plan, rtol, work) } else { None };
        // Where a step ends that goes on to the wall: it is the last piece, and may hardly be longer than the one tried.
        let to_wall = |wall: &Compressed| h - 4.0 * tried.y[Q] / (tried.y[W] + wall[W]); // dq/dθ = w/2
        let wall = wall.filter(|wall| to_wall(wall) <= 1.1 * h);
        // Past the wall there is no contact: a step must end where the wall can be reached from. Nor may it outrun the force.
        let turn = equations.frequency() * (tried.y[TIME] - y[TIME]);
        let lost = (tried.y[Q] < 0.0 && wall.is_none()) || turn > 2.0 * Compression::TURN;
        if error.is_nan() || error > 1.0 || lost {
            work.rejected += 1;
            plan.refuse(if lost { f64::INFINITY } else { error }, shortened, &y);
            if !y.iter().all(|v| v.is_finite()) {
                return Err(SolverError::NonFinite { t });
            }
            // Steps that are tried are work as well.
            budget.check(work.steps + work.rejected, t)?;
            if plan.h < shortest {
                return Err(SolverError::Contact { t });
            }
            continue;
        }
        work.steps += 1;
        budget.check(work.steps, t)?;
        let (mut next, mut length) = (tried.y, h);
        if let Some(wall) = wall {
            (next, length) = (wall, to_wall(&wall));
        }
        let over = touch_down + next[TIME] >= to;
        if over {
            let advance = |theta: f64| step(&equations, &y, &slope, theta).y;
            (length, next) = at_elapsed(advance, length, to - touch_down);
        }
        let mut end = knot(&equations, touch_down, &next);
        if over {
            end.t = to;
        }
        let piece = Piece {
            equations: &equations,
            touch_down,
            from: &y,
            slope: &slope,
            length,
            steps: 1,
            ends: [start, end],
        };
        observer.segment(&piece);
        if over || observer.satisfied() {
            return Ok(End::Pressed(end));
        }
        if wall.is_some() {
            return Ok(End::LiftOff(end));
        }
        let seconds = next[TIME] - y[TIME];
        plan.adapt(&equations, error, (shortened, seconds), &next, rtol);
        y = next;
        start = end;
    }
}

/// The state at the wall, `q = 0`, from one near it on either side (past lift-off the polynomial equations still hold), with
/// `q` as the independent variable: one step of the classical Runge–Kutta method if the speed and the force hardly change on
/// the way, else one of DOP853; none where that is not good enough, for the damper leaves too slowly.
fn reach_wall(
    equations: &Compression,
    y: &Compressed,
    plan: &Plan,
    rtol: f64,
    work: &mut Work,
) -> Option<Compressed> {
    let by_q = |y: &Compressed| {
        let slope = equations.derivative(y);
        slope.map(|s| s / slope[Q])
    };
    let (k1, h) = (by_q(y), -y[Q]);
    let (z, speed) = (h * h, y[W].abs());
    // What each force by itself changes the speed by: their sum may be small by chance.
    let pull = equations.mass_ratio() * equations.size_of_terms(y);
    let change = z * (pull / speed + equations.frequency());
    let mut end = if change < 1e-3 * speed {
        work.evaluations += 4;
        let along = |k: &Compressed, h: f64| std::array::from_fn::<f64, 5, _>(|i| y[i] + h * k[i]);
        let k2 = by_q(&along(&k1, 0.5 * h));
        let k3 = by_q(&along(&k2, 0.5 * h));
        let k4 = by_q(&along(&k3, h));
        along(&std::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0), h)
    } else {
        work.evaluations += EVALUATIONS + 1;
        let step = dop853::step(by_q, y, &k1, h);
        let error = plan.error(h, &step, rtol);
        if error.is_nan() || error > 1.0 || step.y[W] >= 0.0 {
            return None;
        }
        step.y
    };
    end[Q] = 0.0;
    Some(end)
}
