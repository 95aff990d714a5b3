//! The jobs of Retune as a library.
//!
//! A job takes a study (`retune_study`), computes with `retune_optim` and `retune_dynamics`, keeps what it makes in a directory of
//! results (`retune_store`), tells an [`Observer`] how far it is, and returns what it found. Nothing here prints.
//!
//! [`tune()`] searches the best design of a study; [`certify`] says what a design is worth; [`table2`], [`retune`] and [`pareto`]
//! make several searches and compare them; [`verify`] looks at results again; [`simulate`] makes one run; [`evaluate`] answers
//! designs from outside.

pub mod certify;
pub mod describe;
pub mod designs;
pub mod error;
pub mod evaluate;
pub mod observer;
pub mod pareto;
pub mod request;
pub mod resolved;
pub mod retune;
pub mod simulate;
pub mod summary;
pub mod table2;
pub mod tune;
pub mod verify;

pub use error::Error;
pub use observer::{Observer, Progress, Silent};
pub use request::Request;
