//! The proof: for a motion with impacts by Krawczyk's operator, with stability and largest values; for a steady motion in closed form.
//!
//! Without a damper, or with one that touches no wall, equation (1) is linear. A system that comes to rest without force then has exactly
//! one periodic motion, and it is stable: `x1 = Re(X1 e^{iφ})`, `r = D + Re(R e^{iφ})`, where the force is `Re(F e^{iφ})`. With
//! `S = k1 - m1 ω² + iω c1`, `Q = k2 + iω c2`, `d = Q - m2 ω²` and `N = S d - m2 ω² Q` the amplitudes are `X1 = F d/N` and `R = F m2 ω²/N`
//! (J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 3.2; `retune_model::Steady` has them in doubles).

use crate::elementary::pi;
use crate::largest::{Largest, largest};
use crate::number::{FREE, applied, off, width};
use crate::orbit::{Closed, Guess, Orbit, Residual};
use crate::segment::Node;
use crate::stability::{Stability, stability};
use crate::{Equations, Event, Failure, Interval, Number, Taylor};
use retune_model::{Scene, Side};
use serde::Serialize;

/// How to search for a box about a motion.
struct Search<'a> {
    /// Half-widths to try, in multiples of the image of the centre alone under Krawczyk's operator.
    tried: &'a [f64],
    /// The largest half-width, relative to the states, but not less than twice that image.
    widest: f64,
    /// Number of times that the operator contracts a proven box.
    rounds: usize,
}

/// For one motion: the largest box is tried first.
const ONE: Search<'_> = Search { tried: &[1e5, 1e4, 1e3, 100.0, 20.0, 5.0, 2.0], widest: 1e-6, rounds: 2 };
/// For a family, whose curvature the operator does not reduce.
const MANY: Search<'_> = Search { tried: &[1.5, 3.0, 10.0], widest: f64::INFINITY, rounds: 0 };
/// Least half-width of a box, relative to the states.
const NARROWEST: f64 = 1e-13;

/// Bisections for the decay rate of a motion.
const HALVINGS: usize = 30;
/// Terms of the exponential.
const TERMS: u32 = 30;

/// An event of a proven motion.
#[derive(Clone, Debug, Serialize)]
pub struct Proven {
    /// What happens.
    pub event: &'static str,
    /// The phase of the force there, rad.
    pub phase: Interval,
    /// `[x1, v1, x2, v2]`, m and m/s.
    pub state: [Interval; 4],
}

/// The theorem proven for a scene: in a box exactly one motion repeats after some periods of the force with these events.
#[derive(Clone, Debug, Serialize)]
pub struct Theorem {
    /// Periods of the force.
    pub periods: usize,
    /// The walls that it strikes in turn, S for the structure and O for the obstacle.
    pub impacts: String,
    /// The largest width of the box that holds no other such motion, in m, m/s and rad, about the states at its events; none if no other
    /// motion without contact is periodic at all.
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

/// Proves the periodic motion of a scene near the one from the state `[x1, v1, x2, v2]` at a crest of the force. If that touches no wall,
/// and the system comes to rest without force, it is the steady motion.
///
/// # Errors
/// See [`Failure`].
pub fn prove(scene: &Scene, start: [f64; 4], periods: usize) -> Result<Theorem, Failure> {
    let equations = Equations::new(scene)?;
    let is_linear = equations.comes_to_rest();
    if is_linear && !equations.has_walls() {
        return steady(&equations);
    }
    let guess = Orbit::guess(&equations, (start, periods), true)?;
    if is_linear && guess.nodes.iter().all(|node| node.event == Event::Crest) {
        return steady(&equations);
    }
    prove_orbit(&equations, &guess.improved(&equations)?, &ONE)
}

/// The middle of a piece of a band, and half its width or more.
fn middle_and_half([from, to]: [f64; 2]) -> [f64; 2] {
    let middle = 0.5 * (from + to);
    [middle, (Interval::new(from, to) - Interval::point(middle)).magnitude()]
}

/// A family of motions, one for each frequency of a piece of a band.
#[derive(Clone, Debug)]
pub struct Family(Orbit, [f64; 2]);

/// Where to look for a motion.
#[derive(Clone, Copy, Debug)]
pub enum Start<'a> {
    /// Near the one from a state.
    From(Guess),
    /// By extrapolation of a nearby family.
    Beside(&'a Family),
}

/// Proves a stable motion for every frequency of a piece of a band: the theorem holds at each, with one motion in the box, and its bounds
/// hold for all.
///
/// # Errors
/// See [`Failure`].
pub fn prove_over(scene: &Scene, omega: [f64; 2], start: Start<'_>) -> Result<(Theorem, Family), Failure> {
    let (equations, [middle, half]) = (Equations::new(scene)?, middle_and_half(omega));
    let single = equations.at(Taylor::point(middle));
    let guess = match start {
        Start::From(guess) => Orbit::guess(&single, guess, false)?,
        Start::Beside(Family(orbit, [other, width])) => orbit.member(&single, (middle - other) / width)?,
    };
    let Closed { orbit, known, .. } = guess.improved(&single)?;
    // Give up early if the motion at the middle is not stable.
    stability(&known.passages).stable()?;
    let all = equations.at(Taylor::line(middle, half));
    let closed = orbit.widened(&all)?;
    let theorem = prove_orbit(&all, &closed, &MANY)?;
    theorem.stability.stable()?;
    Ok((theorem, Family(closed.orbit, [middle, half])))
}

/// Proves the motion near one that repeats to rounding, segment by segment; for a family for each value of its parameter.
fn prove_orbit(equations: &Equations, closed: &Closed, search: &Search<'_>) -> Result<Theorem, Failure> {
    let [unique, mut away] = boxes(equations, closed, search)?;
    let orbit = &closed.orbit;
    let mut known = orbit.residual(equations, &away)?;
    for _ in 0..search.rounds {
        let smaller = krawczyk(closed, &known, &away);
        // The solution is in both.
        away = smaller.iter().zip(&away).map(|(new, old)| new.meet(*old).unwrap_or(*old)).collect();
        known = orbit.residual(equations, &away)?;
    }
    Ok(Theorem {
        periods: orbit.periods,
        impacts: impacts(orbit),
        alone_within: Some(width(&unique)),
        width: width(&away),
        events: events(equations, orbit, &away),
        stability: stability(&known.passages),
        largest: largest(equations, &known.passages),
    })
}

/// A box about the nodes that is proven to hold exactly one solution, the first that succeeds of the sizes to try, and the smaller one that
/// contains the solution.
fn boxes(equations: &Equations, closed: &Closed, search: &Search<'_>) -> Result<[Vec<Interval>; 2], Failure> {
    let none = vec![Interval::ZERO; closed.known.gaps.len()];
    let least = krawczyk(closed, &closed.known, &none);
    let mut failure = Failure::Krawczyk(0.0, 0.0);
    for size in search.tried {
        let half_width = |(state, least): (Taylor, &Interval)| {
            let (state, least) = (state.mid().abs().max(1e-3), least.magnitude());
            (size * least).max(NARROWEST * state).min((search.widest * state).max(2.0 * least))
        };
        let half_widths = closed.orbit.unknowns().zip(&least).map(half_width);
        let away: Vec<Interval> = half_widths.map(Interval::around_zero).collect();
        match closed.orbit.residual(equations, &away) {
            Err(why) => failure = why,
            Ok(known) => {
                let image = krawczyk(closed, &known, &away);
                if image.iter().zip(&away).all(|(image, away)| image.is_inside(*away)) {
                    return Ok([away, image]);
                }
                failure = Failure::Krawczyk(width(&away), width(&image));
            }
        }
    }
    Err(failure)
}

/// Krawczyk's operator on the box `x̂ + away`, relative to `x̂`: `-A F(x̂) + (I - A F'(box)) away`, with `A` near the inverse of the
/// derivatives, and `F'` from the residual `known` over the box; for a family for each value of its parameter.
///
/// If the image is in the interior of `away`, the box holds exactly one solution, which is in the image (R. Krawczyk, 1969; R. E. Moore,
/// 1977).
fn krawczyk(Closed { orbit, inverse, .. }: &Closed, known: &Residual, away: &[Interval]) -> Vec<Interval> {
    let moved = applied(inverse, &known.gaps);
    let off = off(inverse, &orbit.jacobian(&known.passages));
    let row = |(moved, off): (&Taylor, &Vec<Taylor>)| {
        let terms = off.iter().zip(away).map(|(off, away)| off.hull() * *away);
        terms.fold(-moved.hull(), |sum, term| sum + term)
    };
    moved.iter().zip(&off).map(row).collect()
}

/// The walls struck, in order.
fn impacts(orbit: &Orbit) -> String {
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

/// Real and imaginary part.
type Complex = [Taylor; 2];

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

/// The square of the absolute value.
fn square([a, b]: Complex) -> Taylor {
    a * a + b * b
}

/// Proves, for every frequency of a piece of a band, the steady motion of a damper that touches no wall or has none.
///
/// # Errors
/// It may touch a wall, or the system may not come to rest without force.
pub fn prove_steady(scene: &Scene, omega: [f64; 2]) -> Result<Theorem, Failure> {
    let (equations, [middle, half]) = (Equations::new(scene)?, middle_and_half(omega));
    if !equations.comes_to_rest() {
        return Err(Failure::Undamped);
    }
    steady(&equations.at(Taylor::line(middle, half)))
}

/// The steady motion without contact of a system that comes to rest without force, at one frequency or each of a family; no other one is
/// periodic.
///
/// # Errors
/// It may touch a wall.
fn steady(equations: &Equations) -> Result<Theorem, Failure> {
    let [[m1, c1, k1], [m2, c2, k2]] = [equations.primary, equations.damper].map(|of| of.map(Taylor::from));
    let omega = equations.omega;
    let inertia = m2 * omega * omega;
    let (structure, spring) = ([k1 - m1 * omega * omega, omega * c1], [k2, omega * c2]);
    let dynamic = [k2 - inertia, omega * c2];
    let (whole, coupled) = (times(structure, dynamic), spring.map(|part| part * inertia));
    let [re, im] = [whole[0] - coupled[0], whole[1] - coupled[1]];
    let [cos, sin] = equations.force_per_mass::<Taylor>().map(|part| part * m1);
    // F/N.
    let scale = times([cos, -sin], [re, -im]).map(|part| part * square([re, im]).reciprocal());
    let (x1, r) = (times(scale, dynamic), scale.map(|part| part * inertia));

    // Each part of (m1 v1² + k1 x1²)/2 is largest where the other is zero, so the larger one decides.
    let half = Taylor::point(0.5) * square(x1);
    let energy = (half * k1).hull().max((half * m1 * omega * omega).hull());
    // `abs` removes negative values due to rounding.
    let stroke = square(r).hull().abs().sqrt();
    for side in Side::BOTH.into_iter().filter(|_| equations.has_walls()) {
        let gap = Interval::point(side.sign()) * (equations.walls[side as usize] - equations.rest);
        if !(gap - stroke).is_positive() {
            return Err(Failure::Graze(Event::Touch(side), stroke.width()));
        }
    }
    let [v1, w] = [x1, r].map(|amplitude| -(omega * amplitude[1]));
    let state = [x1[0], v1, x1[0] + Taylor::from(equations.rest) + r[0], v1 + w].map(Taylor::hull);
    Ok(Theorem {
        periods: 1,
        impacts: String::new(),
        alone_within: None,
        width: width(&state),
        events: vec![Proven { event: Event::Crest.name(), phase: Interval::ZERO, state }],
        stability: Stability::Stable(multipliers(equations)),
        largest: Largest { energy, stroke, contact_force: Interval::ZERO },
    })
}

/// A bound on all multipliers: `e^{-σT}` if all roots of `N`, as a polynomial in `s = iω`, are left of `-σ`, that is, those of `N(s - σ)`
/// left of zero.
fn multipliers(equations: &Equations) -> f64 {
    let [[m1, c1, k1], [m2, c2, k2]] = [equations.primary, equations.damper];
    let all =
        [m1 * m2, m1 * c2 + m2 * (c1 + c2), m1 * k2 + m2 * (k1 + k2) + c1 * c2, c1 * k2 + k1 * c2, k1 * k2];
    // For a structure alone the polynomial is that of the structure, times the spring of its damper.
    let polynomial = if m2 == Interval::ZERO { &all[2..] } else { &all };
    // A proven decay rate, trivially zero at first, and one that is not reached.
    let (mut rate, mut beyond) = (0.0, (polynomial[1] / polynomial[0]).hi());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (rate + beyond);
        if all_left(&shifted(polynomial, Interval::point(middle))) { rate = middle } else { beyond = middle }
    }
    // For x >= 0 all terms of e^x are positive, so the partial sum is a lower bound.
    let x = (Interval::point(2.0 * rate) * pi() / equations.omega.hull()).abs();
    let exponential = |sum, k| Interval::ONE + sum * x / Interval::point(f64::from(k));
    (Interval::ONE / (1..TERMS).rev().fold(Interval::ONE, exponential)).hi().min(1.0)
}

/// The coefficients of `p(s - σ)`, the highest power first (W. G. Horner, 1819).
fn shifted(p: &[Interval], sigma: Interval) -> Vec<Interval> {
    let mut all = p.to_vec();
    for last in (1..all.len()).rev() {
        (1..=last).for_each(|k| all[k] = all[k] - sigma * all[k - 1]);
    }
    all
}

/// Whether all roots of a polynomial are proven left of zero: each step of Routh's scheme removes one root left of zero (E. J. Routh,
/// 1877).
fn all_left(p: &[Interval]) -> bool {
    let [first, second, ..] = *p else { return true };
    let ratio = first / second;
    let next = |k: usize| if k % 2 == 1 && k + 2 < p.len() { p[k + 1] - ratio * p[k + 2] } else { p[k + 1] };
    let is_next = || all_left(&(0..p.len() - 1).map(next).collect::<Vec<_>>());
    first.is_positive() && second.is_positive() && is_next()
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
            let guess = guess.improved(&equations).expect("a motion");
            let general = prove_orbit(&equations, &guess, &ONE).expect("a proof");
            let closed = steady(&equations).expect("a gap");
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

    /// The motions at the ends of a piece are in the boxes about its family, which are much smaller than the distance between these
    /// motions.
    #[test]
    fn invariant_the_boxes_of_a_family_hold_its_motions() {
        let text = r#"{
            "primary": { "m1": 1000, "c1": 452, "k1": 39500 }, "forcing": { "P": 800, "omega": 6.62 },
            "damper": { "m2": 60, "k2": 584, "c2": 95, "D": 0.029, "C": 1.1, "contact": { "R": 2, "q": 0.318,
                "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4, "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4 } }
        }"#;
        let scene: Scene = serde_json::from_str(text).expect("a scene");
        let (omega, half) = (6.62, 5e-3);
        let equations = Equations::new(&scene).expect("equations");
        let single = equations.at(Taylor::point(omega));
        let guess = Orbit::guess(&single, ([-0.0282, 0.608, 0.183, -1.121], 1), false).expect("a guess");
        let wide = equations.at(Taylor::line(omega, half));
        let closed = guess.improved(&single).and_then(|one| one.orbit.widened(&wide)).expect("a family");
        let [_, boxes] = boxes(&wide, &closed, &MANY).expect("a proof");
        for end in [-1.0, 1.0] {
            let there = equations.at(Taylor::point(omega + half * end));
            let own =
                closed.orbit.member(&there, end).and_then(|own| own.improved(&there)).expect("a motion");
            for ((own, family), held) in own.orbit.unknowns().zip(closed.orbit.unknowns()).zip(&boxes) {
                let off = own.mid() - family.near(end);
                assert!(held.wider(1e-12).contains(off), "{family:?}: {off:e} {held}");
                let way = own.mid() - family.mid();
                assert!(held.magnitude() < 1e-6 * way.abs() + 1e-10, "{family:?}: {way:e} {held}");
            }
        }
    }
}
