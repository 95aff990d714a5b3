//! The rules that hold between the fields of a study.

use retune_optim::{AxisError, Bounds, GridError, Parameter};
use thiserror::Error;

/// A contradiction between the fields of a study.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Rule {
    /// The name cannot be that of a directory.
    #[error("name: \"{name}\" is not allowed: give letters, digits, `-`, `_` and `.`, not starting with `.`")]
    Name {
        /// The name as given.
        name: String,
    },
    /// The window is empty.
    #[error("window: t0 = {t0} s is not before T = {end} s: the window is empty")]
    EmptyWindow {
        /// Start as given, s.
        t0: f64,
        /// End as given, s.
        end: f64,
    },
    /// The relative tolerance is out of range.
    #[error("{field}: {value} is not allowed here: give a number above 0 and at most 0.1")]
    Rtol {
        /// The field.
        field: &'static str,
        /// The tolerance as given.
        value: f64,
    },
    /// The absolute tolerance is out of range.
    #[error("solver.atol: {value} is not allowed here: give a finite number not below 0")]
    Atol {
        /// The tolerance as given.
        value: f64,
    },
    /// The scene has no damper to tune.
    #[error("scene.damper: missing, but `optimize` tunes the damper")]
    NoDamper,
    /// The study has no `optimize`.
    #[error("optimize: missing; it says what to tune, for instance {{ \"vary\": [\"k2\", \"c2\"] }}")]
    NoOptimize,
    /// The objective has no restitutions to compare.
    #[error(
        "optimize.objective.restitution: missing; it lists the restitutions to compare, for instance [0.6, 0.8, 1]"
    )]
    NoRestitutions,
    /// There is no grid to divide into parts.
    #[error("optimize.surf: missing, but only the grid can be made in parts")]
    NoGrid,
    /// No parameter is tuned.
    #[error("optimize.vary: empty: name at least one of {}", Parameter::VARIED_SYMBOLS.join(", "))]
    NothingVaried,
    /// A parameter is named twice.
    #[error("optimize.vary: `{variable}` is named twice")]
    VariedTwice {
        /// The parameter.
        variable: Parameter,
    },
    /// A band or a range without width.
    #[error("{field}: from = {from}{unit} is not below to = {to}{unit}: the band is empty")]
    EmptyBand {
        /// Its path.
        field: String,
        /// Its unit, after a space.
        unit: &'static str,
        /// Lowest as given.
        from: f64,
        /// Highest as given.
        to: f64,
    },
    /// Too few samples of a band, or too many.
    #[error("{field}.samples: {samples} is not allowed here: give a whole number from 2 to {most}")]
    Samples {
        /// The path of the band.
        field: String,
        /// Their number as given.
        samples: usize,
        /// The largest number allowed.
        most: usize,
    },
    /// Bounds or an axis for a parameter that is not tuned.
    #[error("optimize.{field}.{variable}: `{variable}` is not tuned: add it to `vary` or leave it out here")]
    NotVaried {
        /// `bounds` or `surf`.
        field: &'static str,
        /// The parameter.
        variable: Parameter,
    },
    /// Bounds that are empty, or allow values out of range.
    #[error(
        "optimize.bounds.{variable}: {bounds} is not allowed here: give [smallest, largest] with 0 <= smallest < largest"
    )]
    Bounds {
        /// The parameter.
        variable: Parameter,
        /// Its bounds.
        bounds: Bounds,
    },
    /// An invalid axis.
    #[error("optimize.surf.{variable}: {source}")]
    Axis {
        /// The parameter.
        variable: Parameter,
        /// The error of its axis.
        source: AxisError,
    },
    /// A grid that exceeds the bounds.
    #[error("optimize.surf.{variable}: from {from} to {to} leaves the bounds {bounds}")]
    GridOutside {
        /// The parameter.
        variable: Parameter,
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// The bounds of the parameter.
        bounds: Bounds,
    },
    /// The grid is empty or too large.
    #[error("optimize.surf: {0}")]
    Grid(#[from] GridError),
    /// The start lies outside its bounds.
    #[error(
        "scene.damper.{variable}: {value} is where the refinement starts, but lies outside the bounds {bounds}"
    )]
    StartOutside {
        /// The parameter.
        variable: Parameter,
        /// Its value in the scene.
        value: f64,
        /// The bounds of the parameter.
        bounds: Bounds,
    },
    /// No refinement.
    #[error("optimize.refine.starts: 0 is not allowed here: give a whole number above 0")]
    NoStarts,
    /// A table without rows.
    #[error("rows: empty: give at least one")]
    NoRows,
    /// Two rows whose results would share a directory.
    #[error("rows: two studies are named \"{name}\"")]
    SameName {
        /// The name.
        name: String,
    },
    /// An invalid tolerance.
    #[error("optimize.refine.{name}: {value} is not allowed here: give a finite number not below 0")]
    Tolerance {
        /// `TolX` or `TolFun`.
        name: &'static str,
        /// The tolerance as given.
        value: f64,
    },
    /// A value that is not allowed.
    #[error("{field}: {value} is not allowed here: give {allowed}")]
    NotAllowed {
        /// Its path.
        field: String,
        /// The value as given.
        value: String,
        /// The allowed values, in words.
        allowed: &'static str,
    },
    /// A record that cannot be read.
    #[error("{}: {file}: {problem}", if *listed { "optimize.objective.records" } else { "scene.forcing.record" })]
    Record {
        /// Whether it stands in the list of the objective.
        listed: bool,
        /// The file as given.
        file: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A sum together with fields that it replaces.
    #[error(
        "{path}.sum: stands in the place of quantity, omega, k1, response, starts, settle and ensemble: move them into its parts"
    )]
    SumAndMore {
        /// The path of the objective.
        path: String,
    },
    /// A global search over an unbounded parameter.
    #[error(
        "optimize.global.box.{variable}: missing, and optimize.bounds.{variable} has no largest value: give one of them"
    )]
    NoEnd {
        /// The parameter.
        variable: Parameter,
    },
}
