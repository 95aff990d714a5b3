//! A whole band of frequencies: pieces of it, over each of which one family of motions is proven at once.

use crate::largest::{Largest, largest};
use crate::orbit::{Closed, Guess, Orbit};
use crate::stability::{Stability, stability};
use crate::steady::steady;
use crate::theorem::{alone, impacts};
use crate::{Equations, Failure, Interval, Taylor};
use retune_model::{Bare, Coupled, Scene};
use serde::Serialize;

/// Half-widths that are tried, in what Krawczyk's operator leaves of the family's curvature.
const TRIED: [f64; 3] = [1.5, 3.0, 10.0];
/// The longest piece and the shortest, rad/s.
const LONGEST: f64 = 0.05;
const SHORTEST: f64 = 2e-5;
/// By how much a piece is longer than the last one, or shorter where the last one failed.
const LONGER: f64 = 1.4;
const SHORTER: f64 = 0.5;
/// What is left out where no piece can be proven, rad/s; twice as much each time that nothing beyond can be proven either, up to the most.
const LEFT_OUT: [f64; 2] = [1e-4, 0.01];
/// Of steady motions, by which share the bound on E1max may exceed what it is in doubles, and the shortest piece that is halved for that, rad/s.
const TIGHT: f64 = 1e-9;
const HALVED: f64 = 2e-6;
/// The longest piece that is tried after it, in what was left out: motions change fast next to a bifurcation.
const AFTER: f64 = 8.0;

/// A piece of the band over which a family of motions is proven: at each of its frequencies there is exactly one in a box.
#[derive(Clone, Debug, Serialize)]
pub struct Piece {
    /// From where to where, rad/s.
    pub omega: [f64; 2],
    /// Periods of the force after which each motion repeats.
    pub periods: usize,
    /// The walls that it strikes in turn.
    pub impacts: String,
    /// Bounds that hold at all frequencies: the largest value at each is in them.
    pub largest: Largest,
    /// No multiplier is larger than this, and all are below 1.
    pub multipliers: f64,
}

/// What was proven of a band.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Band {
    /// The pieces, in the order of their frequencies.
    pub pieces: Vec<Piece>,
    /// What they leave out.
    pub left_out: Vec<LeftOut>,
}

/// A part of a band over which nothing is proven.
#[derive(Clone, Debug, Serialize)]
pub struct LeftOut {
    /// From where to where, rad/s.
    pub omega: [f64; 2],
    /// Why not.
    pub why: Failure,
}

/// A guess at a frequency.
pub type Guesses<'a> = &'a dyn Fn(f64) -> Option<Guess>;

/// Proves stable motions with an E1max of at most `most` (J) over a band, as far as it can. A motion is followed from piece to piece, which need not be one branch:
/// where it is lost, a new one is guessed beyond, and followed to both sides.
///
/// # Errors
/// The proof does not cover such scenes.
pub fn band(scene: &Scene, [from, to]: [f64; 2], most: f64, guesses: Guesses<'_>) -> Result<Band, Failure> {
    let equations = Equations::new(scene)?;
    let task = Task { equations: &equations, most, guesses };
    let (mut band, mut at, mut gap, mut length) = (Band::default(), from, LEFT_OUT[0], LONGEST);
    while at < to {
        let (pieces, own, stop) = task.march([at, to], length, None);
        if let (Some(first), Some(part)) = (own, band.left_out.last_mut())
            && part.omega[1] == at
        {
            let (mut back, ..) = task.march([at, part.omega[0]], LONGEST, Some(first));
            back.reverse();
            part.omega[1] = back.first().map_or(at, |piece| piece.omega[0]);
            band.pieces.extend(back);
            if part.omega[1] <= part.omega[0] {
                band.left_out.pop();
            }
            gap = LEFT_OUT[0];
        }
        at = pieces.last().map_or(at, |piece| piece.omega[1]);
        band.pieces.extend(pieces);
        if let Some((end, why)) = stop {
            let next = (at + gap).max(end).min(to);
            band.leave_out(LeftOut { omega: [at, next], why });
            (at, gap, length) = (next, (2.0 * gap).min(LEFT_OUT[1]), (AFTER * gap).min(LONGEST));
        }
    }
    Ok(band)
}

/// Proves the steady motions over a band, where the damper touches no wall at any of its frequencies, or there is none. None if that is not proven of the scene.
///
/// # Errors
/// The proof does not cover such scenes.
pub fn steady_band(scene: &Scene, omega: [f64; 2], most: f64) -> Result<Option<Band>, Failure> {
    let (equations, mut band) = (Equations::new(scene)?, Band::default());
    let worst = match &scene.damper {
        Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady_e1_max(omega),
        None => Bare::new(&scene.primary, &scene.forcing).steady_e1_max(omega),
    };
    // How far pieces are halved; no bound rests on it.
    let goal = most.min((1.0 + TIGHT) * worst.value);
    let is_proven = equations.comes_to_rest() && band.covers(&equations, omega, [goal, most]);
    Ok(is_proven.then_some(band))
}

/// The middle of a piece, and half its width or more.
fn middle_and_half([from, to]: [f64; 2]) -> [f64; 2] {
    let middle = 0.5 * (from + to);
    [middle, (Interval::new(from, to) - Interval::point(middle)).magnitude()]
}

impl Band {
    /// Adds the steady motions over a part, in pieces that have no more energy than a goal, if they are long enough to be halved. Whether all touch no wall.
    fn covers(&mut self, equations: &Equations, omega: [f64; 2], [goal, most]: [f64; 2]) -> bool {
        let [middle, half] = middle_and_half(omega);
        let is_short = 2.0 * half <= HALVED;
        match steady(&equations.at(Taylor::line(middle, half))) {
            Ok(own) if own.largest.energy.lo() > most || (is_short && own.largest.energy.hi() > most) => {
                self.leave_out(LeftOut { omega, why: Failure::Above(own.largest.energy, most) });
                true
            }
            Ok(own) if is_short || (2.0 * half <= LONGEST && own.largest.energy.hi() <= goal) => {
                let (periods, impacts, largest, multipliers) = (1, String::new(), own.largest, 1.0);
                self.pieces.push(Piece { omega, periods, impacts, largest, multipliers });
                true
            }
            Err(_) if is_short => false,
            _ => {
                let halves = [[omega[0], middle], [middle, omega[1]]];
                halves.into_iter().all(|half| self.covers(equations, half, [goal, most]))
            }
        }
    }

    /// Bands that follow one another, as one.
    pub fn joined(parts: Vec<Self>) -> Self {
        parts.into_iter().fold(Self::default(), |mut all, part| {
            all.pieces.extend(part.pieces);
            part.left_out.into_iter().for_each(|part| all.leave_out(part));
            all
        })
    }

    /// Adds a part, as one with that before it if they meet.
    fn leave_out(&mut self, part: LeftOut) {
        match self.left_out.last_mut() {
            Some(last) if last.omega[1] == part.omega[0] => last.omega[1] = part.omega[1],
            _ => self.left_out.push(part),
        }
    }

    /// Bounds on the largest E1max over the frequencies of all pieces, J: what one of them has at least, and what none exceeds; zero if there are none.
    pub fn energy(&self) -> Interval {
        self.pieces.iter().fold(Interval::ZERO, |most, piece| most.max(piece.largest.energy))
    }
}

/// The family of a piece, with the frequency in its middle and half its width.
type Last = (Orbit, [f64; 2]);

/// What is to be proven.
struct Task<'a> {
    equations: &'a Equations,
    most: f64,
    guesses: Guesses<'a>,
}

/// Pieces in turn, the family of the first, and where and why nothing more can be proven.
type March = (Vec<Piece>, Option<Last>, Option<(f64, Failure)>);

impl Task<'_> {
    /// Pieces from a frequency up or down to another one, from a family next to them or a guess.
    fn march(&self, [from, to]: [f64; 2], longest: f64, beside: Option<Last>) -> March {
        let (mut pieces, mut first, mut last) = (Vec::new(), None, beside);
        let (mut at, mut length) = (from, longest);
        while at != to {
            let end = if (to - at).abs() <= 1.01 * length { to } else { at + length.copysign(to - at) };
            let omega = [at.min(end), at.max(end)];
            match self.piece(omega, last.as_ref()) {
                Ok((piece, own)) => {
                    pieces.push(piece);
                    first.get_or_insert_with(|| own.clone());
                    (at, last, length) = (end, Some(own), (LONGER * (end - at).abs()).min(LONGEST));
                }
                // All motions of the piece have more.
                Err(why) if matches!(why, Failure::Above(energy, most) if energy.lo() > most) => {
                    return (pieces, first, Some((end, why)));
                }
                Err(why) if (end - at).abs() <= SHORTEST => return (pieces, first, Some((at, why))),
                Err(_) => length = SHORTER * (end - at).abs(),
            }
        }
        (pieces, first, None)
    }

    /// The motion at one frequency, if it is stable: where it is not, no piece is tried.
    fn motion(&self, omega: f64, last: Option<&Last>) -> Result<Orbit, Failure> {
        let equations = self.equations.at(Taylor::point(omega));
        let start = match last {
            Some((orbit, [middle, half])) => orbit.member(&equations, (omega - middle) / half)?,
            None => Orbit::guess(&equations, (self.guesses)(omega).ok_or(Failure::NoGuess)?, false)?,
        };
        let Closed { orbit, known, .. } = start.improved(&equations)?;
        match stability(&known.passages) {
            Stability::Stable(_) => Ok(orbit),
            _ => Err(Failure::NotStable),
        }
    }

    /// A piece, and its family.
    fn piece(&self, omega: [f64; 2], last: Option<&Last>) -> Result<(Piece, Last), Failure> {
        let [middle, half] = middle_and_half(omega);
        let orbit = self.motion(middle, last)?;
        let equations = self.equations.at(Taylor::line(middle, half));
        let closed = orbit.widened(&equations)?;
        let (_, boxes) = alone(&equations, &closed, &TRIED, f64::INFINITY)?;
        let Closed { orbit, .. } = closed;
        let known = orbit.residual(&equations, &boxes)?;
        let Stability::Stable(multipliers) = stability(&known.passages) else {
            return Err(Failure::NotStable);
        };
        let largest = largest(&equations, &known.passages);
        if largest.energy.hi() > self.most {
            return Err(Failure::Above(largest.energy, self.most));
        }
        let piece = Piece { omega, periods: orbit.periods, impacts: impacts(&orbit), largest, multipliers };
        Ok((piece, (orbit, [middle, half])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The motions at the ends of a piece are in the boxes about its family, which are much smaller than the way between these motions.
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
        let closed = guess.improved(&single).and_then(|own| own.orbit.widened(&wide)).expect("a family");
        let (_, boxes) = alone(&wide, &closed, &TRIED, f64::INFINITY).expect("a proof");
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
