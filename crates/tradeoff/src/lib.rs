//! What a damper costs and how long it lasts: jobs that are made of many searches and set what they find side by side.
//!
//! [`retention`] tunes dampers anew for other stiffnesses of the structure and shows how much of a tuning is retained; [`fronts`] finds the
//! least E1max of each damper under ever looser bounds, and the trade between E1max and what it takes. Both are jobs of
//! `retune_workbench`, and return what they found.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod caption;
pub mod fronts;
pub mod retention;

use retune_workbench::verify::Others;

/// How `verify` computes the files again that only these jobs know.
pub static OTHERS: &Others = &[(&retention::KIND, retention::again), (&fronts::KIND, fronts::again)];
