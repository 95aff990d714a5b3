//! The exact flow of a forced linear system: Taylor series over one step of a fixed length.
//!
//! The step is no longer than the inverse of the flow's fastest rate, so the series of the matrix exponential needs no
//! scaling, loses nothing to cancellation and has converged to rounding after [`TERMS`] terms (`1/20! = 4e-19`). Eigenvectors
//! are not used: near critical damping they are nearly parallel. The force is two more components that turn with `ωt`, so
//! resonance is no special case.

use crate::settings::SolverError;
use crate::system::Linear;
use retune_model::Drive;

/// Terms of a Taylor series over one step.
pub const TERMS: usize = 20;

/// The flow over a fixed step: `y(t + h) = origin + Φ (y(t) - origin) + Ψ [P cos ωt, P sin ωt]`.
pub struct Flow<const N: usize> {
    linear: Linear<N>,
    step: f64,
    phi: [[f64; N]; N],
    psi: [[f64; N]; 2],
    turn: [f64; 2],
    /// The series of which `Φ` and `Ψ` are the values at the end of the step.
    free: [Expansion<N>; N],
    forced: [Expansion<N>; 2],
}

/// The motion over one step as a polynomial: `y(t + s) = Σ c_k s^k`, `0 <= s <= step`, to the first `K` terms.
#[derive(Clone, Copy)]
pub struct Expansion<const N: usize, const K: usize = TERMS> {
    coefficients: [[f64; N]; K],
}

/// The series of one linear combination of the components.
pub struct Series<const N: usize> {
    origin: [f64; N],
    at_origin: f64,
    free: [[f64; TERMS]; N],
    forced: [[f64; TERMS]; 2],
}

impl<const N: usize> Flow<N> {
    /// Prepares the flow for steps of `1 / rate` seconds, or of `longest` if that is shorter.
    pub fn new(linear: Linear<N>, longest: f64) -> Self {
        let step = longest.min(1.0 / linear.rate);
        let unit = |i: usize| -> [f64; N] { std::array::from_fn(|j| f64::from(i == j)) };
        let free = std::array::from_fn(|j| series(&linear, [0.0; 2], unit(j)));
        let forced = [[1.0, 0.0], [0.0, 1.0]].map(|drive| series(&linear, drive, [0.0; N]));
        Self {
            linear,
            step,
            phi: std::array::from_fn(|j| free[j].at(step)),
            psi: [forced[0].at(step), forced[1].at(step)],
            turn: rotation(linear.frequency * step),
            free,
            forced,
        }
    }

    /// Length of a whole step, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Refuses a run to time `to` (s) in which a whole step would be lost to rounding.
    ///
    /// # Errors
    /// [`SolverError::StepTooSmall`].
    pub fn check_step(&self, t: f64, to: f64) -> Result<(), SolverError> {
        if to <= t || to + self.step > to {
            Ok(())
        } else {
            Err(SolverError::StepTooSmall { t, h: self.step })
        }
    }

    /// The flow's numbers.
    pub fn linear(&self) -> &Linear<N> {
        &self.linear
    }

    /// A deviation from the origin after `steps` whole steps without force, `Φ^steps y`, by repeated squaring.
    pub fn decay(&self, mut steps: u64, mut deviation: [f64; N]) -> [f64; N] {
        let apply = |phi: &[[f64; N]; N], y: &[f64; N]| -> [f64; N] {
            std::array::from_fn(|i| (0..N).map(|j| phi[j][i] * y[j]).sum())
        };
        let mut power = self.phi;
        while steps > 0 {
            if steps & 1 == 1 {
                deviation = apply(&power, &deviation);
            }
            power = power.map(|column| apply(&power, &column));
            steps >>= 1;
        }
        deviation
    }

    /// Advances by a whole step.
    #[inline(always)]
    pub fn advance(&self, drive: Drive, y: &[f64; N]) -> (Drive, [f64; N]) {
        let mut next = self.linear.origin;
        for (column, force) in self.psi.iter().zip(drive) {
            for i in 0..N {
                next[i] += column[i] * force;
            }
        }
        for (j, column) in self.phi.iter().enumerate() {
            let deviation = y[j] - self.linear.origin[j];
            for i in 0..N {
                next[i] += column[i] * deviation;
            }
        }
        (turned(drive, self.turn), next)
    }

    /// The force `s` seconds later.
    pub fn drive_after(&self, drive: Drive, s: f64) -> Drive {
        turned(drive, rotation(self.linear.frequency * s))
    }

    /// The motion from `y` over the next step.
    #[inline(always)]
    pub fn expand<const K: usize>(&self, drive: Drive, y: &[f64; N]) -> Expansion<N, K> {
        let mut coefficients = [[0.0; N]; K];
        for k in 1..K {
            for (series, force) in self.forced.iter().zip(drive) {
                for i in 0..N {
                    coefficients[k][i] += series.coefficients[k][i] * force;
                }
            }
            for (j, series) in self.free.iter().enumerate() {
                let deviation = y[j] - self.linear.origin[j];
                for i in 0..N {
                    coefficients[k][i] += series.coefficients[k][i] * deviation;
                }
            }
        }
        coefficients[0] = *y;
        Expansion { coefficients }
    }

    /// Prepares the series of `row · y`.
    pub fn series(&self, row: &[f64; N]) -> Series<N> {
        let combined = |e: &Expansion<N>| e.coefficients.map(|c| dot(&c, row));
        Series {
            origin: self.linear.origin,
            at_origin: dot(&self.linear.origin, row),
            free: self.free.each_ref().map(combined),
            forced: self.forced.each_ref().map(combined),
        }
    }
}

impl<const N: usize> Series<N> {
    /// `Σ c_k s^k` from a state on.
    #[inline(always)]
    pub fn expand(&self, drive: Drive, y: &[f64; N]) -> [f64; TERMS] {
        let mut sum = [0.0; TERMS];
        for (series, force) in self.forced.iter().zip(drive) {
            for k in 0..TERMS {
                sum[k] += series[k] * force;
            }
        }
        for (j, series) in self.free.iter().enumerate() {
            let deviation = y[j] - self.origin[j];
            for k in 0..TERMS {
                sum[k] += series[k] * deviation;
            }
        }
        sum[0] += self.at_origin;
        sum
    }
}

/// Taylor series of the deviation from the origin: `c_{k+1} = (A c_k + b f_k) / (k + 1)`, `f_{k+1} = ω J f_k / (k + 1)`.
fn series<const N: usize>(linear: &Linear<N>, mut drive: Drive, deviation: [f64; N]) -> Expansion<N> {
    let Linear { columns, input, frequency, .. } = linear;
    let mut coefficients = [deviation; TERMS];
    for k in 1..TERMS {
        let (previous, scale) = (coefficients[k - 1], 1.0 / k as f64);
        let mut next = [0.0; N];
        for i in 0..N {
            next[i] = input[i] * drive[0];
        }
        for (column, c) in columns.iter().zip(previous) {
            for i in 0..N {
                next[i] += column[i] * c;
            }
        }
        coefficients[k] = next.map(|c| c * scale);
        drive = [-frequency * scale * drive[1], frequency * scale * drive[0]];
    }
    Expansion { coefficients }
}

impl<const N: usize, const K: usize> Expansion<N, K> {
    /// The state after `s` seconds: even and odd terms apart, so that less waits for less.
    #[inline(always)]
    pub fn at(&self, s: f64) -> [f64; N] {
        let (mut even, mut odd, square) = ([0.0; N], [0.0; N], s * s);
        for pair in self.coefficients.chunks_exact(2).rev() {
            for i in 0..N {
                even[i] = even[i] * square + pair[0][i];
                odd[i] = odd[i] * square + pair[1][i];
            }
        }
        std::array::from_fn(|i| even[i] + s * odd[i])
    }

    /// The coefficients of one component.
    #[inline(always)]
    pub fn component(&self, i: usize) -> [f64; K] {
        self.coefficients.map(|c| c[i])
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn rotation(angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos, sin]
}

/// `[f cos, f sin]` of a phase, turned by the angle whose cosine and sine are given.
#[inline(always)]
fn turned([c, s]: Drive, [cos, sin]: [f64; 2]) -> Drive {
    [c * cos - s * sin, s * cos + c * sin]
}
