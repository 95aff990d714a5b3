//! An objective: which E1max is made small. A study file is read into this, and this is what a search evaluates.

use super::band::Band;
use super::ensemble::Ensemble;
use retune_model::{Positive, Primary};
use retune_solver::Settle;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which E1max is made small: a statistic over `ensemble` of the largest over `k1` of the largest over `omega` of the E1max that
/// `response` takes from a run. What is left out stays as it is in `scene`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Objective {
    /// The worst over a band of omega; leave it out (or null) for the omega of `scene` alone.
    pub omega: Option<FrequencyBand>,
    /// The worst over stiffnesses k1 of the structure, each with its own worst over `omega`; null for the k1 of `scene` alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k1: Option<Stiffnesses>,
    /// Where E1max is taken: in `window`, steady, or settled.
    pub response: Response,
    /// When a motion counts as settled, for the response "settled".
    #[serde(skip_serializing_if = "is_default")]
    pub settle: Settle,
    /// A statistic over phases of the force and small errors of parameters; null for the scene itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ensemble: Option<Ensemble>,
    /// A weighted sum of objectives in the place of everything above.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sum: Vec<Part>,
}

/// A part of a weighted sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// By what its E1max is multiplied.
    pub weight: Positive,
    /// Which E1max it is.
    pub objective: Objective,
}

/// A band of angular frequencies: E1max is the largest over it, with its peaks refined between samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Band")]
pub struct FrequencyBand {
    /// Lowest angular frequency, rad/s.
    pub from: Positive,
    /// Highest angular frequency, rad/s.
    pub to: Positive,
    /// Evenly spaced frequencies at which runs are made first, both ends included; each maximum of them is then refined between
    /// its neighbours by at most 12 more. What is found this way is a lower bound: a peak that shows at no sample is missed. The
    /// steady response needs no samples: it is exact over the whole band.
    #[serde(default = "samples")]
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
    /// Whether `from` and `to` are multiples of the structure's natural frequency √(k1/m1), whatever its k1 is, instead of rad/s.
    #[serde(default, skip_serializing_if = "is_false")]
    pub relative: bool,
}

/// Stiffnesses of the primary structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "K1")]
pub enum Stiffnesses {
    /// Each of these, N/m.
    Set(#[schemars(length(min = 1))] Vec<Positive>),
    /// A range.
    Range(StiffnessRange),
}

/// A range of stiffnesses, looked at as a band of omega is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "K1Range")]
pub struct StiffnessRange {
    /// Smallest k1, N/m.
    pub from: Positive,
    /// Largest k1, N/m.
    pub to: Positive,
    /// Evenly spaced values that are looked at first, both ends included; their maxima are then refined.
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
}

/// When E1max is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Response {
    /// The largest in `window` of a run from rest.
    #[default]
    Window,
    /// The largest once all transients have died, in closed form. A design whose damper would reach a wall has no value; the
    /// solver only runs the design that was found.
    Steady,
    /// The largest once the motion of a run from rest repeats, see `settle`; in `window`, if it does not by its end (the
    /// result counts such runs). For motions with contacts too.
    Settled,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_false(value: &bool) -> bool {
    !value
}

fn is_default(settle: &Settle) -> bool {
    *settle == Settle::default()
}

fn samples() -> usize {
    61
}

impl FrequencyBand {
    /// The band for a structure, rad/s.
    pub fn of(&self, primary: &Primary) -> Band {
        let unit = if self.relative { primary.natural_frequency() } else { 1.0 };
        Band { from: unit * self.from.get(), to: unit * self.to.get(), samples: self.samples }
    }
}

impl StiffnessRange {
    /// The range as a band that is searched, N/m.
    pub fn band(&self) -> Band {
        Band { from: self.from.get(), to: self.to.get(), samples: self.samples }
    }
}

impl Objective {
    /// Whether it is that of a study that does not name one: the largest E1 in the window.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The objectives that it is a weighted sum of, each with its weight; itself, if it is no sum.
    pub fn terms(&self) -> Vec<(f64, &Self)> {
        if self.sum.is_empty() {
            return vec![(1.0, self)];
        }
        self.sum
            .iter()
            .flat_map(|Part { weight, objective }| {
                objective.terms().into_iter().map(|(own, term)| (weight.get() * own, term))
            })
            .collect()
    }

    /// Changes each of [`Self::terms`].
    pub fn for_each_term(&mut self, change: &mut impl FnMut(&mut Self)) {
        if self.sum.is_empty() {
            change(self);
        } else {
            self.sum.iter_mut().for_each(|part| part.objective.for_each_term(change));
        }
    }

    /// Whether every part of it is steady, so that no window and no solver matter.
    pub fn is_steady(&self) -> bool {
        self.terms().iter().all(|(_, term)| term.response == Response::Steady)
    }
}
