//! A live explorer in the browser: change a damper, and its motion, impacts and response are updated.
//!
//! [`explore`] serves one page on the loopback address. A page shows a study with changed numbers ([`start::Start`]), by the rules of
//! study files; its figures of a run are those that `retune simulate` prints. [`protocol`] defines every message, [`limits`] the bounds
//! on the work of one. The latest message of a page wins: work for an older one is cancelled, and nothing is queued ([`session`]).
//!
//! Read [`protocol`] first, then [`session`], then what is computed: [`motion`], [`response`], [`branches`], [`kind`],
//! [`tuning`].
//!
//! ```
//! use retune_explore::protocol::{DamperKind, Place};
//! use retune_explore::{motion, start::Start};
//!
//! // The paper's SSVI NES with another spring, as a page shows it in 800 columns of pixels.
//! let start = Start::read(None)?;
//! let place = Place { damper: DamperKind::Ssvi, set: [("k2".to_owned(), 300.0)].into() };
//! let study = start.at(&place).map_err(|refused| refused.problem)?;
//! let shown = motion::look(&study, [50.0, 100.0], 800).map_err(|refused| refused.problem)?;
//! assert!(shown.get("text").and_then(|text| text.as_str()).is_some_and(|text| text.contains("E1max")));
//!
//! // The rules are those of study files.
//! let refused = start.at(&Place { damper: DamperKind::Tmd, set: [("D".to_owned(), 0.1)].into() });
//! assert!(refused.is_err_and(|refused| refused.problem == "D: the damper has no walls"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

pub mod branches;
pub mod forcing;
mod http;
pub mod kind;
pub mod limits;
pub mod motion;
mod page;
pub mod protocol;
mod refused;
mod report;
pub mod response;
pub mod server;
pub mod session;
pub mod sheets;
pub mod start;
pub mod texts;
pub mod thin;
pub mod tuning;

pub use refused::Refused;
pub use server::{Options, Server, explore};
