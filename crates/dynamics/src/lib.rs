//! What motions there are: sweeps over frequency or stiffness, impact zones, stroboscopic maps, orbit diagrams, Lyapunov
//! exponents through contacts, and names for regimes that stand on evidence.
//!
//! - [`sweep`]: the response at each value of a parameter, every run fresh from rest, in parallel.
//! - [`poincare`]: the motion once per period of the force, and sweeps that carry the state over.
//! - [`lyapunov`]: how fast neighbouring motions part, from two trajectories with renormalisation.
//! - [`record`]: a motion followed for many periods together with its neighbour.
//! - [`attractor`]: whether two stretches of motion show one motion or two.
//! - [`regime`]: periodic (`nT, m, k`), amplitude-modulated, chaotic, intermittent, after transient chaos or not.
//!
//! Every result depends on its input alone, whatever the number of threads. Nothing is printed, no file is touched.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

pub mod attractor;
pub mod lyapunov;
pub mod parameter;
pub mod poincare;
pub mod record;
pub mod regime;
pub mod sweep;

pub use lyapunov::Exponent;
pub use parameter::{Error, Parameter};
pub use poincare::{Orbit, continuation, independent_orbits, resumed};
pub use record::{Record, Stretch, follow};
pub use regime::{Kind, Regime, classify};
pub use sweep::{Point, Zone, independent};
