//! The request for a job beside its study.

use crate::Error;
use retune_store::{Begin, Order};
use retune_study::{Study, found_in, name_from};
use std::path::{Path, PathBuf};

/// The options of a job.
#[derive(Clone, Debug, Default)]
#[expect(missing_docs, reason = "their names say it")]
pub struct Request {
    pub study: PathBuf,
    /// Directory of the results; by default that of the job.
    pub out: Option<PathBuf>,
    /// Number of threads; by default all cores. The results are the same for any number.
    pub threads: Option<u16>,
    pub begin: Begin,
    pub replace: bool,
}

impl Request {
    /// A request for a study file, with the job's directory of results and all cores.
    pub fn new(study: &Path) -> Self {
        Self { study: study.to_owned(), ..Self::default() }
    }

    /// The order to open a directory of results for `command`.
    pub fn order(&self, command: &'static str) -> Order {
        Order { command, study: self.study.clone(), begin: self.begin, replace: self.replace }
    }

    /// The directory of the results of one study: by default `results/` and its name.
    pub fn out_of(&self, study: &Study) -> PathBuf {
        self.out.clone().unwrap_or_else(|| Path::new("results").join(study.name()))
    }

    /// The directory of the results of a study of several dampers: by default `results/` and the name of its file.
    pub fn out_of_file(&self) -> PathBuf {
        let stem = self.study.file_stem().unwrap_or_default();
        self.out.clone().unwrap_or_else(|| Path::new("results").join(name_from(&stem.to_string_lossy())))
    }

    /// The same with the directory of results along a parameter: by default `results/<kind>-<study>-<rest>`, of a design that a search found
    /// `results/<kind>-<study>-tuned-<rest>`.
    pub fn placed(&self, kind: &str, study: &Study, rest: &str) -> Result<Self, Error> {
        let tuned = if found_in(&self.study)?.is_some() { "-tuned" } else { "" };
        let out = || Path::new("results").join(format!("{kind}-{}{tuned}-{rest}", study.name()));
        Ok(Self { out: Some(self.out.clone().unwrap_or_else(out)), ..self.clone() })
    }

    /// Runs `work` on the threads of the request.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> Result<T, Error> + Send) -> Result<T, Error> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0).into()).build()?;
        pool.install(work)
    }
}

/// A message with the directory of the results and their list.
pub fn where_results_are(out: &Path) -> Result<String, Error> {
    let refuse = |source| retune_store::Error::Output { path: PathBuf::from(out), source };
    let entries = std::fs::read_dir(out).map_err(refuse)?;
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    Ok(format!("results in {}: {}", out.display(), names.join(" ")))
}
