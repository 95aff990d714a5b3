//! The search for pieces of a band of frequencies, each proven as a whole. It only finds what `retune_proof` can prove; no proof depends on
//! it.

use retune_model::{Bare, Coupled, Scene};
use retune_proof::{
    Failure, Family, Guess, Interval, Largest, Multiplier, Start, Theorem, prove_over, prove_steady,
};
use serde::{Serialize, Serializer};

/// The longest and the shortest piece, rad/s.
const LONGEST: f64 = 0.05;
const SHORTEST: f64 = 2e-5;
/// Factors on the length of a piece after a success and after a failure.
const LONGER: f64 = 1.4;
const SHORTER: f64 = 0.5;
/// First and largest width left out where no piece can be proven, rad/s; it doubles while nothing beyond can be proven either.
const LEFT_OUT: [f64; 2] = [1e-4, 0.01];
/// For steady motions: allowed relative excess of the bound on E1max over its value in doubles, and the shortest piece, rad/s, halved to
/// reach it.
const TIGHT: f64 = 1e-9;
const HALVED: f64 = 2e-6;
/// The longest piece tried after a gap, as a multiple of the gap: motions change fast next to a bifurcation.
const AFTER: f64 = 8.0;
/// Distance of the modulus of a multiplier from 1 that indicates a bifurcation nearby.
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
    /// Bounds on the largest values that hold at all frequencies.
    pub largest: Largest,
    /// A bound below 1 on all multipliers.
    pub multipliers: f64,
}

/// The proof over a band.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Band {
    /// The pieces, in the order of their frequencies.
    pub pieces: Vec<Piece>,
    /// The parts left out.
    pub left_out: Vec<LeftOut>,
}

/// A part of a band over which nothing is proven.
#[derive(Clone, Debug, Serialize)]
pub struct LeftOut {
    /// From where to where, rad/s.
    pub omega: [f64; 2],
    /// Why not, at its lower end.
    pub why: Why,
    /// Why not, at its upper end, if motions proven beyond it were followed back to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_above: Option<Why>,
}

/// Why nothing is proven over a part of a band.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Why {
    /// The proof fails.
    #[error("{0}{near}", near = next_to(.0))]
    Failure(#[from] Failure),
    /// The energy of a motion may exceed the wanted bound: its bounds, and the wanted one.
    #[error("the motion may have an E1max of {bound} J, and at most {1} J are to be proven", bound = .0.hi())]
    Above(Interval, f64),
    /// There is no motion to prove.
    #[error("none found: the run settles on no periodic motion")]
    NoGuess,
}

/// The bifurcation nearby, judged by the computed largest multiplier of a motion that is not proven stable.
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

/// Gives a guess of the motion at a frequency.
pub type Guesses<'a> = &'a (dyn Fn(f64) -> Option<Guess> + Sync);

/// Proves stable motions with an E1max of at most `most` (J) over a band, as far as possible. Motions are followed from piece to piece, not
/// necessarily along one branch: where one is lost, a new one is guessed beyond and followed both ways.
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

/// Proves the steady motions over a band, if there is no damper or it touches no wall at any frequency; none if that cannot be proven.
///
/// # Errors
/// The proof does not cover such scenes.
pub fn steady_band(scene: &Scene, omega: [f64; 2], most: f64) -> Result<Option<Band>, Failure> {
    match prove_steady(scene, omega) {
        Err(Failure::Undamped) => return Ok(None),
        // A proof that fails over the whole band because of contacts may succeed over its parts.
        Ok(_) | Err(Failure::Graze(..)) => {}
        Err(why) => return Err(why),
    }
    let worst = match &scene.damper {
        Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady_e1_max(omega),
        None => Bare::new(&scene.primary, &scene.forcing).steady_e1_max(omega),
    };
    // Decides how far pieces are halved; no bound depends on it.
    let goal = most.min((1.0 + TIGHT) * worst.value);
    let mut band = Band::default();
    Ok(band.covers(scene, omega, [goal, most])?.then_some(band))
}

impl Band {
    /// Adds the steady motions over a part, halving pieces until their energy is at most `goal` or they are too short. Returns whether it
    /// is proven that none touches a wall.
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

    /// Joins consecutive bands.
    pub fn joined(parts: Vec<Self>) -> Self {
        parts.into_iter().fold(Self::default(), |mut all, part| {
            all.pieces.extend(part.pieces);
            part.left_out.into_iter().for_each(|part| all.leave_out(part));
            all
        })
    }

    /// Adds a part left out, joined to the one before if they meet.
    fn leave_out(&mut self, part: LeftOut) {
        match self.left_out.last_mut() {
            Some(last) if last.omega[1] == part.omega[0] => {
                (last.omega[1], last.from_above) = (part.omega[1], part.from_above);
            }
            _ => self.left_out.push(part),
        }
    }

    /// Bounds on the largest E1max over all pieces, J; zero if there are none.
    pub fn energy(&self) -> Interval {
        self.pieces.iter().fold(Interval::ZERO, |most, piece| most.max(piece.largest.energy))
    }
}

impl Piece {
    /// A piece from the theorem proven over it.
    fn new(omega: [f64; 2], theorem: Theorem) -> Result<Self, Failure> {
        let Theorem { periods, impacts, largest, stability, .. } = theorem;
        Ok(Self { omega, periods, impacts, largest, multipliers: stability.stable()? })
    }
}

/// The claim to prove.
struct Task<'a> {
    scene: &'a Scene,
    most: f64,
    guesses: Guesses<'a>,
}

/// Consecutive pieces, the family of the first, and where and why the proof stopped.
struct March {
    pieces: Vec<Piece>,
    first: Option<Family>,
    stop: Option<(f64, Why)>,
}

impl Task<'_> {
    /// Proves pieces from one frequency up or down to another, starting from a neighbouring family or a guess.
    fn march(&self, [from, to]: [f64; 2], longest: f64, neighbour: Option<Family>) -> March {
        let (mut pieces, mut first, mut last) = (Vec::new(), None, neighbour);
        let (mut at, mut length) = (from, longest);
        while at != to {
            let end = if (to - at).abs() <= 1.01 * length { to } else { at + length.copysign(to - at) };
            let omega = [at.min(end), at.max(end)];
            match self.piece(omega, last.as_ref()) {
                Ok((piece, family)) => {
                    pieces.push(piece);
                    first.get_or_insert_with(|| family.clone());
                    (at, last, length) = (end, Some(family), (LONGER * (end - at).abs()).min(LONGEST));
                }
                // All motions of the piece exceed the bound.
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

    /// Proves one piece; returns it with its family.
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
