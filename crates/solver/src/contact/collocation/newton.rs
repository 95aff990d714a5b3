//! Newton's iteration for collisions that are nearly undisturbed, with inverse Jacobians computed once per program.
//!
//! The unknowns are the depths `ζ` at the nodes and the duration `σ` in units of the undisturbed collision's, the residuals those
//! of the motion at the nodes and at the end. The two perturbations that matter most are a steady acceleration `α` and a drag `β`,
//!
//! ```text
//! ζ'' = -Λ ζ^(3/2) + α - β ζ'
//! ```
//!
//! and the first change of the iteration gives the amount of each. Their second-order correction is then added to that change, and
//! the inverse Jacobian corrected for them to first order: instead of one and a half digits an iteration gains three. Where contacts lose
//! energy by the law of Hunt and Crossley, the difference of their χ from that of the undisturbed collision is a third.

use super::disturbed::{Amounts, DisturbedCollision, UNDISTURBED};
use super::nodes::{Nodes, dot, packed, product};
use nalgebra::{DMatrix, DVector};
use wide::f64x4;

/// A vector of a number for each node and one more, for the duration or the end.
pub type Extended<const M: usize> = (Nodes<M>, f64);

fn extended<const N: usize, const M: usize>(number: impl Fn(usize) -> f64) -> Extended<M> {
    (packed::<N, M>(&std::array::from_fn(&number)), number(N))
}

/// A matrix of `N + 1` rows and columns: `body[j]` for node `j` and the last column, all but their last rows, which are `row`.
#[repr(C, align(64))]
struct Bordered<const N: usize, const M: usize> {
    body: [Nodes<M>; N],
    column: Nodes<M>,
    row: Extended<M>,
}

impl<const N: usize, const M: usize> Bordered<N, M> {
    fn new(matrix: &DMatrix<f64>) -> Self {
        let column = |j: usize| packed::<N, M>(&std::array::from_fn(|i| matrix[(i, j)]));
        Self {
            body: std::array::from_fn(column),
            column: column(N),
            row: extended::<N, M>(|j| matrix[(N, j)]),
        }
    }

    #[inline(always)]
    fn times(&self, (vector, last): (&Nodes<M>, f64)) -> Extended<M> {
        let mut sum = product(&self.body, vector);
        for i in 0..M {
            sum[i] += self.column[i] * last;
        }
        (sum, dot(&self.row.0, vector) + self.row.1 * last)
    }
}

/// Inverse Jacobian at the undisturbed collision, and how disturbances move it.
pub struct Newton<const N: usize, const M: usize> {
    undisturbed: Bordered<N, M>,
    perturbations: Vec<Perturbation<N, M>>,
    /// Second-order corrections of the unknowns: for each pair of perturbations, the squares first.
    second_order: Vec<([usize; 2], Extended<M>)>,
}

struct Perturbation<const N: usize, const M: usize> {
    /// The row whose product with the first change is the amount of this perturbation.
    row: Extended<M>,
    /// The change of the inverse Jacobian by a unit of it.
    correction: Bordered<N, M>,
}

/// Disturbances small enough to be linear: an acceleration, a drag, a difference of χ.
const UNITS: Amounts = [0.05, 0.02, 0.02];

impl<const N: usize, const M: usize> Newton<N, M> {
    /// Prepares the iteration from the unknowns of the undisturbed collision and the solutions under the first `count` perturbations.
    pub fn new(start: &DVector<f64>, count: usize, solve: impl Fn(Amounts) -> DisturbedCollision) -> Self {
        let undisturbed = solve(UNDISTURBED).inverse;
        // The change left after the first iteration, the change in it, and the converged inverse Jacobian.
        let with = |units: &[(usize, f64)]| {
            let mut amounts = UNDISTURBED;
            units.iter().for_each(|&(of, unit)| amounts[of] = unit * UNITS[of]);
            let DisturbedCollision { first, unknowns, inverse } = solve(amounts);
            let change = -&undisturbed * first;
            (unknowns - start - &change, change, inverse)
        };
        // Each perturbation and its opposite, and two perturbations together: first and second differences.
        let pairs: Vec<_> = (0..count).map(|of| [with(&[(of, 1.0)]), with(&[(of, -1.0)])]).collect();
        let changes: Vec<_> = pairs.iter().map(|[more, less]| (&more.1 - &less.1) / 2.0).collect();
        let changes = DMatrix::from_columns(&changes);
        let bends: Vec<_> = pairs.iter().map(|[more, less]| (&more.0 + &less.0) / 2.0).collect();
        let mixed = (0..count).flat_map(|b| (0..b).map(move |a| [a, b])).map(|[a, b]| {
            let both = with(&[(a, 1.0), (b, 1.0)]).0;
            ([a, b], both - &bends[a] - &bends[b])
        });
        let second_order = bends.iter().cloned().enumerate().map(|(of, bend)| ([of, of], bend)).chain(mixed);
        // Least squares: (CᵀC)⁻¹ Cᵀ; changes are subtracted.
        let normal = (changes.transpose() * &changes).try_inverse().expect("the perturbations differ");
        let rows = -(normal * changes.transpose());
        let perturbation = |c: usize| Perturbation {
            row: extended::<N, M>(|i| rows[(c, i)]),
            correction: Bordered::new(&((&pairs[c][0].2 - &pairs[c][1].2) / 2.0)),
        };
        Self {
            undisturbed: Bordered::new(&undisturbed),
            perturbations: (0..count).map(perturbation).collect(),
            second_order: second_order.map(|(of, bend)| (of, extended::<N, M>(|i| bend[i]))).collect(),
        }
    }

    /// The second-order correction of the unknowns for these amounts of the perturbations.
    #[inline(always)]
    pub fn second_order(&self, amounts: Amounts) -> Extended<M> {
        let (mut change, mut duration) = ([f64x4::ZERO; M], 0.0);
        for ([a, b], (bend, last)) in &self.second_order {
            let weight = amounts[*a] * amounts[*b];
            for i in 0..M {
                change[i] += bend[i] * weight;
            }
            duration += weight * last;
        }
        (change, duration)
    }

    /// The amount of each perturbation, from the first change.
    #[inline(always)]
    pub fn amounts(&self, change: &Nodes<M>, lengthening: f64) -> Amounts {
        let mut amounts = UNDISTURBED;
        for (amount, Perturbation { row: (row, last), .. }) in amounts.iter_mut().zip(&self.perturbations) {
            *amount = dot(row, change) + last * lengthening;
        }
        amounts
    }

    /// The change in one Newton iteration: the inverse Jacobian for these amounts of the perturbations times the residuals.
    #[inline(always)]
    pub fn change(&self, amounts: Amounts, residual: &Nodes<M>, last: f64) -> Extended<M> {
        let (mut change, mut lengthening) = self.undisturbed.times((residual, last));
        if amounts != UNDISTURBED {
            for (perturbation, amount) in self.perturbations.iter().zip(amounts) {
                let (correction, end) = perturbation.correction.times((residual, last));
                for i in 0..M {
                    change[i] += correction[i] * amount;
                }
                lengthening += amount * end;
            }
        }
        (change, lengthening)
    }
}
