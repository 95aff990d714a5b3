//! Retune's methods and other people's integrators on the same scenes: speed against accuracy, and where methods fail.
//!
//! No crate imports this one, and it is not built with the program (`just lab accuracy` and `just lab stability` build it). Other people's
//! integrators come with the feature `integrators`.

pub mod atlas;
pub mod chart;
pub mod external;
pub mod hunts;
pub mod motion;
pub mod own;
pub mod panel;
#[cfg(feature = "integrators")]
pub mod peers;
pub mod reading;
pub mod record;
pub mod reference;
pub mod savings;
pub mod scenes;
pub mod sealed;
pub mod statistics;
pub mod text;
