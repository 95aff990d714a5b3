//! Proofs by interval arithmetic of a damper's periodic motion: that it exists and is unique in a small box, its sequence of impacts,
//! whether it is stable, and its largest values. Nothing of the solver is used: a motion found by it serves as the guess. `docs/proof.md`
//! has the theorem.
//!
//! Read `interval`, `elementary`, `taylor` and `number` (the arithmetic), `equations` (equation (1) and its Taylor series), `step` (a
//! validated step), `range` (bounds on a quantity during a step), `crossing` and `segment` (from one event to the next), `orbit` (the cycle
//! of events), then `theorem`, with `stability` and `largest`.
//!
//! ```
//! use retune_proof::{Stability, prove};
//!
//! // A tuned mass damper: from rest, Newton's iteration finds its one steady motion.
//! let scene = serde_json::from_str(
//!     r#"{
//!         "primary": { "m1": 1000, "c1": 452, "k1": 39500 }, "forcing": { "P": 800, "omega": 6.28 },
//!         "damper": { "m2": 60, "k2": 2000, "c2": 85 }
//!     }"#,
//! )?;
//! let proven = prove(&scene, [0.0; 4], 1)?;
//! assert!(proven.impacts.is_empty() && matches!(proven.stability, Stability::Stable(_)));
//! assert!(proven.largest.energy.width() < 1e-10 * proven.largest.energy.hi());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod crossing;
mod elementary;
mod equations;
mod event;
mod interval;
mod largest;
mod loss;
mod number;
mod orbit;
mod range;
mod segment;
mod stability;
mod step;
mod taylor;
mod theorem;

use equations::Equations;
use taylor::{Number, Taylor};

pub use elementary::cos_sin;
pub use event::{Event, Failure, Multiplier};
pub use interval::Interval;
pub use largest::Largest;
pub use orbit::Guess;
pub use stability::Stability;
pub use theorem::{Family, Proven, Start, Theorem, prove, prove_over, prove_steady};
