//! A study as a function of a design.

use crate::arrays::{numbers, plain_row, table};
use crate::errors::{Fault, Given};
use crate::pool::pool;
use crate::watch::{caught, watched};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rayon::prelude::*;
use retune_optim::{Evaluation, Limit, Objective, PeakEnergy, Response, Variable};
use retune_study::{Rule, Setting, Study, read::from_text};

/// A study, checked, with its objective: what `retune.Problem` is made of.
#[pyclass(subclass, frozen, module = "retune._core")]
pub struct Core {
    pub(crate) study: Study,
    /// What its results are said to be made of: the file that it was read from, if any.
    pub(crate) file: Option<String>,
    objective: Option<PeakEnergy>,
    /// Whether one evaluation makes runs side by side.
    is_parallel: bool,
    /// Whether stroke and force are known: a limit asks for them, or the stroke is that of a steady motion.
    knows: [bool; 2],
}

/// The columns of a batch, and the rows without a value, each with its exception.
type Batch<'py> = (Bound<'py, PyDict>, Vec<(usize, Py<PyAny>)>);

/// The number of columns of a batch.
const BATCH: usize = 6;
/// Rows without a value whose exceptions are kept.
const TOLD: usize = 100;

#[pymethods]
impl Core {
    /// From the text of a study and the file that it stands for.
    #[new]
    #[pyo3(signature = (text, file=None))]
    fn new(text: &str, file: Option<String>) -> PyResult<Self> {
        Ok(caught(|| Self::read(text, file))?)
    }

    /// The study with every default written out, as JSON.
    #[pyo3(name = "_text")]
    fn text(&self) -> PyResult<String> {
        Ok(json(&self.study.resolved())?)
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
        let bounds = |variable: &Variable| optimize.bounds.get(*variable).unwrap_or((0.0, None));
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
        let mut row = [0.0; Variable::ALL.len()];
        let row = &mut row[..objective.variables().len()];
        self.design(x, row)?;
        let row = &*row;
        Ok(py.detach(|| caught(|| Ok(self.found(objective, row)?.value)))?)
    }

    /// Everything that an evaluation finds, by its name.
    #[pyo3(name = "_evaluation")]
    fn evaluation<'py>(&self, py: Python<'py>, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let objective = self.objective()?;
        let mut row = vec![0.0; objective.variables().len()];
        self.design(x, &mut row)?;
        let found = py.detach(|| caught(|| self.found(objective, &row)))?;
        let all = PyDict::new(py);
        for (name, value) in self.columns().into_iter().zip(self.numbers(&found)) {
            all.set_item(name, value)?;
        }
        all.set_item("runs", found.runs)?;
        all.set_item("unsettled", found.unsettled)?;
        Ok(all)
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
        let found = |design: &[f64]| self.evaluated(objective, design).map(|found| self.numbers(&found));
        let evaluate = |design: &[f64]| match caught(|| found(design)) {
            Ok(numbers) => (numbers, None),
            Err(fault) => {
                let mut none = [f64::NAN; BATCH];
                none[0] = f64::INFINITY;
                (none, Some(Box::new(fault)))
            }
        };
        let rows = watched(py, None, |watch| {
            // Nobody asks for the rows of a batch that was stopped.
            let row = |design: &[f64]| {
                if watch.is_stopped() { ([f64::NAN; BATCH], None) } else { evaluate(design) }
            };
            let rows = designs.par_chunks(width).map(row);
            Ok(pool(threads)?.install(|| rows.collect::<Vec<_>>()))
        })?;
        let column = |i: usize| rows.iter().map(|(numbers, _)| numbers[i]).collect();
        let columns = self.columns().into_iter().enumerate().map(|(i, name)| (name.to_owned(), column(i)));
        let columns = table(py, columns)?;
        let failed = rows.into_iter().enumerate().filter_map(|(i, (_, fault))| Some((i, *fault?))).take(TOLD);
        let failed = failed.map(|(i, fault)| (i, PyErr::from(fault).into_value(py).into_any()));
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
        Ok(json(&self.at(Some(x))?)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let rebuilt = py.import("retune._problem")?.getattr("rebuilt")?;
        let core = slf.get();
        (rebuilt, (slf.get_type(), json(&core.study)?, core.file.clone())).into_pyobject(py)
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
                Some(PeakEnergy::new(study.scene, search.damper, search.variables, study.goal(), settings))
            }
        };
        let is_one = |term: &Objective| {
            let at_once = term.omega.is_none() || term.response == Response::Steady;
            at_once && term.k1.is_none() && term.ensemble.is_none()
        };
        let is_parallel = !study.objective().terms().iter().all(|(_, term)| is_one(term));
        let goal = study.goal();
        let walls = goal.limits.walls_from().is_some();
        let knows = [walls || goal.objective.is_steady(), walls];
        Ok(Self { study, file, objective, is_parallel, knows })
    }

    fn variables(&self) -> &[Variable] {
        self.objective.as_ref().map_or(&[], PeakEnergy::variables)
    }

    fn objective(&self) -> Result<&PeakEnergy, Fault> {
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

    /// Evaluates a design on the pool if it makes runs side by side, else here.
    fn found(&self, objective: &PeakEnergy, design: &[f64]) -> Result<Evaluation, Fault> {
        if self.is_parallel {
            pool(None)?.install(|| self.evaluated(objective, design))
        } else {
            self.evaluated(objective, design)
        }
    }

    fn evaluated(&self, objective: &PeakEnergy, design: &[f64]) -> Result<Evaluation, Fault> {
        Ok(objective.evaluate(&objective.scene(design)?, f64::INFINITY)?)
    }

    /// The names of [`Self::numbers`].
    fn columns(&self) -> [&'static str; BATCH] {
        ["value", self.quantity().0, "stroke", "force", "violation", "omega_worst"]
    }

    /// What an evaluation found; stroke and force are NaN where no limit asks for them.
    fn numbers(&self, found: &Evaluation) -> [f64; BATCH] {
        let known = |limit, known| if known { found.reached.get(limit) } else { f64::NAN };
        let [stroke, force] = self.knows;
        let [stroke, force] = [known(Limit::Stroke, stroke), known(Limit::Force, force)];
        let omega = found.worst.scene.forcing.frequency.get();
        // An empty sum of violations is -0.
        [found.value, found.energy, stroke, force, found.violation + 0.0, omega]
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
