//! Everything that can go wrong, and whose fault it is.

use crate::study::{Rule, SettingError, StudyError};
use retune_optim::{Failures, Unusable};
use retune_solver::SolverError;
use std::path::PathBuf;
use std::process::ExitCode;
use thiserror::Error;

/// Why a command ends without its result.
#[derive(Debug, Error)]
pub enum Error {
    /// A study file is wrong.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A number given on the command line is wrong.
    #[error("command line: {0}")]
    Setting(#[from] SettingError),
    /// A study does not ask for what the command does, or an option contradicts it.
    #[error("study {name}: {rule}")]
    Rule {
        /// The study.
        name: String,
        /// The rule that is broken.
        rule: Rule,
    },
    /// The interval of a trajectory is none, or makes a file that nobody can read.
    #[error(
        "--interval: {value} s is not allowed here: give a number above 0 that makes at most {most} rows"
    )]
    Interval {
        /// The interval as given.
        value: f64,
        /// Most rows of a trajectory.
        most: u32,
    },
    /// Something cannot be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Output {
        /// The file or directory.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The threads could not be started.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A run could not be finished.
    #[error("the run failed: {0}")]
    Run(#[from] SolverError),
    /// A motion could not be followed.
    #[error("the run failed: {0}")]
    Atlas(#[from] retune_atlas::Error),
    /// A design that was found cannot be run.
    #[error("a design that was found cannot be run: {0}")]
    Unusable(#[from] Unusable),
    /// No point of the grid has a value.
    #[error("no point of the grid could be computed{}", example(.0))]
    NoStart(Failures),
    /// A global search found nothing to start from.
    #[error("the global search failed: {source}{}", example(.failures))]
    Global {
        /// What it says.
        source: retune_optim::GlobalError,
        /// The evaluations that failed.
        failures: Failures,
    },
    /// A refinement could not be started.
    #[error("the refinement failed: {source}{}", example(.failures))]
    Search {
        /// What it says.
        source: retune_optim::Error,
        /// The evaluations that failed.
        failures: Failures,
    },
    /// A figure could not be drawn.
    #[error("cannot draw {name}: {problem}")]
    Figure {
        /// The figure.
        name: String,
        /// What the drawing library says.
        problem: String,
    },
}

fn example(failures: &Failures) -> String {
    match &failures.example {
        Some((design, reason)) => format!(" ({} failed; at {design:?}: {reason})", failures.count),
        None => String::new(),
    }
}

impl Error {
    /// 2 where the user can mend it (an input, a place to write to), 1 where the computation failed.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Study(_)
            | Self::Setting(_)
            | Self::Rule { .. }
            | Self::Interval { .. }
            | Self::Output { .. } => 2,
            Self::Threads(_)
            | Self::Run(_)
            | Self::Atlas(_)
            | Self::Unusable(_)
            | Self::NoStart(_)
            | Self::Global { .. }
            | Self::Search { .. }
            | Self::Figure { .. } => 1,
        }
        .into()
    }
}
