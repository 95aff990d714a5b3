//! Observed quantities of a periodic motion: its largest values and its impacts.

use crate::parameter::Error;
use crate::poincare::coupled;
use retune_model::{Measure, PerMeasure, Scene, Side};
use retune_solver::observe::{LargestValues, TouchDownTimes};
use retune_solver::{Follower, Motion, Phase, Settings};
use std::f64::consts::TAU;

/// The largest values and the impacts of a periodic motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seen {
    /// The walls that it strikes in turn, S for the structure and O for the obstacle, as the alphabetically first cyclic rotation; empty if
    /// none.
    pub impacts: String,
    /// The largest value of each measure.
    pub largest: PerMeasure<f64>,
    /// `[x1, v1, x2, v2]` at its first crest of the force.
    pub start: [f64; 4],
}

/// Observes a motion of `periods` periods, given by its states at the beginnings of equal segments. Each segment is run from its own state,
/// so that the run does not depart from an unstable motion.
///
/// # Errors
/// The scene cannot be run.
pub fn seen(scene: &Scene, settings: &Settings, periods: usize, states: &[[f64; 4]]) -> Result<Seen, Error> {
    let system = coupled(scene)?;
    let share = periods as f64 * TAU / system.bare().frequency() / states.len() as f64;
    let mut follower = Follower::new(&system, settings, share);
    let mut all = (LargestValues::new(&system, PerMeasure::EVERY), TouchDownTimes::default());
    for (k, &y) in states.iter().enumerate() {
        let start = Motion { t: k as f64 * share, y, phase: Phase::of(&system, &y) };
        follower.propagate(start, (k + 1) as f64 * share, &mut all)?;
    }
    let (values, touches) = all;
    let start = states.first().copied().unwrap_or_default();
    let impacts = canonical(touches.0.iter().map(|(_, side)| *side));
    Ok(Seen { impacts, largest: values.values(), start })
}

impl Seen {
    /// The largest value of a measure, in its unit.
    pub fn largest(&self, measure: Measure) -> f64 {
        self.largest.get(measure)
    }
}

/// The alphabetically first cyclic rotation of the impacts.
fn canonical(sides: impl Iterator<Item = Side>) -> String {
    let letter = |side: Side| if side == Side::Primary { 'S' } else { 'O' };
    let word: Vec<char> = sides.map(letter).collect();
    let turns = (0..word.len()).map(|from| [&word[from..], &word[..from]].concat());
    turns.min().unwrap_or_default().into_iter().collect()
}
