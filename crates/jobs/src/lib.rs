//! The jobs of Retune as a library: everything that the command line does, another program can do.
//!
//! A job takes a study (`retune_study`), computes with `retune_optim` and `retune_dynamics`, keeps its files in a directory of
//! results (`retune_store`), reports its progress to an [`Observer`], and returns its result. Nothing here prints.
//!
//! [`mod@tune`] searches the best design of a study; [`certify`] gives the error bar, the sensitivity and the motion of a design;
//! [`table2`] makes several searches and compares them; [`verify`] checks results by recomputing them; [`prove`] proves one periodic
//! motion; [`simulate`] makes one run, [`sweep`] one at each value of a parameter; [`evaluate`] evaluates designs of other programs.
//!
//! ```
//! use retune_jobs::simulate::simulate;
//!
//! // The damper of `studies/ssvi.json`. SI units: kg, N·s/m, N/m, N, rad/s, m, Pa, s.
//! let text = r#"{
//!     "scene": {
//!         "primary": { "m1": 1000, "c1": 452, "k1": 3.95e4 },
//!         "forcing": { "P": 800, "omega": 6.28 },
//!         "damper": {
//!             "m2": 60, "k2": 215, "c2": 232, "D": 0.06, "C": 0.36,
//!             "contact": {
//!                 "R": 2, "q": 0.318,
//!                 "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4,
//!                 "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4
//!             }
//!         }
//!     },
//!     "window": { "t0": 50, "T": 100 }
//! }"#;
//! let study = retune_study::read::from_text(text, "ssvi.json")?;
//! let with_damper = simulate(&study, None)?;
//! assert_eq!(with_damper.summary.damper_type(), "SSVI NES"); // it strikes its walls
//!
//! let mut bare = study.clone();
//! bare.scene.damper = None;
//! let without = simulate(&bare, None)?;
//!
//! // The largest energy of the structure in the window, J, as a program reads it.
//! let [with_damper, without] = [with_damper, without].map(|run| serde_json::json!(run)["E1max"].as_f64());
//! assert!(with_damper < without);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod amount;
pub mod answer;
pub mod artefact;
pub mod branches;
pub mod certify;
mod columns;
mod contacts;
pub mod describe;
pub mod design;
pub mod designs;
mod error;
pub mod evaluate;
pub mod fronts;
mod job;
pub mod losses;
pub mod methods;
mod needs;
mod observer;
mod pages;
pub mod paper;
pub mod parts;
pub mod prove;
mod recompute;
pub mod resolved;
pub mod retention;
pub mod rows;
mod searches;
pub mod simulate;
pub mod summary;
pub mod sweep;
pub mod table2;
pub mod tune;
pub mod verify;

pub use error::Error;
pub use job::{Done, Request};
pub use observer::{Observer, Progress, Silent};
