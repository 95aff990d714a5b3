//! The motions of a scene: sweeps over frequency or stiffness, impact zones, stroboscopic maps, orbit diagrams, Lyapunov
//! exponents through contacts, and classification of regimes by measured quantities.
//!
//! - [`sweep`]: the response at each value of a parameter, every run from rest, in parallel.
//! - [`poincare`]: the state once per period of the force, and sweeps by continuation.
//! - [`lyapunov`]: the rate at which neighbouring motions diverge, from two trajectories with renormalisation.
//! - [`record`]: a motion recorded over many periods together with a neighbouring one.
//! - [`attractor`]: whether two stretches of motion belong to one motion or to two.
//! - [`periodic`]: periodic motions, stable or not, along a parameter: branches, bifurcations, what coexists.
//! - [`regime`]: periodic (`nT, m, k`), amplitude-modulated, chaotic or intermittent, with or without transient chaos before.
//!
//! Every result depends on its input alone, not on the number of threads. Nothing is printed, and no file is read or written.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

pub mod attractor;
pub mod lyapunov;
pub mod parameter;
pub mod periodic;
pub mod poincare;
pub mod record;
pub mod regime;
pub mod sweep;

pub use lyapunov::Exponent;
pub use parameter::Error;
pub use poincare::{Orbit, continuation, resumed};
pub use record::{Record, Stretch, follow};
pub use regime::{Kind, Regime, classify};
pub use retune_model::Parameter;
pub use sweep::{Point, Zone, independent};
