//! Runs of a study, and sweeps.

use crate::arrays::{numbers, table};
use crate::errors::{Fault, Given};
use crate::monitor::on_pool;
use crate::pool::pool;
use crate::problem::{Core, json};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use retune_jobs::sweep::{Plan, Sweep};
use retune_model::{Parameter, Side};
use retune_optim::Scale;
use retune_solver::{Moment, Rows, Sample, trajectory};
use retune_study::Study;

/// Most rows of a motion that is kept in memory.
const MOST_ROWS: f64 = 1e7;
/// The columns of a motion.
const COLUMNS: [&str; 9] = ["t", "x1", "v1", "x2", "v2", "E1", "E2", "FconL", "FconR"];

/// The results of a run: its rows, its events, the name of each event and the wall of its contact, and its summary as JSON.
type Ran<'py> = (Bound<'py, PyDict>, Bound<'py, PyDict>, Vec<(&'static str, &'static str)>, String);
/// The columns of a sweep, and the unit of each.
type Swept<'py> = (Bound<'py, PyDict>, Vec<(String, String)>);

/// One run: the motion at equal intervals, its events, and its largest values.
///
/// # Errors
/// A number out of its range, or a run that cannot be finished.
#[pyfunction]
pub fn run<'py>(
    py: Python<'py>,
    core: &Core,
    x: Option<&Bound<'py, PyAny>>,
    interval: f64,
    settings: Vec<(String, f64)>,
) -> PyResult<Ran<'py>> {
    let study = changed(&core.at(x)?, &settings)?;
    let (summary, samples) = on_pool(py, &*pool(None)?, move |_| moved(&study, interval))?;
    let (grid, events): (Vec<_>, Vec<_>) =
        samples.into_iter().partition(|sample| sample.moment == Moment::Grid);
    let wall = |sample: &Sample| match sample.wall {
        Some(Side::Primary) => "structure",
        Some(Side::Obstacle) => "obstacle",
        None => "",
    };
    let names = events.iter().map(|sample| (sample.moment.name(), wall(sample))).collect();
    Ok((columns(py, &grid)?, columns(py, &events)?, names, summary))
}

/// A run, or the objective, at each value of a parameter: the columns and their units.
///
/// # Errors
/// A value out of its range, or a parameter that cannot be swept.
#[pyfunction]
#[pyo3(signature = (core, x, over, values, objective=false, threads=None))]
pub fn sweep<'py>(
    py: Python<'py>,
    core: &Core,
    x: Option<&Bound<'py, PyAny>>,
    over: &str,
    values: &Bound<'py, PyAny>,
    objective: bool,
    threads: Option<i64>,
) -> PyResult<Swept<'py>> {
    let (values, shape) = numbers(values, over)?;
    if shape.len() != 1 || values.is_empty() {
        let message =
            format!("{over}: the shape {shape:?} is not allowed here: give one value or more, in one row");
        return Err(Fault::study(message, Given::Nothing).into());
    }
    let sweep = swept(core.at(x)?, over, &values, objective)?;
    let columns = sweep.columns();
    let rows = on_pool(py, &*pool(threads)?, move |monitor| {
        let row =
            |value: &f64| (!monitor.is_stopped()).then(|| sweep.row(*value, &sweep.numbers_at(*value).0));
        let rows: Option<Vec<_>> = values.par_iter().map(row).collect();
        Ok(rows.unwrap_or_default())
    })?;
    let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
    let column = |i: usize| rows.iter().map(|row| finite(row[i])).collect();
    let all = table(py, columns.iter().enumerate().map(|(i, one)| (one.name.clone(), column(i))))?;
    Ok((all, columns.into_iter().map(|column| (column.name, column.unit.into_owned())).collect()))
}

/// A study with other numbers.
fn changed(study: &Study, settings: &[(String, f64)]) -> Result<Study, Fault> {
    let setting = |(name, value): &(String, f64)| format!("{name}={value}").parse();
    let settings = settings.iter().map(setting).collect::<Result<Vec<_>, _>>()?;
    Ok(study.with(&settings)?)
}

/// The summary of a run, and its motion.
fn moved(study: &Study, interval: f64) -> Result<(String, Vec<Sample>), Fault> {
    let window = study.window.window();
    if !(interval > 0.0 && (window.to - window.from) / interval <= MOST_ROWS) {
        let allowed = "a number above 0 that makes at most ten million rows, s";
        return Err(Fault::argument("interval", interval, allowed));
    }
    let summary = json(&retune_jobs::simulate::simulate(study, None)?)?;
    let mut samples = Vec::new();
    let mut keep = |sample: &Sample| samples.push(*sample);
    trajectory(&study.scene, window, &study.solver.settings(), Rows { interval, events: true }, &mut keep)?;
    Ok((summary, samples))
}

fn columns<'py>(py: Python<'py>, samples: &[Sample]) -> PyResult<Bound<'py, PyDict>> {
    let values = |sample: &Sample| {
        let Sample { t, state: [x1, v1, x2, v2], e1, e2, forces: [left, right], .. } = *sample;
        [t, x1, v1, x2, v2, e1, e2, left, right]
    };
    let column = |i: usize| samples.iter().map(|sample| values(sample)[i]).collect();
    table(py, COLUMNS.iter().enumerate().map(|(i, name)| ((*name).to_owned(), column(i))))
}

/// A sweep through any values of a parameter.
fn swept(study: Study, over: &str, values: &[f64], objective: bool) -> Result<Sweep, Fault> {
    let refuse = |message: String| Fault::study(message, Given::Nothing);
    let parameter: Parameter = over.parse().map_err(|words| refuse(format!("{over}: {words}")))?;
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(Fault::argument(over, *value, "finite numbers"));
    }
    let [from, to] = [f64::min, f64::max].map(|end| values.iter().copied().fold(values[0], end));
    // Only the ends are used, for the checks; they must differ in a sweep.
    let to = if from == to { 2.0 * from.abs() + 1.0 } else { to };
    let plan = Plan {
        over: parameter,
        from,
        to,
        points: 2,
        scale: Scale::Linear,
        quantities: Vec::new(),
        objective,
    };
    Ok(Sweep::new(plan, study)?)
}
