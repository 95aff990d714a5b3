//! The undisturbed collision of a restitution at the nodes of its rule, and the inverse Jacobian there: computed once for a restitution.

use super::nodes::{Nodes, dot, node, packed};
use super::rule::{Integrals, Rule};
use super::undisturbed::{Lossy, leaning};
use nalgebra::DMatrix;
use retune_model::Restoring;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use wide::f64x4;

/// Most laws whose rules are kept: a study has a few restitutions.
const KEPT: usize = 64;
/// The rules of laws by the bits of their restitutions.
static RULES: Mutex<BTreeMap<u64, Arc<LossyRule>>> = Mutex::new(BTreeMap::new());

/// A rule for collisions near the undisturbed one of a law, and their iteration. Lengths are in units of the greatest depth Z without loss, speeds
/// in that at touch-down, w, times in Z/w, forces in `K Z^(3/2)`.
pub struct LossyRule {
    pub law: Restoring,
    /// Duration of the undisturbed collision.
    pub duration: f64,
    pub rule: Rule<N, M>,
    /// The forces of the undisturbed collision at the nodes.
    pub forces: Nodes<M>,
    /// The speeds of its indentation.
    pub speeds: Nodes<M>,
    /// The slopes of its force by depth and by speed.
    pub slopes: [Nodes<M>; 2],
    /// The inverse Jacobian there: a column for each node and one for the end; last rows apart.
    inverse: [Nodes<M>; N + 1],
    last_row: (Nodes<M>, f64),
}

/// Nodes, four side by side.
pub const N: usize = 4 * M;
pub const M: usize = 6;

/// A vector of forces and the duration.
pub type Unknowns = (Nodes<M>, f64);

/// Their inner product.
pub fn inner(a: &Unknowns, b: &Unknowns) -> f64 {
    dot(&a.0, &b.0) + a.1 * b.1
}

impl LossyRule {
    /// The rule of a law, computed once for a restitution.
    pub fn of(law: &Restoring) -> Arc<Self> {
        let key = law.restitution().to_bits();
        // A rule is whole before it is kept, so that a panic elsewhere has left nothing half done.
        if let Some(rule) = RULES.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Arc::clone(rule);
        }
        let rule = Arc::new(Self::new(law));
        let mut kept = RULES.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= KEPT {
            kept.clear();
        }
        kept.insert(key, Arc::clone(&rule));
        rule
    }

    fn new(law: &Restoring) -> Self {
        let undisturbed = Lossy::new(law);
        let duration = undisturbed.duration;
        let (rule, integrals) = Rule::new(leaning, undisturbed.force(law), undisturbed.depth());
        let Integrals { depths, forces, .. } = &integrals;
        let speeds: [f64; N] = std::array::from_fn(|i| 1.0 - 1.25 * duration * integrals.whole(0, i));
        let slopes: [[f64; 2]; N] = std::array::from_fn(|i| {
            let (z, [factor, by_z, by_w]) = (depths[i], law.slopes(0.5 * depths[i].powf(2.5), speeds[i]));
            [z.sqrt() * (1.5 * factor + by_z), z * z.sqrt() * by_w]
        });
        let inverse = inverse(duration, &integrals, &slopes);
        let column = |j: usize| packed::<N, M>(&std::array::from_fn(|i| inverse[(i, j)]));
        Self {
            law: law.clone(),
            duration,
            rule,
            forces: packed(forces),
            speeds: packed(&speeds),
            slopes: [0, 1].map(|by| packed::<N, M>(&slopes.map(|slopes| slopes[by]))),
            inverse: std::array::from_fn(column),
            last_row: (packed::<N, M>(&std::array::from_fn(|j| inverse[(N, j)])), inverse[(N, N)]),
        }
    }

    /// The change by the inverse Jacobian of the undisturbed collision.
    #[inline(always)]
    pub fn change(&self, (residual, end): &Unknowns) -> Unknowns {
        let (columns, last) = self.inverse.split_at(N);
        let mut change = [f64x4::ZERO; M];
        for (column, i) in columns.iter().zip(0..) {
            let by = node(residual, i);
            for (change, column) in change.iter_mut().zip(column) {
                *change += *column * by;
            }
        }
        for (change, column) in change.iter_mut().zip(&last[0]) {
            *change = -(*change + *column * *end);
        }
        (change, -(dot(&self.last_row.0, residual) + self.last_row.1 * end))
    }
}

/// The inverse Jacobian of the residuals at the undisturbed collision, by forces and duration: with `Λ = (5/4) D²`,
/// `ζ = D σ τ - Λ σ² m_1` and `ż/w = 1 - (Λ/D) σ m_0`.
fn inverse(duration: f64, integrals: &Integrals<N>, slopes: &[[f64; 2]; N]) -> DMatrix<f64> {
    let stiffness = 1.25 * duration * duration;
    let jacobian = DMatrix::from_fn(N + 1, N + 1, |i, j| {
        let [depth, speed] = if j < N {
            [-stiffness * integrals.moment(1, i, j), -stiffness / duration * integrals.moment(0, i, j)]
        } else {
            let time = if i < N { integrals.times[i] } else { 1.0 };
            [
                duration * time - 2.0 * stiffness * integrals.whole(1, i),
                -stiffness / duration * integrals.whole(0, i),
            ]
        };
        if i == N {
            return depth;
        }
        let [by_depth, by_speed] = slopes[i];
        f64::from(i == j) - by_depth * depth - by_speed * speed
    });
    jacobian.try_inverse().expect("a collision is an isolated solution")
}
