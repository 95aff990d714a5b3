//! Newton's iteration for collisions that are nearly undisturbed, with inverse Jacobians computed once a program.
//!
//! The unknowns are the depths `ζ` at the nodes and the duration `σ` in units of the undisturbed collision's, the residuals those
//! of the motion at the nodes and at the end. The two perturbations that matter most are a steady acceleration `α` and a drag `β`,
//!
//! ```text
//! ζ'' = -Λ ζ^(3/2) + α - β ζ'
//! ```
//!
//! and the first change of the iteration gives the amount of each. Their second-order correction is then added to that change, and
//! the inverse Jacobian corrected for them to first order: instead of one and a half digits an iteration gains three.

use super::nodes::{Nodes, dot, packed, product};
use super::undisturbed::{DURATION, STIFFNESS};
use crate::motion::linearised::MOMENTS;
use nalgebra::{DMatrix, DVector};
use wide::f64x4;

/// A vector of a number for each node and one more, for the duration or the end.
type Extended<const M: usize> = (Nodes<M>, f64);

fn extended<const N: usize, const M: usize>(number: impl Fn(usize) -> f64) -> Extended<M> {
    (packed::<N, M>(&std::array::from_fn(&number)), number(N))
}

/// A matrix of `N + 1` rows and columns: `body[j]` for node `j` and the last column, all but their last rows, which are `row`.
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
    perturbations: [Perturbation<N, M>; 2],
    /// Second-order corrections of depths and duration: for the square of the first perturbation, of the second, and their product.
    second_order: [Extended<M>; 3],
}

struct Perturbation<const N: usize, const M: usize> {
    /// The row whose product with the first change is the amount of this perturbation.
    row: Extended<M>,
    /// The change of the inverse Jacobian by a unit of it.
    correction: Bordered<N, M>,
}

/// Disturbances small enough to be linear.
const ACCELERATION: f64 = 0.05;
const DRAG: f64 = 0.02;

impl<const N: usize, const M: usize> Newton<N, M> {
    /// Prepares the iteration from times and depths of the nodes and the moments of forces there and at the end.
    pub fn new(
        times: &[f64; N],
        depths: &[f64; N],
        moments: &[[[f64; N]; N]; MOMENTS],
        last: &[[f64; N]; MOMENTS],
    ) -> Self {
        let time = DVector::from_fn(N + 1, |i, _| if i < N { times[i] } else { 1.0 });
        let moment =
            |k: usize| DMatrix::from_fn(N + 1, N, |i, j| if i < N { moments[k][j][i] } else { last[k][j] });
        let (once, twice, thrice) = (moment(1), moment(2), moment(3));
        let start = DVector::from_fn(N + 1, |i, _| if i < N { depths[i] } else { 1.0 });
        // Residuals and Jacobian of a disturbed collision.
        let equations = |alpha: f64, beta: f64, unknowns: &DVector<f64>| {
            let sigma = unknowns[N];
            let force = unknowns.rows(0, N).map(|z| z.powf(1.5));
            let t = &time * sigma;
            // The response to a unit of force, (1 - e^(-βt)) / β = t - β t²/2 + β² t³/6, and to a touch-down at unit speed.
            let kernel = (&once * sigma.powi(2) - &twice * (beta * sigma.powi(3))
                + &thrice * (beta.powi(2) * sigma.powi(4)))
                * STIFFNESS;
            let slope = (&once * (2.0 * sigma) - &twice * (3.0 * beta * sigma.powi(2))
                + &thrice * (4.0 * beta.powi(2) * sigma.powi(3)))
                * STIFFNESS;
            let free = t.map(|t| {
                DURATION * t * (1.0 - beta * t / 2.0 + (beta * t).powi(2) / 6.0)
                    + alpha * t * t * (0.5 - beta * t / 6.0)
            });
            let free_slope = t.map(|t| {
                DURATION * (1.0 - beta * t + (beta * t).powi(2) / 2.0) + alpha * t * (1.0 - beta * t / 2.0)
            });
            let by_duration = &slope * &force - free_slope.component_mul(&time);
            let jacobian = DMatrix::from_fn(N + 1, N + 1, |i, j| {
                if j == N {
                    by_duration[i]
                } else {
                    f64::from(i == j) + 1.5 * kernel[(i, j)] * unknowns[j].sqrt()
                }
            });
            let mut residual = kernel * force - free;
            for i in 0..N {
                residual[i] += unknowns[i];
            }
            (residual, jacobian.try_inverse().expect("a collision is an isolated solution"))
        };
        let solution = |alpha: f64, beta: f64| {
            let (mut unknowns, mut inverse) = (start.clone(), DMatrix::zeros(0, 0));
            for _ in 0..12 {
                let (residual, here) = equations(alpha, beta, &unknowns);
                unknowns -= &here * residual;
                inverse = here;
            }
            (unknowns, inverse)
        };
        let (start, undisturbed) = solution(0.0, 0.0);
        // The change left after the first iteration, the change in it, and the converged inverse Jacobian.
        let with = |a: f64, b: f64| {
            let (alpha, beta) = (a * ACCELERATION, b * DRAG);
            let change = -&undisturbed * equations(alpha, beta, &start).0;
            let (unknowns, inverse) = solution(alpha, beta);
            (unknowns - &start - &change, change, inverse)
        };
        // Each perturbation and its opposite, and both perturbations together: first and second differences.
        let pairs = [[with(1.0, 0.0), with(-1.0, 0.0)], [with(0.0, 1.0), with(0.0, -1.0)]];
        let changes = DMatrix::from_columns(&pairs.each_ref().map(|[more, less]| (&more.1 - &less.1) / 2.0));
        let [first, second] = pairs.each_ref().map(|[more, less]| (&more.0 + &less.0) / 2.0);
        let both = with(1.0, 1.0).0 - &first - &second;
        // Least squares: (CᵀC)⁻¹ Cᵀ; a change is what is subtracted.
        let normal = (changes.transpose() * &changes).try_inverse().expect("the two perturbations differ");
        let rows = -(normal * changes.transpose());
        let perturbation = |c: usize| Perturbation {
            row: extended::<N, M>(|i| rows[(c, i)]),
            correction: Bordered::new(&((&pairs[c][0].2 - &pairs[c][1].2) / 2.0)),
        };
        Self {
            undisturbed: Bordered::new(&undisturbed),
            perturbations: [perturbation(0), perturbation(1)],
            second_order: [first, second, both].map(|bend| extended::<N, M>(|i| bend[i])),
        }
    }

    /// The second-order correction of depths and duration for these amounts of the perturbations.
    #[inline(always)]
    pub fn second_order(&self, [a, b]: [f64; 2]) -> Extended<M> {
        let (mut depths, mut duration) = ([f64x4::ZERO; M], 0.0);
        for ((bend, last), weight) in self.second_order.iter().zip([a * a, b * b, a * b]) {
            for i in 0..M {
                depths[i] += bend[i] * weight;
            }
            duration += weight * last;
        }
        (depths, duration)
    }

    /// The amount of each perturbation, from the first change at the nodes and of the duration.
    #[inline(always)]
    pub fn shares(&self, change: &Nodes<M>, lengthening: f64) -> [f64; 2] {
        let share = |Perturbation { row: (row, last), .. }: &Perturbation<N, M>| {
            dot(row, change) + last * lengthening
        };
        self.perturbations.each_ref().map(share)
    }

    /// The change in one Newton iteration: the inverse Jacobian for these amounts of the perturbations times the residuals.
    #[inline(always)]
    pub fn change(&self, shares: [f64; 2], residual: &Nodes<M>, last: f64) -> Extended<M> {
        let (mut change, mut lengthening) = self.undisturbed.times((residual, last));
        if shares != [0.0; 2] {
            for (perturbation, share) in self.perturbations.iter().zip(shares) {
                let (correction, end) = perturbation.correction.times((residual, last));
                for i in 0..M {
                    change[i] += correction[i] * share;
                }
                lengthening += share * end;
            }
        }
        (change, lengthening)
    }
}
