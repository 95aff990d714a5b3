//! A piece of a contact in regularised time, as observers see it.

use super::shared::{Shared, cached, interval_key};
use crate::methods::dop853::{self, Step};
use crate::motion::form::{Form, QUINTIC};
use crate::motion::knot::{Jet, Knot};
use crate::motion::segment::Segment;
use retune_model::{Change, Growth, ORDERS, RegularisedContact, RegularisedState};
use std::cell::OnceCell;

// Components of a regularised state.
pub const Q: usize = 0;
pub const W: usize = 1;
pub const V1: usize = 3;
pub const TIME: usize = 4;

/// A piece of a contact. Its interior is reached by steps from its start, shorter than those that would reach its end.
pub struct Piece<'a> {
    pub equations: &'a RegularisedContact,
    /// Time from which the regularised state counts, s.
    pub touch_down: f64,
    pub from: &'a RegularisedState,
    /// Derivative there.
    pub slope: &'a RegularisedState,
    /// Length in θ.
    pub length: f64,
    /// Number of steps from the start to a place in it.
    pub steps: u32,
    pub ends: [Knot<4>; 2],
    /// A bound on the energy norm of the motion in it, √J.
    pub energy: f64,
    /// Bounds over all of it, for observers of the state and of its rate.
    pub bounds: [OnceCell<[Growth<ORDERS>; 2]>; 2],
    /// The cache of its observers, if they evaluate it often.
    pub shared: Option<&'a Shared>,
}

/// The moment of a regularised state.
pub fn knot(equations: &RegularisedContact, touch_down: f64, y: &RegularisedState) -> Knot<4> {
    Knot {
        t: touch_down + y[TIME],
        excitation: equations.excitation(y),
        y: equations.physical(y),
        clock: [y[Q], 0.5 * y[W]],
    }
}

/// The regularised state of a moment; `q` is taken from the clock, because it has lost digits in the state.
pub fn regularised(equations: &RegularisedContact, touch_down: f64, knot: &Knot<4>) -> RegularisedState {
    let [_, w, x1, v1, _] = equations.regularise(&knot.y);
    [knot.clock[0], w, x1, v1, knot.t - touch_down]
}

/// One step of DOP853 from `y`, with the derivative `slope` there. A speed that follows the forces does so at its end.
#[inline(always)]
pub fn step(
    equations: &RegularisedContact,
    y: &RegularisedState,
    slope: &RegularisedState,
    h: f64,
) -> Step<5> {
    let mut step = dop853::step(|y| equations.derivative(y), y, slope, h);
    if equations.is_overdamped() {
        step.y[W] = equations.following(&step.y).speed[0];
    }
    step
}

impl Segment<4> for Piece<'_> {
    fn energy(&self) -> f64 {
        self.energy
    }
    fn ends(&self) -> [&Knot<4>; 2] {
        [&self.ends[0], &self.ends[1]]
    }
    fn length(&self) -> f64 {
        self.length
    }
    fn at(&self, theta: f64) -> Knot<4> {
        let reach = || knot(self.equations, self.touch_down, &self.advance(theta));
        cached(self.shared.map(|shared| &shared.moments), theta, reach)
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        let (_, y) = at_elapsed(|theta| self.advance(theta), self.length, t - self.touch_down);
        Knot { t, ..knot(self.equations, self.touch_down, &y) }
    }
    fn in_flight(&self) -> bool {
        self.equations.has_no_force()
    }
    fn jet(&self, at: &Knot<4>) -> Option<Jet<4>> {
        self.equations.is_overdamped().then(|| {
            let (states, force) = self.equations.jet(&self.state(at));
            Jet { states, force }
        })
    }
    /// Measured by `just lab hunt-durations`: the law of a restitution enters forces and bounds; where it is not tabulated, it takes an
    /// iteration.
    fn cost(&self) -> u64 {
        self.equations.restoring().map_or(1, |law| if law.is_tabulated() { 3 } else { 12 })
    }
    fn quintic_error(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64, _sharp: bool) -> Option<f64> {
        let bound = || self.growth(form, ends, h);
        let computed;
        let [growth, rates] = if h == self.length {
            self.bounds[usize::from(form.is_rated())].get_or_init(bound)
        } else {
            let cache = self.shared.map(|shared| &shared.growths[usize::from(form.is_rated())]);
            computed = cached(cache, interval_key(ends, h), bound);
            &computed
        };
        Some(QUINTIC * 720.0 * h.powi(6) * form.in_contact::<ORDERS>(growth, rates, 6)) // 6! of a Taylor coefficient
    }

    fn rise(&self, form: &Form<4>, ends: [&Knot<4>; 2], slopes: [f64; 2], h: f64) -> f64 {
        self.change(ends, h).map_or(f64::INFINITY, |change| form.rise_between(&change, slopes, h))
    }
}

impl Piece<'_> {
    fn state(&self, knot: &Knot<4>) -> RegularisedState {
        regularised(self.equations, self.touch_down, knot)
    }

    /// Bounds on the change of the motion between two places `h` apart.
    fn change(&self, ends: [&Knot<4>; 2], h: f64) -> Option<Change> {
        let bound = || {
            let states = ends.map(|knot| self.state(knot));
            self.equations.change(h, states.each_ref())
        };
        cached(self.shared.map(|shared| &shared.changes), interval_key(ends, h), bound)
    }

    /// Bounds between two places `h` apart; those of the rates where a form needs them.
    fn growth(&self, form: &Form<4>, ends: [&Knot<4>; 2], h: f64) -> [Growth<ORDERS>; 2] {
        let (states, change) = (ends.map(|knot| self.state(knot)), self.change(ends, h));
        if form.is_rated() {
            self.equations.growth_of_rates(states.each_ref(), &change)
        } else {
            [self.equations.growth(states.each_ref(), &change), [[0.0; ORDERS]; 4]]
        }
    }

    /// Corrects the length by one step of Newton's iteration: the piece ends at its time, or where it is to leave the wall.
    pub fn meet_end(&mut self) {
        let y = self.advance(self.length);
        let [t, q] = [self.ends[1].t - self.touch_down, self.ends[1].clock[0]];
        self.length -= if q > 0.0 { (y[TIME] - t) / y[Q] } else { 2.0 * y[Q] / y[W] };
    }

    /// The state at `θ`.
    pub fn advance(&self, theta: f64) -> RegularisedState {
        let h = theta / f64::from(self.steps);
        let mut y = step(self.equations, self.from, self.slope, h).y;
        for _ in 1..self.steps {
            y = step(self.equations, &y, &self.equations.derivative(&y), h).y;
        }
        y
    }
}

/// The `θ` and the state when `elapsed` seconds have passed since touch-down, within a piece of `length`: time grows with θ, so Newton's
/// iteration safeguarded by bisection finds it.
pub fn at_elapsed(
    advance: impl Fn(f64) -> RegularisedState,
    length: f64,
    elapsed: f64,
) -> (f64, RegularisedState) {
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
