//! The part of a wide band around the resonance, where a damper with walls is effective: samples of the whole band may miss a narrow
//! resonance.

use retune_model::Positive;
use retune_optim::{FrequencyBand, Response};
use retune_study::Study;

/// A band that extends farther from the resonance than this factor is wide; and its part around the resonance, in multiples of the natural
/// frequency.
const WIDE: f64 = 2.0;
const ABOUT: [f64; 2] = [0.8, 1.25];

/// The study with its band restricted to the resonance of the structure; none for a narrow band, one that leaves out the resonance, or a
/// steady motion in closed form.
pub(super) fn about_resonance(study: &Study) -> Option<Study> {
    let (objective, primary) = (study.objective(), &study.scene.primary);
    let (band, natural) = (objective.omega?.of(primary), primary.natural_frequency());
    let is_wide = band.from < natural / WIDE || band.to > natural * WIDE;
    if !is_wide || natural < band.from || natural > band.to || objective.response == Response::Steady {
        return None;
    }
    let end = |omega: f64| Positive::new(omega.clamp(band.from, band.to)).ok();
    let [from, to] = ABOUT.map(|share| end(share * natural));
    let about = FrequencyBand { from: from?, to: to?, samples: band.samples, relative: false };
    let mut study = study.clone();
    study.optimize.as_mut()?.objective.omega = Some(about);
    Some(study)
}
