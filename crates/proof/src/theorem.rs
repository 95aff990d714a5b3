//! The proof: Krawczyk's operator, stability, and largest values.

use crate::equations::Equations;
use crate::event::Event;
use crate::inverse::Inverse;
use crate::largest::{Largest, largest};
use crate::number::{SPEED, STATE, State};
use crate::orbit::{Orbit, Residual};
use crate::segment::Node;
use crate::stability::{Stability, stability};
use crate::taylor::Taylor;
use crate::{Failure, Interval};
use retune_model::{Scene, Side};
use serde::Serialize;
use std::array;

/// Boxes that are tried, in widths of what Krawczyk's operator makes of the centre alone.
const TRIED: [f64; 7] = [1e5, 1e4, 1e3, 100.0, 20.0, 5.0, 2.0];
/// A box is at least so wide, relative to the states, and no wider than this.
const NARROWEST: f64 = 1e-13;
const WIDEST: f64 = 1e-6;
/// Times that a proven box is made smaller by Krawczyk's operator.
const SMALLER: usize = 2;

/// An event of a motion that is proven.
#[derive(Clone, Debug, Serialize)]
pub struct Proven {
    /// What happens.
    pub event: &'static str,
    /// The phase of the force there, rad.
    pub phase: Interval,
    /// `[x1, v1, x2, v2]`, m and m/s.
    pub state: [Interval; 4],
}

/// What is proven of a scene: it has exactly one motion in a box that repeats after some periods of the force with these events.
#[derive(Clone, Debug, Serialize)]
pub struct Theorem {
    /// Periods of the force.
    pub periods: usize,
    /// The walls that it strikes in turn, S for the structure and O for the obstacle.
    pub impacts: String,
    /// The largest width of the box with no other such motion, in m, m/s and rad, about the states at its events.
    pub alone_within: f64,
    /// The largest width of the box that it is in.
    pub width: f64,
    /// Its events.
    pub events: Vec<Proven>,
    /// Whether it is stable.
    pub stability: Stability,
    /// Its largest values over the whole period.
    pub largest: Largest,
}

/// Proves what it can of the periodic motion of a scene near the one from the state `[x1, v1, x2, v2]` at a crest of the force.
///
/// # Errors
/// See [`Failure`].
pub fn prove(scene: &Scene, start: [f64; 4], periods: usize) -> Result<Theorem, Failure> {
    let equations = Equations::new(scene)?;
    let (orbit, inverse) = Orbit::guess(&equations, start, periods, true)?.improved(&equations)?;
    let (alone, mut away) = alone(&equations, &orbit, &inverse)?;
    let mut known = orbit.residual(&equations, &away)?;
    for _ in 0..SMALLER {
        let smaller = krawczyk(&orbit, &inverse, &known, &away);
        for (own, new) in away.iter_mut().flatten().zip(smaller.iter().flatten()) {
            // It is in both.
            *own = new.meet(*own).unwrap_or(*own);
        }
        known = orbit.residual(&equations, &away)?;
    }
    Ok(Theorem {
        periods,
        impacts: impacts(&orbit),
        alone_within: width(&alone),
        width: width(&away),
        events: events(&equations, &orbit, &away),
        stability: stability(&orbit, &known.passages),
        largest: largest(&equations, &known.passages),
    })
}

/// The largest box about the nodes that is proven to hold exactly one solution, and the smaller one that it is in.
fn alone(
    equations: &Equations,
    orbit: &Orbit,
    inverse: &Inverse,
) -> Result<(Vec<State>, Vec<State>), Failure> {
    let none = vec![[Interval::ZERO; STATE]; orbit.nodes.len()];
    let least = krawczyk(orbit, inverse, &orbit.residual(equations, &none)?, &none);
    let mut failure = Failure::Sequence;
    for times in TRIED {
        let away = about(orbit, &least, times, WIDEST);
        match orbit.residual(equations, &away) {
            Err(why) => failure = why,
            Ok(known) => {
                let image = krawczyk(orbit, inverse, &known, &away);
                if is_inside(orbit, &image, &away) {
                    return Ok((away, image));
                }
                failure = Failure::Krawczyk { width: width(&away), image: width(&image) };
            }
        }
    }
    Err(failure)
}

/// Boxes about the nodes of so many times a width, but no narrower than rounding and no wider than a share of the states.
pub fn about(orbit: &Orbit, least: &[State], times: f64, widest: f64) -> Vec<State> {
    let of_node = |(node, least): (&Node, &State)| {
        let half_width = |i: usize| {
            let size = node.state[i].mid().abs().max(1e-3);
            let least = least[i].magnitude();
            (times * least).max(NARROWEST * size).min((widest * size).max(2.0 * least))
        };
        let mut away = [Interval::ZERO; STATE];
        node.event.free().for_each(|i| away[i] = Interval::around_zero(half_width(i)));
        away
    };
    orbit.nodes.iter().zip(least).map(of_node).collect()
}

/// Whether a box is in the interior of another one.
pub fn is_inside(orbit: &Orbit, image: &[State], away: &[State]) -> bool {
    let inside = |k: usize| orbit.nodes[k].event.free().all(|i| image[k][i].is_inside(away[k][i]));
    (0..away.len()).all(inside)
}

/// Krawczyk's operator on the box `x̂ + away`, from `x̂`: `-A F(x̂) + (I - A F'(box)) away`, with `A` near the inverse of the derivatives;
/// of a family for each value of its parameter.
///
/// If it is in the interior of `away`, the box holds exactly one solution, and the solution is in it (R. Krawczyk, 1969; R. E. Moore, 1977).
pub fn krawczyk(orbit: &Orbit, inverse: &Inverse, known: &Residual, away: &[State]) -> Vec<State> {
    let moved = inverse.times(&known.gaps);
    let off = inverse.off(&orbit.jacobian(&known.passages));
    let places: Vec<(usize, usize)> =
        orbit.nodes.iter().enumerate().flat_map(|(k, node)| node.event.free().map(move |i| (k, i))).collect();
    let mut image = vec![[Interval::ZERO; STATE]; orbit.nodes.len()];
    for (row, &(k, i)) in places.iter().enumerate() {
        let terms = places.iter().zip(&off[row]).map(|(&(k, i), off)| off.hull() * away[k][i]);
        image[k][i] = terms.fold(-moved[row].hull(), |sum, term| sum + term);
    }
    image
}

/// The largest width.
pub fn width(boxes: &[State]) -> f64 {
    boxes.iter().flat_map(|x| &x[..SPEED]).map(|x| x.width()).fold(0.0, f64::max)
}

/// The walls in turn.
pub fn impacts(orbit: &Orbit) -> String {
    let letter = |event: Event| match event {
        Event::Touch(Side::Primary) => Some('S'),
        Event::Touch(Side::Obstacle) => Some('O'),
        Event::Crest | Event::Leave(_) => None,
    };
    orbit.nodes.iter().filter_map(|node| letter(node.event)).collect()
}

/// The states at the events.
fn events(equations: &Equations, orbit: &Orbit, away: &[State]) -> Vec<Proven> {
    let at = |(node, away): (&Node, &State)| {
        let mut state: State = array::from_fn(|i| (node.state[i] + Taylor::from(away[i])).hull());
        let (event, wall) = match node.event {
            Event::Crest => ("crest of the force", None),
            Event::Touch(Side::Primary) => ("touches the structure", equations.wall(Side::Primary)),
            Event::Touch(Side::Obstacle) => ("touches the obstacle", equations.wall(Side::Obstacle)),
            Event::Leave(Side::Primary) => ("leaves the structure", equations.wall(Side::Primary)),
            Event::Leave(Side::Obstacle) => ("leaves the obstacle", equations.wall(Side::Obstacle)),
        };
        state[0] = wall.unwrap_or(state[0]);
        let [r, w, x1, v1, phase, _] = state;
        Proven { event, phase, state: [x1, v1, x1 + r, v1 + w] }
    };
    orbit.nodes.iter().zip(away).map(at).collect()
}
