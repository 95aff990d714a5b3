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
//! the inverse Jacobian corrected for them to first order: instead of one and a half digits an iteration gains three. Where contacts lose
//! energy by the law of Hunt and Crossley, the difference of their χ from that of the undisturbed collision is a third.

use super::nodes::{Nodes, dot, packed, product};
use super::rule::Integrals;
use super::undisturbed::DURATION;
use nalgebra::{DMatrix, DVector};
use wide::f64x4;

/// A vector of a number for each node and one more, for the duration or the end.
pub type Extended<const M: usize> = (Nodes<M>, f64);

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

/// Most perturbations, the amount of each, and none of any.
const MOST: usize = 3;
pub type Amounts = [f64; MOST];
pub const UNDISTURBED: Amounts = [0.0; MOST];

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

/// A collision under perturbations.
pub struct Disturbed {
    /// Residuals at the undisturbed collision, as the first iteration takes them.
    pub first: DVector<f64>,
    /// The solution, and the inverse Jacobian there.
    pub unknowns: DVector<f64>,
    pub inverse: DMatrix<f64>,
}

/// The motion under `ζ'' = α - β ζ'` and forces at the nodes, at the nodes and at the end, over the duration of the undisturbed collision.
pub struct DisturbedMotion<'a, const N: usize> {
    /// D, in units of the greatest depth over the touch-down speed: `Λ = κ T² √Z = (5/4) D²`.
    pub duration: f64,
    pub integrals: &'a Integrals<N>,
}

/// Its depths or its speeds: without forces, what a unit of force at each node takes away, and the derivatives of both by the duration.
pub struct Linear {
    pub free: DVector<f64>,
    pub free_slope: DVector<f64>,
    pub kernel: DMatrix<f64>,
    pub kernel_slope: DMatrix<f64>,
}

impl<const N: usize> DisturbedMotion<'_, N> {
    fn moment(&self, k: usize) -> DMatrix<f64> {
        DMatrix::from_fn(N + 1, N, |i, j| self.integrals.moment(k, i, j))
    }

    fn time(&self) -> DVector<f64> {
        DVector::from_fn(N + 1, |i, _| if i < N { self.integrals.times[i] } else { 1.0 })
    }

    /// The response to a unit of force over its moments from this one on, `(1 - e^(-βt)) / β = t - β t²/2 + β² t³/6` of a depth, and its
    /// derivative by the duration.
    fn response(&self, from: usize, beta: f64, sigma: f64) -> [DMatrix<f64>; 2] {
        let first = from as i32 + 1;
        let [once, twice, thrice] = [0, 1, 2].map(|k| self.moment(from + k));
        let of = |weight: &dyn Fn(i32) -> f64| {
            (&once * weight(0) - &twice * weight(1) + &thrice * weight(2))
                * (1.25 * self.duration * self.duration)
        };
        let value = of(&|k| beta.powi(k) * sigma.powi(first + k));
        [value, of(&|k| f64::from(first + k) * beta.powi(k) * sigma.powi(first + k - 1))]
    }

    /// Depths, in units of the greatest.
    pub fn depths(&self, [alpha, beta, _]: Amounts, sigma: f64) -> Linear {
        let (time, speed) = (self.time(), self.duration);
        let t = &time * sigma;
        let free = t.map(|t| {
            speed * t * (1.0 - beta * t / 2.0 + (beta * t).powi(2) / 6.0)
                + alpha * t * t * (0.5 - beta * t / 6.0)
        });
        let free_slope = self.rates([alpha, beta, 0.0], &t).component_mul(&time);
        let [kernel, kernel_slope] = self.response(1, beta, sigma);
        Linear { free, free_slope, kernel, kernel_slope }
    }

    /// Their rates over the undisturbed duration.
    fn rates(&self, [alpha, beta, _]: Amounts, t: &DVector<f64>) -> DVector<f64> {
        t.map(|t| {
            self.duration * (1.0 - beta * t + (beta * t).powi(2) / 2.0) + alpha * t * (1.0 - beta * t / 2.0)
        })
    }

    /// Speeds, in units of that at touch-down.
    pub fn speeds(&self, [alpha, beta, _]: Amounts, sigma: f64) -> Linear {
        let time = self.time();
        let t = &time * sigma;
        let free = self.rates([alpha, beta, 0.0], &t) / self.duration;
        let slope = t.map(|t| self.duration * (-beta + beta * beta * t) + alpha * (1.0 - beta * t));
        let free_slope = slope.component_mul(&time) / self.duration;
        let [kernel, kernel_slope] = self.response(0, beta, sigma).map(|matrix| matrix / self.duration);
        Linear { free, free_slope, kernel, kernel_slope }
    }
}

/// The equations of a collision without loss: the unknowns are depths.
pub fn lossless<const N: usize>(integrals: &Integrals<N>) -> (DVector<f64>, impl Fn(Amounts) -> Disturbed) {
    let motion = DisturbedMotion { duration: DURATION, integrals };
    let depths = DVector::from_fn(N + 1, |i, _| if i < N { integrals.depths[i] } else { 1.0 });
    let equations = move |amounts: Amounts, unknowns: &DVector<f64>| {
        let Linear { free, free_slope, kernel, kernel_slope } = motion.depths(amounts, unknowns[N]);
        let force = unknowns.rows(0, N).map(|z| z.powf(1.5));
        let by_duration = kernel_slope * &force - free_slope;
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
        (residual, jacobian)
    };
    let undisturbed = |unknowns: &DVector<f64>| equations(UNDISTURBED, unknowns);
    let start = Disturbed::solved(DVector::zeros(0), depths.clone(), undisturbed).unknowns;
    let begin = start.clone();
    let solve = move |amounts: Amounts| {
        let (first, _) = equations(amounts, &begin);
        Disturbed::solved(first, depths.clone(), |unknowns| equations(amounts, unknowns))
    };
    (start, solve)
}

impl Disturbed {
    /// By Newton's iteration from some unknowns.
    pub fn solved(
        first: DVector<f64>,
        mut unknowns: DVector<f64>,
        equations: impl Fn(&DVector<f64>) -> (DVector<f64>, DMatrix<f64>),
    ) -> Self {
        let mut inverse = DMatrix::zeros(0, 0);
        for _ in 0..12 {
            let (residual, jacobian) = equations(&unknowns);
            inverse = jacobian.try_inverse().expect("a collision is an isolated solution");
            unknowns -= &inverse * residual;
        }
        Self { first, unknowns, inverse }
    }
}

impl<const N: usize, const M: usize> Newton<N, M> {
    /// Prepares the iteration from the unknowns of the undisturbed collision and the solutions under so many of the perturbations.
    pub fn new(start: &DVector<f64>, count: usize, solve: impl Fn(Amounts) -> Disturbed) -> Self {
        let undisturbed = solve(UNDISTURBED).inverse;
        // The change left after the first iteration, the change in it, and the converged inverse Jacobian.
        let with = |units: &[(usize, f64)]| {
            let mut amounts = UNDISTURBED;
            units.iter().for_each(|&(of, unit)| amounts[of] = unit * UNITS[of]);
            let Disturbed { first, unknowns, inverse } = solve(amounts);
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
        // Least squares: (CᵀC)⁻¹ Cᵀ; a change is what is subtracted.
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
