//! How a state moves in time: the exact flight + regularised contact propagator, `ode23s`, `ode45` and other
//! general methods, and what they observe.
//!
//! [`simulate`], [`e1_max`] and [`trajectory`] run a scene. Below them, a method hands its motion over piece by piece
//! ([`observe::Segment`]) to whatever was asked for ([`observe::Observer`]); nothing is stored on the way.
#![deny(clippy::print_stdout, clippy::print_stderr, missing_docs)]

mod budget;
mod contact;
mod energy_bound;
mod error;
mod extremes;
mod hybrid;
mod linear;
pub mod methods;
mod motion;
pub mod observe;
mod response;
mod run;
mod settings;
mod settle;
mod simulate;
mod system;
mod trajectory;

pub use budget::{Budget, Pace};
pub use error::{Remedy, SolverError};
pub use extremes::{Ask, Extremes, extremes};
pub use hybrid::propagator::{Hybrid, Motion, Phase};
pub use linear::steps;
pub use response::{Extreme, Response, SceneKind, Work};
pub use run::Follower;
pub use settings::{Contacts, Method, Settings, Window};
pub use settle::{Settle, settled};
pub use simulate::{e1_max, simulate, touch_downs};
pub use system::{Linear, LinearSystem, System};
pub use trajectory::{Moment, Rows, Sample, trajectory};
