//! Which E1max a search makes small: over which frequencies and stiffnesses, when, for which ensemble, in which sum.

use super::{Rule, Study};
use retune_model::{Positive, Scene};
use retune_optim::{Frequencies, Goal, Statistic, Stiffnesses, Term, When};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which E1max is made small: a statistic over `ensemble` of the largest over `k1` of the largest over `omega` of the E1max that
/// `response` takes from a run. What is left out stays as it is in `scene`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Objective {
    /// The worst over a band of omega; leave it out (or null) for the omega of `scene` alone.
    pub omega: Option<Band>,
    /// The worst over stiffnesses k1 of the structure, each with its own worst over `omega`; null for the k1 of `scene` alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k1: Option<K1>,
    /// Where E1max is taken: in `window`, steady, or settled.
    pub response: Response,
    /// When a motion counts as settled, for the response "settled".
    #[serde(skip_serializing_if = "Settle::is_default")]
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
pub struct Band {
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
pub enum K1 {
    /// Each of these, N/m.
    Set(#[schemars(length(min = 1))] Vec<Positive>),
    /// A range.
    Range(K1Range),
}

/// A range of stiffnesses, looked at as a band of omega is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct K1Range {
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

/// When a motion counts as settled: its state returns after some periods of the force, throughout successive blocks of periods
/// counted from t = 0. E1max is then that of the last of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settle {
    /// Length of a block in periods of the force. A motion that repeats less often does not settle.
    #[schemars(range(min = 1, max = 10000))]
    pub periods: u32,
    /// How many blocks in a row must agree.
    #[schemars(range(min = 2, max = 100))]
    pub blocks: u32,
    /// The most by which the state may still change, as a share of its size: from return to return, and all that is to follow if
    /// the change keeps falling as it fell from block to block.
    pub tolerance: Positive,
}

/// A deterministic ensemble about the scene, the same for every design: the points of a scrambled Sobol sequence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ensemble {
    /// How many members.
    #[schemars(range(min = 1, max = 65536))]
    pub members: u32,
    /// Whether the force P cos(omega t + phase) begins at another phase in each member, evenly spread over a turn.
    #[serde(default = "yes")]
    pub phases: bool,
    /// k1, k2, c2, D and C of each member are off by at most this share, independently and evenly spread.
    #[serde(default = "errors")]
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub errors: f64,
    /// What is taken of the members' E1max.
    #[serde(default)]
    pub statistic: Of,
    /// Chooses the members.
    #[serde(default)]
    pub seed: u32,
}

/// What is taken of the members' E1max.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Of {
    /// The mean.
    #[default]
    Mean,
    /// The largest.
    Worst,
    /// The smallest that at least this share of the members does not exceed, above 0 and at most 1.
    Quantile(#[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))] f64),
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_false(value: &bool) -> bool {
    !value
}

fn samples() -> usize {
    61
}

fn yes() -> bool {
    true
}

fn errors() -> f64 {
    1e-3
}

/// Most samples of a band: at a third of a millisecond each, three seconds for a design.
const MOST_SAMPLES: usize = 10_000;

impl Default for Settle {
    fn default() -> Self {
        let retune_solver::Settle { periods, blocks, tolerance } = retune_solver::Settle::default();
        let tolerance = Positive::new(tolerance).unwrap_or_else(|_| unreachable!("the solver's own"));
        Self { periods, blocks, tolerance }
    }
}

impl Settle {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl Objective {
    /// Whether it is that of a study that does not name one.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Checks what serde cannot: `path` is that of this objective in the study.
    ///
    /// # Errors
    /// The first [`Rule`] that is broken.
    pub(super) fn check(&self, path: &str, omega: f64) -> Result<(), Rule> {
        let field = |name: &str| format!("{path}.{name}");
        let bad = |field: String, value: String, allowed: &'static str| {
            Err(Rule::NotAllowed { field, value, allowed })
        };
        if !self.sum.is_empty() {
            let alone = Self { sum: Vec::new(), ..self.clone() };
            if !alone.is_default() {
                return Err(Rule::SumAndMore { path: path.to_owned() });
            }
            let part = |(i, part): (usize, &Part)| {
                part.objective.check(&field(&format!("sum[{i}].objective")), omega)
            };
            return self.sum.iter().enumerate().try_for_each(part);
        }
        let band = |name: &str, unit, [from, to]: [f64; 2], samples: usize| {
            if from >= to {
                return Err(Rule::EmptyBand { field: field(name), unit, from, to });
            }
            match samples {
                2..=MOST_SAMPLES => Ok(()),
                _ => Err(Rule::Samples { field: field(name), samples, most: MOST_SAMPLES }),
            }
        };
        if let Some(Band { from, to, samples, relative }) = self.omega {
            band("omega", if relative { "" } else { " rad/s" }, [from.get(), to.get()], samples)?;
        }
        match &self.k1 {
            Some(K1::Set(set)) if set.is_empty() => {
                return bad(field("k1.set"), "an empty list".to_owned(), "at least one stiffness, N/m");
            }
            Some(K1::Range(K1Range { from, to, samples })) => {
                band("k1.range", " N/m", [from.get(), to.get()], *samples)?;
            }
            _ => {}
        }
        let Settle { periods, blocks, .. } = self.settle;
        if !(1..=10_000).contains(&periods) {
            return bad(field("settle.periods"), periods.to_string(), "a whole number from 1 to 10000");
        }
        if !(2..=100).contains(&blocks) {
            return bad(field("settle.blocks"), blocks.to_string(), "a whole number from 2 to 100");
        }
        if self.omega.is_none()
            && omega == 0.0
            && (self.ensemble.is_some() || self.response == Response::Settled)
        {
            return bad(
                "scene.forcing.omega".to_owned(),
                "0".to_owned(),
                "a frequency above 0, for this objective counts periods",
            );
        }
        let Some(Ensemble { members, errors, statistic, .. }) = self.ensemble else { return Ok(()) };
        if !(1..=retune_optim::MOST_MEMBERS).contains(&members) {
            return bad(field("ensemble.members"), members.to_string(), "a whole number from 1 to 65536");
        }
        if !(0.0..1.0).contains(&errors) {
            return bad(field("ensemble.errors"), errors.to_string(), "a number not below 0 and below 1");
        }
        match statistic {
            Of::Quantile(share) if !(share > 0.0 && share <= 1.0) => {
                bad(field("ensemble.statistic.quantile"), share.to_string(), "a number above 0 and at most 1")
            }
            _ => Ok(()),
        }
    }

    /// The band as searches take it, of an objective that is no sum.
    pub fn band(&self) -> Option<Frequencies> {
        let Band { from, to, samples, relative } = self.omega?;
        Some(Frequencies { band: retune_optim::Band { from: from.get(), to: to.get(), samples }, relative })
    }

    /// The terms of its sum; itself, if it is none.
    fn terms(&self, study: &Study, weight: f64) -> Vec<Term> {
        if !self.sum.is_empty() {
            let part = |part: &Part| part.objective.terms(study, weight * part.weight.get());
            return self.sum.iter().flat_map(part).collect();
        }
        let window = study.window.window();
        let Settle { periods, blocks, tolerance } = self.settle;
        let settle = retune_solver::Settle { periods, blocks, tolerance: tolerance.get() };
        let when = match self.response {
            Response::Window => When::Window(window),
            Response::Steady => When::Steady,
            Response::Settled => When::Settled(window, settle),
        };
        let k1 = self.k1.as_ref().map(|k1| match k1 {
            K1::Set(set) => Stiffnesses::Set(set.iter().map(|k1| k1.get()).collect()),
            K1::Range(K1Range { from, to, samples }) => {
                Stiffnesses::Range(retune_optim::Band { from: from.get(), to: to.get(), samples: *samples })
            }
        });
        let ensemble = self.ensemble.map(|Ensemble { members, phases, errors, statistic, seed }| {
            let statistic = match statistic {
                Of::Mean => Statistic::Mean,
                Of::Worst => Statistic::Worst,
                Of::Quantile(share) => Statistic::Quantile(share),
            };
            retune_optim::Ensemble { members, phases, errors, seed, statistic }
        });
        vec![Term { weight, when, omega: self.band(), k1, ensemble }]
    }
}

impl Study {
    /// Which E1max its search makes small.
    pub fn objective(&self) -> Objective {
        self.optimize.as_ref().map(|optimize| optimize.objective.clone()).unwrap_or_default()
    }

    /// What its search makes small, and under which limits.
    pub fn goal(&self) -> Goal {
        let limits = self.optimize.as_ref().map(|optimize| optimize.limits.limits()).unwrap_or_default();
        Goal { terms: self.objective().terms(self, 1.0), limits }
    }

    /// E1max of a scene by its objective, whatever the limits, J; none where it cannot be run.
    pub fn energy(&self, scene: &Scene) -> Option<f64> {
        Some(self.goal().evaluate(scene, &self.solver.settings(), f64::INFINITY).ok()?.energy)
    }
}
