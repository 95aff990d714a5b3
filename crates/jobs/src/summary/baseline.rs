//! What a tuned damper is compared with, in words.

use retune_model::Scene;
use retune_study::{is_of_paper, rounded};

/// The damper of a study's scene: the paper's where it has the numbers of an optimum that the paper publishes.
pub fn baseline(scene: &Scene) -> &'static str {
    if scene.damper.as_ref().is_some_and(is_of_paper) {
        "the paper's damper"
    } else {
        "the damper of the study"
    }
}

/// A ratio above 1 in three digits, or in words where nobody would read its digits.
pub fn how_many(times: f64) -> String {
    if times >= 1e6 { "over a million".to_owned() } else { rounded(times, 3) }
}
