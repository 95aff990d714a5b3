//! A structure of many degrees of freedom by its modes, and the one that a damper works on as a primary structure.

use crate::{NonNegative, OutOfRange, Positive, Primary};
use nalgebra::Complex;

/// A mode with its shape where the damper hangs. SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Angular frequency without damping, rad/s.
    pub omega: Positive,
    /// Share of critical damping.
    pub zeta: NonNegative,
    /// Modal mass `φᵀ M φ` in the scale of the shape, kg.
    pub mass: Positive,
    /// The shape at the damper, in any scale.
    pub shape: f64,
}

impl Mode {
    /// The oscillator that this mode is at the damper: a force there moves it by `q φ` with `M (q'' + 2ζω q' + ω² q) = φ F`, so
    /// `m1 = M/φ²`, `c1 = 2ζω m1` and `k1 = ω² m1`.
    ///
    /// # Errors
    /// The shape is zero there, or a number too large.
    pub fn primary(&self) -> Result<Primary, OutOfRange> {
        let (omega, m1) = (self.omega.get(), self.mass.get() / (self.shape * self.shape));
        Ok(Primary {
            mass: Positive::new(m1)?,
            damping: NonNegative::new(2.0 * self.zeta.get() * omega * m1)?,
            stiffness: NonNegative::new(omega * omega * m1)?,
        })
    }

    /// The dynamic stiffness of the mode in its own coordinate at the angular frequency `omega` (rad/s), N/m; zero at the resonance of one without damping.
    fn stiffness(&self, omega: f64) -> Complex<f64> {
        let own = self.omega.get();
        self.mass.get() * Complex::new(own * own - omega * omega, 2.0 * self.zeta.get() * own * omega)
    }

    /// The displacement at the damper by a harmonic force of 1 N there at the angular frequency `omega` (rad/s), m; not finite at the resonance of a mode
    /// without damping.
    pub fn flexibility(&self, omega: f64) -> Complex<f64> {
        self.shape * self.shape / self.stiffness(omega)
    }
}

/// What the other modes add to the displacement at the damper at the frequency of mode `which`, as a share of its own.
pub fn left_out(modes: &[Mode], which: usize) -> f64 {
    let Some(own) = modes.get(which) else { return f64::NAN };
    let omega = own.omega.get();
    let others =
        modes.iter().enumerate().filter(|(i, _)| *i != which).map(|(_, mode)| mode.flexibility(omega));
    others.sum::<Complex<f64>>().norm() * own.stiffness(omega).norm() / (own.shape * own.shape)
}

/// The mode that moves the damper's place most by a force there at its own frequency: of the largest `φ² / (2ζ M ω²)`, the first of
/// equal ones. None of an empty list.
pub fn most_felt(modes: &[Mode]) -> Option<usize> {
    let size = |mode: &Mode| match mode.shape {
        0.0 => 0.0,
        shape => shape * shape / mode.stiffness(mode.omega.get()).norm(),
    };
    (0..modes.len()).reduce(|most, i| if size(&modes[i]) > size(&modes[most]) { i } else { most })
}
