//! Whether a motion repeats: the states at whole periods of the force return, and their remaining drift is small.

use crate::settings::Settings;
use retune_model::{Coupled, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The criterion by which a motion is settled: its state recurs after a number of excitation periods, throughout successive
/// blocks of periods counted from t = 0. E1max is then that of the last block.
// States are compared at whole periods of the force: the structure's as a share of the largest `√(m1 v1² + k1 x1²)`, the damper's,
// relative to the structure, of the largest `√((x2 - x1 - D)² + (v2 - v1)²/ω²)` at these moments.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settle {
    /// Length of a block, in excitation periods. A motion with a longer period does not settle.
    #[schemars(range(min = 1, max = 10000))]
    pub periods: u32,
    /// Number of consecutive blocks that must agree.
    #[schemars(range(min = 2, max = 100))]
    pub blocks: u32,
    /// Tolerance on the state, relative to its size: on its change from one recurrence to the next, and on the sum of all future
    /// changes, extrapolated from their decay from block to block.
    #[serde(deserialize_with = "positive")]
    #[schemars(with = "Positive")]
    pub tolerance: f64,
}

fn positive<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Positive::deserialize(deserializer).map(Positive::get)
}

impl Default for Settle {
    fn default() -> Self {
        Self { periods: 6, blocks: 3, tolerance: 1e-5 }
    }
}

/// Limit on returns over which a change is summed.
const SLOWEST: f64 = 1e3;

/// The test whether states return, by which a run may stop.
///
/// It must prove recurrence: the rest of the run is not computed, so all future changes, extrapolated from their decay, must be small. Runs
/// that end when they repeat, and settled responses, use it. `retune-dynamics` has another test for motions that have been followed: of
/// what kind one is (`regime`), whether two are the same (`attractor`), from which orbit Newton's iteration is to begin
/// (`periodic::settle`). That is a classification: a motion that still drifts towards its orbit is of that orbit's kind, the least number
/// of periods matters, and distances weight both bodies by their energy (`record::coordinates`). A tolerance that suits one test is wrong
/// for the other, so there are two.
pub struct Recurrence<'a> {
    system: &'a Coupled,
    settle: Settle,
    /// The largest number of returns over which a change is summed, however slowly it falls.
    most_returns: f64,
}

impl<'a> Recurrence<'a> {
    /// A test by `settle` that sums all future changes, however small they are: for tolerances as tight as the solver's own.
    pub fn exhaustive(system: &'a Coupled, settle: Settle) -> Self {
        Self { system, settle, most_returns: SLOWEST }
    }

    /// A test by `settle`. Changes below a thousandth of its tolerance, or below the solver's own error at these settings, are
    /// taken as zero.
    pub fn new(system: &'a Coupled, settle: Settle, settings: &Settings) -> Self {
        const NOISE: f64 = 100.0;
        let resolved = settle.tolerance / (NOISE * settings.rtol);
        Self { system, settle, most_returns: resolved.clamp(1.0, SLOWEST) }
    }

    /// Whether the motion has settled, by the states of its last blocks at whole periods of the force.
    pub fn has_settled(&self, states: &[[f64; 4]]) -> bool {
        let Settle { periods, blocks, .. } = self.settle;
        let periods = periods as usize;
        if states.len() < periods * blocks as usize {
            return false;
        }
        let size = self.size(&states[states.len() - periods..]);
        (1..=periods).any(|lag| self.returns(states, lag, size))
    }

    /// Whether states return after `lag` periods.
    fn returns(&self, states: &[[f64; 4]], lag: usize, size: [f64; 2]) -> bool {
        let Settle { periods, tolerance, .. } = self.settle;
        let periods = periods as usize;
        let change = |i: usize| self.change(&states[i], &states[i - lag], size);
        let small = |change: f64| change <= tolerance;
        // The latest change rules out most states that do not return.
        if !small(change(states.len() - 1)) {
            return false;
        }
        // The largest change of each block but the first, and how slowly it falls from block to block.
        let (mut largest, mut falls) = (f64::NAN, f64::NAN);
        for block in (periods..states.len()).step_by(periods) {
            let now = (block..block + periods).map(change).fold(0.0, f64::max);
            if !small(now) {
                return false;
            }
            falls = falls.max(now / largest); // NaN for the first, which `max` ignores
            largest = now;
        }
        let share = falls.powf(lag as f64 / periods as f64);
        let returns = 1.0 / (1.0 - share);
        let to_come = if returns > 0.0 { returns.min(self.most_returns) } else { self.most_returns };
        largest == 0.0 || small(largest * to_come)
    }

    /// The parts of a state that are compared: energy of the structure, J, and `r² + (dr/dt)²/ω²` of the damper's place in it, m².
    fn parts(&self, [x1, v1, x2, v2]: [f64; 4]) -> [f64; 2] {
        let omega = self.system.bare().frequency();
        [self.system.bare().primary_energy(x1, v1), (x2 - x1).powi(2) + ((v2 - v1) / omega).powi(2)]
    }

    /// The sizes of both parts of a motion. A body that moves a million times less than the other is compared less closely.
    pub fn size(&self, states: &[[f64; 4]]) -> [f64; 2] {
        const LEAST: f64 = 1e-6;
        let omega = self.system.bare().frequency();
        let rest = self.system.rest_distance();
        let mut size = [0.0_f64; 2];
        for &[x1, v1, x2, v2] in states {
            let [structure, damper] = self.parts([x1, v1, x2 - rest, v2]);
            let moved = LEAST * damper.sqrt();
            let least = [
                self.system.bare().primary_energy(moved, omega * moved),
                LEAST * LEAST * (x1 * x1 + (v1 / omega).powi(2)),
            ];
            size = [size[0].max(structure).max(least[0]), size[1].max(damper).max(least[1])];
        }
        size
    }

    /// The change from one state to another, as a share of the size of the motion.
    pub fn change(&self, a: &[f64; 4], b: &[f64; 4], size: [f64; 2]) -> f64 {
        let [structure, damper] = self.parts(std::array::from_fn(|i| a[i] - b[i]));
        let share = |part: f64, size: f64| if part == 0.0 { 0.0 } else { (part / size).sqrt() };
        share(structure, size[0]).max(share(damper, size[1]))
    }
}
