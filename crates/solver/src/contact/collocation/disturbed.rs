//! Collisions under small perturbations, solved to rounding once per program: the basis of the iteration of contacts (see `newton`).

use super::rule::Integrals;
use super::undisturbed::DURATION;
use nalgebra::{DMatrix, DVector};

/// Limit on perturbations, their amounts, and the amounts without any.
const MOST: usize = 3;
pub type Amounts = [f64; MOST];
pub const UNDISTURBED: Amounts = [0.0; MOST];

/// A collision under perturbations.
pub struct DisturbedCollision {
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

/// Its depths or its speeds: without forces, the reduction by a unit of force at each node, and the derivatives of both by the duration.
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
pub fn without_loss<const N: usize>(
    integrals: &Integrals<N>,
) -> (DVector<f64>, impl Fn(Amounts) -> DisturbedCollision) {
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
    let start = DisturbedCollision::solved(DVector::zeros(0), depths.clone(), undisturbed).unknowns;
    let begin = start.clone();
    let solve = move |amounts: Amounts| {
        let (first, _) = equations(amounts, &begin);
        DisturbedCollision::solved(first, depths.clone(), |unknowns| equations(amounts, unknowns))
    };
    (start, solve)
}

impl DisturbedCollision {
    /// Solves by Newton's iteration from these unknowns.
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
