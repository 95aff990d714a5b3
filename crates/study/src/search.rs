//! Derives the search of a study; checks the rules between its fields.

use super::format::{GridAxis, Margins, Optimize, Solver, Study};
use super::global::GlobalSearch;
use super::objective::{check, check_decay, check_limits};
use super::records;
use super::rule::Rule;
use retune_model::{Amplitude, Coupled, Damper, Design, Forcing, Measure, PerVariable, Side, Source};
use retune_optim::{Axis, Bounds, Global, Grid, Limit, Options, Parameter, Scaling, Space};
use retune_solver::Method;
use std::convert::Infallible;

/// Most points of a grid: at a tenth of a millisecond each, a quarter of an hour.
pub const MOST_GRID_POINTS: usize = 10_000_000;

/// The allowed values of a tolerance.
const FINITE: &str = "a finite number not below 0";

/// A search and its settings.
#[derive(Clone, Debug)]
pub struct Search {
    /// The damper of the scene, where the search starts; parameters that are not tuned keep its values.
    pub damper: Damper,
    /// The tuned parameters, in the order of the paper's tables.
    pub variables: Vec<Parameter>,
    /// The coarse grid and its parameters, if any.
    pub surf: Option<(Vec<Parameter>, Grid)>,
    /// Number of grid points from which refinements start.
    pub starts: usize,
    /// Least number of grid steps between any two starts.
    pub apart: usize,
    /// The global search, its box, and the distance below which two ends are one basin; if any.
    pub global: Option<(Global, Space, f64)>,
    /// Given designs from which further refinements start.
    pub given: Vec<Vec<f64>>,
    /// The settings of a refinement.
    pub options: Options,
}

impl Search {
    /// The values of [`Self::variables`] in [`Self::damper`], in SI units.
    pub fn own(&self) -> Vec<f64> {
        self.variables.iter().map(|variable| variable.get(&self.damper)).collect()
    }
}

/// The largest gap, m.
const MAX_GAP: f64 = 1e6;

impl Study {
    /// Checks the rules between the fields.
    pub fn check(&self) -> Result<(), Rule> {
        check_name(self.name())?;
        self.check_rigid()?;
        let (t0, end) = (self.window.t0.get(), self.window.end.get());
        if t0 >= end {
            return Err(Rule::EmptyWindow { t0, end });
        }
        let Solver { rtol, search_rtol, .. } = self.solver;
        let coarse = self.optimize.as_ref().and_then(|optimize| optimize.coarse.rtol);
        for (field, rtol) in [
            ("solver.rtol", Some(rtol)),
            ("solver.search_rtol", search_rtol),
            ("optimize.coarse.rtol", coarse),
        ] {
            if let Some(value) = rtol.filter(|rtol| !(*rtol > 0.0 && *rtol <= 0.1)) {
                return Err(Rule::not_allowed(field, value, "a number above 0 and at most 0.1"));
            }
        }
        if let Some(most) = self.coarse().most.filter(|most| !(*most > 0.0 && most.is_finite())) {
            return Err(Rule::not_allowed("optimize.coarse.most", most, "a finite number above 0"));
        }
        let Margins { force, errors } = self.certificate;
        for (field, value, most, allowed) in [
            ("certificate.force", force, 1.0, "a number from 0 to 1"),
            ("certificate.errors", errors, 0.1, "a number from 0 to 0.1"),
        ] {
            if !(0.0..=most).contains(&value) {
                return Err(Rule::not_allowed(field, value, allowed));
            }
        }
        if matches!(self.scene.forcing.source, Source::Harmonic(Amplitude::BaseAcceleration, size) if size.get() > 0.0)
            && self.scene.forcing.frequency.get() == 0.0
        {
            let allowed = "a number above 0: the base would move without end";
            return Err(Rule::not_allowed("scene.forcing.omega", 0.0, allowed));
        }
        for gap in [Parameter::D, Parameter::C] {
            if let Some(value) = gap.of(&self.scene).filter(|gap| *gap > MAX_GAP) {
                let allowed = "at most 1e6 m, beyond which rounding loses the motion; or leave `contact` out: then there is no wall";
                return Err(Rule::not_allowed(format!("scene.damper.{gap}"), value, allowed));
            }
        }
        if !(self.solver.atol >= 0.0 && self.solver.atol.is_finite()) {
            return Err(Rule::not_allowed("solver.atol", self.solver.atol, FINITE));
        }
        if self.optimize.is_some() { self.search().map(drop) } else { Ok(()) }
    }

    /// The parameters that its search varies; empty without a search.
    pub fn varied(&self) -> &[Parameter] {
        self.optimize.as_ref().map_or(&[], |optimize| &optimize.vary)
    }

    /// The name; empty if none was given and the study was not read from a file.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or_default()
    }

    /// The search of the study.
    pub fn search(&self) -> Result<Search, Rule> {
        let optimize = self.optimize.as_ref().ok_or(Rule::NoOptimize)?;
        let damper = self.scene.damper.ok_or(Rule::NoDamper)?;
        self.begins_at_rest()?;
        if let Some(gap) = optimize.vary.iter().find(|variable| variable.of_damper(&damper).is_none()) {
            let allowed = match damper.contact.and_then(|contact| contact.rigid()) {
                Some(_) => "what the damper has: its walls are rigid, without surfaces",
                None => "what the damper has: without D, C and contact it has no walls",
            };
            return Err(Rule::not_allowed("optimize.vary", gap, allowed));
        }
        let variables = varied(&optimize.vary)?;
        check(&optimize.objective, "optimize.objective", &self.scene)?;
        check_limits(&optimize.limits, self.window.end.get())?;
        check_decay(&self.goal(), &self.scene.forcing)?;
        if optimize.objective.is_stationary() && !optimize.limits.is_empty() {
            let allowed = "none: limits are on largest values, of which a stationary random motion has none";
            return Err(Rule::not_allowed("optimize.limits", "what is given", allowed));
        }
        let tuned = |field, variable: &Parameter| match variables.contains(variable) {
            true => Ok(()),
            false => Err(Rule::NotVaried { field, variable: *variable }),
        };
        optimize.bounds.parameters().iter().try_for_each(|variable| tuned("bounds", variable))?;
        let bounds_of = |variable| bounds(&optimize.bounds, variable);
        let bounds = variables.iter().map(|&variable| bounds_of(variable)).collect::<Result<Vec<_>, _>>()?;
        let surf = match &optimize.surf {
            None => None,
            Some(axes) => {
                let over = axes.parameters();
                over.iter().try_for_each(|variable| tuned("surf", variable))?;
                Some((over, grid(axes, bounds_of)?))
            }
        };
        let space = |global: &GlobalSearch| -> Result<_, Rule> {
            global.sides.parameters().iter().try_for_each(|variable| tuned("global.box", variable))?;
            Ok((global.global(), global.space(&variables, &bounds)?, global.basin))
        };
        let global = optimize.global.as_ref().map(space).transpose()?;
        let given = optimize.starts.iter().enumerate();
        let given = given
            .map(|(i, start)| given_start(i, start, &variables, &bounds, &damper))
            .collect::<Result<Vec<_>, _>>()?;
        let found_elsewhere = global.is_some() || !given.is_empty();
        let on_grid = |variable| {
            found_elsewhere && surf.is_none()
                || surf.as_ref().is_some_and(|(over, _)| over.contains(variable))
        };
        for (variable, bounds) in variables.iter().zip(&bounds).filter(|(variable, _)| !on_grid(variable)) {
            let value = variable.of_damper(&damper).unwrap_or(f64::NAN);
            if !bounds.contain(value) {
                return Err(Rule::StartOutside { variable: *variable, value, bounds: *bounds });
            }
        }
        let refine = optimize.refine;
        if refine.starts == 0 {
            return Err(Rule::not_allowed("optimize.refine.starts", 0, "a whole number above 0"));
        }
        let options = options(optimize, bounds)?;
        let (starts, apart) = (refine.starts, refine.apart);
        Ok(Search { damper, variables, surf, starts, apart, global, given, options })
    }

    /// The study with the samples of its records included, so that it needs no other file.
    #[must_use]
    pub fn whole(&self) -> Self {
        let mut study = self.clone();
        let mut whole = |forcing: &mut Forcing| {
            if let Some((_, record)) = forcing.record_mut() {
                *record = record.whole();
            }
            Ok::<(), Infallible>(())
        };
        let Ok(()) = whole(&mut study.scene.forcing);
        let Ok(()) = records::each(&mut study, &mut whole);
        study
    }

    /// The study with every default written out, the samples of its records included, and this version of Retune.
    pub fn resolved(&self) -> Self {
        let mut study = self.whole();
        study.schema = None;
        study.retune = Some(env!("CARGO_PKG_VERSION").to_owned());
        if let Some(optimize) = &mut study.optimize {
            for &variable in &optimize.vary {
                let bounds = optimize.bounds.get(variable).unwrap_or((0.0, None));
                optimize.bounds.set(variable, Some(bounds));
            }
            let limit = 200 * optimize.vary.len() as u64;
            optimize.refine.max_iter.get_or_insert(limit);
            optimize.refine.max_fun_evals.get_or_insert(limit);
        }
        study
    }
}

/// The tuned parameters in the order of the paper's tables.
fn varied(vary: &[Parameter]) -> Result<Vec<Parameter>, Rule> {
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

/// A start given in the study; omitted parameters are taken from the damper.
fn given_start(
    i: usize,
    start: &PerVariable<f64>,
    variables: &[Parameter],
    bounds: &[Bounds],
    damper: &Damper,
) -> Result<Vec<f64>, Rule> {
    if let Some(other) = start.parameters().into_iter().find(|variable| !variables.contains(variable)) {
        return Err(Rule::NotVaried { field: "starts", variable: other });
    }
    let value = |(&variable, bounds): (&Parameter, &Bounds)| {
        let value = start.get(variable).or_else(|| variable.of_damper(damper)).unwrap_or(f64::NAN);
        let field = || format!("optimize.starts[{i}].{variable}");
        match bounds.contain(value) {
            true => Ok(value),
            false => Err(Rule::not_allowed(field(), value, "a value within its bounds")),
        }
    };
    variables.iter().zip(bounds).map(value).collect()
}

fn bounds(given: &PerVariable<(f64, Option<f64>)>, variable: Parameter) -> Result<Bounds, Rule> {
    let (lower, upper) = given.get(variable).unwrap_or((0.0, None));
    let bounds = Bounds { lower: Some(lower), upper };
    let room =
        lower >= 0.0 && lower.is_finite() && upper.is_none_or(|upper| lower < upper && upper.is_finite());
    let allowed = "[smallest, largest] with 0 <= smallest < largest";
    if room {
        Ok(bounds)
    } else {
        Err(Rule::not_allowed(format!("optimize.bounds.{variable}"), bounds, allowed))
    }
}

fn grid(
    axes: &PerVariable<GridAxis>,
    bounds_of: impl Fn(Parameter) -> Result<Bounds, Rule>,
) -> Result<Grid, Rule> {
    let axis = |variable: Parameter| -> Option<Result<Axis, Rule>> {
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
    let axes = Parameter::VARIED.into_iter().filter_map(axis).collect::<Result<Vec<_>, _>>()?;
    Ok(Grid::new(axes, MOST_GRID_POINTS)?)
}

fn options(optimize: &Optimize, bounds: Vec<Bounds>) -> Result<Options, Rule> {
    let refine = optimize.refine;
    for (name, value) in [("TolX", refine.tol_x), ("TolFun", refine.tol_fun)] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(Rule::not_allowed(format!("optimize.refine.{name}"), value, FINITE));
        }
    }
    Ok(Options {
        tol_x: refine.tol_x,
        tol_fun: refine.tol_fun,
        max_iter: refine.max_iter,
        max_fun_evals: refine.max_fun_evals,
        bounds,
        // A violation in the place of a value has no unit that TolX could be of.
        scaling: if refine.scaled || !optimize.limits.is_empty() { Scaling::Start } else { Scaling::None },
    })
}

/// A design clipped to the bounds of a search.
pub fn clipped(at: &Design, optimize: &Optimize) -> PerVariable<f64> {
    let mut start = PerVariable::default();
    for &variable in &optimize.vary {
        let (low, high) = optimize.bounds.get(variable).unwrap_or((0.0, None));
        let value = at.get(variable);
        start.set(variable, Some(value.min(high.unwrap_or(value)).max(low)));
    }
    start
}

/// Whether a name may have this character.
fn is_plain(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '-' | '_' | '.')
}

/// A valid name of results from any file name: `My study` gives `My-study`.
pub fn name_from(stem: &str) -> String {
    let name: String = stem.chars().map(|c| if is_plain(c) { c } else { '-' }).collect();
    let name = name.trim_start_matches('.');
    if name.is_empty() { "study".to_owned() } else { name.to_owned() }
}

/// Whether a directory of results may have this name.
pub fn check_name(name: &str) -> Result<(), Rule> {
    if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
        return Err(Rule::Name { name: name.to_owned() });
    }
    Ok(())
}

impl Study {
    /// Checks a study with rigid walls.
    pub(super) fn check_rigid(&self) -> Result<(), Rule> {
        let Some(damper) =
            self.scene.damper.filter(|damper| damper.contact.is_some_and(|walls| walls.rigid().is_some()))
        else {
            return Ok(());
        };
        let refuse = |field: &str, value: String, allowed| Err(Rule::not_allowed(field, value, allowed));
        if self.solver.method != Method::Hybrid {
            let allowed = "hybrid: the walls are rigid, and a general method cannot follow impacts that take no time; or give Hertz's surfaces";
            return refuse("solver.method", self.solver.method.name().to_owned(), allowed);
        }
        const FORCE: &str = "no contact force or pressure: that of an impact with a rigid wall has no bound; limit the stroke, or give Hertz's surfaces";
        if self.quantity().is_of_walls() {
            return refuse("optimize.objective.quantity", self.quantity().name().to_owned(), FORCE);
        }
        for measure in Measure::ALL.into_iter().filter(|measure| measure.is_of_walls()) {
            if let Some(most) = self.goal().limits.get(Limit::Of(measure)) {
                return refuse(&format!("optimize.limits.{}", measure.name()), most.to_string(), FORCE);
            }
        }
        let system = Coupled::new(&self.scene.primary, &self.scene.forcing, &damper);
        let start = system.start();
        let inside = system.indentation(&start);
        if Side::BOTH.iter().any(|&side| inside[side as usize] > 0.0 && !system.rests_on(side, &start)) {
            let allowed = "a place from x1 to x1 + D + C: rigid walls let nothing in";
            return refuse("scene.forcing.start.x2", start[2].to_string(), allowed);
        }
        Ok(())
    }
}
