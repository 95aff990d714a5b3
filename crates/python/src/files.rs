//! Jobs on a study file whose results are files, called as by the command line.

use crate::errors::{Fault, Given};
use crate::jobs;
use crate::monitor::{Monitor, monitored};
use crate::problem::json;
use pyo3::prelude::*;
use retune_jobs::answer::as_json;
use retune_jobs::design::Specification;
use retune_jobs::sweep::Options;
use retune_jobs::sweep::Points;
use retune_jobs::{Error, Request, certify, design, sweep, table2, tune};
use retune_jobs::{fronts, losses, retention};
use retune_model::Parameter;
use retune_study::Setting;
use serde::Deserialize;
use std::path::PathBuf;
use std::str::FromStr;

/// The arguments of a job, in addition to its study file and [`jobs::JobOptions`].
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Job {
    Certify,
    Design(Box<Specification>),
    Fronts,
    Losses,
    Merge { parts: Vec<PathBuf> },
    Reproduce { only: Option<String> },
    Share(String),
    Sweep(Swept),
    Table2,
    Retention(Vec<f64>),
}

/// The arguments of a sweep, as typed.
#[derive(Deserialize)]
struct Swept {
    over: String,
    from: String,
    to: String,
    points: usize,
    log: bool,
    quantities: Vec<String>,
    objective: bool,
    shard: Option<String>,
    merge: bool,
}

/// Does a job on a study file; returns its answer as JSON: a certificate or a table, else the directory of the results.
///
/// # Errors
/// Those of the job, or Ctrl-C.
#[pyfunction]
pub fn job(
    py: Python<'_>,
    study: PathBuf,
    job: &str,
    asked: jobs::JobOptions,
    tell: Option<Py<PyAny>>,
) -> PyResult<String> {
    let job: Job = serde_json::from_str(job).map_err(|error| Fault::Other(error.to_string()))?;
    let request = asked.request(study)?;
    monitored(py, tell.as_ref(), |monitor| done(job, &request, monitor))
}

fn done(job: Job, request: &Request, monitor: &Monitor) -> Result<String, Fault> {
    let mut out = request.out_of_file();
    match job {
        Job::Certify => return json(&certify::certify_file(request, monitor)?),
        Job::Design(specification) => {
            drop(design::design(&specification.within("design").requirements()?, request, monitor)?);
        }
        Job::Fronts => {
            fronts::fronts(request, monitor)?;
        }
        Job::Losses => drop(losses::losses(request, monitor)?),
        Job::Merge { parts } => {
            tune::merge::merge(request, &parts, monitor)?;
            out = out_of_one(request)?;
        }
        Job::Reproduce { only } => {
            retune_jobs::paper::reproduce(request, only.as_deref(), monitor)?;
        }
        Job::Share(shard) => {
            tune::merge::share(request, read("shard", &shard)?, monitor)?;
            out = out_of_one(request)?;
        }
        Job::Sweep(swept) => return swept.made(request, monitor),
        Job::Table2 => drop(table2::table2(request, monitor)?),
        Job::Retention(k1) => {
            let settings: Vec<Setting> =
                k1.into_iter().map(|value| Setting::new(Parameter::K1, value)).collect();
            retention::retention(request, &settings, monitor)?;
        }
    }
    json(&out)
}

/// The directory of the results of a job on one study.
fn out_of_one(request: &Request) -> Result<PathBuf, Error> {
    Ok(request.out_of(&retune_study::read(&request.study)?))
}

impl Swept {
    /// The table in the form of `sweep.json`; null for a share.
    fn made(self, request: &Request, monitor: &Monitor) -> Result<String, Fault> {
        let Self { over, from, to, points, log, quantities, objective, shard, merge } = self;
        let over = read("over", &over)?;
        let quantities =
            quantities.iter().map(|name| read("quantities", name)).collect::<Result<Vec<_>, _>>()?;
        let shard = shard.map(|shard| read("shard", &shard)).transpose()?;
        let options = Options { over, from, to, unit: None, points, log, quantities, objective };
        sweep::sweep(request, &options, &Points::of(shard, merge), monitor)?;
        Ok(monitor.answer().map_or(Ok("null".to_owned()), |file| as_json(&file))?)
    }
}

/// An argument that is a word.
fn read<T: FromStr<Err = String>>(name: &str, text: &str) -> Result<T, Fault> {
    text.parse().map_err(|words| Fault::study(format!("{name}: {words}"), Given::Json(text.into())))
}
