//! Study files: the input of Retune, in JSON with the paper's symbols, in SI units or with a unit beside a number (`"20 kN/m"`).
//!
//! [`read`] turns a file into a checked [`Study`], or an error that names the field, its value and the allowed values.
//! [`Study::search`] returns the search and [`Study::goal`] the objective with its limits.
//!
//! ```
//! let study = retune_study::read::from_text(
//!     r#"{
//!         "scene": {
//!             "primary": { "m1": 1000, "c1": 452, "k1": 39500 },
//!             "forcing": { "P": 800, "omega": 6.28 }
//!         },
//!         "window": { "t0": 0, "T": 60 }
//!     }"#,
//!     "bare.json",
//! )?;
//! assert_eq!(study.name(), "bare");
//! // From rest, the structure without a damper reaches hundreds of joules near its resonance.
//! assert!(study.energy(&study.scene).is_some_and(|energy| energy > 500.0));
//! let refused = retune_study::read::from_text(r#"{ "scene": { "primary": { "m1": -1 } } }"#, "bad.json");
//! assert!(refused.is_err_and(|error| error.to_string().contains("m1: -1 is not allowed here")));
//! # Ok::<(), retune_study::StudyError>(())
//! ```
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

#[cfg(any(test, fuzzing))]
pub mod any_text;
mod built_in;
mod file;
mod format;
mod fronts;
mod global;
mod objective;
pub mod read;
mod records;
mod rule;
mod search;
mod set;
mod table2;
mod units;
mod window;
mod words;

pub use built_in::is_built_in;
pub use file::{Kind, StudyError, kind_of};
pub use format::{Coarse, GridAxis, Margins, Optimize, Refine, Solver, Span, Study, is_default, schema};
pub use fronts::{Fronts, FrontsPlan, Sweep, bounded, read_fronts};
pub use global::GlobalSearch;
pub use read::{found_in, read, read_paper};
pub use records::{read_record, read_record_text};
pub use rule::Rule;
pub use search::{MOST_GRID_POINTS, Search, check_name, clipped, name_from};
pub use set::{Settable, Setting, SettingError, start};
pub use table2::{
    PaperStudy, SpringBounds, Table2, is_of_paper, is_papers_structure, read_rows, read_table2,
};
pub use units::typed;
pub use window::SLOWEST;
pub use words::{
    are, counted, design_cells, design_words, frequency, hertz_and_rpm, joined, over, rounded, short, visible,
};
