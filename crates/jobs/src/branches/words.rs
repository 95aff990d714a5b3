//! Motions in words.

use crate::certify::periodic;
use retune_dynamics::periodic::Orbit;
use retune_study::rounded;

/// The periods and impacts of a motion in words.
pub fn kind(orbit: &Orbit) -> String {
    periodic(orbit.periods, &orbit.seen.impacts)
}

/// An energy, J, to five digits.
pub fn joule(value: f64) -> String {
    rounded(value, 5)
}
