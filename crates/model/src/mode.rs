//! Modes of a structure with many degrees of freedom, and the one that a damper acts on as a primary structure.

use crate::{NonNegative, OutOfRange, Positive, Primary};
use nalgebra::Complex;

/// A mode with its shape at the damper. SI units.
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
    /// The oscillator equivalent to this mode at the damper: a force F there moves it by `q φ` with `M (q'' + 2ζω q' + ω² q) = φ F`, so
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

    /// The dynamic stiffness in the modal coordinate at the angular frequency `omega` (rad/s), N/m; zero at an undamped resonance.
    fn stiffness(&self, omega: f64) -> Complex<f64> {
        let natural = self.omega.get();
        self.mass.get()
            * Complex::new(natural * natural - omega * omega, 2.0 * self.zeta.get() * natural * omega)
    }

    /// The displacement at the damper due to a harmonic force of 1 N there at the angular frequency `omega` (rad/s), m; not finite at an
    /// undamped resonance.
    pub fn flexibility(&self, omega: f64) -> Complex<f64> {
        self.shape * self.shape / self.stiffness(omega)
    }
}

/// Displacement at the damper due to the other modes at the frequency of mode `which`, relative to that due to `which`.
pub fn left_out(modes: &[Mode], which: usize) -> f64 {
    let Some(own) = modes.get(which) else { return f64::NAN };
    let omega = own.omega.get();
    let others =
        modes.iter().enumerate().filter(|(i, _)| *i != which).map(|(_, mode)| mode.flexibility(omega));
    others.sum::<Complex<f64>>().norm() * own.stiffness(omega).norm() / (own.shape * own.shape)
}

/// The mode that responds most at the damper to a force there at the mode's own frequency: the largest `φ² / (2ζ M ω²)`, on a tie the
/// first. None for an empty list.
pub fn most_felt(modes: &[Mode]) -> Option<usize> {
    let size = |mode: &Mode| match mode.shape {
        0.0 => 0.0,
        shape => shape * shape / mode.stiffness(mode.omega.get()).norm(),
    };
    (0..modes.len()).reduce(|most, i| if size(&modes[i]) > size(&modes[most]) { i } else { most })
}
