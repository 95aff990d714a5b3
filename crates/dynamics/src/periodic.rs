//! Periodic motions: Newton's iteration on the stroboscopic map, Floquet multipliers, branches along a parameter, bifurcations.
//!
//! A motion of `n` periods of the force is a fixed point of the map over them. It is cut into equal segments, and Newton's iteration
//! closes the gaps between them all at once (multiple shooting), with exact derivatives of each (`retune_solver::Tangent`). A branch is
//! followed by pseudo-arclength continuation (H. B. Keller, 1977), so that it goes through folds.
//!
//! Read `forced` (the interface to a system), `shooting` (the equations and their solution), `orbit` and `seen` (a motion and its observed
//! quantities), `trace` (a branch, and the branch of twice the period that begins on it), `events` (bifurcations), `settle` (the motion
//! that a run settles on), `attractors` (those of runs from many starts), `largest`, then `branches`, which uses all of them, `belongs`
//! (the branch that a motion lies on), `seek` (motions that runs at the samples miss), `deflate` (Newton's iteration away from known
//! motions), `worst` (the largest value over all), `onset` (the value of a parameter from which a motion exists), `known` (motions of one
//! damper continued to another), and `basins` (where starts end).

pub mod attractors;
pub mod basins;
mod belongs;
pub mod branches;
pub mod deflate;
pub mod events;
pub mod forced;
mod known;
pub mod largest;
mod node;
pub mod onset;
pub mod orbit;
mod seek;
pub mod seen;
pub mod settle;
pub mod shooting;
pub mod trace;
pub mod worst;

pub use attractors::{Attractor, Sample};
pub use basins::{Basins, Plane};
pub use branches::{Branches, Control, Interval, branches};
pub use events::{End, Event, EventKind};
pub use forced::Forced;
pub use known::from_rest_and;
pub use largest::largest;
pub use onset::{Onset, Seed, onset};
pub use orbit::Orbit;
pub use shooting::Shooting;
pub use trace::Branch;
pub use worst::{Largest, Motions, Share, motions};
