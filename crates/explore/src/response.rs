//! The response over frequency: what the study's objective measures, at each frequency of a band and at its worst.

use crate::limits::MOST_SAMPLES;
use crate::protocol::Answer;
use rayon::prelude::*;
use retune_model::{Bare, Measure, NonNegative, Positive, Scene};
use retune_optim::{Band, FrequencyBand, Goal, Limit, Objective, Response, worst_over};
use retune_study::{Study, rounded, short};
use serde::Serialize;
use serde_json::Value;

/// Samples of the first curve, and of the final one.
pub const CURVES: [usize; 2] = [31, 301];

/// The work was for a message that a newer one has replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stale;

/// The first term of the study's objective.
fn first(study: &Study) -> Objective {
    study.objective().terms().first().map(|(_, term)| (*term).clone()).unwrap_or_default()
}

/// Whether the study asks for the largest value over all motions, while curves show runs from rest.
pub fn of_all_motions(study: &Study) -> bool {
    first(study).response == Response::Motions
}

/// The first term at one frequency of the scene itself: no band, no other k1, no ensemble. It covers runs from rest only; coexisting
/// motions take a hundred times the work and are left to the branches.
fn term(study: &Study) -> Objective {
    let first = first(study);
    let response = if first.response == Response::Motions { Response::Window } else { first.response };
    Objective { omega: None, k1: None, restitution: None, ensemble: None, response, ..first }
}

/// The goal behind a curve. For the quantity that the study minimises it covers the same part of the response as the objective; for any
/// other quantity, all that a limit on it covers.
fn goal(study: &Study, quantity: Measure) -> Goal {
    let (own, mut window) = (term(study), study.window.window());
    if quantity == study.quantity() || own.response == Response::Steady {
        return Goal { objective: Objective { quantity, ..own }, ..window.into() };
    }
    window.from = limited_from(study);
    Goal { objective: Objective { quantity, response: Response::Window, ..own }, ..window.into() }
}

/// When limits begin to apply, s.
fn limited_from(study: &Study) -> f64 {
    study.goal().limits.from.map_or(0.0, NonNegative::get)
}

/// Describes the part of the response from a time (s) on.
fn since(from: f64) -> String {
    if from > 0.0 { format!("from {} s on", short(from)) } else { "from rest on".to_owned() }
}

/// Describes the part of the response that a curve covers, and the part that limits cover.
pub fn parts(study: &Study, quantity: Measure) -> [String; 2] {
    let response = term(study).response;
    let limited = match response {
        Response::Steady => "in the steady motion".to_owned(),
        _ => since(limited_from(study)),
    };
    let own = match response {
        Response::Steady => limited.clone(),
        _ if quantity != study.quantity() => limited.clone(),
        Response::Settled => "once settled".to_owned(),
        _ => since(study.window.t0.get()),
    };
    [own, limited]
}

/// A quantity that a curve may show, the study's limit on it, and the part of the response that each covers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drawn {
    name: &'static str,
    unit: &'static str,
    words: &'static str,
    /// Whether it exists only with a damper, and only with one that has walls.
    of_damper: bool,
    of_walls: bool,
    /// The part of the response that the curve covers.
    part: String,
    /// The largest value allowed, and the part of the response where it applies.
    limit: Option<f64>,
    limit_part: String,
}

impl Drawn {
    /// A quantity of a study.
    pub fn of(study: &Study, quantity: Measure) -> Self {
        let [part, limit_part] = parts(study, quantity);
        Self {
            name: quantity.name(),
            unit: quantity.unit(),
            words: quantity.words(),
            of_damper: quantity.is_of_damper(),
            of_walls: quantity.is_of_walls(),
            part,
            limit: allowed(study, quantity),
            limit_part,
        }
    }
}

/// The largest value that a study allows.
pub fn allowed(study: &Study, quantity: Measure) -> Option<f64> {
    study.goal().limits.get(Limit::Of(quantity))
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

/// A quantity of a study as a function of the frequency.
#[derive(Clone, Debug)]
pub struct Curve {
    goal: Goal,
    study: Study,
}

impl Curve {
    /// The curve of a quantity.
    pub fn of(study: &Study, quantity: Measure) -> Self {
        Self { goal: goal(study, quantity), study: study.clone() }
    }

    /// The curve of the quantity that the study minimises.
    fn of_objective(study: &Study) -> Self {
        Self::of(study, study.quantity())
    }

    /// Whether the scene has the quantity.
    pub fn is_there(&self) -> bool {
        let quantity = self.goal.objective.quantity;
        let damper = self.study.scene.damper;
        !(quantity.is_of_damper() && damper.is_none()
            || quantity.is_of_walls() && damper.is_none_or(|damper| damper.contact.is_none()))
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

    /// The largest value over the band and its frequency, found as `retune optimize` does; none if some frequency has no value.
    ///
    /// # Errors
    /// The work has become stale.
    pub fn worst(&self, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Option<[f64; 2]>, Stale> {
        if self.study.scene.forcing.is_transient() {
            // There is only one run.
            let value = self.at(0.0);
            return if is_stale() { Err(Stale) } else { Ok((!value.is_nan()).then_some([value, 0.0])) };
        }
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
        let quantity = self.goal.objective.quantity.name();
        let answer = Answer::new("response").with("whose", whose).with("quantity", quantity);
        Ok(answer.column("omega", &omega).column("value", &values))
    }
}

/// The worst value of a study over its band, with and without its damper, and the largest value of every figure over the band, from rest
/// on.
///
/// # Errors
/// The work has become stale.
pub fn worst(study: &Study, whose: &str, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Answer, Stale> {
    let (found, none) = (Curve::of_objective(study).worst(is_stale)?, worst_without_damper(study, is_stale)?);
    let Some([value, omega]) = found else {
        let problem = "no value at some frequency of the band";
        return Ok(Answer::new("worst").with("whose", whose).with("problem", problem));
    };
    let figures = largest_values(study, is_stale)?;
    let reduction = none.map(|none| none / value).filter(|ratio| ratio.is_finite());
    Ok(Answer::new("worst")
        .with("whose", whose)
        .with("value", value)
        .with("words", rounded(value, 4))
        .with("omega", omega)
        .with("reduction", reduction.map(|ratio| rounded(ratio, 3)))
        .with("none", none.map(|none| rounded(none, 4)))
        .with("figures", figures))
}

/// The worst value without a damper. If the bare structure has not settled in the window while the study has, the steady motion counts too,
/// since its maximum may be larger. If neither has settled, both values are those of the window.
fn worst_without_damper(study: &Study, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Option<f64>, Stale> {
    let bare = bare(study);
    let found = Curve::of_objective(&bare).worst(is_stale)?.map(|[value, _]| value);
    if bare.unsettled().is_none() || study.unsettled().is_some() {
        return Ok(found);
    }
    let Band { from, to, .. } = band(study);
    let system = Bare::new(&bare.scene.primary, &bare.scene.forcing);
    let steady = system.steady_max(study.quantity(), [from, to]).value;
    Ok(found.map(|found| found.max(steady)).filter(|value| value.is_finite()))
}

/// The largest values over the band, each at its own frequency, in the form of a run's figures; none if some frequency has no value.
fn largest_values(study: &Study, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<Option<Value>, Stale> {
    let Band { from, to, samples } = band(study);
    let [Ok(from), Ok(to)] = [from, to].map(Positive::new) else { return Ok(None) };
    let omega =
        (!study.scene.forcing.is_transient()).then_some(FrequencyBand { from, to, samples, relative: false });
    let goal = Goal { objective: Objective { omega, ..term(study) }, ..study.window.window().into() };
    let found = goal.needs(&study.scene, &study.solver.settings(), &|| !is_stale());
    if is_stale() {
        return Err(Stale);
    }
    let Ok(needs) = found else { return Ok(None) };
    Ok(Some(crate::motion::largest(|measure| needs.whole.get(measure).value).into()))
}
