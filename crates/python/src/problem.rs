//! A study as a function of a design.

use crate::arrays::{numbers, plain_row, table};
use crate::columns::{COUNT, Known, MAX_EXCEPTIONS, column_names, in_columns, numbers_of};
use crate::errors::{Fault, Given};
use crate::monitor::{catch_panic, on_pool};
use crate::pool::pool;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use retune_model::Measure;
use retune_optim::{DesignObjective, Evaluation, Limit, Objective, Parameter, Proceed, Response};
use retune_study::{Rule, Setting, Study, read::from_text};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A study, checked, with its objective: what `retune.Problem` is made of.
#[pyclass(subclass, frozen, module = "retune._core")]
pub struct Core {
    pub(crate) study: Study,
    /// The file that it was read from, if any, which its results name as their origin.
    pub(crate) file: Option<String>,
    objective: Option<Arc<DesignObjective>>,
    /// Whether one evaluation may take long: many runs, or a long one.
    takes_long: bool,
    /// The quantities known beside the objective's: those with a limit, and the stroke of a steady motion.
    known: Known,
}

/// The columns of a batch, and the rows without a value, each with its exception.
type Batch<'py> = (Bound<'py, PyDict>, Vec<(usize, Py<PyAny>)>);

/// A run of more periods of the force takes long: some tenths of a second.
const LONG: f64 = 2e4;
#[pymethods]
impl Core {
    /// From the text of a study and the file that it stands for.
    #[new]
    #[pyo3(signature = (text, file=None))]
    fn new(text: &str, file: Option<String>) -> PyResult<Self> {
        Ok(catch_panic(|| Self::read(text, file))?)
    }

    /// The study with every default written out, as JSON.
    #[pyo3(name = "_text")]
    fn text(&self) -> PyResult<String> {
        Ok(json(&self.study.resolved())?)
    }

    /// What is to be known of the transient in its window.
    #[pyo3(name = "_transient")]
    fn transient(&self) -> Option<String> {
        self.study.transient()
    }

    /// The file that it was read from.
    #[getter]
    fn file(&self) -> Option<&str> {
        self.file.as_deref()
    }

    /// The tuned parameters, in the order of a design.
    #[getter]
    fn names(&self) -> Vec<&'static str> {
        self.variables().iter().map(|variable| variable.symbol()).collect()
    }

    /// The unit of each.
    #[getter]
    fn units(&self) -> Vec<&'static str> {
        self.variables().iter().map(|variable| variable.unit()).collect()
    }

    /// Lower and upper bound of each; infinity for none.
    #[getter]
    fn bounds(&self) -> Vec<(f64, f64)> {
        let Some(optimize) = &self.study.optimize else { return Vec::new() };
        let bounds = |variable: &Parameter| optimize.bounds.get(*variable).unwrap_or((0.0, None));
        let with_end = |(lower, upper): (f64, Option<f64>)| (lower, upper.unwrap_or(f64::INFINITY));
        self.variables().iter().map(|variable| with_end(bounds(variable))).collect()
    }

    /// The values of the tuned parameters in the study.
    #[getter]
    fn start(&self) -> Vec<f64> {
        let Some(damper) = &self.study.scene.damper else { return Vec::new() };
        self.variables().iter().map(|variable| variable.get(damper)).collect()
    }

    /// What is made small, and its unit.
    #[getter]
    fn quantity(&self) -> (&'static str, &'static str) {
        let quantity = self.study.quantity();
        (quantity.name(), quantity.unit())
    }

    /// The value that searches make small.
    #[pyo3(signature = (x, /))]
    fn __call__(&self, py: Python<'_>, x: &Bound<'_, PyAny>) -> PyResult<f64> {
        let objective = self.objective()?;
        let mut row = [0.0; Parameter::VARIED.len()];
        let row = &mut row[..objective.variables().len()];
        self.design(x, row)?;
        Ok(self.evaluate(py, objective, row)?.ranked)
    }

    /// Everything that an evaluation finds, by its name.
    #[pyo3(name = "_evaluation")]
    fn evaluation<'py>(&self, py: Python<'py>, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let objective = self.objective()?;
        let mut row = vec![0.0; objective.variables().len()];
        self.design(x, &mut row)?;
        let found = self.evaluate(py, objective, &row)?;
        let all = PyDict::new(py);
        for (name, value) in column_names("largest").into_iter().zip(numbers_of(&found, self.known)) {
            all.set_item(name, value)?;
        }
        all.set_item("runs", found.runs)?;
        all.set_item("unsettled", found.unsettled)?;
        Ok(all)
    }

    /// The value that searches make small, and its derivatives.
    #[pyo3(name = "_gradient")]
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
    ) -> PyResult<(f64, Bound<'py, PyArray1<f64>>)> {
        let objective = Arc::clone(self.objective()?);
        let mut row = vec![0.0; objective.variables().len()];
        self.design(x, &mut row)?;
        let by = move |proceed: Proceed<'_>| {
            let (found, by) = objective.gradient(&row, proceed)?;
            Ok((found.ranked, by))
        };
        let (value, by) = if self.takes_long {
            on_pool(py, &*pool(None)?, move |monitor| by(&|| !monitor.is_stopped()))?
        } else {
            py.detach(|| catch_panic(|| by(&|| true)))?
        };
        Ok((value, PyArray1::from_vec(py, by)))
    }

    /// The same for each row of designs, as columns; and the rows without a value, each with its exception.
    #[pyo3(name = "_batch", signature = (x, threads=None))]
    fn batch<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        threads: Option<i64>,
    ) -> PyResult<Batch<'py>> {
        let objective = self.objective()?;
        let width = objective.variables().len();
        let (designs, shape) = numbers(x, "X")?;
        if shape.len() != 2 || shape[1] != width {
            return Err(self.shape("X", &shape, &format!("(n, {width})"))?.into());
        }
        let (goal, known) = (Arc::clone(objective), self.known);
        let (columns, failed) = on_pool(py, &*pool(threads)?, move |monitor| {
            // The rows of a stopped batch are never used.
            let proceed = || !monitor.is_stopped();
            let row = |design: &[f64]| {
                if monitor.is_stopped() {
                    return Ok([f64::NAN; COUNT]);
                }
                catch_panic(|| {
                    let found = goal
                        .scene(design)
                        .and_then(|scene| goal.evaluate_while(&scene, f64::INFINITY, &proceed));
                    found.map(|found| numbers_of(&found, known)).map_err(Fault::from)
                })
            };
            Ok(in_columns(&designs, width, row))
        })?;
        let names = column_names(self.quantity().0).map(str::to_owned);
        let columns = table(py, names.into_iter().zip(columns))?;
        let failed = failed.into_iter().take(MAX_EXCEPTIONS);
        let failed = failed.map(|(i, fault)| (i, PyErr::from(*fault).into_value(py).into_any()));
        Ok((columns, failed.collect()))
    }

    /// The text of the same study with other numbers.
    #[pyo3(name = "_changed")]
    fn changed(&self, settings: Vec<(String, f64)>) -> PyResult<String> {
        Ok(json(&self.with(&settings)?)?)
    }

    /// The text of the same study with another design of its damper.
    #[pyo3(name = "_tuned")]
    fn tuned(&self, x: &Bound<'_, PyAny>) -> PyResult<String> {
        Ok(json(&self.at(Some(x))?.whole())?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let rebuilt = py.import("retune._problem")?.getattr("rebuilt")?;
        let core = slf.get();
        (rebuilt, (slf.get_type(), json(&core.study.whole())?, core.file.clone())).into_pyobject(py)
    }
}

impl Core {
    fn read(text: &str, file: Option<String>) -> Result<Self, Fault> {
        let name = file.as_deref().unwrap_or("problem");
        let study = from_text(text, name).map_err(|error| Fault::of_study(&error, text, file.is_some()))?;
        let objective = match &study.optimize {
            None => None,
            Some(_) => {
                let search = study.search().map_err(|rule| Fault::of_rule(&rule))?;
                let settings = study.solver.settings();
                let goal = study.goal();
                Some(Arc::new(DesignObjective::new(
                    study.scene,
                    search.damper,
                    search.variables,
                    goal,
                    settings,
                )))
            }
        };
        let is_single_run = |term: &Objective| {
            let at_once = term.omega.is_none() || term.response == Response::Steady;
            at_once && term.k1.is_none() && term.restitution.is_none() && term.ensemble.is_none()
        };
        let periods = study.window.window().to * study.scene.forcing.frequency.get() / TAU;
        let takes_long = periods > LONG && !study.objective().is_steady()
            || !study.objective().terms().iter().all(|(_, term)| is_single_run(term));
        let goal = study.goal();
        let limited = |measure| goal.limits.get(Limit::Of(measure)).is_some();
        // A stationary random motion has no largest stroke.
        let is_steady = goal.objective.is_steady() && !goal.objective.is_stationary();
        let known = Known {
            quantity: study.quantity(),
            stroke: limited(Measure::Stroke) || is_steady,
            force: limited(Measure::ContactForce),
        };
        Ok(Self { study, file, objective, takes_long, known })
    }

    fn variables(&self) -> &[Parameter] {
        self.objective.as_ref().map_or(&[], |objective| objective.variables())
    }

    fn objective(&self) -> Result<&Arc<DesignObjective>, Fault> {
        self.objective.as_ref().ok_or_else(|| Fault::of_rule(&Rule::NoOptimize))
    }

    /// Reads a design into `row`.
    fn design(&self, x: &Bound<'_, PyAny>, row: &mut [f64]) -> PyResult<()> {
        if plain_row(x, row) {
            return Ok(());
        }
        let (given, shape) = numbers(x, "x")?;
        if shape.len() != 1 || given.len() != row.len() {
            return Err(self.shape("x", &shape, &format!("({},)", row.len()))?.into());
        }
        row.copy_from_slice(&given);
        Ok(())
    }

    fn shape(&self, name: &str, shape: &[usize], wanted: &str) -> PyResult<Fault> {
        let shape: Vec<String> = shape.iter().map(ToString::to_string).collect();
        let (shape, names) = (shape.join(", "), self.names().join(", "));
        Ok(Fault::study(
            format!(
                "{name}: the shape ({shape}) is not allowed here: give {wanted}, one number for each of {names}"
            ),
            Given::Nothing,
        ))
    }

    /// Evaluates a design: on this thread, or, if that may take long, on the pool, so that Ctrl-C ends it.
    fn evaluate(
        &self,
        py: Python<'_>,
        objective: &Arc<DesignObjective>,
        design: &[f64],
    ) -> PyResult<Evaluation> {
        if !self.takes_long {
            let here = || Ok(objective.evaluate(&objective.scene(design)?, f64::INFINITY)?);
            return Ok(py.detach(|| catch_panic(here))?);
        }
        let (objective, design) = (Arc::clone(objective), design.to_vec());
        on_pool(py, &*pool(None)?, move |monitor| {
            let proceed = || !monitor.is_stopped();
            Ok(objective.evaluate_while(&objective.scene(&design)?, f64::INFINITY, &proceed)?)
        })
    }

    /// The study with other numbers.
    pub(crate) fn with(&self, settings: &[(String, f64)]) -> Result<Study, Fault> {
        let setting = |(name, value): &(String, f64)| format!("{name}={value}").parse::<Setting>();
        let settings = settings.iter().map(setting).collect::<Result<Vec<_>, _>>()?;
        Ok(self.study.with(&settings)?)
    }

    /// The study with the damper of a design, if one is given.
    pub(crate) fn at(&self, x: Option<&Bound<'_, PyAny>>) -> PyResult<Study> {
        let Some(x) = x else { return Ok(self.study.clone()) };
        let objective = self.objective()?;
        let mut row = vec![0.0; objective.variables().len()];
        self.design(x, &mut row)?;
        let scene = objective.scene(&row).map_err(Fault::from)?;
        Ok(Study { scene, ..self.study.clone() })
    }
}

/// A value as JSON.
pub(crate) fn json(value: &impl serde::Serialize) -> Result<String, Fault> {
    serde_json::to_string(value).map_err(|error| Fault::Other(error.to_string()))
}
