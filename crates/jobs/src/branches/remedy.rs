//! What removes a motion: how far each parameter can be changed before it vanishes at a fold.

use retune_dynamics::periodic::trace::trace;
use retune_dynamics::periodic::{Branch, End, EventKind, Orbit};
use retune_model::Parameter;

/// The parameters that are tried: the gaps, the dashpot, the spring, whatever forces the structure.
const TRIED: [Parameter; 8] = [
    Parameter::D,
    Parameter::C,
    Parameter::C2,
    Parameter::K2,
    Parameter::P,
    Parameter::Imbalance,
    Parameter::Base,
    Parameter::BaseAcceleration,
];
/// How far a parameter is changed, as a share of its value.
const REACH: [f64; 2] = [0.3, 3.0];

/// How long a motion lasts as a parameter changes.
#[derive(Debug)]
pub struct Remedy {
    /// The parameter.
    pub parameter: Parameter,
    /// Its value in the scene.
    pub own: f64,
    /// The folds below and above it at which the motion vanishes; none where there is none within reach.
    pub folds: [Option<f64>; 2],
}

/// The folds that end a motion of a branch, along each parameter that has one.
pub fn remedies(branch: &Branch, orbit: &Orbit) -> Vec<Remedy> {
    TRIED.into_iter().filter_map(|parameter| remedy(branch, orbit, parameter)).collect()
}

fn remedy(branch: &Branch, orbit: &Orbit, parameter: Parameter) -> Option<Remedy> {
    let own = parameter.of(&branch.shooting.forced.scene).filter(|own| *own > 0.0)?;
    let folds = folds(branch, orbit, (parameter, own))?;
    folds.iter().any(Option::is_some).then_some(Remedy { parameter, own, folds })
}

/// The values of a parameter below and above its own in the scene at which a motion of a branch vanishes at a fold.
fn folds(branch: &Branch, orbit: &Orbit, (parameter, own): (Parameter, f64)) -> Option<[Option<f64>; 2]> {
    let shooting = branch.shooting.along(orbit.value, parameter, own).ok()?;
    let seed = shooting.correct_at_value(&shooting.unknowns(&orbit.states, own))?;
    let along = trace(&shooting, &seed, REACH.map(|share| share * own), &|| true)?;
    let seed = along.points.iter().position(|point| point.value == own)?;
    let folds = || along.events.iter().filter(|event| event.kind == EventKind::Fold);
    // Traced towards larger values first. A closed branch comes back from the other side.
    let closed = along.ends == [End::Closed; 2];
    let before = folds().rfind(|event| event.place < seed || closed);
    let after = folds().find(|event| event.place > seed);
    let [low, high] = [before, after].map(|event| event.map(|event| event.orbit.value));
    Some([low.filter(|end| *end < own), high.filter(|end| *end > own)])
}

impl Remedy {
    /// In words: "D at least 0.636 m (28.4 mm more)".
    pub fn words(&self) -> String {
        let Self { parameter, own, folds } = self;
        let amount = |end: f64| match parameter.unit() {
            "m" => format!("{:.1} mm", 1e3 * (end - own).abs()),
            unit => format!("{} {unit}", retune_study::rounded((end - own).abs(), 3)),
        };
        let way = |end: f64, least: &str, more: &str| {
            let (symbol, unit) = (parameter.symbol(), parameter.unit());
            format!("{symbol} {least} {} {unit} ({} {more})", retune_study::rounded(end, 4), amount(end))
        };
        let above = folds[1].map(|end| way(end, "above", "more"));
        let below = folds[0].map(|end| way(end, "below", "less"));
        above.into_iter().chain(below).collect::<Vec<_>>().join(" or ")
    }
}
