//! From one event of a motion to the next: a flight to a wall or to a crest of the force, a contact to its end.

use crate::crossing::{Crossing, Section, cross};
use crate::equations::{Equations, Mode, at};
use crate::event::Event;
use crate::loss::{Factor, touch_down};
use crate::number::{Family, Number, SPEED, STATE, State};
use crate::range::Range;
use crate::small::{Matrix, identity};
use crate::step::{ORDER, Piece, Quantity, States, step};
use crate::taylor::Taylor;
use crate::{Failure, Interval};
use retune_model::Side;

/// An event and the state there, `[r, w, x1, v1, φ, 0]`, of a family a polynomial in its parameter.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// What happens.
    pub event: Event,
    /// The state; the fixed coordinate has its value to rounding.
    pub state: Family,
}

/// How to get from an event to the next one: the steps to near it, and which it is.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Lengths of the steps, without rest.
    pub steps: Vec<Taylor>,
    /// The event.
    pub end: Event,
    /// The state there, to rounding.
    pub reached: Family,
}

/// A segment of all motions of a box of first states.
#[derive(Clone, Debug)]
pub struct Passage {
    /// What the motion from the centre has come to.
    pub centre: Family,
    /// The derivatives of the state at the end by that at the beginning.
    pub by: Matrix<Taylor>,
    /// What is known in between.
    pub pieces: Vec<Piece>,
    /// All motions about the end, in the coordinates of the mode, and from where to where it may be, counted from the end of the last piece.
    pub near: Family,
    /// When the end is reached, counted from that of the last piece, in lengths of it.
    pub delay: Interval,
}

/// The least step, of a second or of a second per root of a metre.
const LEAST: f64 = 1e-7;
/// The greatest step.
const GREATEST: f64 = 0.5;
/// Most steps of a segment.
const STEPS: usize = 4000;
/// Largest share of the states that a step of a plan leaves out: rounding.
const LEFT_OUT: f64 = 1e-17;
/// Places of a step at which an event is looked for.
const PLACES: usize = 32;
/// Halvings to find it.
const HALVINGS: usize = 60;
/// Newton's iterations for its time as a polynomial: each doubles the order.
const AIMED: usize = 4;

/// What the damper does after an event.
fn mode_after(event: Event) -> Mode {
    match event {
        Event::Touch(side) => Mode::Contact(side),
        Event::Crest | Event::Leave(_) => Mode::Flight,
    }
}

/// A state as the first states of a mode, the fixed coordinate exact.
fn first(equations: &Equations, node: &Node, away: &State) -> States {
    let (mut centre, mut away, mut by) = (node.state, *away, identity());
    away[node.event.fixed()] = Interval::ZERO;
    match node.event {
        Event::Crest => centre[4] = Taylor::ZERO,
        Event::Touch(side) => {
            let sign = Interval::point(side.sign());
            (centre[0], centre[1], away[1]) = (Taylor::ZERO, centre[1].times(sign), sign * away[1]);
            if let Factor::Restoring(_) = equations.factors[side as usize] {
                (centre[SPEED], by[SPEED]) = (centre[1], by[1]);
            }
        }
        Event::Leave(side) => {
            centre[0] = Taylor::from(equations.wall(side).unwrap_or(Interval::ENTIRE));
        }
    }
    States::first(&centre, away, by)
}

/// The quantities that are above zero until an event ends the segment, each with the event and its section.
fn events(equations: &Equations, mode: Mode, crest: Option<Interval>) -> Vec<(Event, Section)> {
    let mut all = Vec::new();
    match mode {
        Mode::Contact(side) => {
            let section = Section { index: 0, value: Interval::ZERO, is_rising: false };
            all.push((Event::Leave(side), section));
        }
        Mode::Flight => {
            for side in Side::BOTH {
                if let Some(value) = equations.wall(side) {
                    let section = Section { index: 0, value, is_rising: side == Side::Obstacle };
                    all.push((Event::Touch(side), section));
                }
            }
            all.extend(crest.map(|value| (Event::Crest, Section { index: 4, value, is_rising: true })));
        }
    }
    all
}

/// How far a motion is from a section.
impl Quantity for Section {
    fn series<T: Number>(&self, _: Mode, motion: &[[T; STATE]]) -> Vec<T> {
        let mut series: Vec<T> = motion.iter().map(|c| c[self.index]).collect();
        series[0] = series[0] - T::constant(self.value);
        if self.is_rising {
            series.iter().map(|c| T::constant(Interval::ZERO) - *c).collect()
        } else {
            series
        }
    }
}

/// By how much a contact's factor `1 + λ w` is above zero.
struct Pushing(Interval);

impl Quantity for Pushing {
    fn series<T: Number>(&self, _: Mode, motion: &[[T; STATE]]) -> Vec<T> {
        let mut series: Vec<T> = motion.iter().map(|c| c[1].times(self.0)).collect();
        series[0] = series[0] + T::constant(Interval::ONE);
        series
    }
}

/// The first event during a piece, by its middles: at which share of it, and which.
fn first_event(sections: &[(Event, Section)], piece: &Piece) -> Option<(f64, Event)> {
    let found = sections.iter().filter_map(|(event, section)| {
        let range = Range::new(piece.series_of(section));
        let is_past = |t: f64| range.at(Taylor::point(t)).mid() <= 0.0;
        let place = |i: usize| i as f64 / PLACES as f64;
        let next = (1..=PLACES).find(|&i| is_past(place(i)))?;
        let (mut a, mut b) = (place(next - 1), place(next));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            if is_past(middle) { b = middle } else { a = middle }
        }
        Some((b, *event))
    });
    found.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Plans the way from an event to the next one. `crest` is the phase of a crest at which it ends, if it comes to it.
///
/// # Errors
/// No next event, or none that is crossed with a speed.
pub fn plan(equations: &Equations, node: &Node, crest: Option<Interval>) -> Result<Plan, Failure> {
    let states = first(equations, node, &[Interval::ZERO; STATE]);
    plan_from(equations, mode_after(node.event), states, crest)
}

fn plan_from(
    equations: &Equations,
    mode: Mode,
    mut states: States,
    crest: Option<Interval>,
) -> Result<Plan, Failure> {
    let (mut steps, mut h) = (Vec::new(), GREATEST);
    let sections = events(equations, mode, crest);
    while steps.len() < STEPS {
        let (next, piece, taken) = sharp_step(equations, mode, &states, h)?;
        if let Some((share, end)) = first_event(&sections, &piece) {
            let graze = Failure::Graze { event: end };
            let last = Taylor::point(share * taken);
            let (near, _) = step(equations, mode, &states, last).ok_or(graze.clone())?;
            let section = sections.iter().find(|(event, _)| *event == end).map(|(_, section)| section);
            let crossing = section.and_then(|section| cross(equations, mode, &near, section));
            let reached = in_flight(equations, mode, &crossing.ok_or(graze)?).map(Taylor::polynomial);
            steps.push(last);
            return Ok(Plan { steps, end, reached });
        }
        (states, h) = (next, (1.5 * taken).min(GREATEST));
        steps.push(Taylor::point(taken));
    }
    Err(Failure::Endless { steps: STEPS })
}

/// The same steps for a family: all longer or shorter by one share, so that the last one ends at the event for all values of the parameter, to the order that the
/// states have.
///
/// # Errors
/// The event is not crossed with a speed.
pub fn aimed(
    equations: &Equations,
    node: &Node,
    plan: &Plan,
    crest: Option<Interval>,
) -> Result<Plan, Failure> {
    let mode = mode_after(node.event);
    let mut state = first(equations, node, &[Interval::ZERO; STATE]).centre();
    let Some((last, steps)) = plan.steps.split_last() else { return Ok(plan.clone()) };
    let series = |state: &Family| equations.series(mode, state, ORDER - 1);
    for &h in steps {
        let series = series(&state);
        state = std::array::from_fn(|i| at(series.iter().map(|c| c[i]), h).polynomial());
    }
    let section = events(equations, mode, crest).into_iter().find(|(event, _)| *event == plan.end);
    let (_, section) = section.ok_or(Failure::Graze { event: plan.end })?;
    let range = Range::new(section.series(mode, &series(&state)));
    let mut end = *last;
    for _ in 0..AIMED {
        end = (end - range.at(end) * range.slope_at(end).reciprocal()).polynomial();
    }
    let sum = |steps: &[Taylor]| steps.iter().fold(Taylor::ZERO, |sum, h| sum + *h);
    let all = (sum(steps) + end) * sum(&plan.steps).reciprocal();
    let steps = plan.steps.iter().map(|h| (*h * all).polynomial()).collect();
    Ok(Plan { steps, ..plan.clone() })
}

/// A step that leaves out no more than rounding, as long as possible: what it comes to, what is known in between, and its length.
fn sharp_step(
    equations: &Equations,
    mode: Mode,
    states: &States,
    longest: f64,
) -> Result<(States, Piece, f64), Failure> {
    let mut h = longest;
    while h > LEAST {
        match step(equations, mode, states, Taylor::point(h)) {
            Some((next, piece)) if piece.left_out() <= LEFT_OUT => return Ok((next, piece, h)),
            _ => h *= 0.75,
        }
    }
    Err(too_wide(LEAST, states))
}

/// A crossing in the coordinates of a flight.
fn in_flight(equations: &Equations, mode: Mode, crossing: &Crossing) -> Family {
    let mut centre = crossing.centre;
    if let Mode::Contact(side) = mode {
        centre[0] = Taylor::from(equations.wall(side).unwrap_or(Interval::ENTIRE));
        centre[1] = centre[1].times(Interval::point(side.sign()));
    }
    centre[SPEED] = Taylor::ZERO;
    centre
}

/// Follows all motions of a box about a node, by the steps of a plan, and proves that they come to its end and to nothing before.
///
/// # Errors
/// It cannot be proven for a box as wide.
pub fn follow(
    equations: &Equations,
    node: &Node,
    away: &State,
    plan: &Plan,
    crest: Option<Interval>,
) -> Result<Passage, Failure> {
    let mode = mode_after(node.event);
    let mut states = first(equations, node, away);
    let sections = events(equations, mode, crest);
    let mut pieces = Vec::with_capacity(plan.steps.len());
    for (k, &h) in plan.steps.iter().enumerate() {
        let (next, piece) = step(equations, mode, &states, h).ok_or_else(|| too_wide(h.mid(), &states))?;
        let is_last = k + 1 == plan.steps.len();
        for (event, section) in sections.iter().filter(|(event, _)| *event != Event::Crest) {
            let starts = k == 0 && starts_at(node.event, *event);
            let ends = is_last && *event == plan.end;
            if !Range::new(piece.series_of(section)).is_positive(starts, ends) {
                return Err(Failure::Graze { event: *event });
            }
        }
        if let Some(lambda) = damping(equations, mode)
            && !Range::new(piece.series_of(&Pushing(lambda))).is_positive(false, false)
        {
            return Err(Failure::Pulls);
        }
        pieces.push(piece);
        states = next;
    }
    let section = sections.iter().find(|(event, _)| *event == plan.end).map(|(_, section)| section);
    let crossing = section.and_then(|section| cross(equations, mode, &states, section));
    let crossing = crossing.ok_or(Failure::Graze { event: plan.end })?;
    // The walls that it does not end at are not reached about the end either.
    for (event, section) in sections.iter().filter(|(event, _)| ![Event::Crest, plan.end].contains(event)) {
        let off = crossing.near[section.index].hull() - section.value;
        if !(if section.is_rising { off.is_negative() } else { off.is_positive() }) {
            return Err(Failure::Graze { event: *event });
        }
    }
    let near = crossing.near;
    if let Some(lambda) = damping(equations, mode)
        && !(Interval::ONE + lambda * near[1].hull()).is_positive()
    {
        return Err(Failure::Pulls);
    }
    let centre = in_flight(equations, mode, &crossing);
    let by = match mode {
        Mode::Flight => crossing.by,
        Mode::Contact(side) => turned(side.sign(), &crossing.by),
    };
    let last = plan.steps.last().map_or(Interval::ONE, |h| h.hull());
    Ok(Passage { centre, by, pieces, near, delay: crossing.delay / last })
}

/// λ of a contact.
fn damping(equations: &Equations, mode: Mode) -> Option<Interval> {
    match mode {
        Mode::Contact(side) => match equations.factors[side as usize] {
            Factor::Damping(lambda) => Some(lambda),
            Factor::None | Factor::Restoring(_) => None,
        },
        Mode::Flight => None,
    }
}

/// Whether a motion is on the section of an event when it starts from another: on a wall that it leaves, or whose contact begins.
fn starts_at(from: Event, event: Event) -> bool {
    match (from, event) {
        (Event::Touch(_), Event::Leave(_)) => true,
        (Event::Leave(left), Event::Touch(wall)) => left == wall,
        _ => false,
    }
}

/// Derivatives by the state of a contact as those by a state of a flight: the speed changes its sign at the structure's wall.
fn turned(sign: f64, by: &Matrix<Taylor>) -> Matrix<Taylor> {
    let sign = |i: usize| Interval::point(if i == 1 { sign } else { 1.0 });
    std::array::from_fn(|i| std::array::from_fn(|j| by[i][j].times(sign(i) * sign(j))))
}

fn too_wide(least: f64, states: &States) -> Failure {
    Failure::Step { least, width: states.all().iter().map(|x| x.hull().width()).fold(0.0, f64::max) }
}

/// Where the rest of a contact ends that has come to a state `[q, w, x1, v1, φ, 0]`.
///
/// # Errors
/// See [`plan`].
pub fn rest_of_contact(equations: &Equations, side: Side, state: [f64; STATE]) -> Result<Node, Failure> {
    let mut state = state;
    if let Factor::Restoring(chi) = equations.factors[side as usize] {
        let stored = 0.4 * (equations.hertz[side as usize] * equations.inverse_masses()).mid();
        state[SPEED] = touch_down(chi.mid(), stored * state[0].powi(5), state[1]);
    }
    let states = States::first(&state.map(Taylor::point), [Interval::ZERO; STATE], identity());
    let Plan { end, reached, .. } = plan_from(equations, Mode::Contact(side), states, None)?;
    Ok(Node { event: end, state: reached })
}
