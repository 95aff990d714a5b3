//! Work of seconds to hours: searches, certificates, verification. The files are identical to those of the command line.

use crate::errors::{Fault, Given};
use crate::monitor::{catch_panic, monitored, on_pool};
use crate::pool::{check, pool};
use crate::problem::{Core, json};
use pyo3::prelude::*;
use retune_jobs::Done;
use retune_jobs::design::Specification;
use retune_jobs::{Request, tune, verify as verification};
use retune_model::{Of, Parameter, Positive, Surfaces, unit};
use retune_store::Begin;
use retune_study::Setting;
use std::path::PathBuf;

/// What a job is asked beside its study: the directory of its results, whether to go on or to begin anew, whether to replace other results,
/// and the number of threads.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct JobOptions {
    out: Option<PathBuf>,
    resume: bool,
    restart: bool,
    replace: bool,
    threads: Option<i64>,
}

impl JobOptions {
    pub(crate) fn request(self, study: PathBuf) -> Result<Request, Fault> {
        let Self { out, resume, restart, replace, threads } = self;
        let threads = threads.map(check).transpose()?;
        let begin = match (resume, restart) {
            (true, _) => Begin::Resume,
            (false, true) => Begin::Restart,
            (false, false) => Begin::New,
        };
        Ok(Request { study, out, threads, begin, replace })
    }
}

/// The text of a study file, or of the study behind results with the design that was found.
///
/// # Errors
/// `retune.StudyError`.
#[pyfunction]
pub fn study_text(path: PathBuf) -> PyResult<String> {
    let read = || {
        let study = retune_study::read(&path).map_err(|error| {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            Fault::of_study(&error, &text, true)
        })?;
        json(&study.whole())
    };
    Ok(catch_panic(read)?)
}

/// Makes the whole search of a problem; returns the directory of its results.
///
/// # Errors
/// Those of the job, or Ctrl-C.
#[pyfunction]
pub fn optimize(
    py: Python<'_>,
    core: &Core,
    asked: JobOptions,
    tell: Option<Py<PyAny>>,
) -> PyResult<PathBuf> {
    let study = &core.study;
    let mut request = asked.request(PathBuf::new())?;
    let out = request.out_of(study);
    // The origin of a problem without a file is the study written with its results.
    request.study = core.file.as_ref().map_or_else(|| out.join("study.json"), PathBuf::from);
    monitored(py, tell.as_ref(), |monitor| {
        tune::tune_study(study, &request, monitor)?;
        Ok(())
    })?;
    Ok(out)
}

/// The certificate of a design, as JSON.
///
/// # Errors
/// The design has no value.
#[pyfunction]
#[pyo3(signature = (core, x, threads=None))]
pub fn certify(
    py: Python<'_>,
    core: &Core,
    x: Option<&Bound<'_, PyAny>>,
    threads: Option<i64>,
) -> PyResult<String> {
    let threads = threads.map(check).transpose()?;
    let study = core.at(x)?;
    let request = Request { threads, ..Request::default() };
    let certificate = move || request.on_threads(|| retune_jobs::certify::certify(&study));
    on_pool(py, &*pool(Some(1))?, move |_| json(&certificate()?))
}

/// Checks results; what is found goes to `tell`.
///
/// # Errors
/// They do not hold, or cannot be checked.
#[pyfunction]
pub fn verify(
    py: Python<'_>,
    path: PathBuf,
    sample: usize,
    within: f64,
    tell: Option<Py<PyAny>>,
) -> PyResult<()> {
    monitored(py, tell.as_ref(), |monitor| Ok(verification::verify(&path, sample, within, monitor)?))
}

/// The study with which `design` tunes a damper of a kind, "TMD" or "SSVI NES", for a structure and what is wished: from JSON to JSON.
///
/// # Errors
/// A wish cannot be fulfilled.
#[pyfunction]
pub fn design_study(requirements: &str, kind: &str) -> PyResult<String> {
    let made = || {
        let specification: Specification =
            serde_json::from_str(requirements).map_err(|error| Fault::Other(error.to_string()))?;
        let requirements = specification.within("damper").requirements()?;
        json(&if kind == "TMD" { requirements.tmd()? } else { requirements.ssvi()? })
    };
    Ok(catch_panic(made)?)
}

/// How every periodic motion of a study, or of the design behind results, is looked for: the parameter, its range, the values at which
/// runs are started, and their starts.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Along {
    over: String,
    from: Option<String>,
    to: Option<String>,
    samples: usize,
    starts: usize,
    apart: usize,
    fine: usize,
}

/// Follows every periodic motion along a parameter; returns the answer as JSON.
///
/// # Errors
/// Those of the job, or Ctrl-C.
#[pyfunction]
pub fn branches(
    py: Python<'_>,
    study: PathBuf,
    along: Along,
    asked: JobOptions,
    tell: Option<Py<PyAny>>,
) -> PyResult<String> {
    let request = asked.request(study)?;
    let Along { over, from, to, samples, starts, apart, fine } = along;
    let over = over.parse().map_err(Fault::Other)?;
    let asked = retune_jobs::branches::Options {
        over,
        from,
        to,
        samples,
        starts,
        apart,
        fine,
        ..retune_jobs::branches::Options::default()
    };
    monitored(py, tell.as_ref(), |monitor| {
        match retune_jobs::branches::branches(&request, &asked, monitor)? {
            Done::Made(found) => json(&retune_jobs::branches::summary(&found)),
            Done::FinishedBefore => {
                Err(Fault::Other("these results are finished: there is nothing to resume".to_owned()))
            }
        }
    })
}

/// Proves the periodic motion of a study, or of the design in a directory of results; the theorem as JSON.
#[pyfunction]
pub fn prove(
    py: Python<'_>,
    study: PathBuf,
    omega: Option<f64>,
    tell: Option<Py<PyAny>>,
) -> PyResult<String> {
    let omega = omega.map(|omega| Setting::new(Parameter::Omega, omega));
    let guess = retune_jobs::prove::Guess { omega, ..Default::default() };
    monitored(py, tell.as_ref(), |_| json(&retune_jobs::prove::prove(&study, &guess)?))
}

/// A number of a name of the catalogue as it was typed, with its unit or without, in the SI unit.
///
/// # Errors
/// `ValueError`: what to give.
#[pyfunction]
pub fn typed(name: &str, text: &str) -> PyResult<f64> {
    retune_study::typed(name, text).map_err(pyo3::exceptions::PyValueError::new_err)
}

/// The catalogue of parameters: the symbol, the SI unit and the words of each.
#[pyfunction]
pub fn parameters() -> Vec<(&'static str, &'static str, &'static str)> {
    Parameter::ALL.map(|one| (one.symbol(), one.unit(), one.words())).to_vec()
}

/// The symbols of the sizes of harmonic forcings, by which a study has them.
#[pyfunction]
pub fn amplitudes() -> Vec<&'static str> {
    Parameter::AMPLITUDES.map(Parameter::symbol).to_vec()
}

/// How many SI units a unit of what is given in time is; the SI unit if none is named.
#[pyfunction]
#[pyo3(signature = (of, unit = None))]
pub fn history_unit(of: &str, unit: Option<&str>) -> Result<f64, Fault> {
    let known: Of = serde_json::from_value(of.into())
        .map_err(|error| Fault::study(format!("of: {error}"), Given::Json(of.into())))?;
    let units = known.units();
    let Some(given) = unit else { return Ok(units[0].1) };
    let refused = || {
        let all: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
        let message = format!("unit: \"{given}\" is not allowed here: give one of {}", all.join(", "));
        Fault::study(message, Given::Json(given.into()))
    };
    Ok(unit::named(given, units).ok_or_else(refused)?.1)
}

/// The walls of a damper of so many kg for which none are given, as JSON.
#[pyfunction]
pub fn contact(mass: f64) -> PyResult<String> {
    let contact = Positive::new(mass).and_then(Surfaces::for_mass);
    let contact = contact.map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    Ok(json(&contact)?)
}
