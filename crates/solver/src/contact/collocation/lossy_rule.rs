//! The undisturbed collision of a loss at the nodes of its rule, and the inverse Jacobian there: computed once for a loss.

use super::nodes::{Nodes, dot, node, packed};
use super::rule::{Integrals, Rule};
use super::undisturbed::{Lossy, leaning};
use super::unit_law::UnitLaw;
use nalgebra::DMatrix;
use retune_model::{Kept, RegularisedContact, Restoring};
use std::sync::{Arc, OnceLock};
use wide::f64x4;

/// Rules by the restitutions.
static RESTORING: Kept<LossyRules> = Kept::new();

/// The χ whose undisturbed collisions are kept of the law of Hunt and Crossley: multiples of this, up to a restitution of 0.37.
const STEP: f64 = 0.1;
const STEPS: usize = 18;
static DAMPING: [OnceLock<LossyRules>; STEPS] = [const { OnceLock::new() }; STEPS];

/// The rules near an undisturbed collision, from few nodes to many.
pub struct LossyRules {
    pub few: LossyRule<16, 4>,
    pub some: LossyRule<20, 5>,
    pub many: LossyRule<24, 6>,
}

impl LossyRules {
    fn new(law: &UnitLaw) -> Self {
        let undisturbed = Lossy::new(law);
        Self {
            few: LossyRule::new(law, &undisturbed),
            some: LossyRule::new(law, &undisturbed),
            many: LossyRule::new(law, &undisturbed),
        }
    }

    /// Those of a restitution.
    fn restoring(law: &Arc<Restoring>) -> Arc<Self> {
        RESTORING.of(law.restitution(), || Self::new(&UnitLaw::Restoring(Arc::clone(law))))
    }

    /// Those of the kept χ next to one; none if that is beyond them.
    fn damping(chi: f64) -> Option<&'static Self> {
        let step = (chi / STEP).round();
        let kept = DAMPING.get(step as usize).filter(|_| step >= 0.0)?;
        Some(kept.get_or_init(|| Self::new(&UnitLaw::Damping(STEP * step))))
    }
}

/// The loss of the contacts with a wall, where they can be computed at once.
pub enum Loss {
    Restoring(Arc<LossyRules>, UnitLaw),
    /// λ, s/m.
    Damping(f64),
}

impl Loss {
    /// Of equations; none without loss, and for restitutions below 0.3, which have no tables.
    pub fn of(equations: &RegularisedContact) -> Option<Self> {
        match equations.restoring() {
            Some(law) if law.is_tabulated() => {
                Some(Self::Restoring(LossyRules::restoring(law), UnitLaw::Restoring(Arc::clone(law))))
            }
            Some(_) => None,
            None => Some(equations.lambda()).filter(|lambda| *lambda > 0.0).map(Self::Damping),
        }
    }

    /// The rules for a contact that begins at a speed, m/s, and its law.
    pub fn rules(&self, speed: f64) -> Option<(&LossyRules, UnitLaw)> {
        match self {
            Self::Restoring(rules, law) => Some((rules, law.clone())),
            Self::Damping(lambda) => {
                LossyRules::damping(lambda * speed).map(|rules| (rules, UnitLaw::Damping(lambda * speed)))
            }
        }
    }
}

/// A rule for collisions near the undisturbed one of a law, and their iteration. Lengths are in units of the greatest depth Z without loss, speeds
/// in that at touch-down, w, times in Z/w, forces in `K Z^(3/2)`.
pub struct LossyRule<const N: usize, const M: usize> {
    /// Duration of the undisturbed collision.
    pub duration: f64,
    pub rule: Rule<N, M>,
    /// The forces of the undisturbed collision at the nodes.
    pub forces: Nodes<M>,
    /// The speeds of its indentation.
    pub speeds: Nodes<M>,
    /// The slopes of its force by depth and by speed.
    pub slopes: [Nodes<M>; 2],
    /// The inverse Jacobian there: a column for each node; that of the end and the last row apart.
    inverse: [Nodes<M>; N],
    last_column: Nodes<M>,
    last_row: (Nodes<M>, f64),
}

/// A vector of forces and the duration.
pub type Unknowns<const M: usize> = (Nodes<M>, f64);

/// Their inner product.
pub fn inner<const M: usize>(a: &Unknowns<M>, b: &Unknowns<M>) -> f64 {
    dot(&a.0, &b.0) + a.1 * b.1
}

impl<const N: usize, const M: usize> LossyRule<N, M> {
    fn new(law: &UnitLaw, undisturbed: &Lossy) -> Self {
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
            duration,
            rule,
            forces: packed(forces),
            speeds: packed(&speeds),
            slopes: [0, 1].map(|by| packed::<N, M>(&slopes.map(|slopes| slopes[by]))),
            inverse: std::array::from_fn(column),
            last_column: column(N),
            last_row: (packed::<N, M>(&std::array::from_fn(|j| inverse[(N, j)])), inverse[(N, N)]),
        }
    }

    /// The change by the inverse Jacobian of the undisturbed collision.
    #[inline(always)]
    pub fn change(&self, (residual, end): &Unknowns<M>) -> Unknowns<M> {
        let mut change = [f64x4::ZERO; M];
        for (column, i) in self.inverse.iter().zip(0..) {
            let by = node(residual, i);
            for (change, column) in change.iter_mut().zip(column) {
                *change += *column * by;
            }
        }
        for (change, column) in change.iter_mut().zip(&self.last_column) {
            *change = -(*change + *column * *end);
        }
        (change, -(dot(&self.last_row.0, residual) + self.last_row.1 * end))
    }
}

/// The inverse Jacobian of the residuals at the undisturbed collision, by forces and duration: with `Λ = (5/4) D²`,
/// `ζ = D σ τ - Λ σ² m_1` and `ż/w = 1 - (Λ/D) σ m_0`.
fn inverse<const N: usize>(duration: f64, integrals: &Integrals<N>, slopes: &[[f64; 2]; N]) -> DMatrix<f64> {
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
