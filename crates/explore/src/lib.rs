//! A live explorer in the browser: turn a damper, and its motion, its impacts and its response follow.
//!
//! [`explore`] serves one page on the loopback address. What a page shows is a study with its numbers changed ([`start::Start`]), by the
//! rules of study files; what it shows of a run is what `retune simulate` prints. [`protocol`] has every message, [`limits`] what bounds
//! the work of one. The latest message of a page wins: work for an older one is cancelled, and nothing is queued ([`session`]).
//!
//! Read [`protocol`] first, then [`session`], then what is computed: [`motion`], [`response`], [`kind`], [`tuning`].
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod http;
pub mod kind;
pub mod limits;
pub mod motion;
mod page;
pub mod protocol;
mod refused;
pub mod response;
pub mod server;
pub mod session;
pub mod sheets;
pub mod start;
pub mod texts;
pub mod thin;
pub mod tuning;

pub use refused::Refused;
pub use server::{Asked, Server, explore};
