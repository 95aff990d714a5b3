//! The exact flow of a forced linear system: Taylor series over one step of a fixed length.
//!
//! The step is no longer than the inverse of the flow's fastest rate, so the series of the matrix exponential needs no
//! scaling, loses nothing to cancellation and has converged to rounding after [`TERMS`] terms (`1/19! = 8e-18`). Eigenvectors
//! are not used: near critical damping they are nearly parallel. The force is two more components that turn with `ωt`, so
//! resonance is no special case.

use crate::settings::SolverError;
use crate::system::Linear;
use retune_model::Drive;

/// Terms of a Taylor series over one step.
pub const TERMS: usize = 19;

/// The flow over a fixed step: `y(t + h) = origin + Φ (y(t) - origin) + Ψ [P cos ωt, P sin ωt]`.
pub struct Flow<const N: usize> {
    linear: Linear<N>,
    step: f64,
    phi: [[f64; N]; N],
    psi: [[f64; N]; 2],
    turn: [f64; 2],
}

/// The motion over one step as a polynomial: `y(t + s) = Σ c_k s^k`, `0 <= s <= step`.
pub struct Expansion<const N: usize> {
    coefficients: [[f64; N]; TERMS],
}

impl<const N: usize> Flow<N> {
    /// Prepares the flow for steps of `1 / rate` seconds, or of `longest` if that is shorter.
    pub fn new(linear: Linear<N>, longest: f64) -> Self {
        let step = longest.min(1.0 / linear.rate);
        let unit = |i: usize| -> [f64; N] { std::array::from_fn(|j| f64::from(i == j)) };
        let mut flow = Self {
            linear,
            step,
            phi: [[0.0; N]; N],
            psi: [[0.0; N]; 2],
            turn: rotation(linear.frequency * step),
        };
        flow.phi = std::array::from_fn(|j| flow.series([0.0; 2], unit(j)).deviation(step));
        flow.psi = [[1.0, 0.0], [0.0, 1.0]].map(|drive| flow.series(drive, [0.0; N]).deviation(step));
        flow
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
    pub fn expand(&self, drive: Drive, y: &[f64; N]) -> Expansion<N> {
        let mut expansion = self.series(drive, std::array::from_fn(|i| y[i] - self.linear.origin[i]));
        expansion.coefficients[0] = *y;
        expansion
    }

    /// Taylor series of the deviation from the origin: `c_{k+1} = (A c_k + b f_k) / (k + 1)`, `f_{k+1} = ω J f_k / (k + 1)`.
    fn series(&self, mut drive: Drive, deviation: [f64; N]) -> Expansion<N> {
        let Linear { columns, input, frequency, .. } = &self.linear;
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
}

impl<const N: usize> Expansion<N> {
    /// The state after `s` seconds.
    pub fn at(&self, s: f64) -> [f64; N] {
        self.horner(s)
    }

    fn deviation(&self, s: f64) -> [f64; N] {
        self.horner(s)
    }

    fn horner(&self, s: f64) -> [f64; N] {
        let mut y = self.coefficients[TERMS - 1];
        for c in self.coefficients[..TERMS - 1].iter().rev() {
            for i in 0..N {
                y[i] = c[i] + s * y[i];
            }
        }
        y
    }

    /// The polynomial of a linear combination of the components, without its constant term's offset.
    pub fn combination(&self, row: &[f64; N]) -> [f64; TERMS] {
        self.coefficients.map(|c| c.iter().zip(row).map(|(c, r)| c * r).sum())
    }
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
