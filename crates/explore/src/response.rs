//! The response over frequency: what the study's objective measures, at each frequency of a band and at its worst.

use crate::limits::MOST_SAMPLES;
use crate::protocol::Answer;
use rayon::prelude::*;
use retune_model::{Measure, NonNegative, Positive, Scene};
use retune_optim::{Band, FrequencyBand, Goal, Objective, Response, worst_over};
use retune_study::{Study, rounded};
use serde_json::Value;

/// Samples of the first curve, and of the final one.
pub const CURVES: [usize; 2] = [31, 301];

/// The work was for a message that another has replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stale;

/// The first term of the study's objective.
fn first(study: &Study) -> Objective {
    study.objective().terms().first().map(|(_, term)| (*term).clone()).unwrap_or_default()
}

/// Whether the study asks for the largest over all motions, where curves are of runs from rest.
pub fn of_all_motions(study: &Study) -> bool {
    first(study).response == Response::Motions
}

/// The first term at one frequency of the scene itself: no band, no other k1, no ensemble. Coexisting motions, a hundred times the work,
/// are left to the branches: a curve is of runs from rest.
fn term(study: &Study) -> Objective {
    let first = first(study);
    let response = if first.response == Response::Motions { Response::Window } else { first.response };
    Objective { omega: None, k1: None, restitution: None, ensemble: None, response, ..first }
}

/// The band of frequencies of the study; about the natural frequency if it has none.
pub fn band(study: &Study) -> Band {
    let objective = study.objective();
    let own = objective.terms().first().and_then(|(_, term)| term.omega);
    let natural = study.scene.primary.natural_frequency();
    let about = if natural > 0.0 { natural } else { study.scene.forcing.frequency.get().max(1.0) };
    let band = own.map_or(Band { from: 0.75 * about, to: 1.25 * about, samples: 61 }, |band| {
        band.of(&study.scene.primary)
    });
    Band { samples: band.samples.min(MOST_SAMPLES), ..band }
}

/// A study without its damper.
pub fn bare(study: &Study) -> Study {
    Study { scene: Scene { damper: None, ..study.scene }, ..study.clone() }
}

/// What a curve is of: the measure of a study, at any frequency.
#[derive(Clone, Debug)]
pub struct Curve {
    goal: Goal,
    study: Study,
}

impl Curve {
    /// Of a study.
    pub fn of(study: &Study) -> Self {
        let goal = Goal { objective: term(study), ..study.window.window().into() };
        Self { goal, study: study.clone() }
    }

    /// The value at a frequency, rad/s; NaN where there is none.
    pub fn at(&self, omega: f64) -> f64 {
        let Ok(frequency) = NonNegative::new(omega) else { return f64::NAN };
        let mut scene: Scene = self.study.scene;
        scene.forcing.frequency = frequency;
        let found = self.goal.evaluate(&scene, &self.study.solver.settings(), f64::INFINITY);
        found.map_or(f64::NAN, |found| found.value)
    }

    /// The values at evenly spaced frequencies of the band: `[omega, value]`.
    ///
    /// # Errors
    /// The work has become stale.
    pub fn over(&self, samples: usize, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<[Vec<f64>; 2], Stale> {
        let band = Band { samples, ..band(&self.study) };
        let at = |i: usize| if is_stale() { Err(Stale) } else { Ok(self.at(band.at(i))) };
        let values = (0..samples).into_par_iter().map(at).collect::<Result<Vec<f64>, Stale>>()?;
        Ok([(0..samples).map(|i| band.at(i)).collect(), values])
    }

    /// The largest value over the band and its frequency, as `retune optimize` finds it; none where some frequency has no value.
    ///
    /// # Errors
    /// The work has become stale.
    pub fn worst(&self, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Option<[f64; 2]>, Stale> {
        let value = |omega: f64| match self.at(omega) {
            _ if is_stale() => Err(Some(Stale)),
            value if value.is_nan() => Err(None),
            value => Ok(value),
        };
        match worst_over(&band(&self.study), value, f64::INFINITY) {
            Ok(worst) => Ok(Some([worst.value, worst.frequency])),
            Err(Some(stale)) => Err(stale),
            Err(None) => Ok(None),
        }
    }

    /// The answer with a curve.
    ///
    /// # Errors
    /// The work has become stale.
    pub fn answer(
        &self,
        whose: &str,
        samples: usize,
        is_stale: &(dyn Fn() -> bool + Sync),
    ) -> Result<Answer, Stale> {
        let [omega, values] = self.over(samples, is_stale)?;
        Ok(Answer::new("response").with("whose", whose).column("omega", &omega).column("value", &values))
    }
}

/// The worst of a study over its band beside that without a damper, and the largest of every figure over the band, from rest on.
///
/// # Errors
/// The work has become stale.
pub fn worst(study: &Study, whose: &str, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Answer, Stale> {
    let (found, bare) = (Curve::of(study).worst(is_stale)?, Curve::of(&bare(study)).worst(is_stale)?);
    let Some([value, omega]) = found else {
        let problem = "no value at some frequency of the band";
        return Ok(Answer::new("worst").with("whose", whose).with("problem", problem));
    };
    let figures = largest(study, is_stale)?;
    let reduction = bare.map(|[bare, _]| bare / value).filter(|ratio| ratio.is_finite());
    Ok(Answer::new("worst")
        .with("whose", whose)
        .with("value", value)
        .with("words", rounded(value, 4))
        .with("omega", omega)
        .with("reduction", reduction.map(|ratio| rounded(ratio, 3)))
        .with("none", bare.map(|[value, _]| rounded(value, 4)))
        .with("figures", figures))
}

/// The largest values over the band, each at its own frequency, as the figures of a run are shown; none where some frequency has no value.
fn largest(study: &Study, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Option<Value>, Stale> {
    let Band { from, to, samples } = band(study);
    let [Ok(from), Ok(to)] = [from, to].map(Positive::new) else { return Ok(None) };
    let omega = Some(FrequencyBand { from, to, samples, relative: false });
    let goal = Goal { objective: Objective { omega, ..term(study) }, ..study.window.window().into() };
    let found = goal.needs(&study.scene, &study.solver.settings(), &|| !is_stale());
    if is_stale() {
        return Err(Stale);
    }
    let Ok(needs) = found else { return Ok(None) };
    // The energy is that of the objective, in its window; all else is of the whole run.
    let of = |measure| match measure {
        Measure::Energy => needs.own.get(measure).value,
        _ => needs.whole.get(measure).value,
    };
    Ok(Some(crate::motion::largest(of).into()))
}
