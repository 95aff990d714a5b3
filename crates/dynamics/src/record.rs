//! A motion recorded over many periods of the force, together with a neighbouring one: the data from which its regime is
//! classified.

use crate::lyapunov::{Exponent, Neighbours, Pair};
use crate::parameter::Error;
use crate::poincare::{PoincareMap, at_rest, coupled};
use retune_model::{Coupled, Scene};
use retune_solver::observe::{TouchDowns, Unobserved};
use retune_solver::{Motion, Phase, Settings, SolverError};

/// How long a motion is recorded, in periods of the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// Periods after which the motion is taken to have settled; they are recorded too, to see transients.
    pub settle: usize,
    /// Periods after that, from which the regime is determined.
    pub observe: usize,
}

impl Default for Stretch {
    fn default() -> Self {
        Self { settle: 500, observe: 500 }
    }
}

/// A motion, once per period.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Period of the force, s.
    pub period: f64,
    /// States in coordinates with the common unit √J (see [`coordinates`]), one at the end of each period.
    pub samples: Vec<[f64; 4]>,
    /// Impacts in each period, on the structure and on the obstacle.
    pub impacts: Vec<[u64; 2]>,
    /// Logarithm of the neighbour's growth in each period.
    pub growth: Vec<f64>,
    /// How many of the first periods are treated as transient.
    pub settle: usize,
}

/// Initial distance of the neighbour, as a share of the size of the motion.
const APART: f64 = 1e-7;
/// Largest tolerance of a step: a thousandth of the distance of the neighbours or less.
const TOLERANCE: f64 = 1e-11;

/// The state in the common unit √J: `[ω√m1 x1, √m1 v1, ω√m2 (x2 - x1 - D), √m2 v2]`. Its square is twice the kinetic energy plus
/// that of springs that would resonate at ω, so that a distance weighs all four coordinates by their energy.
pub fn coordinates(scene: &Scene, &[x1, v1, x2, v2]: &[f64; 4]) -> [f64; 4] {
    let d = scene.damper.map_or(0.0, |damper| damper.rest_distance.get());
    let [a, b, c, e] = weights(scene);
    [a * x1, b * v1, c * (x2 - x1 - d), e * v2]
}

/// The state `[x1, v1, x2, v2]` (m, m/s) with these [`coordinates`]; its inverse. Not finite where the force has no frequency; x2 is that of
/// a scene with a damper.
pub fn state(scene: &Scene, &[q1, p1, q2, p2]: &[f64; 4]) -> [f64; 4] {
    let d = scene.damper.map_or(0.0, |damper| damper.rest_distance.get());
    let [a, b, c, e] = weights(scene);
    let x1 = q1 / a;
    [x1, p1 / b, q2 / c + x1 + d, p2 / e]
}

/// `[ω√m1, √m1, ω√m2, √m2]`: the weights of positions (√J/m) and speeds (√J s/m) in the common unit.
pub(crate) fn weights(scene: &Scene) -> [f64; 4] {
    let omega = scene.forcing.frequency.get();
    let m1 = scene.primary.mass.get().sqrt();
    let m2 = scene.damper.map_or(0.0, |damper| damper.mass.get().sqrt());
    [omega * m1, m1, omega * m2, m2]
}

/// Euclidean distance.
pub(crate) fn distance(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Root mean square of states about zero, √J.
pub(crate) fn size(states: &[[f64; 4]]) -> f64 {
    let sum: f64 = states.iter().map(|y| y.iter().map(|v| v * v).sum::<f64>()).sum();
    (sum / states.len().max(1) as f64).sqrt()
}

struct Twins<'a> {
    scene: &'a Scene,
    system: &'a Coupled,
    map: PoincareMap<'a>,
}

impl Neighbours for Twins<'_> {
    type State = Motion;
    type Error = SolverError;

    fn step(&mut self, state: Motion) -> Result<Motion, SolverError> {
        self.map.next(state, &mut Unobserved)
    }
    fn distance(&self, a: Motion, b: Motion) -> f64 {
        distance(&coordinates(self.scene, &a.y), &coordinates(self.scene, &b.y))
    }
    fn between(&self, a: Motion, b: Motion, share: f64) -> Motion {
        let y = std::array::from_fn(|i| a.y[i] + share * (b.y[i] - a.y[i]));
        Motion { t: a.t, y, phase: Phase::of(self.system, &y) }
    }
}

/// Records the motion of a scene from `start` (at a crest of the force), or from rest.
///
/// # Errors
/// See [`Error`].
pub fn follow(
    scene: &Scene,
    start: Option<Motion>,
    stretch: Stretch,
    settings: &Settings,
) -> Result<Record, Error> {
    let system = coupled(scene)?;
    let settings = Settings { rtol: settings.rtol.min(TOLERANCE), ..*settings };
    let start = start.unwrap_or_else(|| at_rest(&system));
    let mut twins = Twins { scene, system: &system, map: PoincareMap::new(&system, &settings) };
    let mut ahead = PoincareMap::new(&system, &settings);
    let count = stretch.settle + stretch.observe;
    let mut record = Record {
        period: ahead.period(),
        samples: Vec::with_capacity(count),
        impacts: Vec::with_capacity(count),
        growth: Vec::with_capacity(count),
        settle: stretch.settle,
    };
    // At most the amplitude of the structure without its damper, and at least a tenth of it: only the order of magnitude matters.
    let size = (system.energy_norm_growth() * record.period).max(f64::MIN_POSITIVE);
    let mut pair = Pair {
        motion: start,
        neighbour: beside(scene, &system, start, APART * size),
        distance: APART * size,
    };
    for _ in 0..count {
        let mut touches = TouchDowns::default();
        let motion = ahead.next(pair.motion, &mut touches)?;
        record.growth.push(pair.advance(&mut twins, motion)?);
        record.samples.push(coordinates(scene, &motion.y));
        record.impacts.push(touches.0);
    }
    Ok(record)
}

/// A neighbouring state at the given distance, in an arbitrary direction.
fn beside(scene: &Scene, system: &Coupled, motion: Motion, distance: f64) -> Motion {
    let unit = coordinates(scene, &[1.0, 1.0, 2.0 + system.rest_distance(), 1.0]);
    let share = 0.5 * distance;
    let [a, b, c, d] = unit.map(|scale| share / scale);
    let [x1, v1, x2, v2] = motion.y;
    let y = [x1 + a, v1 - b, x2 + a + c, v2 + d];
    Motion { t: motion.t, y, phase: Phase::of(system, &y) }
}

impl Record {
    /// The exponent of the settled motion, 1/s.
    pub fn exponent(&self) -> Exponent {
        Exponent::of(&self.growth[self.settle.min(self.growth.len())..], self.period)
    }

    /// Root mean square of the settled samples about zero, √J: the scale for distances.
    pub fn scale(&self) -> f64 {
        size(&self.samples[self.settle.min(self.samples.len())..])
    }
}
