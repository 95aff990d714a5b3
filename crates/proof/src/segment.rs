//! From one event of a motion to the next: a flight to a wall or to a crest of the force, a contact to its end.

use crate::crossing::{Section, cross};
use crate::equations::{Flow, Mode, at};
use crate::loss::{Factor, touch_down};
use crate::number::{Block, Family, SPEED, STATE, identity, matrix};
use crate::range::Range;
use crate::step::{ORDER, Piece, Quantity, States, step};
use crate::{Equations, Event, Failure, Interval, Number, Taylor};
use retune_model::Side;
use std::array;

/// An event and the state there, `[r, w, x1, v1, φ, 0]`; for a family a polynomial in its parameter.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// The event.
    pub event: Event,
    /// The state; the fixed coordinate has its value to rounding.
    pub state: Family,
}

/// The plan from an event to the next one: the lengths of the steps, and the event that ends them.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Lengths of the steps, as polynomials without rest.
    pub steps: Vec<Taylor>,
    /// The section of the event.
    pub end: Section,
    /// The state there, to rounding.
    pub reached: Family,
}

/// A segment of all motions from a box of initial states.
#[derive(Clone, Debug)]
pub struct Passage {
    /// The end of the motion from the centre.
    pub centre: Family,
    /// The derivatives of the free coordinates at the end by those at the beginning.
    pub by: Block,
    /// The enclosures of the steps.
    pub pieces: Vec<Piece>,
    /// All motions between the end of the last piece and the event, in the coordinates of the mode.
    pub near: Family,
    /// When the event is reached, from the end of the last piece, in lengths of that piece.
    pub delay: Interval,
}

/// The least step, of a second or of a second per root of a metre.
const LEAST: f64 = 1e-7;
/// The greatest step.
const GREATEST: f64 = 0.5;
/// Most steps of a segment.
const STEPS: usize = 4000;
/// Largest relative truncation error of a planned step: below rounding.
const LEFT_OUT: f64 = 1e-17;
/// Points of a step at which events are looked for.
const PLACES: usize = 32;
/// Bisections to locate an event.
const HALVINGS: usize = 60;
/// Newton iterations for the time of an event as a polynomial: each doubles the order.
const AIMED: usize = 4;

/// The initial states after an event: the state of a node, with an exact fixed coordinate and the free ones `away` from it.
fn first(equations: &Equations, node: &Node, away: &[Interval]) -> States {
    let (mut centre, mut wide, mut by) = (node.state, [Interval::ZERO; STATE], identity());
    // Include the centre, about which the mean value theorem is applied: a box from Krawczyk's operator may not contain it.
    node.event.free().into_iter().zip(away).for_each(|(i, away)| wide[i] = away.hull(Interval::ZERO));
    centre[node.event.fixed()] = match node.event {
        Event::Leave(side) => Taylor::from(equations.walls[side as usize]),
        _ => Taylor::ZERO,
    };
    if let Event::Touch(side) = node.event {
        let sign = Interval::point(side.sign());
        (centre[1], wide[1]) = (centre[1].times(sign), sign * wide[1]);
        if let Factor::Restoring(_) = equations.factors[side as usize] {
            (centre[SPEED], by[SPEED]) = (centre[1], by[1]);
        }
    }
    States::first(&centre, wide, by)
}

/// The sections that motions may reach: the ends of a segment, the crest at a phase if one is given, and the end of a contact's force.
fn sections(Flow { equations, mode }: Flow<'_>, crest: Option<Interval>) -> Vec<Section> {
    let mut all = Vec::new();
    match mode {
        Mode::Contact(side) => {
            all.push((Event::Leave(side), Interval::ZERO));
            // 1 + λ w = 0.
            if let Factor::Damping(lambda) = equations.factors[side as usize] {
                all.push((Event::Pull, -(Interval::ONE / lambda)));
            }
        }
        Mode::Flight => {
            all.extend(Side::BOTH.map(|side| (Event::Touch(side), equations.walls[side as usize])));
            all.retain(|(_, wall)| wall.is_bounded());
            all.extend(crest.map(|phase| (Event::Crest, phase)));
        }
    }
    all.into_iter().map(|(event, value)| Section { event, value }).collect()
}

/// The distance of a motion from a section, positive until it is reached.
impl Quantity for Section {
    fn series<T: Number>(&self, _: Mode, motion: &[[T; STATE]]) -> Vec<T> {
        let mut series: Vec<T> = motion.iter().map(|c| c[self.event.fixed()]).collect();
        series[0] = series[0] + -T::constant(self.value);
        let to_come = |c: T| if self.event.is_rising() { -c } else { c };
        series.into_iter().map(to_come).collect()
    }
}

/// The first event during a piece, approximately, by midpoints: its share of the piece, and its section.
fn first_event<'a>(sections: &'a [Section], piece: &Piece) -> Option<(f64, &'a Section)> {
    let found = sections.iter().filter_map(|section| {
        let range = Range::new(piece.series_of(section));
        let is_past = |t: f64| range.at(Taylor::point(t)).mid() <= 0.0;
        let place = |i: usize| i as f64 / PLACES as f64;
        let next = (1..=PLACES).find(|&i| is_past(place(i)))?;
        let (mut a, mut b) = (place(next - 1), place(next));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            if is_past(middle) { b = middle } else { a = middle }
        }
        Some((b, section))
    });
    found.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Plans the steps from an event to the next one, or to the crest at the phase `crest` if that comes first.
///
/// # Errors
/// There is no next event, or it is not crossed at a speed.
pub fn plan(equations: &Equations, node: &Node, crest: Option<Interval>) -> Result<Plan, Failure> {
    plan_from(Flow::after(equations, node.event), first(equations, node, &[]), crest)
}

fn plan_from(flow: Flow<'_>, mut states: States, crest: Option<Interval>) -> Result<Plan, Failure> {
    let (mut steps, mut h) = (Vec::new(), GREATEST);
    let sections = sections(flow, crest);
    while steps.len() < STEPS {
        let (next, piece, taken) = sharp_step(flow, &states, h)?;
        if let Some((share, end)) = first_event(&sections, &piece) {
            let last = Taylor::point(share * taken);
            let near = step(flow, &states, last, ORDER).filter(|_| end.event != Event::Pull);
            let crossing = near.and_then(|(near, _)| cross(flow, &near, end));
            let centre = crossing.ok_or(Failure::Graze(end.event, states.width()))?.centre;
            steps.push(last);
            return Ok(Plan { steps, end: *end, reached: in_flight(flow, centre).map(Taylor::polynomial) });
        }
        (states, h) = (next, (1.5 * taken).min(GREATEST));
        steps.push(Taylor::point(taken));
    }
    Err(Failure::Endless(STEPS, states.width()))
}

/// The steps of a plan for a family: all scaled by one factor, so that the last one ends at the event for all values of the parameter, to
/// the order of the states' polynomials.
pub fn aimed(equations: &Equations, node: &Node, plan: &Plan) -> Plan {
    let flow = Flow::after(equations, node.event);
    let mut state = first(equations, node, &[]).centre();
    let Some((last, steps)) = plan.steps.split_last() else { return plan.clone() };
    for &h in steps {
        let series = flow.series(&state, ORDER - 1);
        state = array::from_fn(|i| at(series.iter().map(|c| c[i]), h).polynomial());
    }
    let range = Range::new(plan.end.series(flow.mode, &flow.series(&state, ORDER - 1)));
    let mut end = *last;
    for _ in 0..AIMED {
        end = (end - range.at(end) * range.slope_at(end).reciprocal()).polynomial();
    }
    let sum = |steps: &[Taylor]| steps.iter().fold(Taylor::ZERO, |sum, h| sum + *h);
    let all = (sum(steps) + end) * sum(&plan.steps).reciprocal();
    let steps = plan.steps.iter().map(|h| (*h * all).polynomial()).collect();
    Plan { steps, ..plan.clone() }
}

/// The longest step, up to `longest`, whose truncation error is below rounding: the states after it, its enclosure, and its length.
fn sharp_step(flow: Flow<'_>, states: &States, longest: f64) -> Result<(States, Piece, f64), Failure> {
    let mut h = longest;
    while h > LEAST {
        match step(flow, states, Taylor::point(h), ORDER) {
            Some((next, piece)) if piece.left_out() <= LEFT_OUT => return Ok((next, piece, h)),
            _ => h *= 0.75,
        }
    }
    Err(Failure::Step(LEAST, states.width()))
}

/// A state at the end of a segment in the coordinates of a flight.
fn in_flight(flow: Flow<'_>, mut state: Family) -> Family {
    if let Mode::Contact(side) = flow.mode {
        state[0] = Taylor::from(flow.equations.walls[side as usize]);
        state[1] = state[1].times(flow.sign());
    }
    state[SPEED] = Taylor::ZERO;
    state
}

/// Follows all motions from a box about a node by the steps of a plan, and proves that they reach its end and no other event before.
///
/// # Errors
/// This cannot be proven for so wide a box.
pub fn follow(equations: &Equations, node: &Node, away: &[Interval], way: &Plan) -> Result<Passage, Failure> {
    let (flow, Plan { steps, end, .. }) = (Flow::after(equations, node.event), way);
    let (mut states, mut pieces) = (first(equations, node, away), Vec::with_capacity(steps.len()));
    let sections = sections(flow, None);
    for (k, &h) in steps.iter().enumerate() {
        let (next, piece) =
            step(flow, &states, h, ORDER).ok_or_else(|| Failure::Step(h.mid(), states.width()))?;
        for section in &sections {
            // The wall that the motion leaves, or the end of the contact that begins.
            let starts = k == 0 && section.event.is_beside(node.event);
            let ends = k + 1 == steps.len() && section.event == end.event;
            if !Range::new(piece.series_of(section)).is_positive(starts, ends) {
                return Err(Failure::Graze(section.event, states.width()));
            }
        }
        pieces.push(piece);
        states = next;
    }
    let crossing = cross(flow, &states, end).ok_or_else(|| Failure::Graze(end.event, states.width()))?;
    // No other section is reached near the end either.
    for section in sections.iter().filter(|section| section.event != end.event) {
        let left = section.value - crossing.near[section.event.fixed()].hull();
        if !section.is_towards(left) {
            return Err(Failure::Graze(section.event, states.width()));
        }
    }
    // The speed changes its sign between the coordinates of a contact with the structure and of a flight.
    let sign = |i: usize| if i == 1 { flow.sign() } else { Interval::ONE };
    let (rows, columns) = (end.event.free(), node.event.free());
    let by = |i: usize, j: usize| crossing.by[i][j].times(sign(i) * sign(j));
    Ok(Passage {
        centre: in_flight(flow, crossing.centre),
        by: matrix(|i, j| by(rows[i], columns[j])),
        pieces,
        near: crossing.near,
        delay: crossing.delay / steps.last().map_or(Interval::ONE, |h| h.hull()),
    })
}

/// The end of a contact that has reached the state `[q, w, x1, v1, φ, 0]`.
///
/// # Errors
/// See [`plan`].
pub fn rest_of_contact(equations: &Equations, side: Side, mut state: [f64; STATE]) -> Result<Node, Failure> {
    if let Factor::Restoring(chi) = equations.factors[side as usize] {
        let stored = 0.4 * (equations.hertz[side as usize] * equations.inverse_masses()).mid();
        state[SPEED] = touch_down(chi.mid(), stored * state[0].powi(5), state[1]);
    }
    let states = States::first(&state.map(Taylor::point), [Interval::ZERO; STATE], identity());
    let Plan { end, reached, .. } = plan_from(Flow { equations, mode: Mode::Contact(side) }, states, None)?;
    Ok(Node { event: end.event, state: reached })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::largest::largest;
    use crate::step::tests::scene;
    use std::slice;

    /// A crest at the phase 0.1, 16 ms later, by a plan of one step of 1 ms: on the long way to the crest the damper touches a wall, or
    /// moves away from it.
    #[test]
    fn contract_a_wall_that_is_touched_after_the_last_step_is_seen() {
        let equations = scene();
        for side in Side::BOTH {
            let (wall, to_wall) = (equations.walls[side as usize].mid(), side.sign());
            for (speed, is_free) in [(0.5, false), (-0.5, true)] {
                let state = [wall - 1e-3 * to_wall, speed * to_wall, 0.05, 0.3, 0.0, 0.0].map(Taylor::point);
                let end = Section { event: Event::Crest, value: Interval::point(0.1) };
                let way = Plan { steps: vec![Taylor::point(1e-3)], end, reached: state };
                match follow(&equations, &Node { event: Event::Crest, state }, &[Interval::ZERO; 4], &way) {
                    // From 1 ms to 0.1/6.28 s.
                    Ok(passage) => {
                        assert!(is_free && (passage.delay.mid() - 14.924).abs() < 1e-3, "{side:?}")
                    }
                    Err(Failure::Graze(event, width)) => {
                        assert!(!is_free && event == Event::Touch(side) && width < 1e-14, "{width:e}");
                    }
                    Err(why) => panic!("{why}"),
                }
            }
        }
    }

    /// By that plan and by a sharp one: the enclosures over the long way to the crest contain the sharp end, its derivatives, and the
    /// energy until then, which grows.
    #[test]
    fn invariant_a_long_way_to_the_end_holds_what_a_sharp_plan_says() {
        let equations = scene();
        let state = [0.4, -0.5, 0.05, 0.3, 0.0, 0.0].map(Taylor::point);
        let (node, value) = (Node { event: Event::Crest, state }, Interval::point(0.1));
        let sharp = plan(&equations, &node, Some(value)).expect("a plan");
        let long = Plan { steps: vec![Taylor::point(1e-3)], ..sharp.clone() };
        let [long, sharp] =
            [long, sharp].map(|way| follow(&equations, &node, &[Interval::ZERO; 4], &way).expect("a way"));
        let [wide, narrow] =
            [&long, &sharp].map(|passage| largest(&equations, slice::from_ref(passage)).energy);
        assert!(wide.hi() >= narrow.lo() && wide.lo() <= narrow.hi(), "{wide} {narrow}");
        for i in 0..4 {
            let [wide, narrow] = [&long, &sharp].map(|passage| passage.centre[i].hull());
            assert!(
                wide.meet(narrow).is_some() && wide.width() > 1e4 * narrow.width(),
                "{i}: {narrow} {wide}"
            );
            for j in 0..4 {
                let [wide, narrow] = [&long, &sharp].map(|passage| passage.by[i][j].hull());
                assert!(wide.meet(narrow).is_some(), "{i} {j}: {narrow} {wide}");
            }
        }
    }

    /// The mean value theorem connects the centre with each state of a box: the enclosure holds the motions between, even if the box is
    /// beside the centre.
    #[test]
    fn contract_the_centre_is_among_the_states_of_a_box_beside_it() {
        let equations = scene();
        let state = [0.0, 0.5, 0.05, 0.3, 1.0, 0.0].map(Taylor::point);
        for (event, sign) in [(Event::Touch(Side::Obstacle), 1.0), (Event::Touch(Side::Primary), -1.0)] {
            let all = first(&equations, &Node { event, state }, &[Interval::new(1e-6, 2e-6); 4]).all();
            for i in event.free() {
                let own = state[i].mid() * if i == 1 { sign } else { 1.0 };
                let beside = own + if i == 1 { 2e-6 * sign } else { 2e-6 };
                assert!(all[i].hull().contains(own) && all[i].hull().contains(beside), "{event:?} {i}");
            }
        }
    }
}
