//! The steps common to all jobs: open the directory, do the work, write the input and the manifest, publish and report.

use crate::artefact::Kind;
use crate::resolved::Resolved;
use crate::{Error, Observer, resolved};
use retune_store::plain::names;
use retune_store::{Begin, Directory, Extent, Identity, Order, manifest};
use retune_study::{Solver, Study, found_in, is_built_in, name_from};
use std::path::{Path, PathBuf};

pub struct Job {
    pub kind: &'static Kind,
    pub out: PathBuf,
    pub order: Order,
    /// The file that holds the complete input, and its text.
    pub input: (&'static str, String),
    /// The file without which its results are not complete.
    pub answer: String,
    pub solvers: Vec<Solver>,
    /// Prefix of the names of its files, if it makes only part of the results and keeps the others.
    pub only: Option<String>,
}

pub struct Made<T> {
    pub answer: T,
    /// The last lines on screen, if any.
    pub report: String,
    /// The results of its searches. They can be resumed until the whole job is finished.
    pub parts: Vec<Directory>,
}

/// The end of a job.
#[derive(Debug)]
pub enum Done<T> {
    /// The result of the job.
    Made(T),
    /// The job to resume was finished already.
    FinishedBefore,
}

impl Job {
    /// The job of a kind on one study.
    pub fn of_study(kind: &'static Kind, study: &Study, out: &Path, order: &Order) -> Result<Self, Error> {
        let input = (resolved::ONE, resolved::study_text(study)?);
        let (out, order, answer) = (out.to_owned(), order.clone(), kind.answer.to_owned());
        Ok(Self { kind, out, order, input, answer, solvers: vec![study.solver], only: None })
    }

    /// The job of a kind on several studies, each with the name of its damper, and a plan.
    pub fn of_studies<'a>(
        kind: &'static Kind,
        request: &Request,
        plan: serde_json::Value,
        studies: impl Iterator<Item = (&'a str, &'a Study)> + Clone,
    ) -> Result<Self, Error> {
        let solvers = studies.clone().map(|(_, study)| study.solver).collect();
        let input = (resolved::SEVERAL, Resolved::new(plan, studies).text()?);
        let (out, order) = (request.out_of_file(), request.order(kind.command));
        Ok(Self { kind, out, order, input, answer: kind.answer.to_owned(), solvers, only: None })
    }

    pub fn identity(&self) -> Identity {
        Identity::of(&self.input.1)
    }

    /// Does the work and publishes its results. The work can be resumed until the directory is finished.
    pub fn make<T>(
        &self,
        watch: &dyn Observer,
        work: impl FnOnce(&mut Directory) -> Result<T, Error>,
    ) -> Result<(T, Directory), Error> {
        let (kind, only, input) = (self.kind, self.only.clone(), self.input.0);
        let is_ours = move |name: &str| {
            let shared = [input, manifest::NAME].contains(&name);
            let wanted = |only: &String| {
                name.strip_prefix(only.as_str()).is_some_and(|rest| rest.starts_with(['.', '-']))
            };
            shared || kind.makes(name) && only.as_ref().is_none_or(wanted)
        };
        let extent = if self.only.is_none() { Extent::Whole } else { Extent::Share };
        let mut results = open(&self.out, &self.order, &self.identity(), extent, is_ours, watch)?;
        let made = work(&mut results)?;
        results.write(self.input.0, &self.input.1)?;
        results.write_manifest(&self.solvers)?;
        results.publish()?;
        Ok((made, results))
    }

    /// Runs the whole job on the threads of its request and reports its end to the observer; `work` must not report it.
    pub fn run<T: Send>(
        &self,
        request: &Request,
        watch: &dyn Observer,
        work: impl FnOnce(&mut Directory) -> Result<Made<T>, Error> + Send,
    ) -> Result<Done<T>, Error> {
        if is_built_in(&request.study) {
            let study = request.study.display();
            watch.result(&format!(
                "{study} is not here: the plan of this name that is built into Retune is used"
            ))?;
        }
        let resumed = self.order.begin == Begin::Resume;
        if resumed && Directory::is_finished(&self.out, &self.identity(), &self.answer) {
            Directory::tidy(&self.out);
            let place = where_results_are(&self.out)?;
            watch.result(&format!("finished already: nothing to resume\n{place}"))?;
            watch.answered(&self.out.join(&self.answer))?;
            return Ok(Done::FinishedBefore);
        }
        let (Made { answer, report, parts }, results) = request.on_threads(|| self.make(watch, work))?;
        parts.into_iter().try_for_each(Directory::finish)?;
        results.finish()?;
        if !report.is_empty() {
            watch.result(&report)?;
        }
        watch.result(&where_results_are(&self.out)?)?;
        watch.answered(&self.out.join(&self.answer))?;
        Ok(Done::Made(answer))
    }
}

/// Opens a directory of results and reports it to the observer.
pub fn open(
    path: &Path,
    order: &Order,
    identity: &Identity,
    extent: Extent,
    is_ours: impl Fn(&str) -> bool + Send + Sync + 'static,
    watch: &dyn Observer,
) -> Result<Directory, Error> {
    let directory = Directory::open(path, order, identity, extent, is_ours)?;
    if let Some(warning) = directory.warning() {
        watch.warn(warning);
    }
    watch.resumable();
    Ok(directory)
}

/// The options of a job.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// The study file.
    pub study: PathBuf,
    /// Directory of the results; by default that of the kind of job.
    pub out: Option<PathBuf>,
    /// Number of threads; by default all cores. The results are the same for any number.
    pub threads: Option<u16>,
    /// Whether to continue earlier work.
    pub begin: Begin,
    /// Whether to replace files that Retune did not make, or that belong to another study.
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

    /// The request with its directory for results along a parameter: by default `results/<kind>-<study>-<rest>`, for a design that a search
    /// found `results/<kind>-<study>-tuned-<rest>`.
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
    let mut names = names(out).map_err(refuse)?;
    names.retain(|name| !name.starts_with('.'));
    Ok(format!("results in {}: {}", out.display(), names.join(" ")))
}
