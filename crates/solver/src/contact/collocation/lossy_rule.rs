//! The undisturbed collision of a loss at the nodes of its rule, and the iteration from there: computed once for a loss.

use super::disturbed::{Amounts, DisturbedCollision, DisturbedMotion, Linear};
use super::newton::Newton;
use super::node_law::NodeLaw;
use super::nodes::{Nodes, packed};
use super::rule::{Integrals, Rule, TAIL};
use super::undisturbed::{Lossy, lossy_clock};
use super::unit_law::UnitLaw;
use nalgebra::{DMatrix, DVector};
use retune_model::{Kept, RegularisedContact, Restoring};
use std::sync::{Arc, OnceLock};
use wide::f64x4;

/// Rules by the restitutions.
static RESTORING: Kept<LossyRules> = Kept::new();

/// The least restitution whose contacts are computed at once.
const LEAST: f64 = 0.3;

/// Undisturbed collisions by the law of Hunt and Crossley are cached for multiples of this χ, down to a restitution of 0.37.
const STEP: f64 = 0.1;
const STEPS: usize = 18;
static DAMPING: [OnceLock<LossyRules>; STEPS] = [const { OnceLock::new() }; STEPS];

/// The rules near an undisturbed collision, from few nodes to many.
pub struct LossyRules {
    pub few: LossyRule<12, 3>,
    pub some: LossyRule<16, 4>,
    pub more: LossyRule<20, 5>,
    pub many: LossyRule<24, 6>,
    /// The least tolerances at which common contacts pass the error estimate of each rule but the last.
    pub suffice: [f64; 3],
}

/// The error of the end of a contact over `tail^1.25`, for the rule of N nodes, as `TAIL`. With few nodes the inside of a contact with much
/// loss has more error than its end; with much loss the branch point is near (see `lossy_clock`), and coefficients fall slowly except with
/// the most nodes.
fn tail<const N: usize>(law: &UnitLaw) -> f64 {
    let slowly = match law {
        UnitLaw::Restoring(law) if N < 24 => (0.5 / law.restitution()).powi(4).max(1.0),
        _ => 1.0,
    };
    slowly * if N == 12 { 4e-3 } else { TAIL[2] }
}

/// As `solve::KINK`, for the rule of N nodes: a bound on what the linear theory gives for restitutions from 0.3, and for χ up to 1.75.
pub(super) fn kink<const N: usize>(law: &UnitLaw) -> f64 {
    let loss = match law {
        UnitLaw::Restoring(law) => 0.17 * (5.05 * (1.0 - law.restitution())).exp(),
        UnitLaw::Damping(chi) => 0.34 + 1.7 * chi,
    };
    loss / (N as f64).powi(4)
}

impl LossyRules {
    fn new(law: &UnitLaw) -> Self {
        let undisturbed = Lossy::new(law);
        // With e below 0.65 most contacts drawn at random need more than sixteen nodes at 1e-10.
        let suffice = match law {
            UnitLaw::Restoring(law) if law.restitution() < 0.65 => [1e-7, 1e-9, 1e-11],
            UnitLaw::Restoring(_) => [1e-7, 1e-10, 1e-11],
            UnitLaw::Damping(_) => [1e-7, 1e-10, 1e-12],
        };
        Self {
            suffice,
            few: LossyRule::new(law, &undisturbed),
            some: LossyRule::new(law, &undisturbed),
            more: LossyRule::new(law, &undisturbed),
            many: LossyRule::new(law, &undisturbed),
        }
    }

    /// The rules of a restitution. Not inlined: they are built in large arrays, which every run would have on its stack.
    #[inline(never)]
    fn restoring(law: &Arc<Restoring>) -> Arc<Self> {
        RESTORING.of(law.restitution(), || Self::new(&UnitLaw::Restoring(Arc::clone(law))))
    }

    /// The rules of the cached χ nearest to this one; `None` beyond the cached range.
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
    /// The loss of these equations; `None` without loss, and for restitutions below 0.3, to which [`kink`] and [`tail`] do not reach.
    pub fn of(equations: &RegularisedContact) -> Option<Self> {
        match equations.restoring() {
            Some(law) if law.restitution() >= LEAST => {
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
    /// The law at the nodes, if it is one of the same restitution at every speed.
    pub law: Option<NodeLaw<M>>,
    /// The error of the end of a contact over `tail^1.25`.
    pub tail: f64,
    /// The error by a bend that adds a cube of 1 to the depth.
    pub kink: f64,
    /// The iteration from the undisturbed collision.
    pub newton: Newton<N, M>,
}

impl<const N: usize, const M: usize> LossyRule<N, M> {
    fn new(law: &UnitLaw, undisturbed: &Lossy) -> Self {
        let duration = undisturbed.duration;
        let (rule, integrals) = Rule::new(lossy_clock(law), undisturbed.force(law), undisturbed.depth());
        let Integrals { depths, forces, .. } = &integrals;
        let speeds: [f64; N] = std::array::from_fn(|i| 1.0 - 1.25 * duration * integrals.whole(0, i));
        let slopes: [[f64; 2]; N] = std::array::from_fn(|i| force(law, depths[i], speeds[i]).1);
        let start = DVector::from_fn(N + 1, |i, _| if i < N { forces[i] } else { 1.0 });
        let equations = Equations { law, motion: DisturbedMotion { duration, integrals: &integrals } };
        Self {
            duration,
            tail: tail::<N>(law),
            kink: kink::<N>(law),
            forces: packed(forces),
            speeds: packed(&speeds),
            slopes: [0, 1].map(|by| packed::<N, M>(&slopes.map(|slopes| slopes[by]))),
            law: matches!(law, UnitLaw::Restoring(_)).then(|| NodeLaw::new(law, depths, &speeds)).flatten(),
            // With one restitution every contact has the same χ.
            newton: Newton::new(&start, if matches!(law, UnitLaw::Damping(_)) { 3 } else { 2 }, |amounts| {
                equations.solve(amounts, &start, &speeds, &slopes)
            }),
            rule,
        }
    }

    /// By how much the forces of the undisturbed collision differ from those of another law.
    #[inline(always)]
    pub fn force_offset(&self, law: &UnitLaw) -> Nodes<M> {
        match law {
            UnitLaw::Restoring(_) => [f64x4::ZERO; M],
            UnitLaw::Damping(_) => {
                let forces = self.at_nodes(law, &self.rule.depths, &self.speeds);
                std::array::from_fn(|i| self.forces[i] - forces[i])
            }
        }
    }

    /// The force `ζ^(3/2) φ` of a law at these depths and speeds of the nodes.
    #[inline(always)]
    pub fn at_nodes(&self, law: &UnitLaw, depths: &Nodes<M>, speeds: &Nodes<M>) -> Nodes<M> {
        let hertz: Nodes<M> = depths.map(|z| z * z.sqrt());
        let shares: Nodes<M> = std::array::from_fn(|i| hertz[i] * depths[i] * 0.5);
        let factors = self.law.as_ref().and_then(|law| law.push(&shares, speeds));
        let factors =
            factors.unwrap_or_else(|| std::array::from_fn(|i| law.push_of_four(shares[i], speeds[i])));
        std::array::from_fn(|i| hertz[i] * factors[i])
    }
}

/// The equations of a collision with loss: the unknowns are forces.
struct Equations<'a, const N: usize> {
    law: &'a UnitLaw,
    motion: DisturbedMotion<'a, N>,
}

impl<const N: usize> Equations<'_, N> {
    /// The collision under these amounts. The first residuals are those of a force that is linear about the undisturbed collision: before
    /// the duration fits, depths near the end may be below zero.
    fn solve(
        &self,
        amounts: Amounts,
        start: &DVector<f64>,
        speeds: &[f64; N],
        slopes: &[[f64; 2]; N],
    ) -> DisturbedCollision {
        let (law, depths) = (self.law.with_chi_offset(amounts[2]), &self.motion.integrals.depths);
        let linear = |i: usize, [z, w]: [f64; 2]| {
            let [by_z, by_w] = slopes[i];
            let (undisturbed, _) = force(&law, depths[i], speeds[i]);
            (undisturbed + by_z * (z - depths[i]) + by_w * (w - speeds[i]), slopes[i])
        };
        let (first, jacobian) = self.at(amounts, start, linear);
        let inverse = jacobian.try_inverse().expect("a collision is an isolated solution");
        let unknowns = start - inverse * &first;
        DisturbedCollision::solved(first, unknowns, |unknowns| {
            self.at(amounts, unknowns, |_, [z, w]| force(&law, z, w))
        })
    }

    /// Residuals and Jacobian under a law: forces and their slopes by depth and by speed.
    fn at(
        &self,
        amounts: Amounts,
        unknowns: &DVector<f64>,
        law: impl Fn(usize, [f64; 2]) -> (f64, [f64; 2]),
    ) -> (DVector<f64>, DMatrix<f64>) {
        let forces = unknowns.rows(0, N);
        let motions = [self.motion.depths(amounts, unknowns[N]), self.motion.speeds(amounts, unknowns[N])];
        let [depths, speeds] = motions.each_ref().map(|of| &of.free - &of.kernel * forces);
        let by = |of: &Linear, i: usize, j: usize| match j {
            j if j < N => -of.kernel[(i, j)],
            _ => of.free_slope[i] - (of.kernel_slope.row(i) * forces)[0],
        };
        let mut residual = DVector::zeros(N + 1);
        let mut jacobian = DMatrix::zeros(N + 1, N + 1);
        for i in 0..N {
            let (force, slopes) = law(i, [depths[i], speeds[i]]);
            residual[i] = unknowns[i] - force;
            for j in 0..=N {
                let changes =
                    slopes.iter().zip(&motions).map(|(slope, of)| slope * by(of, i, j)).sum::<f64>();
                jacobian[(i, j)] = f64::from(i == j) - changes;
            }
        }
        residual[N] = depths[N];
        for j in 0..=N {
            jacobian[(N, j)] = by(&motions[0], N, j);
        }
        (residual, jacobian)
    }
}

/// `ζ^(3/2) φ` and its slopes by depth and by speed.
fn force(law: &UnitLaw, z: f64, w: f64) -> (f64, [f64; 2]) {
    let [factor, by_z, by_w] = law.slopes(0.5 * z.powf(2.5), w);
    let root = z.sqrt();
    (z * root * factor, [root * (1.5 * factor + by_z), z * root * by_w])
}
