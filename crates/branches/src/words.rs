//! Motions in words.

use retune_dynamics::periodic::Orbit;
use retune_study::{counted, rounded};

/// The periods and impacts of a motion in words.
pub fn kind(orbit: &Orbit) -> String {
    let impacts = match orbit.seen.impacts.as_str() {
        "" => "no impact".to_owned(),
        impacts => format!("impacts {impacts}"),
    };
    format!("{}, {impacts}", counted(orbit.periods as u64, "period"))
}

/// An energy, J, to five digits.
pub fn joule(value: f64) -> String {
    rounded(value, 5)
}
