//! Properties of a periodic motion: its largest values, its impacts, its stability.

use super::forced::Forced;
use super::seen::Seen;
use super::shooting::{Shooting, Solution};
use crate::parameter::Error;
use nalgebra::{Complex, Matrix4};

/// A periodic motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// The parameter's value.
    pub value: f64,
    /// Periods of the force.
    pub periods: usize,
    /// `[x1, v1, x2, v2]` at the beginnings of its segments, the first at a crest of the force.
    pub states: Vec<[f64; 4]>,
    /// Floquet multipliers, the largest first: a small change grows by them each time the motion repeats.
    pub multipliers: [Complex<f64>; 4],
    /// Its largest values and its impacts.
    pub seen: Seen,
}

impl Orbit {
    /// The properties of a solution.
    ///
    /// # Errors
    /// The system cannot be run there.
    pub fn of(shooting: &Shooting<impl Forced>, solution: &Solution) -> Result<Self, Error> {
        let (value, states) = (shooting.value(&solution.x), shooting.states(&solution.x));
        let seen = shooting.forced.seen(value, shooting.periods, &states)?;
        let multipliers = multipliers(&solution.at.monodromy());
        Ok(Self { value, periods: shooting.periods, states, multipliers, seen })
    }

    /// Recomputes its largest values after its states or its value were changed, so that they can be reproduced from these bit for bit.
    pub(super) fn recompute_seen(&mut self, shooting: &Shooting<impl Forced>) -> Option<()> {
        self.seen = shooting.forced.seen(self.value, self.periods, &self.states).ok()?;
        Some(())
    }

    /// Whether small changes die out.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].norm() < 1.0
    }
}

/// The eigenvalues of a monodromy matrix, the largest first.
pub fn multipliers(monodromy: &Matrix4<f64>) -> [Complex<f64>; 4] {
    let mut all: [Complex<f64>; 4] = monodromy.complex_eigenvalues().into();
    all.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    all
}
