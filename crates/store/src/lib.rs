//! Results on disk, independent of what is computed: a file exists completely or not at all, and nothing made by another program or
//! person is replaced unless asked for.
//!
//! A run opens a [`Directory`] for work of an [`Identity`], writes its files, and finishes. The new files are written into the
//! subdirectory [`UNFINISHED`]; only when all are complete do they replace the earlier ones. Every value that the run computes is
//! recorded in its [`Journal`] there, so a run that was stopped or killed can be resumed.
//!
//! ```
//! use retune_store::{Begin, Directory, Extent, Identity, Order};
//!
//! # let desk = tempfile::tempdir()?;
//! # let path = desk.path().join("results");
//! let order = Order { command: "tune", study: "study.json".into(), begin: Begin::New, replace: false };
//! let results = Directory::open(&path, &order, &Identity::of("a study"), Extent::Whole, |name| name == "table.csv")?;
//!
//! // The objective x² at x = 3. A resumed run takes the value from the journal.
//! let energy = results.journal().value("search", &[3.0], f64::INFINITY, || 3.0 * 3.0, |recalled| drop(recalled));
//! results.write("table.csv", &format!("x,energy\n3,{energy}\n"))?;
//! assert!(!path.join("table.csv").exists()); // not before all is complete
//!
//! results.finish()?;
//! assert_eq!(std::fs::read_to_string(path.join("table.csv"))?, "x,energy\n3,9\n");
//! assert!(!Directory::is_unfinished(&path));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod directory;
pub mod error;
pub mod identity;
pub mod journal;
mod lock;
pub mod manifest;
pub mod order;
mod pending;
pub mod plain;
mod unfinished;

pub use directory::Directory;
pub use error::Error;
pub use identity::{Identity, json_text};
pub use journal::{Journal, MOST_POINTS};
pub use order::{Begin, Extent, Order};
pub use pending::Pending;
pub use unfinished::UNFINISHED;
