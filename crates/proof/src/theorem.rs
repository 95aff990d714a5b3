//! The proof: Krawczyk's operator, stability, and largest values.

use crate::largest::{Largest, largest};
use crate::number::FREE;
use crate::orbit::{Closed, Orbit, Residual};
use crate::segment::Node;
use crate::stability::{Stability, stability};
use crate::steady::{Steady, steady};
use crate::{Equations, Event, Failure, Interval, Taylor};
use retune_model::{Scene, Side};
use serde::Serialize;

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
    /// The largest width of the box with no other such motion, in m, m/s and rad, about the states at its events; none if no other motion that touches no wall
    /// repeats at all.
    pub alone_within: Option<f64>,
    /// The largest width of the box that it is in.
    pub width: f64,
    /// Its events.
    pub events: Vec<Proven>,
    /// Whether it is stable.
    pub stability: Stability,
    /// Its largest values over the whole period.
    pub largest: Largest,
}

/// Proves what it can of the periodic motion of a scene near the one from the state `[x1, v1, x2, v2]` at a crest of the force. If that touches no wall, and the
/// system comes to rest without force, the motion is the steady one.
///
/// # Errors
/// See [`Failure`].
pub fn prove(scene: &Scene, start: [f64; 4], periods: usize) -> Result<Theorem, Failure> {
    let equations = Equations::new(scene)?;
    let is_linear = equations.comes_to_rest();
    if is_linear && !equations.has_walls() {
        return Ok(of_steady(steady(&equations)?));
    }
    let guess = Orbit::guess(&equations, (start, periods), true)?;
    if is_linear && guess.nodes.iter().all(|node| node.event == Event::Crest) {
        return Ok(of_steady(steady(&equations)?));
    }
    of_orbit(&equations, guess)
}

/// What is proven of the motion near a guess, by the way from event to event.
fn of_orbit(equations: &Equations, guess: Orbit) -> Result<Theorem, Failure> {
    let closed = guess.improved(equations)?;
    let (alone, mut away) = alone(equations, &closed, &TRIED, WIDEST)?;
    let orbit = &closed.orbit;
    let mut known = orbit.residual(equations, &away)?;
    for _ in 0..SMALLER {
        let smaller = krawczyk(&closed, &known, &away);
        // It is in both.
        away = smaller.iter().zip(&away).map(|(new, own)| new.meet(*own).unwrap_or(*own)).collect();
        known = orbit.residual(equations, &away)?;
    }
    Ok(Theorem {
        periods: orbit.periods,
        impacts: impacts(orbit),
        alone_within: Some(width(&alone)),
        width: width(&away),
        events: events(equations, orbit, &away),
        stability: stability(&known.passages),
        largest: largest(equations, &known.passages),
    })
}

/// What is proven of the steady motion: the linear system has no other that repeats, and all its multipliers are below 1.
fn of_steady(Steady { state, largest }: Steady) -> Theorem {
    Theorem {
        periods: 1,
        impacts: String::new(),
        alone_within: None,
        width: width(&state),
        events: vec![Proven { event: Event::Crest.name(), phase: Interval::ZERO, state }],
        stability: Stability::Stable(1.0),
        largest,
    }
}

/// A box about the nodes that is proven to hold exactly one solution, the first that is of some sizes, in what Krawczyk's operator makes of the nodes alone; and
/// the smaller one that the solution is in. No box is wider than the share `widest` of the states.
pub fn alone(
    equations: &Equations,
    closed: &Closed,
    sizes: &[f64],
    widest: f64,
) -> Result<(Vec<Interval>, Vec<Interval>), Failure> {
    let none = vec![Interval::ZERO; closed.known.gaps.len()];
    let least = krawczyk(closed, &closed.known, &none);
    let mut failure = Failure::Sequence;
    for size in sizes {
        let half_width = |(state, least): (Taylor, &Interval)| {
            let (state, least) = (state.mid().abs().max(1e-3), least.magnitude());
            (size * least).max(NARROWEST * state).min((widest * state).max(2.0 * least))
        };
        let half_widths = closed.orbit.unknowns().zip(&least).map(half_width);
        let away: Vec<Interval> = half_widths.map(Interval::around_zero).collect();
        match closed.orbit.residual(equations, &away) {
            Err(why) => failure = why,
            Ok(known) => {
                let image = krawczyk(closed, &known, &away);
                if image.iter().zip(&away).all(|(image, away)| image.is_inside(*away)) {
                    return Ok((away, image));
                }
                failure = Failure::Krawczyk(width(&away), width(&image));
            }
        }
    }
    Err(failure)
}

/// Krawczyk's operator on the box `x̂ + away`, from `x̂`: `-A F(x̂) + (I - A F'(box)) away`, with `A` near the inverse of the derivatives, and `F'` of what is
/// `known` of the box; of a family for each value of its parameter.
///
/// If it is in the interior of `away`, the box holds exactly one solution, and the solution is in it (R. Krawczyk, 1969; R. E. Moore, 1977).
fn krawczyk(Closed { orbit, inverse, .. }: &Closed, known: &Residual, away: &[Interval]) -> Vec<Interval> {
    let moved = inverse.times(&known.gaps);
    let off = inverse.off(&orbit.jacobian(&known.passages));
    let row = |(moved, off): (&Taylor, &Vec<Taylor>)| {
        let terms = off.iter().zip(away).map(|(off, away)| off.hull() * *away);
        terms.fold(-moved.hull(), |sum, term| sum + term)
    };
    moved.iter().zip(&off).map(row).collect()
}

/// The largest width.
fn width(boxes: &[Interval]) -> f64 {
    boxes.iter().map(|x| x.width()).fold(0.0, f64::max)
}

/// The walls in turn.
pub fn impacts(orbit: &Orbit) -> String {
    let letter = |event: Event| match event {
        Event::Touch(Side::Primary) => Some('S'),
        Event::Touch(Side::Obstacle) => Some('O'),
        _ => None,
    };
    orbit.nodes.iter().filter_map(|node| letter(node.event)).collect()
}

/// The states at the events.
fn events(equations: &Equations, orbit: &Orbit, away: &[Interval]) -> Vec<Proven> {
    let at = |(node, away): (&Node, &[Interval])| {
        let mut state = node.state.map(Taylor::hull);
        for (i, away) in node.event.free().into_iter().zip(away) {
            state[i] = (node.state[i] + Taylor::from(*away)).hull();
        }
        if let Event::Touch(side) | Event::Leave(side) = node.event {
            state[0] = equations.walls[side as usize];
        }
        let [r, w, x1, v1, phase, _] = state;
        Proven { event: node.event.name(), phase, state: [x1, v1, x1 + r, v1 + w] }
    };
    orbit.nodes.iter().zip(away.chunks(FREE)).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::tests::{SURFACES, scene_with};

    /// The general proof encloses the same state at the crest, E1max and stroke; walls far away do not matter.
    #[test]
    fn invariant_the_closed_form_and_the_way_of_a_period_enclose_one_motion() {
        let walls = format!(r#""D": 0.4, "C": 0.5, "contact": {SURFACES}"#);
        for damper in [
            r#""m2": 60, "k2": 2000, "c2": 85"#.to_owned(),
            format!(r#""m2": 60, "k2": 2000, "c2": 85, {walls}"#),
        ] {
            let equations = Equations::new(&scene_with(&damper)).expect("equations");
            let rest = ([0.0, 0.0, equations.rest.mid(), 0.0], 1);
            let guess = Orbit::guess(&equations, rest, true).expect("a guess");
            let general = of_orbit(&equations, guess).expect("a proof");
            let closed = of_steady(steady(&equations).expect("a gap"));
            for (wide, narrow) in general.events[0].state.into_iter().zip(closed.events[0].state) {
                assert!(wide.meet(narrow).is_some() && narrow.width() < 1e-13, "{wide} {narrow}");
            }
            for ((_, wide), (_, narrow)) in general.largest.all().into_iter().zip(closed.largest.all()) {
                assert!(
                    wide.meet(narrow).is_some() && narrow.width() <= 1e-12 * wide.hi() + 1e-300,
                    "{wide} {narrow}"
                );
            }
        }
    }
}
