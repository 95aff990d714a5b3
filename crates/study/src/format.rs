//! The study file: its fields, with their defaults. The doc comments are the descriptions of the JSON Schema.

use super::global::GlobalSearch;
use super::kind::Kind;
use super::per_variable::PerVariable;
use retune_model::{NonNegative, Positive, Scene, Variable};
use retune_optim::{Limits, Objective, Options, Scale};
use retune_solver::{Contacts, Method, Settings, Window};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A study: a structure with its damper, when to look at it, and what to tune. SI units throughout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// The JSON Schema that an editor completes and checks this file with. Retune ignores it.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// "study". A file without it is recognised by its other fields.
    #[serde(default, skip_serializing_if = "Kind::is_study")]
    #[schemars(extend("const" = "study"))]
    pub kind: Kind,
    /// The version of Retune that wrote this file, when it did. Ignored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub retune: Option<String>,
    /// Names the directory of the results; the file's own name if left out. Letters, digits, `-`, `_` and `.`.
    #[serde(default)]
    pub name: Option<String>,
    /// The primary structure, the force on it, and the damper.
    pub scene: Scene,
    /// When maxima are taken.
    pub window: Span,
    /// How the motion is computed.
    #[serde(default)]
    pub solver: Solver,
    /// What is tuned, and where it is looked for.
    #[serde(default)]
    pub optimize: Option<Optimize>,
}

/// The window in which maxima are taken. Every run starts at rest at t = 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// t0, start of the window, s. The motion before it is a transient that counts for nothing; 0 takes the whole run.
    pub t0: NonNegative,
    /// T, end of the window and of the run, s.
    #[serde(rename = "T")]
    pub end: Positive,
}

/// How the motion is computed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// The integration method.
    pub method: Method,
    /// How every method but the hybrid meets a contact. The hybrid always locates it.
    pub contacts: Contacts,
    /// Relative tolerance of a step.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 0.1))]
    pub rtol: f64,
    /// Absolute tolerance of a step, m and m/s (of the methods with an error estimate, but the hybrid).
    #[schemars(range(min = 0.0))]
    pub atol: f64,
    /// Most steps a run may take.
    pub max_steps: u64,
}

/// What is tuned: the damper's parameters that make E1max, the largest energy of the primary structure, small.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Optimize {
    /// The parameters to tune; the others keep their values in `scene`.
    #[schemars(length(min = 1))]
    pub vary: Vec<Variable>,
    /// Which E1max is made small. Default: the largest in `window` at the scene's omega.
    #[serde(default, skip_serializing_if = "Objective::is_default")]
    pub objective: Objective,
    /// Smallest and largest value allowed for a tuned parameter; null for no largest value. Default: `[0, null]`.
    #[serde(default)]
    pub bounds: PerVariable<(f64, Option<f64>)>,
    /// Largest stroke (spring deflection), contact force and cavity allowed, and from when on. Default: none.
    #[serde(default, skip_serializing_if = "Limits::is_default")]
    pub limits: Limits,
    /// The coarse grid (the paper's `surf`), over all tuned parameters or some of them. Without it, without `global` and without
    /// `starts` the refinement starts at the damper of `scene`.
    #[serde(default)]
    pub surf: Option<PerVariable<GridAxis>>,
    /// A global search beside the grid. Default: none; `{}` takes all its defaults.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub global: Option<GlobalSearch>,
    /// Designs that start a refinement each, beside those that `surf` and `global` find. What one leaves out is that of `scene`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub starts: Vec<PerVariable<f64>>,
    /// The refinement (the paper's `fminsearch`).
    #[serde(default)]
    pub refine: Refine,
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
    /// Equal differences or equal ratios.
    #[serde(default = "linear")]
    pub scale: Scale,
}

/// The refinement: MATLAB's `fminsearch` from the best points of the grid and the best basins, with MATLAB's names and defaults.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Refine {
    /// How many of the grid's best points, and how many of the best basins, start a refinement each.
    #[schemars(range(min = 1))]
    pub starts: usize,
    /// Grid steps between any two starts, along at least one axis.
    pub apart: usize,
    /// A run stops once its simplex is at most this wide and TolFun holds too.
    #[serde(rename = "TolX")]
    #[schemars(range(min = 0.0))]
    pub tol_x: f64,
    /// A run stops once E1max differs by at most this over its simplex, J, and TolX holds too.
    #[serde(rename = "TolFun")]
    #[schemars(range(min = 0.0))]
    pub tol_fun: f64,
    /// What TolX measures: false, the parameters in their units, as in MATLAB; true, the parameters divided by their starts.
    pub scaled: bool,
    /// Most iterations of a run. Default: 200 for each tuned parameter.
    #[serde(rename = "MaxIter")]
    pub max_iter: Option<u64>,
    /// Most evaluations of a run. Default: 200 for each tuned parameter.
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
        let Self { method, contacts, rtol, atol, max_steps } = self;
        Settings { method, contacts, rtol, atol, max_steps, ..Settings::default() }
    }
}

impl Default for Solver {
    fn default() -> Self {
        let Settings { method, contacts, rtol, atol, max_steps, .. } = Settings::default();
        Self { method, contacts, rtol, atol, max_steps }
    }
}

impl Default for Refine {
    fn default() -> Self {
        let Options { tol_x, tol_fun, max_iter, max_fun_evals, .. } = Options::default();
        Self { starts: 1, apart: 3, tol_x, tol_fun, scaled: false, max_iter, max_fun_evals }
    }
}
