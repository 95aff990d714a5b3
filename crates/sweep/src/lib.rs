//! A sweep: the run of a scene, or the objective of a study, at each value of one parameter.
//!
//! - [`plan`]: what is swept, from words of a command line to a checked [`Plan`].
//! - [`sweep`]: the numbers of each point, one by one, in any order.
//! - [`table`]: all points as rows, as CSV and as JSON.
//! - [`words`]: the answer, and a table for the screen.
//! - [`draw`]: the figure.
//!
//! ```
//! use retune_sweep::{Asked, Plan, Sweep};
//!
//! let study = retune_study::read::from_text(
//!     r#"{
//!         "scene": {
//!             "primary": { "m1": 1000, "c1": 452, "k1": 39500 },
//!             "forcing": { "P": 800, "omega": 6.28 }
//!         },
//!         "window": { "t0": 200, "T": 230 }
//!     }"#,
//!     "bare.json",
//! )?;
//! let asked = Asked { from: "0.8Hz".into(), to: "1.2Hz".into(), points: 5, ..Asked::over("omega".parse()?) };
//! let sweep = Sweep::new(Plan::read(&asked)?, study)?;
//! let points: Vec<f64> = (0..sweep.len()).flat_map(|i| sweep.numbers(sweep.value(i)).0).collect();
//! let table = sweep.table(&points);
//! assert_eq!(table.column("f_Hz").map(|column| column[2]), Some(1.0)); // resonance is at 1 Hz
//! let energy = table.column("E1max").ok_or("a column")?;
//! assert!(energy[2] > 10.0 * energy[0] && energy[2] > 10.0 * energy[4]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

pub mod draw;
mod error;
pub mod plan;
mod quantity;
pub mod sweep;
pub mod table;
pub mod words;

pub use error::Error;
pub use plan::{Asked, Plan};
pub use quantity::Quantity;
pub use retune_model::Parameter;
pub use sweep::Sweep;
pub use table::Table;
