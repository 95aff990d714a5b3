//! The rules that hold between the fields of a study.

use retune_optim::{AxisError, Bounds, GridError, Parameter};
use thiserror::Error;

/// A contradiction between the fields of a study.
#[derive(Clone, Debug, PartialEq, Error)]
#[expect(missing_docs, reason = "its words say what each is and holds")]
pub enum Rule {
    #[error("name: \"{name}\" is not allowed: give letters, digits, `-`, `_` and `.`, not starting with `.`")]
    Name { name: String },
    #[error("window: t0 = {t0} s is not before T = {end} s: the window is empty")]
    EmptyWindow { t0: f64, end: f64 },
    #[error("scene.damper: missing, but `optimize` tunes the damper")]
    NoDamper,
    #[error("optimize: missing; it says what to tune, for instance {{ \"vary\": [\"k2\", \"c2\"] }}")]
    NoOptimize,
    #[error(
        "optimize.objective.restitution: missing; it lists the restitutions to compare, for instance [0.6, 0.8, 1]"
    )]
    NoRestitutions,
    #[error("optimize.surf: missing, but only the grid can be made in parts")]
    NoGrid,
    #[error("optimize.vary: empty: name at least one of {}", Parameter::VARIED_SYMBOLS.join(", "))]
    NothingVaried,
    #[error("optimize.vary: `{variable}` is named twice")]
    VariedTwice { variable: Parameter },
    #[error("{field}: from = {from}{unit} is not below to = {to}{unit}: the band is empty")]
    EmptyBand { field: String, unit: &'static str, from: f64, to: f64 },
    #[error("optimize.{field}.{variable}: `{variable}` is not tuned: add it to `vary` or leave it out here")]
    NotVaried { field: &'static str, variable: Parameter },
    #[error("optimize.surf.{variable}: {source}")]
    Axis { variable: Parameter, source: AxisError },
    #[error("optimize.surf.{variable}: from {from} to {to} leaves the bounds {bounds}")]
    GridOutside { variable: Parameter, from: f64, to: f64, bounds: Bounds },
    #[error("optimize.surf: {0}")]
    Grid(#[from] GridError),
    #[error(
        "scene.damper.{variable}: {value} is where the refinement starts, but lies outside the bounds {bounds}"
    )]
    StartOutside { variable: Parameter, value: f64, bounds: Bounds },
    #[error("rows: empty: give at least one")]
    NoRows,
    #[error("rows: two studies are named \"{name}\"")]
    SameName { name: String },
    #[error("{field}: {value} is not allowed here: give {allowed}")]
    NotAllowed { field: String, value: String, allowed: &'static str },
    #[error("{}: {file}: {problem}", if *listed { "optimize.objective.records" } else { "scene.forcing.record" })]
    Record { listed: bool, file: String, problem: String },
    #[error(
        "{path}.sum: stands in the place of quantity, omega, k1, response, starts, settle and ensemble: move them into its parts"
    )]
    SumAndMore { path: String },
    #[error(
        "optimize.global.box.{variable}: missing, and optimize.bounds.{variable} has no largest value: give one of them"
    )]
    NoEnd { variable: Parameter },
}

impl Rule {
    /// The rule that a field has a value that is not allowed, with the allowed values.
    pub fn not_allowed(field: impl Into<String>, value: impl ToString, allowed: &'static str) -> Self {
        Self::NotAllowed { field: field.into(), value: value.to_string(), allowed }
    }
}
