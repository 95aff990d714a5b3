//! The loop over the steps of one contact, from touch-down (or a state in contact) to lift-off.

use super::piece::{Piece, Q, TIME, W, at_elapsed, knot, step};
use super::plan::Plan;
use super::shared::Shared;
use crate::budget::Budget;
use crate::error::SolverError;
use crate::methods::dop853::{self, EVALUATIONS};
use crate::motion::knot::Knot;
use crate::observe::observer::Observer;
use crate::response::Work;
use retune_model::{Coupled, RegularisedContact, RegularisedState};

/// How a contact ended.
pub enum End {
    /// The damper left the wall.
    LiftOff(Knot<4>),
    /// The run ended, or the observer was satisfied, while the damper was in contact.
    InContact(Knot<4>),
}

/// Integrates a contact that begins (or continues) at `from`, regularised `y`, until lift-off or time `to`.
///
/// `rtol` is the error allowed in a step, relative to the largest `q` and the largest speed of this contact; in a sustained contact,
/// relative to the recent ones. With `allow_overdamped`, the speed follows the forces once a strong dashpot's fast part of the motion has
/// decayed.
///
/// # Errors
/// [`SolverError`] with the time reached: the step underflows, the state is not finite, or the work is more than allowed.
#[inline(always)]
pub fn integrate(
    mut equations: RegularisedContact,
    from: &Knot<4>,
    y: RegularisedState,
    to: f64,
    (system, rtol, budget, allow_overdamped): (&Coupled, f64, Budget, bool),
    (work, shared): (&mut Work, &Shared),
    observer: &mut (impl Observer<4> + ?Sized),
) -> Result<End, SolverError> {
    equations.set_excitation(y[TIME], from.excitation);
    equations.set_force(equations.push(y[W]) >= 0.0);
    let plan = Plan::new(&equations, &y, rtol);
    let start = Knot { clock: [y[Q], 0.5 * y[W]], ..*from };
    let (is_soft, shortest) = (equations.is_soft(), plan.h * 1e-12);
    let mut contact =
        Contact { shortest, touch_down: from.t, equations, is_soft, to, rtol, budget, plan, start, y };
    loop {
        if allow_overdamped && contact.toggle_overdamped() {
            observer.discontinuity();
        }
        let Accepted { slope, length, next, end, is_last, lifts_off, toggles_force } =
            contact.step(work, observer.search_work())?;
        let piece = Piece {
            equations: &contact.equations,
            touch_down: contact.touch_down,
            from: &contact.y,
            slope: &slope,
            length,
            steps: 1,
            ends: [contact.start, end],
            // Walls return at most the energy that they store.
            energy: (2.0 * system.total_energy(&contact.start.y)).sqrt()
                + (end.t - contact.start.t) * system.energy_norm_growth(),
            bounds: Default::default(),
            shared: Some(shared),
        };
        shared.clear();
        if length > 0.0 {
            observer.segment(&piece);
        }
        if toggles_force {
            contact.equations.set_force(contact.equations.has_no_force());
        }
        if is_last || observer.satisfied() {
            return Ok(End::InContact(end));
        }
        if lifts_off {
            return Ok(End::LiftOff(end));
        }
        (contact.y, contact.start) = (next, end);
    }
}

/// A contact that is being integrated.
struct Contact {
    equations: RegularisedContact,
    /// Whether the force may have to be carried far.
    is_soft: bool,
    touch_down: f64,
    /// The end of the run, s.
    to: f64,
    rtol: f64,
    budget: Budget,
    plan: Plan,
    /// Least step length.
    shortest: f64,
    /// The present moment.
    start: Knot<4>,
    y: RegularisedState,
}

/// A step of a contact.
struct Accepted {
    /// The derivative at its start.
    slope: RegularisedState,
    length: f64,
    next: RegularisedState,
    end: Knot<4>,
    /// Whether the run ends there.
    is_last: bool,
    lifts_off: bool,
    /// Whether the force of a contact with loss ends there, or begins again.
    toggles_force: bool,
}

impl Contact {
    /// Leaves out the fast part of the motion if it has decayed, or restores it where the speed can no longer follow the forces; returns
    /// whether it did either.
    #[cold]
    fn toggle_overdamped(&mut self) -> bool {
        let Self { equations, y, plan, rtol, .. } = self;
        equations.set_excitation(y[TIME], self.start.excitation);
        let following = equations.following(y);
        let (accurate, speed) = (equations.error_of_following(y, &following) <= *rtol, following.speed[0]);
        if equations.is_overdamped() == accurate
            || (accurate && (speed - y[W]).abs() > plan.least_speed(*rtol))
        {
            return false;
        }
        equations.set_overdamped(accurate);
        if accurate {
            y[W] = speed;
        }
        *plan = Plan::new(equations, y, *rtol);
        true
    }

    /// The next step, of the length that its error allows. It is compiled once, not once for every observer.
    fn step(&mut self, work: &mut Work, search_work: u64) -> Result<Accepted, SolverError> {
        let Self { equations, plan, y, rtol, touch_down, .. } = self;
        let (rtol, touch_down) = (*rtol, *touch_down);
        loop {
            // The force is a polynomial about the start of the step: the step is planned not to outrun it, and checked.
            equations.set_excitation(y[TIME], self.start.excitation);
            let (unrestricted, turning) = (plan.step(y), equations.frequency() * plan.q);
            if self.is_soft && unrestricted * turning > equations.turn() {
                equations.carry_excitation();
            }
            let reach = equations.turn() / turning;
            // A step aimed at the wall if that is near enough; the aim may be rough (see `reach_wall`).
            let planned = unrestricted.min(reach);
            // The equations of a speed that follows the forces end before the wall: such a step may come to half of q.
            let left = match y[W] {
                w if w < 0.0 && equations.is_overdamped() => -y[Q] / w,
                w if w < 0.0 => equations.theta_to_wall(y),
                _ => f64::INFINITY,
            };
            let h = if left < (1.2 * planned).min(reach) { left } else { planned };
            let slope = equations.derivative(y);
            let tried = step(equations, y, &slope, h);
            work.evaluations += EVALUATIONS + 1;
            let error = plan.error(h, &tried, rtol);
            let t = touch_down + y[TIME];
            let shortened = (h / unrestricted).min(1.0);
            let lifting = tried.y[W] < 0.0 && tried.y[Q] < 0.02 * plan.q && !equations.is_overdamped();
            let wall = if lifting { reach_wall(equations, &tried.y, plan, rtol, work) } else { None };
            // The length of the last step if it is extended to the wall: at most a little longer than the one tried.
            let to_wall = |wall: &RegularisedState| h - 4.0 * tried.y[Q] / (tried.y[W] + wall[W]); // dq/dθ = w/2
            let wall = wall.filter(|wall| to_wall(wall) <= 1.1 * h);
            // Beyond the wall there is no contact: a step must end where the wall can be reached. Nor may it outrun the force.
            let turn = equations.frequency() * (tried.y[TIME] - y[TIME]);
            let lost = (tried.y[Q] < 0.0 && wall.is_none()) || turn > 2.0 * equations.turn();
            if error.is_nan() || error > 1.0 || lost {
                work.rejected += 1;
                plan.reject(if lost { f64::INFINITY } else { error }, shortened, y);
                if !y.iter().all(|v| v.is_finite()) {
                    return Err(SolverError::NonFinite { t });
                }
                self.budget.check(&work.with_search_work(search_work), t)?;
                if plan.h < self.shortest {
                    return Err(SolverError::Contact { t });
                }
                continue;
            }
            work.steps += 1;
            self.budget.check(&work.with_search_work(search_work), t)?;
            let (mut next, mut length) = (tried.y, h);
            if let Some(wall) = wall {
                (next, length) = (wall, to_wall(&wall));
            }
            let advance = |theta: f64| step(equations, y, &slope, theta).y;
            let mut is_last = touch_down + next[TIME] >= self.to;
            if is_last {
                (length, next) = at_elapsed(advance, length, self.to - touch_down);
            }
            let mut lifts_off = wall.is_some();
            let parting = if equations.may_part() {
                parting(equations, [y, &next], (&slope, length), advance)
            } else {
                None
            };
            if let Some(parted) = parting {
                (length, next) = parted;
                (is_last, lifts_off) = (false, false);
            }
            let mut end = knot(equations, touch_down, &next);
            if is_last {
                end.t = self.to;
            }
            let seconds = next[TIME] - y[TIME];
            plan.adapt(equations, error, (shortened, seconds), &next, rtol);
            return Ok(Accepted {
                slope,
                length,
                next,
                end,
                is_last,
                lifts_off,
                toggles_force: parting.is_some(),
            });
        }
    }
}

/// Where the force of a contact with loss ends within a step between two states, because it would begin to pull, or resumes after it had
/// ended: `1 + λ w = 0`. Forces are continuous there, but not their rates. Both ends of a step may lie on one side of a brief pull in it;
/// then the cubic through the speeds and their slopes shows where to look.
fn parting(
    equations: &RegularisedContact,
    [from, to]: [&RegularisedState; 2],
    (slope, length): (&RegularisedState, f64),
    advance: impl Fn(f64) -> RegularisedState,
) -> Option<(f64, RegularisedState)> {
    let sign = if equations.has_no_force() { -1.0 } else { 1.0 };
    let left = |y: &RegularisedState| sign * equations.push(y[W]);
    let (begin, end) = (left(from), left(to));
    let mut upper = length;
    if end >= 0.0 {
        let rate = |slope: &RegularisedState| sign * (equations.push(slope[W]) - 1.0) * length;
        let falling = rate(slope);
        if begin + falling >= 0.0 {
            return None;
        }
        let rising = rate(&equations.derivative(to));
        upper = length * negative_minimum([begin, end], [falling, rising])?;
        if left(&advance(upper)) >= 0.0 {
            return None;
        }
    }
    // Bisection, with Newton's step where it stays inside.
    let (mut lower, mut theta) = (0.0, 0.5 * upper);
    let mut y = advance(theta);
    for _ in 0..100 {
        if left(&y) > 0.0 {
            lower = theta
        } else {
            upper = theta
        }
        let newton = theta - (equations.push(y[W])) / (equations.push(equations.derivative(&y)[W]) - 1.0);
        let next = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        if (next - theta).abs() <= 2.0 * f64::EPSILON * length {
            break;
        }
        theta = next;
        y = advance(theta);
    }
    y[W] = equations.parting_speed();
    Some((theta, y))
}

/// Where in (0, 1) the cubic with these values and slopes at both ends has its minimum, if it has one and that is below zero.
fn negative_minimum([begin, end]: [f64; 2], [falling, rising]: [f64; 2]) -> Option<f64> {
    // c(u) = begin + falling u + b u² + a u³
    let (a, b) = (falling + rising - 2.0 * (end - begin), 3.0 * (end - begin) - 2.0 * falling - rising);
    let root = (b * b - 3.0 * a * falling).sqrt();
    let u = -falling / (b + root);
    let value = begin + u * (falling + u * (b + u * a));
    (u > 0.0 && u < 1.0 && value < 0.0).then_some(u)
}

/// The state at the wall, `q = 0`, from one near it on either side (past lift-off the polynomial equations still hold), with
/// `q` as the independent variable: one step of the classical Runge–Kutta method if the speed and the force hardly change on
/// the way, else one of DOP853; `None` where that is too inaccurate because the damper leaves too slowly.
fn reach_wall(
    equations: &RegularisedContact,
    y: &RegularisedState,
    plan: &Plan,
    rtol: f64,
    work: &mut Work,
) -> Option<RegularisedState> {
    let by_q = |y: &RegularisedState| {
        let slope = equations.derivative(y);
        slope.map(|s| s / slope[Q])
    };
    let (k1, h) = (by_q(y), -y[Q]);
    let (z, speed) = (h * h, y[W].abs());
    // The change of speed by each force alone: their sum may be small by chance.
    let pull = equations.mass_ratio() * equations.size_of_terms(y);
    let change = z * (pull / speed + equations.frequency());
    let mut end = if change < 1e-3 * speed {
        work.evaluations += 4;
        let along = |k: &RegularisedState, h: f64| std::array::from_fn::<f64, 5, _>(|i| y[i] + h * k[i]);
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
