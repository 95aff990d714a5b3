//! How a state moves in time: the exact flight + regularised contact propagator, `ode23s`, `ode45`, and what they observe.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod settings;

pub use settings::{Contacts, Extreme, Method, Response, SceneKind, Settings, SolverError, Window, Work};
