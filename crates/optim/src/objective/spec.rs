//! The specification of an objective: the quantity to minimise, and over what. It is read from a study file and evaluated by a search.

use super::band::Band;
use super::ensemble::{Ensemble, Statistic};
use super::limits::Limits;
use super::unusable::Unusable;
use retune_model::{Forcing, Measure, Parameter, Positive, Primary, Restitution, Scene};
use retune_solver::{Settle, Window};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The objective of a search, the window of its runs, and the limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// The objective.
    pub objective: Objective,
    /// The window of the objective's runs; a steady response has none.
    pub window: Window,
    /// The limits, which apply to the largest values over all runs of all terms.
    pub limits: Limits,
    /// Whether the peaks between the samples of a band are searched.
    pub peaks: bool,
}

impl From<Window> for Goal {
    /// E1max in a window, without limits.
    fn from(window: Window) -> Self {
        Self { objective: Objective::default(), window, limits: Limits::default(), peaks: true }
    }
}

impl Goal {
    /// A term of the objective, by its number.
    pub fn term(&self, number: usize) -> Option<&Objective> {
        self.objective.terms().get(number).map(|(_, term)| *term)
    }
}

/// The objective to minimise: a statistic over `records` of a statistic over `ensemble` of the maximum over `restitution`, over `k1` and over `omega` of `quantity`, evaluated
/// in each run as `response` specifies. Fields left out keep their nominal value, that of `scene`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Objective {
    /// What is made small: E1max (J) if left out. Of a sum all terms have the same.
    #[serde(skip_serializing_if = "is_energy")]
    pub quantity: Measure,
    /// Worst case over a band of excitation frequencies; omit it (or null) for the omega of `scene` alone.
    pub omega: Option<FrequencyBand>,
    /// Worst case over stiffnesses k1 of the structure, each with its own worst case over `omega`; null for the k1 of `scene` alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k1: Option<Stiffnesses>,
    /// Worst case over restitutions of the contacts, each the same at every speed and with its own worst case over `k1` and `omega`; null for
    /// the loss of `scene` alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<Vec<Restitution>>,
    /// Records and pulses, each in the place of `scene.forcing`, which is one, too; the fields are those of `scene.forcing`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<Forcing>,
    /// The statistic over `records`: the largest if left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub records_by: Option<Statistic>,
    /// The part of the response in which the quantity is evaluated: in `window`, steady, or settled.
    pub response: Response,
    /// Starts at each frequency beside that from rest, for the response "motions".
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub starts: Option<usize>,
    /// The criterion by which a motion is settled, for the response "settled".
    #[serde(skip_serializing_if = "is_default")]
    pub settle: Settle,
    /// A statistic over phases of the excitation and small perturbations of the parameters; null for the nominal scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ensemble: Option<Ensemble>,
    /// A weighted sum of objectives, instead of all fields above.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sum: Vec<Part>,
}

/// A term of a weighted sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The weight of its value.
    pub weight: Positive,
    /// Its objective.
    pub objective: Objective,
}

/// A band of excitation frequencies, over which the quantity is maximised; its peaks are refined between samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Band")]
pub struct FrequencyBand {
    /// Lower end, angular frequency, rad/s.
    pub from: Positive,
    /// Upper end, angular frequency, rad/s.
    pub to: Positive,
    /// Number of evenly spaced frequencies, both ends included, at which runs are made; each local maximum is then refined between
    /// its neighbours with at most 11 further runs. The result is a lower bound: a peak narrower than the spacing can be missed. The
    /// steady response needs no samples: it is exact over the whole band.
    #[serde(default = "samples")]
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
    /// Whether `from` and `to` are multiples of the natural frequency √(k1/m1) of the structure, for each k1, instead of rad/s.
    #[serde(default, skip_serializing_if = "is_false")]
    pub relative: bool,
}

/// Stiffnesses of the primary structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "K1")]
pub enum Stiffnesses {
    /// A list of values, N/m.
    Set(#[schemars(length(min = 1))] Vec<Positive>),
    /// A range.
    Range(StiffnessRange),
}

/// A range of stiffnesses, sampled and refined like a band of frequencies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "K1Range")]
pub struct StiffnessRange {
    /// Smallest k1, N/m.
    pub from: Positive,
    /// Largest k1, N/m.
    pub to: Positive,
    /// Number of evenly spaced values, both ends included; local maxima are then refined.
    #[schemars(range(min = 2, max = 10000))]
    pub samples: usize,
}

/// The part of the response in which the quantity is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Response {
    /// The maximum in `window` of a run from rest.
    #[default]
    Window,
    /// The maximum of the steady-state response, in closed form. A design whose damper would reach a wall has no value; only the
    /// optimised design is integrated in time.
    Steady,
    /// The maximum once the motion of a run from rest has become periodic, see `settle`; the maximum in `window` if it has not by the
    /// end of the run (the number of such runs is reported). Valid for motions with contacts as well.
    Settled,
    /// The largest over every stable periodic motion that is found, from rest and from other starts, exact in ω along their branches; where
    /// none is known, the largest of the runs that are made there. Tens to hundreds of times the work of a window.
    Motions,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_false(value: &bool) -> bool {
    !value
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_energy(quantity: &Measure) -> bool {
    *quantity == Measure::Energy
}

fn is_default(settle: &Settle) -> bool {
    *settle == Settle::default()
}

/// Default number of starts besides that from rest.
pub const STARTS: usize = 16;

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

impl Stiffnesses {
    /// The values of a set, the samples of a range, N/m.
    pub fn samples(&self) -> Vec<f64> {
        match self {
            Self::Set(all) => all.iter().map(|k1| k1.get()).collect(),
            Self::Range(range) => (0..range.samples).map(|i| range.band().at(i)).collect(),
        }
    }
}

impl StiffnessRange {
    /// The range as a band that is searched, N/m.
    pub fn band(&self) -> Band {
        Band { from: self.from.get(), to: self.to.get(), samples: self.samples }
    }
}

impl Objective {
    /// The statistic over its records.
    pub fn over_records(&self) -> Statistic {
        self.records_by.unwrap_or(Statistic::Worst)
    }

    /// A scene with each of the restitutions; unchanged if none are given.
    ///
    /// # Errors
    /// Its contacts have a loss of another kind, or there are none.
    pub fn scenes(&self, scene: &Scene) -> Result<Vec<Scene>, Unusable> {
        let Some(set) = &self.restitution else { return Ok(vec![*scene]) };
        let with = |e: &Restitution| {
            let (mut scene, parameter) = (*scene, Parameter::Restitution);
            parameter.set(&mut scene, e.get()).map_err(|source| Unusable::Value { parameter, source })?;
            Ok(scene)
        };
        set.iter().map(with).collect()
    }
}

impl Objective {
    /// Whether it is the default: the largest E1 in the window.
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
                objective.terms().into_iter().map(|(inner, term)| (weight.get() * inner, term))
            })
            .collect()
    }

    /// The quantity to minimise, the same for all terms of a sum.
    pub fn quantity(&self) -> Measure {
        self.sum.first().map_or(self.quantity, |part| part.objective.quantity())
    }

    /// Changes each of [`Self::terms`].
    pub fn for_each_term(&mut self, change: &mut impl FnMut(&mut Self)) {
        if self.sum.is_empty() {
            change(self);
        } else {
            self.sum.iter_mut().for_each(|part| part.objective.for_each_term(change));
        }
    }

    /// Whether it is that of a stationary random motion.
    pub fn is_stationary(&self) -> bool {
        matches!(self.quantity(), Measure::Stationary(_))
    }

    /// Whether the quantity changes smoothly with a design and has known derivatives, unlike those of random motions and decay times.
    pub fn has_derivatives(&self) -> bool {
        !self.is_stationary() && self.quantity() != Measure::DecayTime
    }

    /// Whether every part of it is steady, so that no window and no solver matter.
    pub fn is_steady(&self) -> bool {
        self.terms().iter().all(|(_, term)| term.response == Response::Steady)
    }
}
