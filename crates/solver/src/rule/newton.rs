//! Newton's iteration for collisions that are nearly undisturbed, with inverse Jacobians computed once for all.
//!
//! The unknowns are the depths `ζ` at the nodes and the duration `σ` in units of the undisturbed collision's, the residuals those
//! of the motion at the nodes and at the end. What disturbs a collision most are a steady acceleration `α` and a drag `β`,
//!
//! ```text
//! ζ'' = -Λ ζ^(3/2) + α - β ζ'
//! ```
//!
//! and the first change that the iteration makes tells how much there is of each. The inverse Jacobian is then moved by as much,
//! to first order: instead of a digit and a half a turn the iteration gains three.

use super::{DURATION, MOMENTS, STIFFNESS, dot, product};
use nalgebra::{DMatrix, DVector};

/// A matrix of `N + 1` rows and columns: `body[j][i]`, the last column `column[i]`, the last row `row[j]`, and the corner.
pub struct Bordered<const N: usize> {
    body: [[f64; N]; N],
    column: [f64; N],
    row: [f64; N],
    corner: f64,
}

impl<const N: usize> Bordered<N> {
    fn new(matrix: &DMatrix<f64>) -> Self {
        Self {
            body: std::array::from_fn(|j| std::array::from_fn(|i| matrix[(i, j)])),
            column: std::array::from_fn(|i| matrix[(i, N)]),
            row: std::array::from_fn(|j| matrix[(N, j)]),
            corner: matrix[(N, N)],
        }
    }

    /// The product with a vector and its last component.
    #[inline(always)]
    pub fn times(&self, vector: &[f64; N], last: f64) -> ([f64; N], f64) {
        let mut sum = product(&self.body, vector);
        for i in 0..N {
            sum[i] += self.column[i] * last;
        }
        (sum, dot(&self.row, vector) + self.corner * last)
    }
}

/// Inverse Jacobian at the undisturbed collision, and how disturbances move it.
pub struct Newton<const N: usize> {
    undisturbed: Bordered<N>,
    causes: [Cause<N>; 2],
}

struct Cause<const N: usize> {
    /// The row whose product with the first change tells the share of this cause.
    row: [f64; N],
    last: f64,
    /// What a unit of it adds to the inverse Jacobian.
    tilt: Bordered<N>,
}

/// Disturbances small enough to be linear.
const ACCELERATION: f64 = 0.05;
const DRAG: f64 = 0.02;

impl<const N: usize> Newton<N> {
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
        // Depths and duration of a disturbed collision, and its inverse Jacobian.
        let disturbed = |alpha: f64, beta: f64| {
            let mut unknowns = start.clone();
            let mut inverse = DMatrix::zeros(0, 0);
            for _ in 0..12 {
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
                    DURATION * (1.0 - beta * t + (beta * t).powi(2) / 2.0)
                        + alpha * t * (1.0 - beta * t / 2.0)
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
                inverse = jacobian.try_inverse().expect("a collision is an isolated solution");
                unknowns -= &inverse * residual;
            }
            (unknowns, inverse)
        };
        let (_, undisturbed) = disturbed(0.0, 0.0);
        let causes = [disturbed(ACCELERATION, 0.0), disturbed(0.0, DRAG)];
        let changes = DMatrix::from_columns(&causes.each_ref().map(|(unknowns, _)| unknowns - &start));
        // Least squares: (CᵀC)⁻¹ Cᵀ; a change is what is subtracted.
        let normal = (changes.transpose() * &changes).try_inverse().expect("the two causes differ");
        let rows = -(normal * changes.transpose());
        let cause = |c: usize| Cause {
            row: std::array::from_fn(|i| rows[(c, i)]),
            last: rows[(c, N)],
            tilt: Bordered::new(&(&causes[c].1 - &undisturbed)),
        };
        Self { undisturbed: Bordered::new(&undisturbed), causes: [cause(0), cause(1)] }
    }

    /// How much there is of each cause, from the first change at the nodes and of the duration.
    #[inline(always)]
    pub fn shares(&self, change: &[f64; N], lengthening: f64) -> [f64; 2] {
        let share = |c: usize| dot(&self.causes[c].row, change) + self.causes[c].last * lengthening;
        [share(0), share(1)]
    }

    /// The change that Newton's iteration makes: the inverse Jacobian for these shares of the causes times the residuals.
    #[inline(always)]
    pub fn change(&self, shares: [f64; 2], residual: &[f64; N], last: f64) -> ([f64; N], f64) {
        let (mut change, mut lengthening) = self.undisturbed.times(residual, last);
        if shares != [0.0; 2] {
            for (cause, share) in self.causes.iter().zip(shares) {
                let (tilt, end) = cause.tilt.times(residual, last);
                for i in 0..N {
                    change[i] += share * tilt[i];
                }
                lengthening += share * end;
            }
        }
        (change, lengthening)
    }
}
