//! The search for pieces of a band of frequencies, each of which is proven at once. It only looks for what `retune_proof` can prove, and rests on nothing itself.

use retune_model::{Bare, Coupled, Scene};
use retune_proof::{
    Failure, Family, Guess, Interval, Largest, Multiplier, Start, Theorem, prove_over, prove_steady,
};
use serde::{Serialize, Serializer};

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
/// A multiplier whose size is as near to 1 as this tells of a bifurcation nearby.
const CRITICAL: f64 = 0.01;

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
    /// Why not, where it begins.
    pub why: Why,
    /// Why not where it ends, if motions are proven from there on and were followed back to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_above: Option<Why>,
}

/// Why nothing is proven of a part of a band.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Why {
    /// The proof fails.
    #[error("{0}{near}", near = next_to(.0))]
    Failure(#[from] Failure),
    /// A motion may have more energy than it is to have: bounds on it, and what it is to have at most.
    #[error("the motion may have an E1max of {bound} J, and at most {1} J are to be proven", bound = .0.hi())]
    Above(Interval, f64),
    /// No motion to prove anything of.
    #[error("none found: the run settles on no periodic motion")]
    NoGuess,
}

/// Which bifurcation is nearby by the largest multiplier, which is computed, of a motion that is not proven to be stable.
fn next_to(failure: &Failure) -> &'static str {
    match *failure {
        Failure::NotStable(Multiplier { re, im, .. }) if (re.hypot(im) - 1.0).abs() < CRITICAL => {
            match (im, re) {
                (0.0, 0.0..) => ", as next to a fold or to the period doubling that it comes from",
                (0.0, _) => ", as next to a period doubling",
                _ => ", as next to a Neimark-Sacker bifurcation",
            }
        }
        _ => "",
    }
}

impl Serialize for Why {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A guess at a frequency.
pub type Guesses<'a> = &'a (dyn Fn(f64) -> Option<Guess> + Sync);

/// Proves stable motions with an E1max of at most `most` (J) over a band, as far as it can. A motion is followed from piece to piece, which need not be one branch:
/// where it is lost, a new one is guessed beyond, and followed to both sides.
pub fn band(scene: &Scene, [from, to]: [f64; 2], most: f64, guesses: Guesses<'_>) -> Band {
    let task = Task { scene, most, guesses };
    let (mut band, mut at, mut gap, mut length) = (Band::default(), from, LEFT_OUT[0], LONGEST);
    while at < to {
        let March { pieces, first, stop } = task.march([at, to], length, None);
        if let (Some(first), Some(part)) = (first, band.left_out.last_mut())
            && part.omega[1] == at
        {
            let March { pieces: mut back, stop, .. } = task.march([at, part.omega[0]], LONGEST, Some(first));
            back.reverse();
            part.omega[1] = back.first().map_or(at, |piece| piece.omega[0]);
            part.from_above = stop.map(|(_, why)| why);
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
            band.leave_out(LeftOut { omega: [at, next], why, from_above: None });
            (at, gap, length) = (next, (2.0 * gap).min(LEFT_OUT[1]), (AFTER * gap).min(LONGEST));
        }
    }
    band
}

/// Proves the steady motions over a band, where the damper touches no wall at any of its frequencies, or there is none. None if that is not proven of the scene.
///
/// # Errors
/// The proof does not cover such scenes.
pub fn steady_band(scene: &Scene, omega: [f64; 2], most: f64) -> Result<Option<Band>, Failure> {
    match prove_steady(scene, omega) {
        Err(Failure::Undamped) => return Ok(None),
        // Walls that are touched over the whole band may not be touched over parts of it.
        Ok(_) | Err(Failure::Graze(..)) => {}
        Err(why) => return Err(why),
    }
    let worst = match &scene.damper {
        Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady_e1_max(omega),
        None => Bare::new(&scene.primary, &scene.forcing).steady_e1_max(omega),
    };
    // How far pieces are halved; no bound rests on it.
    let goal = most.min((1.0 + TIGHT) * worst.value);
    let mut band = Band::default();
    Ok(band.covers(scene, omega, [goal, most])?.then_some(band))
}

impl Band {
    /// Adds the steady motions over a part, in pieces that have no more energy than a goal, if they are long enough to be halved. Whether all touch no wall.
    fn covers(
        &mut self,
        scene: &Scene,
        omega @ [from, to]: [f64; 2],
        [goal, most]: [f64; 2],
    ) -> Result<bool, Failure> {
        let is_short = to - from <= HALVED;
        match prove_steady(scene, omega) {
            Ok(Theorem { largest: Largest { energy, .. }, .. })
                if energy.lo() > most || (is_short && energy.hi() > most) =>
            {
                self.leave_out(LeftOut { omega, why: Why::Above(energy, most), from_above: None });
                Ok(true)
            }
            Ok(theorem) if is_short || (to - from <= LONGEST && theorem.largest.energy.hi() <= goal) => {
                self.pieces.push(Piece::new(omega, theorem)?);
                Ok(true)
            }
            Err(_) if is_short => Ok(false),
            _ => {
                let (middle, goals) = (0.5 * (from + to), [goal, most]);
                Ok(self.covers(scene, [from, middle], goals)? && self.covers(scene, [middle, to], goals)?)
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
            Some(last) if last.omega[1] == part.omega[0] => {
                (last.omega[1], last.from_above) = (part.omega[1], part.from_above);
            }
            _ => self.left_out.push(part),
        }
    }

    /// Bounds on the largest E1max over the frequencies of all pieces, J: what one of them has at least, and what none exceeds; zero if there are none.
    pub fn energy(&self) -> Interval {
        self.pieces.iter().fold(Interval::ZERO, |most, piece| most.max(piece.largest.energy))
    }
}

impl Piece {
    /// What is proven of each frequency of a piece.
    fn new(omega: [f64; 2], theorem: Theorem) -> Result<Self, Failure> {
        let Theorem { periods, impacts, largest, stability, .. } = theorem;
        Ok(Self { omega, periods, impacts, largest, multipliers: stability.stable()? })
    }
}

/// What is to be proven.
struct Task<'a> {
    scene: &'a Scene,
    most: f64,
    guesses: Guesses<'a>,
}

/// Pieces in turn, the family of the first, and where and why nothing more can be proven.
struct March {
    pieces: Vec<Piece>,
    first: Option<Family>,
    stop: Option<(f64, Why)>,
}

impl Task<'_> {
    /// Pieces from a frequency up or down to another one, from a family next to them or a guess.
    fn march(&self, [from, to]: [f64; 2], longest: f64, beside: Option<Family>) -> March {
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
                Err(why) if matches!(why, Why::Above(energy, most) if energy.lo() > most) => {
                    return March { pieces, first, stop: Some((end, why)) };
                }
                Err(why) if (end - at).abs() <= SHORTEST => {
                    return March { pieces, first, stop: Some((at, why)) };
                }
                Err(_) => length = SHORTER * (end - at).abs(),
            }
        }
        March { pieces, first, stop: None }
    }

    /// A piece, and its family.
    fn piece(&self, omega: [f64; 2], last: Option<&Family>) -> Result<(Piece, Family), Why> {
        let start = match last {
            Some(family) => Start::Beside(family),
            None => Start::From((self.guesses)(0.5 * (omega[0] + omega[1])).ok_or(Why::NoGuess)?),
        };
        let (theorem, family) = prove_over(self.scene, omega, start)?;
        let energy = theorem.largest.energy;
        if energy.hi() > self.most {
            return Err(Why::Above(energy, self.most));
        }
        Ok((Piece::new(omega, theorem)?, family))
    }
}
