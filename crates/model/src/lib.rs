//! What is true of a damper on a forced oscillator: one copy of each formula of the paper, beside its equation number.
//!
//! A heavy *primary structure* (PS; `m1, c1, k1`) is driven by `F(t) = P cos ωt`. A light damper (`m2, c2, k2`) moves in a
//! cavity of the PS: it touches the PS where `x2 - x1 <= 0` and the obstacle (the cavity's far wall, which moves with the
//! PS) where `x2 - x1 >= D + C`. Its spring is at rest at `x2 - x1 = D`.
//!
//! This crate never steps in time, reads files, starts threads or prints. All quantities are in SI units.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod band;
mod bare;
mod coupled;
mod hertz;
mod regularised;
mod scene;
mod steady;
mod value;

pub use band::Worst;
pub use bare::Bare;
pub use coupled::{Coupled, Side};
pub use hertz::{hertz_energy, hertz_force, hertz_force_slope, hertz_stiffness};
pub use regularised::{Compressed, Compression, Growth, ORDERS};
pub use scene::{Contact, Damper, Forcing, Primary, Scene};
pub use steady::Steady;
pub use value::{NonNegative, OutOfRange, PoissonRatio, Positive};

/// Energy ratios of section 3: `R1 = E1max / (E1max + E2max)` and `R2 = E2max / (E1max + E2max)`, dimensionless.
///
/// Both are NaN when nothing moved (`E1max = E2max = 0`).
pub fn energy_ratios(e1_max: f64, e2_max: f64) -> [f64; 2] {
    let total = e1_max + e2_max;
    [e1_max / total, e2_max / total]
}

/// The harmonic force and its quarter-turn: `[P cos(ωt + φ), P sin(ωt + φ)]`, N.
///
/// Every formula below takes this pair instead of `t`, so that a caller who steps in time may turn it by a rotation instead
/// of calling `cos` at every step.
pub type Drive = [f64; 2];
