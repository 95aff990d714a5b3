//! How a state moves in time: the exact flight + regularised contact propagator, `ode23s`, `ode45` and other
//! general methods, and what they observe.
//!
//! [`simulate`], [`e1_max`] and [`trajectory`] run a scene. Below them, a method hands its motion over piece by piece
//! ([`observe::Segment`]) to whatever was asked for ([`observe::Observer`]); nothing is stored on the way.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod budget;
mod collision;
mod contact;
pub mod dop853;
pub mod euler;
mod extremes;
mod flow;
mod follow;
mod free;
mod gap;
mod hybrid;
pub mod observe;
pub mod ode23;
pub mod ode23s;
pub mod ode45;
pub mod onestep;
mod peak;
mod plausible;
mod polynomial;
mod quantity;
pub mod rk4;
mod rule;
mod run;
mod settings;
mod settle;
pub mod steps;
mod system;
mod trajectory;

pub use budget::Budget;
pub use extremes::{Ask, Extremes, extremes};
pub use follow::Follower;
pub use hybrid::{Hybrid, Motion, Phase};
pub use run::{e1_max, simulate, touch_downs};
pub use settings::{Contacts, Extreme, Method, Response, SceneKind, Settings, SolverError, Window, Work};
pub use settle::{Settle, settled};
pub use system::{Linear, LinearSystem, System};
pub use trajectory::{Moment, Rows, Sample, trajectory};
