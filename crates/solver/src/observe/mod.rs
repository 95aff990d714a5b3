//! Observers: they follow a motion while it is computed, and keep a few numbers of it.
//!
//! A method passes its motion on segment by segment and stores nothing else, so a run allocates nothing. Read `observer` (the contract, and
//! how observers compose), then `quantity` and `running_maximum` (E1max and similar values), and for its proof `search` and `quintic`.
//! `structure` has the quantities of the structure's motion, `magnitude` the largest magnitude of a quantity of either sign. `counters` see
//! events alone; `displacement_range` gives stroke and contact forces, `contact_forces` those of walls that lose energy; `largest_values`
//! has any of the measures, `since` a part of a run. `falls` finds where a rate falls through zero.

pub mod contact_forces;
pub mod counters;
pub mod displacement_range;
pub(crate) mod falls;
pub mod largest_values;
pub mod magnitude;
pub mod observer;
pub mod quantity;
mod quintic;
pub mod running_maximum;
pub(crate) mod search;
pub mod since;
pub mod structure;

// For callers of the crate; inside it, files import from the file that defines an item.
pub use crate::motion::form::Form;
pub use crate::motion::knot::Knot;
pub use crate::motion::segment::Segment;
pub use contact_forces::{ContactForces, WallForce};
pub use counters::{TouchDownTimes, TouchDowns};
pub use displacement_range::DisplacementRange;
pub use largest_values::LargestValues;
pub use magnitude::Magnitude;
pub use observer::{Impact, MOST_KNOTS, Observer, Part, Path, Unobserved};
pub use quantity::{BareEnergy, DamperEnergy, PrimaryEnergy, Quantity, RelativePosition};
pub use running_maximum::RunningMaximum;
pub use structure::{Structure, StructureMotion};
