//! The motion of a damper on a forced structure in time.
//!
//! [`simulate`] runs a scene and returns its largest energies, forces and displacements; [`e1_max`] returns the largest energy of the
//! structure alone, [`extremes`] and [`settled`] the values on which limits are set, [`trajectory`] the motion row by row. The default
//! method, the hybrid, is exact between contacts and solves each contact to a tolerance; `ode23s`, `ode45` and other general methods
//! ([`methods`]) serve as a comparison. A motion is passed segment by segment ([`observe::Segment`]) to observers ([`observe::Observer`]);
//! no segment is stored.
//!
//! ```
//! use retune_model::Scene;
//! use retune_solver::{Settings, Window, simulate};
//!
//! // The SSVI of the paper's Table 2, in the symbols of the paper and SI units.
//! let scene: Scene = serde_json::from_str(
//!     r#"{
//!         "primary": { "m1": 1000, "c1": 452, "k1": 39500 },
//!         "forcing": { "P": 800, "omega": 6.28 },
//!         "damper": {
//!             "m2": 60, "k2": 215, "c2": 232, "D": 0.06, "C": 0.36,
//!             "contact": {
//!                 "R": 2, "q": 0.318,
//!                 "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4,
//!                 "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4
//!             }
//!         }
//!     }"#,
//! )?;
//! let window = Window { from: 0.0, to: 100.0 };
//! let with_damper = simulate(&scene, window, &Settings::default())?;
//! let without = simulate(&Scene { damper: None, ..scene }, window, &Settings::default())?;
//! assert!(with_damper.e1_max.value < 0.5 * without.e1_max.value);
//! assert!(with_damper.impacts[0] > 0 && with_damper.force_max[0] > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Inside, files import downwards only. `simulate`, `extremes`, `settle` and `trajectory` are the entry points; `plan` chooses the smallest
//! model that is exact, and `run` follows the motion with it; `recurrence` ends a run that repeats; `hybrid` alternates flight (`linear`)
//! and contact (`contact`); `observe` collects the results; `motion` is the lowest layer.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod budget;
mod collisions;
mod contact;
mod decay;
mod derivatives;
mod energy_bound;
mod error;
mod extremes;
mod hybrid;
mod linear;
mod losses;
pub mod methods;
mod motion;
pub mod observe;
mod plan;
mod recurrence;
mod response;
mod run;
mod settings;
mod settle;
mod simulate;
mod system;
mod tangent;
mod trajectory;

pub use budget::{Budget, Pace};
pub use collisions::Collisions;
pub use decay::{LEFT, decay_time, last_above};
pub use derivatives::{extremes_by, settled_by};
pub use error::{Remedy, SolverError};
pub use extremes::{Also, Ask, Extremes, extremes};
pub use hybrid::propagator::{Hybrid, Motion, Phase};
pub use linear::steps;
pub use losses::Losses;
pub use recurrence::test::Settle;
pub use response::{Extreme, Response, SceneKind, StructureMaxima, Work};
pub use run::{Follower, least_steps, leaves_out_a_fast_part};
pub use settings::{Contacts, Method, Settings, Window};
pub use settle::settled;
pub use simulate::{e1_max, simulate, simulate_in_detail, touch_downs};
pub use system::{Linear, LinearSystem, System};
pub use tangent::{Tangent, Transition};
pub use trajectory::{Moment, Rows, Sample, trajectory};
