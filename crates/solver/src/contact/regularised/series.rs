//! Contacts without loss, in steps of Taylor series: a step covers at most a given phase of the fastest motion, and observers evaluate
//! polynomials inside it.

use super::integrate::End;
use super::piece::{Q, TIME, W, at_elapsed, regularised};
use crate::budget::Budget;
use crate::error::SolverError;
use crate::motion::form::{Form, QUINTIC};
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::observe::observer::Observer;
use crate::response::Work;
use retune_model::{
    ContactSeries, Coupled, Growth, ORDERS, RegularisedContact, RegularisedState, SeriesMoment,
};
use std::cell::OnceCell;
use wide::f64x4;

/// Largest phase (rad) by which the fastest of damper, structure and force advances in a step: observers assume that a speed changes its
/// sign at most once in a segment, and that a rule of 8 nodes is exact on it.
const TURN: f64 = 1.5;

/// The number of steps after which a spring is assumed to hold the damper to its wall, and the largest phase from then on. A speed still
/// changes its sign at most once.
const HELD: (u64, f64) = (100, 3.0);

/// The share of the error allowed in a step that its last two terms may make up. The first term left out is smaller.
const TAIL_SHARE: f64 = 0.1;

/// Largest phase (rad) of the force in a step whose series carries the force on: `0.5¹⁴ / 14! = 7e-16` of it is truncated, and errors of
/// the force would accumulate.
const CARRIED_TURN: f64 = 0.5;

/// Loosest tolerance of a step: searches take slopes from the equations, which a polynomial must satisfy as accurately as its maxima are to
/// be known.
const MAX_RTOL: f64 = 1e-6;

/// Follows a contact without loss from `from`, regularised `y`, until lift-off or time `to`; `rtol` as in [`integrate`](super::integrate::integrate).
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn follow(
    mut equations: RegularisedContact,
    (mut start, mut y): (Knot<4>, RegularisedState),
    to: f64,
    (system, rtol, budget): (&Coupled, f64, Budget),
    work: &mut Work,
    observer: &mut (impl Observer<4> + ?Sized),
) -> Result<End, SolverError> {
    let (touch_down, rtol) = (start.t - y[TIME], rtol.min(MAX_RTOL));
    start.clock = [y[Q], 0.5 * y[W]];
    equations.set_excitation(y[TIME], start.excitation);
    let mut speed = 0.0_f64;
    let (mut turn, held_after) = (TURN, work.steps + HELD.0);
    let mut series = ContactSeries::for_turn(turn, rtol);
    loop {
        if work.steps == held_after {
            turn = HELD.1;
            series = ContactSeries::for_turn(turn, rtol);
        }
        // The scales of a collision that is as fast as the recent motion, or as deep.
        let deep = equations.speed_at_depth(y[Q]);
        speed = (0.5 * speed).max(y[W].abs()).max(deep);
        let depth = if speed == deep { y[Q] } else { equations.greatest_depth(speed) };
        if !depth.is_finite() {
            return Err(budget.no_progress(work, start.t)); // squares of its speed overflow
        }
        // Other forces may press it deeper: about that depth its terms are of ordinary size.
        let pressed = equations.pressed_depth(&y).max(depth);
        series.expand(&equations, &y, start.excitation, 1.0 / (pressed * equations.turning(pressed)));
        let Step { length, mut end, state, event } =
            step(&equations, &series, &y, (touch_down, to), (rtol, turn, speed, depth), work)?;
        if equations.frequency() * (end.t - start.t) > CARRIED_TURN {
            end.excitation = system.bare().turned(start.excitation, end.t - start.t);
        }
        budget.check(&work.with_search_work(observer.search_work()), end.t)?;
        let energy =
            (2.0 * system.total_energy(&start.y)).sqrt() + (end.t - start.t) * system.energy_norm_growth();
        let piece = Piece {
            equations: &equations,
            series: &series,
            touch_down,
            length,
            ends: [start, end],
            energy,
            slopes: OnceCell::new(),
            growth: OnceCell::new(),
        };
        if length > 0.0 {
            observer.segment(&piece);
        }
        match event {
            Some(Event::End) => return Ok(End::InContact(end)),
            _ if observer.satisfied() => return Ok(End::InContact(end)),
            Some(Event::LiftOff) => return Ok(End::LiftOff(end)),
            None => (start, y) = (end, state),
        }
    }
}

/// What ends a contact.
enum Event {
    LiftOff,
    /// The run ends.
    End,
}

/// A step of a contact.
struct Step {
    length: f64,
    end: Knot<4>,
    state: RegularisedState,
    event: Option<Event>,
}

/// The step from `y` along its series.
fn step(
    equations: &RegularisedContact,
    series: &ContactSeries,
    y: &RegularisedState,
    (touch_down, to): (f64, f64),
    (rtol, turn, speed, q): (f64, f64, f64, f64),
    work: &mut Work,
) -> Result<Step, SolverError> {
    work.steps += 1;
    work.evaluations += series.terms() as u64;
    let turning = equations.turning(q);
    // The rounding error of a speed: that of its rate over a radian.
    let rounding = f64::EPSILON * equations.size_of_terms(y) * equations.mass_ratio() / turning;
    let allowed = (rtol * speed).max(rounding);
    let share = TAIL_SHARE * allowed / speed;
    let sizes = [q, speed, speed / equations.mass_ratio()].map(|size| share * size);
    let mut length = series.reach(sizes, turn / (q * turning));
    let mut moment = series.at(length);
    // The polynomials must satisfy the equations at the end of the step, too.
    while equations.defect(series, length, &moment) * length * q > allowed {
        work.rejected += 1;
        length *= 0.5;
        moment = series.at(length);
    }
    if !moment.state.iter().all(|v| v.is_finite()) || length < 1e-12 * q / speed {
        let t = touch_down + y[TIME];
        let finite = y.iter().all(|v| v.is_finite());
        return Err(if finite { SolverError::Contact { t } } else { SolverError::NonFinite { t } });
    }
    let mut event = None;
    if let Some(lift_off) = first_root(&series.root(), length / series.unit()) {
        let lift_off = lift_off * series.unit();
        (length, moment, event) = (lift_off, series.at(lift_off), Some(Event::LiftOff));
        moment.state[Q] = 0.0;
    }
    let is_last = touch_down + moment.state[TIME] >= to;
    if is_last {
        (length, _) = at_elapsed(|theta| series.at(theta).state, length, to - touch_down);
        (moment, event) = (series.at(length), Some(Event::End));
    }
    let mut end = knot(equations, touch_down, &moment);
    if is_last {
        end.t = to;
    }
    Ok(Step { length, end, state: moment.state, event })
}

/// The moment of a regularised state under this excitation.
fn knot(
    equations: &RegularisedContact,
    touch_down: f64,
    SeriesMoment { state: y, excitation }: &SeriesMoment,
) -> Knot<4> {
    let clock = [y[Q], 0.5 * y[W]];
    Knot { t: touch_down + y[TIME], excitation: *excitation, y: equations.physical(y), clock }
}

/// The first root of a polynomial in (0, length], which is positive before; of one without a constant term, the first after 0.
///
/// Between two places `h` apart it is above the lower of its values there less `h²/8` times the bound on its curvature.
fn first_root(terms: &[f64], length: f64) -> Option<f64> {
    let terms = if terms[0] == 0.0 { &terms[1..] } else { terms };
    let rest = terms[1..].iter().rev().fold(0.0, |sum, term| (sum + term.abs()) * length);
    if terms[0] > rest {
        return None;
    }
    // Value and slope.
    let at = |theta: f64| {
        let [mut value, mut slope] = [0.0; 2];
        for term in terms.iter().rev() {
            slope = slope * theta + value;
            value = value * theta + term;
        }
        [value, slope]
    };
    let bend =
        (2..terms.len()).rev().fold(0.0, |sum, k| sum * length + (k * (k - 1)) as f64 * terms[k].abs());
    let mut stretches = vec![[(0.0, terms[0]), (length, at(length)[0])]];
    while let Some([(from, first), (to, last)]) = stretches.pop() {
        let h = to - from;
        if first.min(last) > 0.125 * bend * h * h {
            continue;
        }
        let [_, slope] = at(to);
        let falls = last <= 0.0 && slope + bend * h < 0.0;
        if falls || h < 1e-9 * length {
            if last <= 0.0 {
                return Some(root_between(at, from, to));
            }
            continue;
        }
        let middle = 0.5 * (from + to);
        let value = at(middle)[0];
        stretches.push([(middle, value), (to, last)]);
        stretches.push([(from, first), (middle, value)]);
    }
    None
}

/// The root of a function that falls through zero between two places, by Newton's iteration safeguarded by bisection; `at` returns value
/// and slope.
fn root_between(at: impl Fn(f64) -> [f64; 2], mut lower: f64, mut upper: f64) -> f64 {
    let (mut theta, length) = (upper, upper);
    for _ in 0..100 {
        let [value, slope] = at(theta);
        if value > 0.0 {
            lower = theta
        } else {
            upper = theta
        }
        let newton = theta - value / slope;
        let next = if newton > lower && newton < upper { newton } else { 0.5 * (lower + upper) };
        if (next - theta).abs() <= 2.0 * f64::EPSILON * length {
            break;
        }
        theta = next;
    }
    theta
}

/// A step as observers see it: a polynomial.
struct Piece<'a> {
    equations: &'a RegularisedContact,
    series: &'a ContactSeries,
    /// Time from which the regularised state counts, s.
    touch_down: f64,
    length: f64,
    ends: [Knot<4>; 2],
    /// A bound on the energy norm of the motion in it, √J.
    energy: f64,
    /// Bounds over all of it.
    slopes: OnceCell<[[f64x4; 2]; 3]>,
    growth: OnceCell<[Growth<ORDERS>; 2]>,
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
        knot(self.equations, self.touch_down, &self.series.at(theta))
    }
    fn at_time(&self, t: f64) -> Knot<4> {
        let advance = |theta| self.series.at(theta).state;
        let (theta, _) = at_elapsed(advance, self.length, t - self.touch_down);
        Knot { t, ..self.at(theta) }
    }
    fn quintic_error(&self, form: &Form<4>, _ends: [&Knot<4>; 2], h: f64, _sharp: bool) -> Option<f64> {
        let bounds = || self.equations.growth_in_series(&self.series.bounds(self.length));
        let [growth, rates] = self.growth.get_or_init(bounds);
        Some(QUINTIC * 720.0 * h.powi(6) * form.in_contact::<ORDERS>(growth, rates, 6)) // 6! of a Taylor coefficient
    }
    fn rise(&self, form: &Form<4>, ends: [&Knot<4>; 2], slopes: [f64; 2], h: f64) -> f64 {
        let bounds = self.slopes.get_or_init(|| self.series.bounds(self.length));
        let states = ends.map(|knot| regularised(self.equations, self.touch_down, knot));
        form.rise_between(&self.equations.change_in_series(bounds, h, states.each_ref()), slopes, h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Pace;
    use crate::contact::regularised::integrate::integrate;
    use crate::contact::regularised::shared::Shared;
    use crate::observe::observer::Unobserved;
    use retune_model::Side;
    use retune_testkit::scenes::{Numbers, SSVI, TWO_SIDED};

    /// While the structure swings back from -1 m it presses the damper on a soft wall, and a force that is weak compared with the wall's
    /// rotates by 180 rad.
    #[test]
    fn regress_a_weak_fast_force_is_carried_to_rounding() {
        let young = [2.1e11, 2.2e5, 2.1e11, 2.2e5];
        let system = Numbers { p: 1e-3, omega: 900.0, d: 0.0, young, ..SSVI }.coupled();
        let equations = system.regularised_contact(Side::Primary);
        let (y, excitation) = ([-1.0, 0.0, -1.027, 0.0], system.excitation(0.0));
        let start = (Knot { t: 0.0, excitation, y, clock: [1.0, 0.0] }, equations.regularise(&y));
        let mut work = Work::default();
        let budget = Budget::new(Pace::Steps, 100_000, work, [0.0, 0.2]);
        let end = follow(equations, start, 0.2, (&system, 1e-6, budget), &mut work, &mut Unobserved);
        let End::InContact(end) = end.expect("a contact") else { panic!("it is left") };
        let exact = system.excitation(0.2);
        let off = (end.excitation[0] - exact[0]).hypot(end.excitation[1] - exact[1]);
        assert!(off < 1e-12 * 1e-3 && work.steps > 50, "{off} in {} steps", work.steps);
    }

    /// Contacts from touch-down to lift-off, and one that a stiff spring holds until the run ends, compared with the same contacts in steps
    /// of DOP853.
    #[test]
    fn reference_contacts_in_series_end_where_those_in_steps_do() {
        let soft = [2.1e11, 2.2e5, 2.1e11, 2.2e5];
        let held = Numbers { d: 0.0, k2: 1e6, ..SSVI };
        let fast = Numbers { omega: 60.0, young: soft, ..SSVI };
        for numbers in [SSVI, TWO_SIDED, Numbers { young: soft, ..SSVI }, fast, held] {
            let system = numbers.coupled();
            for (side, speed) in
                Side::BOTH.into_iter().flat_map(|side| [1.0, 0.01].map(|speed| (side, speed)))
            {
                let equations = system.regularised_contact(side);
                let y = equations.physical(&[0.0, speed, 0.05, -0.4, 0.0]);
                let from = Knot { t: 1.3, excitation: system.excitation(1.3), y, clock: [0.0, 0.5 * speed] };
                let [mut series, mut steps] = [Work::default(); 2];
                let budget = Budget::new(Pace::Steps, 100_000, Work::default(), [1.3, 2.3]);
                let start = (from, equations.regularise(&y));
                let found = follow(
                    equations.clone(),
                    start,
                    2.3,
                    (&system, 1e-11, budget),
                    &mut series,
                    &mut Unobserved,
                );
                let expected = integrate(
                    equations,
                    &from,
                    start.1,
                    2.3,
                    (&system, 1e-13, budget, false),
                    (&mut steps, &Shared::default()),
                    &mut Unobserved,
                );
                let (found, expected) = match (found.expect("a contact"), expected.expect("a contact")) {
                    (End::LiftOff(found), End::LiftOff(expected))
                    | (End::InContact(found), End::InContact(expected)) => (found, expected),
                    _ => panic!("{numbers:?}: one has left the wall, the other has not"),
                };
                assert!(
                    (found.t - expected.t).abs() < 1e-10,
                    "{numbers:?} {speed}: {} {}",
                    found.t,
                    expected.t
                );
                for i in 0..4 {
                    let off = (found.y[i] - expected.y[i]).abs();
                    assert!(off < 1e-10, "{numbers:?} {speed} {i}: {off}");
                }
                assert!(2 * series.steps < steps.steps, "{numbers:?}: {} {}", series.steps, steps.steps);
            }
        }
    }

    /// The terms of a product of `x - root`.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let mut terms = vec![1.0];
        for root in roots {
            terms.insert(0, 0.0);
            for k in 0..terms.len() - 1 {
                terms[k] -= root * terms[k + 1];
            }
        }
        terms
    }

    #[test]
    fn exact_the_first_root_of_a_polynomial_is_found_however_near_the_next_is() {
        for apart in [0.5, 1e-2, 1e-4, 1e-6] {
            let terms = with_roots(&[0.3, 0.3 + apart]);
            let found = first_root(&terms, 1.0).expect("two roots");
            assert!((found - 0.3).abs() < 1e-15 / apart, "{apart}: {found}");
            assert_eq!(first_root(&terms, 0.29), None, "{apart}: before it");
        }
        // One at the start is where the contact began.
        let terms: Vec<f64> = with_roots(&[0.0, 0.7]).iter().map(|term| -term).collect();
        assert!((first_root(&terms, 1.0).expect("a root") - 0.7).abs() < 1e-15);
        assert_eq!(first_root(&terms, 0.6), None);
        // x² - 0.6 x + 0.09 + 1e-9 comes close to zero.
        assert_eq!(first_root(&[0.09 + 1e-9, -0.6, 1.0], 1.0), None);
    }
}
