//! The study file: its fields, with their defaults. The doc comments are the descriptions of the JSON Schema.

use super::file::Kind;
use super::global::GlobalSearch;
use retune_model::{NonNegative, Parameter, PerVariable, Positive, Scene};
use retune_optim::{Limits, Objective, Options, Scale};
use retune_solver::{Contacts, Method, Settings, Window};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema, schema_for};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value, json};
use std::borrow::Cow;

/// A study: a structure with its damper, the time window of the evaluation, and the parameters to tune. A number is in its SI unit, or a text
/// with a unit: "20 kN/m".
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// The JSON Schema with which an editor completes and validates this file. Ignored by Retune.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// "study". A file without it is recognised by its other fields.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(extend("const" = "study"))]
    pub kind: Kind,
    /// The version of Retune that wrote this file, if it was written by Retune. Ignored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub retune: Option<String>,
    /// Name of the results directory; by default the name of this file. Letters, digits, `-`, `_` and `.`.
    #[serde(default)]
    pub name: Option<String>,
    /// The primary structure, its excitation, and the damper.
    pub scene: Scene,
    /// The time window in which maxima are evaluated; or "settled".
    #[schemars(with = "crate::window::Said")]
    pub window: Span,
    /// The numerical integration of the motion.
    #[serde(default)]
    pub solver: Solver,
    /// The optimisation: the tuned parameters, their bounds and the search.
    #[serde(default)]
    pub optimize: Option<Optimize>,
    /// The margins that a robust design has.
    #[serde(default, skip_serializing_if = "is_default")]
    pub certificate: Margins,
}

/// How far the force and each parameter may be off before another motion has 5 % more than runs from rest, for a design to be called robust;
/// below that it is on an edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Margins {
    /// Relative increase of P.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub force: f64,
    /// Relative error of each parameter, up or down.
    #[schemars(range(min = 0.0, max = 0.1))]
    pub errors: f64,
}

impl Default for Margins {
    fn default() -> Self {
        Self { force: 0.05, errors: 0.01 }
    }
}

/// Whether a value is the default, which files may omit.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The time window in which maxima are evaluated. Every run starts at t = 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// t0, start of the window, s. The motion before t0 is treated as transient and discarded; 0 evaluates the whole run.
    pub t0: NonNegative,
    /// T, end of the window and of the run, s.
    #[serde(rename = "T")]
    pub end: Positive,
}

/// The numerical integration of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// The integration method.
    pub method: Method,
    /// Treatment of contacts by every method except the hybrid, which always locates them.
    pub contacts: Contacts,
    /// Relative tolerance of the local error of a step.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 0.1))]
    pub rtol: f64,
    /// The same for the runs of a search (`surf`, `global`, `fminsearch`, and the descents of fronts), whose tables hold values of this
    /// tolerance; the ends of refinements are compared, and all else is computed, by rtol. Default: rtol.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 0.1))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub search_rtol: Option<f64>,
    /// Absolute tolerance of the local error of a step, m and m/s (adaptive methods only, except the hybrid).
    #[schemars(range(min = 0.0))]
    pub atol: f64,
    /// Maximum number of steps of a run; of evaluations of its equations, in contact or by a general method, a quarter of it, at least 5 million.
    pub max_steps: u64,
}

/// The optimisation: damper parameters are tuned to minimise E1max, the largest energy of the primary structure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Optimize {
    /// The parameters to tune; the others keep their values in `scene`.
    #[serde(deserialize_with = "read_varied")]
    #[schemars(schema_with = "varied_schema")]
    pub vary: Vec<Parameter>,
    /// The objective to minimise. Default: E1max in `window` at the omega of the scene.
    #[serde(default, skip_serializing_if = "Objective::is_default")]
    pub objective: Objective,
    /// Lower and upper bound of a tuned parameter; null for no upper bound. Default: `[0, null]`.
    #[serde(default)]
    pub bounds: PerVariable<(f64, Option<f64>)>,
    /// Limits on the stroke (spring deflection), the contact force and the cavity, and the time from which they apply. Default: none.
    #[serde(default, skip_serializing_if = "Limits::is_default")]
    pub limits: Limits,
    /// The coarse grid (the paper's `surf`), over some or all of the tuned parameters. Without `surf`, `global` and `starts` the
    /// refinement starts from the damper of `scene`.
    #[serde(default)]
    pub surf: Option<PerVariable<GridAxis>>,
    /// How exact the grid and the global search are, which only say where refinements start. Default: as exact as these are.
    #[serde(default, skip_serializing_if = "is_default")]
    pub coarse: Coarse,
    /// A global search in addition to the grid. Default: none; `{}` selects it with its default settings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub global: Option<GlobalSearch>,
    /// Additional initial designs, each the start of one refinement, beside those found by `surf` and `global`. Parameters left out
    /// take their value in `scene`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub starts: Vec<PerVariable<f64>>,
    /// The refinement (the paper's `fminsearch`).
    #[serde(default)]
    pub refine: Refine,
}

/// How exact the values of a grid and of a global search are, which only say where refinements start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Coarse {
    /// Relative tolerance of its runs. Default: `solver.search_rtol`.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 0.1))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rtol: Option<f64>,
    /// Whether the peaks between the samples of a band are searched. Without, a value is the largest of its samples.
    pub peaks: bool,
    /// The largest value of the grid that matters, in the unit of the quantity. The evaluation of a point ends once it is known to be above;
    /// the point then has this value in tables, and maps are grey there. Refinements start where they would without. Default: none.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most: Option<f64>,
}

impl Coarse {
    /// The value up to which a grid is computed, in the unit of the quantity; infinite if all of it is.
    pub fn up_to(&self) -> f64 {
        self.most.unwrap_or(f64::INFINITY)
    }
}

/// What is left out, as a phrase that follows the words on a grid or a global search.
impl std::fmt::Display for Coarse {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.rtol.map_or(Ok(()), |rtol| write!(f, ", at rtol {rtol:e}"))?;
        if self.peaks { Ok(()) } else { write!(f, ", on the samples of the band alone") }
    }
}

impl Default for Coarse {
    fn default() -> Self {
        Self { rtol: None, peaks: true, most: None }
    }
}

/// Evenly spaced values of a parameter, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridAxis {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values.
    #[schemars(range(min = 1))]
    pub points: usize,
    /// Linear or logarithmic spacing.
    #[serde(default = "linear")]
    pub scale: Scale,
}

/// The refinement: MATLAB's `fminsearch` from the best points of the grid and the best basins, with MATLAB's names and defaults.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Refine {
    /// Number of best grid points, and of best basins, from which a refinement is started.
    #[schemars(range(min = 1))]
    pub starts: usize,
    /// Minimum separation of any two starts, in grid steps along at least one axis.
    pub apart: usize,
    /// Termination tolerance on the parameters: a run stops once the width of its simplex is at most TolX and TolFun is met as well.
    #[serde(rename = "TolX")]
    #[schemars(range(min = 0.0))]
    pub tol_x: f64,
    /// Termination tolerance on E1max, J: a run stops once E1max varies by at most TolFun over its simplex and TolX is met as well.
    #[serde(rename = "TolFun")]
    #[schemars(range(min = 0.0))]
    pub tol_fun: f64,
    /// Scaling of the parameters for TolX: false, in their SI units, as in MATLAB; true, divided by their initial values, as always under limits.
    pub scaled: bool,
    /// Maximum number of iterations of a run. Default: 200 for each tuned parameter.
    #[serde(rename = "MaxIter")]
    pub max_iter: Option<u64>,
    /// Maximum number of evaluations of a run. Default: 200 for each tuned parameter.
    #[serde(rename = "MaxFunEvals")]
    pub max_fun_evals: Option<u64>,
}

fn linear() -> Scale {
    Scale::Linear
}

impl Span {
    /// The window as solvers take it.
    pub fn window(self) -> Window {
        Window { from: self.t0.get(), to: self.end.get() }
    }
}

impl Solver {
    /// The settings as solvers take them.
    pub fn settings(self) -> Settings {
        let Self { method, contacts, rtol, atol, max_steps, .. } = self;
        Settings { method, contacts, rtol, atol, max_steps, ..Settings::default() }
    }

    /// The settings of the runs of a search.
    pub fn searching(self) -> Settings {
        Settings { rtol: self.search_rtol.unwrap_or(self.rtol), ..self.settings() }
    }
}

impl Default for Solver {
    fn default() -> Self {
        let Settings { method, contacts, rtol, atol, max_steps, .. } = Settings::default();
        Self { method, contacts, rtol, search_rtol: None, atol, max_steps }
    }
}

impl Default for Refine {
    fn default() -> Self {
        let Options { tol_x, tol_fun, max_iter, max_fun_evals, .. } = Options::default();
        Self { starts: 1, apart: 3, tol_x, tol_fun, scaled: false, max_iter, max_fun_evals }
    }
}

/// An element of the list `vary`.
struct Varied(Parameter);

impl<'de> Deserialize<'de> for Varied {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Cow::<'de, str>::deserialize(deserializer)?;
        let unknown = || D::Error::unknown_variant(&name, &Parameter::VARIED_SYMBOLS);
        Parameter::varied(&name).map(Self).ok_or_else(unknown)
    }
}

/// Reads the list `vary`; refuses a parameter that no search may vary.
fn read_varied<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Parameter>, D::Error> {
    Ok(Vec::<Varied>::deserialize(deserializer)?.into_iter().map(|Varied(parameter)| parameter).collect())
}

/// The schema of `vary`: symbols, each with its description.
fn varied_schema(_: &mut SchemaGenerator) -> Schema {
    let one = |parameter: Parameter| json_schema!({ "type": "string", "const": parameter.symbol(), "description": parameter.sentence() });
    json_schema!({ "type": "array", "minItems": 1, "items": { "oneOf": Parameter::VARIED.map(one) } })
}

/// Definitions whose numbers may be given as texts with a unit, by name or prefix of the name. Numbers without a unit have other types, or
/// the reader refuses a text.
const NUMBERS: [&str; 9] = [
    "Positive",
    "NonNegative",
    "Finite",
    "Margins",
    "GridAxis",
    "BoxSide",
    "K1Range",
    "Band",
    "PerVariable_",
];

/// A text must contain more than a number: a number in quotes is a mistake.
const MORE_THAN_A_NUMBER: &str = "[^-+.0-9eE ]";

/// The schema of a kind of file.
pub fn schema<T: JsonSchema>() -> Schema {
    let mut schema = schema_for!(T);
    if let Some(Value::Object(all)) = schema.get_mut("$defs") {
        for (name, of) in all.iter_mut() {
            if NUMBERS.iter().any(|known| name == known || known.ends_with('_') && name.starts_with(known)) {
                widen(of);
            }
        }
    }
    schema
}

/// Allows a text in place of each number. Keywords that limit numbers do not apply to texts.
fn widen(schema: &mut Value) {
    match schema {
        Value::Object(keywords) => {
            widen_type(keywords);
            keywords.values_mut().for_each(widen);
        }
        Value::Array(all) => all.iter_mut().for_each(widen),
        _ => {}
    }
}

fn widen_type(keywords: &mut Map<String, Value>) {
    let Some(of) = keywords.get_mut("type") else { return };
    match of {
        Value::String(one) if one == "number" => *of = json!(["number", "string"]),
        Value::Array(several) if several.contains(&json!("number")) => several.push(json!("string")),
        _ => return,
    }
    let words = keywords.get("description").and_then(Value::as_str).map(|words| format!("{words} "));
    let words =
        format!("{}A number in the SI unit, or a text with a unit: \"20 kN/m\".", words.unwrap_or_default());
    keywords.insert("description".to_owned(), words.into());
    keywords.insert("pattern".to_owned(), MORE_THAN_A_NUMBER.into());
}
