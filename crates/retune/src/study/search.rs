//! From what a study says to what is searched; the rules that hold between its fields.

use super::{GridAxis, Optimize, PerVariable, Study};
use retune_model::Damper;
use retune_optim::{Axis, AxisError, Bounds, Grid, GridError, Options, Scaling, Variable};
use thiserror::Error;

/// Most points of a grid: at a tenth of a millisecond each, a quarter of an hour.
pub const MOST_GRID_POINTS: usize = 10_000_000;

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
    /// The relative tolerance is none.
    #[error("solver.rtol: {value} is not allowed here: give a number above 0 and at most 0.1")]
    Rtol {
        /// The tolerance as given.
        value: f64,
    },
    /// The absolute tolerance is none.
    #[error("solver.atol: {value} is not allowed here: give a finite number not below 0")]
    Atol {
        /// The tolerance as given.
        value: f64,
    },
    /// Nothing to tune in a scene without a damper.
    #[error("scene.damper: missing, but `optimize` tunes the damper")]
    NoDamper,
    /// The study does not say what to tune.
    #[error("optimize: missing; it says what to tune, for instance {{ \"vary\": [\"k2\", \"c2\"] }}")]
    NoOptimize,
    /// Nothing to share out.
    #[error("optimize.surf: missing, but only the grid can be made in parts")]
    NoGrid,
    /// No parameter is tuned.
    #[error("optimize.vary: empty: name at least one of k2, c2, D, C")]
    NothingVaried,
    /// A parameter is named twice.
    #[error("optimize.vary: `{variable}` is named twice")]
    VariedTwice {
        /// The parameter.
        variable: Variable,
    },
    /// A band without width.
    #[error("optimize.objective.omega: from = {from} rad/s is not below to = {to} rad/s: the band is empty")]
    EmptyBand {
        /// Lowest as given, rad/s.
        from: f64,
        /// Highest as given, rad/s.
        to: f64,
    },
    /// Too few samples of a band, or too many.
    #[error(
        "optimize.objective.omega.samples: {samples} is not allowed here: give a whole number from 2 to {most}"
    )]
    Samples {
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
        variable: Variable,
    },
    /// Bounds that leave no room, or allow what cannot be.
    #[error(
        "optimize.bounds.{variable}: {bounds} is not allowed here: give [smallest, largest] with 0 <= smallest < largest"
    )]
    Bounds {
        /// The parameter.
        variable: Variable,
        /// Its bounds.
        bounds: Bounds,
    },
    /// An axis that is none.
    #[error("optimize.surf.{variable}: {source}")]
    Axis {
        /// The parameter.
        variable: Variable,
        /// What is wrong with its axis.
        source: AxisError,
    },
    /// A grid that reaches out of the bounds.
    #[error("optimize.surf.{variable}: from {from} to {to} leaves the bounds {bounds}")]
    GridOutside {
        /// The parameter.
        variable: Variable,
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
        variable: Variable,
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
    /// A tolerance that is none.
    #[error("optimize.refine.{name}: {value} is not allowed here: give a finite number not below 0")]
    Tolerance {
        /// `TolX` or `TolFun`.
        name: &'static str,
        /// The tolerance as given.
        value: f64,
    },
}

/// What is searched, and how.
#[derive(Clone, Debug)]
pub struct Search {
    /// The damper that the search starts from; what is not tuned stays as it is here.
    pub damper: Damper,
    /// The tuned parameters, in the order of the paper's tables.
    pub variables: Vec<Variable>,
    /// The coarse grid and its parameters, if any.
    pub surf: Option<(Vec<Variable>, Grid)>,
    /// How many of the grid's points start a refinement.
    pub starts: usize,
    /// Grid steps between any two starts.
    pub apart: usize,
    /// The settings of a refinement.
    pub options: Options,
}

impl Study {
    /// Checks what holds between the fields.
    ///
    /// # Errors
    /// The first [`Rule`] that is broken.
    pub fn check(&self) -> Result<(), Rule> {
        let name = self.name();
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
        if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
            return Err(Rule::Name { name: name.to_owned() });
        }
        let (t0, end) = (self.window.t0.get(), self.window.end.get());
        if t0 >= end {
            return Err(Rule::EmptyWindow { t0, end });
        }
        if !(self.solver.rtol > 0.0 && self.solver.rtol <= 0.1) {
            return Err(Rule::Rtol { value: self.solver.rtol });
        }
        if !(self.solver.atol >= 0.0 && self.solver.atol.is_finite()) {
            return Err(Rule::Atol { value: self.solver.atol });
        }
        if self.optimize.is_some() { self.search().map(drop) } else { Ok(()) }
    }

    /// The name; empty if none was given and the study came from no file.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or_default()
    }

    /// What the study searches.
    ///
    /// # Errors
    /// The first [`Rule`] that is broken.
    pub fn search(&self) -> Result<Search, Rule> {
        let optimize = self.optimize.as_ref().ok_or(Rule::NoOptimize)?;
        let damper = self.scene.damper.ok_or(Rule::NoDamper)?;
        let variables = varied(&optimize.vary)?;
        optimize.objective.check()?;
        let tuned = |field, variable: &Variable| match variables.contains(variable) {
            true => Ok(()),
            false => Err(Rule::NotVaried { field, variable: *variable }),
        };
        optimize.bounds.variables().iter().try_for_each(|variable| tuned("bounds", variable))?;
        let bounds_of = |variable| bounds(&optimize.bounds, variable);
        let bounds = variables.iter().map(|&variable| bounds_of(variable)).collect::<Result<Vec<_>, _>>()?;
        let surf = match &optimize.surf {
            None => None,
            Some(axes) => {
                let over = axes.variables();
                over.iter().try_for_each(|variable| tuned("surf", variable))?;
                Some((over, grid(axes, bounds_of)?))
            }
        };
        let on_grid = |variable| surf.as_ref().is_some_and(|(over, _)| over.contains(variable));
        for (variable, bounds) in variables.iter().zip(&bounds).filter(|(variable, _)| !on_grid(variable)) {
            let value = variable.get(&damper);
            if !bounds.contain(value) {
                return Err(Rule::StartOutside { variable: *variable, value, bounds: *bounds });
            }
        }
        let refine = optimize.refine;
        if refine.starts == 0 {
            return Err(Rule::NoStarts);
        }
        let options = options(optimize, bounds)?;
        Ok(Search { damper, variables, surf, starts: refine.starts, apart: refine.apart, options })
    }

    /// The same study with every default written out, and the version that did it.
    pub fn resolved(&self) -> Self {
        let mut study = self.clone();
        study.schema = None;
        study.retune = Some(env!("CARGO_PKG_VERSION").to_owned());
        if let Some(optimize) = &mut study.optimize {
            for &variable in &optimize.vary {
                optimize.bounds.get_mut(variable).get_or_insert((0.0, None));
            }
            let limit = 200 * optimize.vary.len() as u64;
            optimize.refine.max_iter.get_or_insert(limit);
            optimize.refine.max_fun_evals.get_or_insert(limit);
        }
        study
    }
}

/// The tuned parameters in the order of the paper's tables.
fn varied(vary: &[Variable]) -> Result<Vec<Variable>, Rule> {
    let mut variables = vary.to_vec();
    variables.sort_unstable();
    if variables.is_empty() {
        return Err(Rule::NothingVaried);
    }
    match variables.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(Rule::VariedTwice { variable: pair[0] }),
        None => Ok(variables),
    }
}

fn bounds(given: &PerVariable<(f64, Option<f64>)>, variable: Variable) -> Result<Bounds, Rule> {
    let (lower, upper) = given.get(variable).unwrap_or((0.0, None));
    let bounds = Bounds { lower: Some(lower), upper };
    let room =
        lower >= 0.0 && lower.is_finite() && upper.is_none_or(|upper| lower < upper && upper.is_finite());
    if room { Ok(bounds) } else { Err(Rule::Bounds { variable, bounds }) }
}

fn grid(
    axes: &PerVariable<GridAxis>,
    bounds_of: impl Fn(Variable) -> Result<Bounds, Rule>,
) -> Result<Grid, Rule> {
    let axis = |variable: Variable| -> Option<Result<Axis, Rule>> {
        let GridAxis { from, to, points, scale } = axes.get(variable)?;
        Some(bounds_of(variable).and_then(|bounds| {
            let axis =
                Axis::new(from, to, points, scale).map_err(|source| Rule::Axis { variable, source })?;
            match bounds.contain(from) && bounds.contain(to) {
                true => Ok(axis),
                false => Err(Rule::GridOutside { variable, from, to, bounds }),
            }
        }))
    };
    let axes = Variable::ALL.into_iter().filter_map(axis).collect::<Result<Vec<_>, _>>()?;
    Ok(Grid::new(axes, MOST_GRID_POINTS)?)
}

fn options(optimize: &Optimize, bounds: Vec<Bounds>) -> Result<Options, Rule> {
    let refine = optimize.refine;
    for (name, value) in [("TolX", refine.tol_x), ("TolFun", refine.tol_fun)] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(Rule::Tolerance { name, value });
        }
    }
    Ok(Options {
        tol_x: refine.tol_x,
        tol_fun: refine.tol_fun,
        max_iter: refine.max_iter,
        max_fun_evals: refine.max_fun_evals,
        bounds,
        scaling: if refine.scaled { Scaling::Start } else { Scaling::None },
    })
}
