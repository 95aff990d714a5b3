//! The errors of jobs.

use retune_optim::{Failures, Unusable};
use retune_solver::SolverError;
use retune_study::{Rule, SettingError, Study, StudyError, counted};
use std::path::PathBuf;
use thiserror::Error;

/// Why a job ends without its result.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "its words say what each is and holds")]
pub enum Error {
    #[error(transparent)]
    Store(#[from] retune_store::Error),
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error("command line: {0}")]
    Setting(#[from] SettingError),
    #[error("study {name}: {rule}")]
    Rule { name: String, rule: Rule },
    #[error("command line: {option}: {problem}")]
    Argument { option: &'static str, problem: String },
    #[error("{place}: {problem}")]
    Requirement { place: String, problem: String },
    #[error(
        "--interval: {value} s is not allowed here: give a number above 0 that makes at most {most} rows"
    )]
    Interval { value: f64, most: u32 },
    #[error("{}: {problem}", path.display())]
    Part { path: PathBuf, problem: String },
    #[error(
        "{}: no part holds points {points} of {len}: make what is missing with `{command} --shard i/N`{}",
        place.display(),
        shards.as_ref().map(|shards| format!(", i/N = {shards}")).unwrap_or_default()
    )]
    MissingParts { points: String, len: usize, shards: Option<String>, command: String, place: PathBuf },
    #[error("{}: {problem}", path.display())]
    NotHeld { path: PathBuf, problem: String },
    #[error("{}: cannot be checked: {problem}", path.display())]
    NotChecked { path: PathBuf, problem: String },
    #[error("study {name}: not proven: {why}")]
    NotProven { name: String, why: String },
    #[error(
        "study {name}: the limits are not kept: {words}; loosen a limit, widen a bound, or look at more designs"
    )]
    Infeasible { name: String, words: String },
    #[error("standard input: {failed} of {} had no value", counted(*lines, "line"))]
    Lines { failed: u64, lines: u64 },
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error("the run failed: {0}")]
    Run(#[from] SolverError),
    #[error("the run failed: {0}")]
    Motion(#[from] retune_dynamics::Error),
    #[error("a design that was found cannot be run: {0}")]
    Unusable(#[from] Unusable),
    #[error("no point of the grid could be computed{}", example(.0))]
    NoStart(Failures),
    #[error("the global search failed: {source}{}", example(.failures))]
    Global { source: retune_optim::GlobalError, failures: Failures },
    #[error("the refinement failed: {source}{}", example(.failures))]
    Search { source: retune_optim::Error, failures: Failures },
    #[error("cannot draw {name}: {problem}")]
    Figure { name: String, problem: String },
}

impl Error {
    /// The error of a study that breaks a rule.
    pub fn rule(study: &Study) -> impl Fn(Rule) -> Self + Copy + '_ {
        |rule| Self::Rule { name: study.name().to_owned(), rule }
    }
}

fn example(failures: &Failures) -> String {
    match failures.example.as_deref() {
        Some((design, reason)) => format!(" ({} failed; at {design:?}: {reason})", failures.count),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests;
impl From<retune_model::OutOfRange> for Error {
    fn from(error: retune_model::OutOfRange) -> Self {
        Self::Motion(error.into())
    }
}
