//! The errors of jobs.

use retune_optim::{Failures, Unusable};
use retune_solver::SolverError;
use retune_study::{Rule, SettingError, Study, StudyError, counted};
use std::path::PathBuf;
use thiserror::Error;

/// Why a job ends without its result.
#[derive(Debug, Error)]
pub enum Error {
    /// Results cannot be read, made or replaced.
    #[error(transparent)]
    Store(#[from] retune_store::Error),
    /// A study file is wrong.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A number given on the command line is wrong.
    #[error("command line: {0}")]
    Setting(#[from] SettingError),
    /// A study does not fit the command, or an option contradicts it.
    #[error("study {name}: {rule}")]
    Rule {
        /// The study.
        name: String,
        /// The rule that is broken.
        rule: Rule,
    },
    /// What is asked for on the command line cannot be done.
    #[error("command line: {option}: {problem}")]
    Argument {
        /// The option.
        option: &'static str,
        /// What is wrong, and what to give.
        problem: String,
    },
    /// What is asked of a design is missing, or cannot be.
    #[error("{place}: {problem}")]
    Requirement {
        /// The option, or the file and its field.
        place: String,
        /// What is wrong, and what to give.
        problem: String,
    },
    /// The interval of a trajectory is invalid, or gives too many rows.
    #[error(
        "--interval: {value} s is not allowed here: give a number above 0 that makes at most {most} rows"
    )]
    Interval {
        /// The interval as given.
        value: f64,
        /// Most rows of a trajectory.
        most: u32,
    },
    /// A part of a grid is invalid.
    #[error("{}: {problem}", path.display())]
    Part {
        /// The part.
        path: PathBuf,
        /// The problem.
        problem: String,
    },
    /// Points are missing from the parts.
    #[error(
        "{}: no part holds points {points} of {len}: make what is missing with `{command} --shard i/N`{}",
        place.display(),
        shards.as_ref().map(|shards| format!(", i/N = {shards}")).unwrap_or_default()
    )]
    MissingParts {
        /// The points.
        points: String,
        /// The number of points of the grid.
        len: usize,
        /// The shares that contain them, if these can be determined.
        shards: Option<String>,
        /// The command that makes a part.
        command: String,
        /// The directory of the parts.
        place: PathBuf,
    },
    /// Results that fail verification.
    #[error("{}: {problem}", path.display())]
    NotHeld {
        /// The directory of the results.
        path: PathBuf,
        /// The differences.
        problem: String,
    },
    /// Results that cannot be verified completely; everything that can be checked holds.
    #[error("{}: cannot be checked: {problem}", path.display())]
    NotChecked {
        /// The directory of the results.
        path: PathBuf,
        /// The parts that cannot be checked.
        problem: String,
    },
    /// A motion that was not proven.
    #[error("study {name}: not proven: {why}")]
    NotProven {
        /// The study.
        name: String,
        /// Which step failed, and at which width.
        why: String,
    },
    /// None found that keeps the limits: the results are those of the nearest design.
    #[error(
        "study {name}: the limits are not kept: {words}; loosen a limit, widen a bound, or look at more designs"
    )]
    Infeasible {
        /// The study.
        name: String,
        /// Which limits are broken, and by how much.
        words: String,
    },
    /// Lines that `evaluate` could not answer with a value.
    #[error("standard input: {failed} of {} had no value", counted(*lines, "line"))]
    Lines {
        /// Their number.
        failed: u64,
        /// The number of all lines.
        lines: u64,
    },
    /// The threads could not be started.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A run could not be finished.
    #[error("the run failed: {0}")]
    Run(#[from] SolverError),
    /// A motion could not be computed.
    #[error("the run failed: {0}")]
    Motion(#[from] retune_dynamics::Error),
    /// A design that was found cannot be run.
    #[error("a design that was found cannot be run: {0}")]
    Unusable(#[from] Unusable),
    /// No point of the grid has a value.
    #[error("no point of the grid could be computed{}", example(.0))]
    NoStart(Failures),
    /// A global search failed.
    #[error("the global search failed: {source}{}", example(.failures))]
    Global {
        /// Its error.
        source: retune_optim::GlobalError,
        /// The evaluations that failed.
        failures: Failures,
    },
    /// A refinement could not be started.
    #[error("the refinement failed: {source}{}", example(.failures))]
    Search {
        /// Its error.
        source: retune_optim::Error,
        /// The evaluations that failed.
        failures: Failures,
    },
    /// A figure could not be drawn.
    #[error("cannot draw {name}: {problem}")]
    Figure {
        /// The figure.
        name: String,
        /// The error of the drawing library.
        problem: String,
    },
}

impl Error {
    /// That a study breaks a rule.
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
