//! Everything that can go wrong, and whose fault it is.

use crate::exit;
use crate::optimize::log::{are, counted};
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
    /// A result cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Input {
        /// The file or directory.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A part of a grid is not what it must be.
    #[error("{}: {problem}", path.display())]
    Part {
        /// The part.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Points that no part holds.
    #[error(
        "{}: no part holds points {points} of {len}: make what is missing with `retune optimize {} --shard i/N`{}",
        place.display(),
        study.display(),
        shards.as_ref().map(|shards| format!(", i/N = {shards}")).unwrap_or_default()
    )]
    MissingParts {
        /// The points.
        points: String,
        /// How many the grid has.
        len: usize,
        /// The shares that hold them, if that can be told.
        shards: Option<String>,
        /// The study.
        study: PathBuf,
        /// Where parts are looked for.
        place: PathBuf,
    },
    /// Results that do not hold.
    #[error("{}: {problem}", path.display())]
    NotHeld {
        /// The directory of the results.
        path: PathBuf,
        /// What does not hold.
        problem: String,
    },
    /// Results of which something cannot be checked; all that can be holds.
    #[error("{}: cannot be checked: {problem}", path.display())]
    NotChecked {
        /// The directory of the results.
        path: PathBuf,
        /// What cannot be checked.
        problem: String,
    },
    /// No design that keeps the limits: the results are of the nearest.
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
        /// How many.
        failed: u64,
        /// How many there were.
        lines: u64,
    },
    /// Something stands where results are to go, and nobody said that it may be replaced.
    #[error(
        "{}: {problem}: choose another directory with --out, or give --replace to have it replaced",
        path.display()
    )]
    Standing {
        /// The directory.
        path: PathBuf,
        /// What stands there.
        problem: String,
    },
    /// Something stands where a file is to go that is never replaced.
    #[error("{}: not replaced: {problem}: move it away, or choose another place", path.display())]
    Protected {
        /// What stands there.
        path: PathBuf,
        /// What it is.
        problem: String,
    },
    /// Nobody can tell whose work a journal holds.
    #[error(
        "{}: {problem}: move it away to look at it, or throw the unfinished work away with --restart",
        path.display()
    )]
    Journal {
        /// The journal.
        path: PathBuf,
        /// Why not.
        problem: &'static str,
    },
    /// Another run is at work in the directory.
    #[error(
        "{}: another run{} is at work here: wait for it, stop it, or choose another directory with --out",
        path.display(),
        holder.map(|process| format!(" (process {process})")).unwrap_or_default()
    )]
    Busy {
        /// The directory.
        path: PathBuf,
        /// The other process.
        holder: Option<u32>,
    },
    /// A run was interrupted here, and nobody said what becomes of it.
    #[error("{}: {}", path.display(), unfinished(*lines, *damaged, difference.as_deref()))]
    Unfinished {
        /// The directory.
        path: PathBuf,
        /// How much of it is kept.
        lines: u64,
        /// Lines that are damaged.
        damaged: u64,
        /// Why this run cannot go on with it, if it cannot.
        difference: Option<String>,
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

fn unfinished(lines: u64, damaged: u64, difference: Option<&str>) -> String {
    let damaged = match damaged {
        0 => String::new(),
        1 => ", 1 line is damaged".to_owned(),
        many => format!(", {many} lines are damaged"),
    };
    let kept = format!("{} kept{damaged}", are(lines, "result"));
    match difference {
        None => format!(
            "unfinished work was found here ({kept}): --resume goes on with it, --restart begins anew"
        ),
        Some(difference) => format!(
            "unfinished work was found here ({kept}), but it is {difference}: finish it as it was begun, \
             choose another directory with --out, or throw it away with --restart"
        ),
    }
}

impl Error {
    /// One of [`exit`].
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Study(_)
            | Self::Setting(_)
            | Self::Rule { .. }
            | Self::Interval { .. }
            | Self::Output { .. }
            | Self::Input { .. }
            | Self::Part { .. }
            | Self::MissingParts { .. }
            | Self::Standing { .. }
            | Self::Protected { .. }
            | Self::Journal { .. }
            | Self::Busy { .. }
            | Self::Unfinished { .. } => exit::WRONG,
            Self::Infeasible { .. } => exit::INFEASIBLE,
            Self::NotChecked { .. } => exit::UNCHECKED,
            Self::Threads(_)
            | Self::Run(_)
            | Self::Atlas(_)
            | Self::Unusable(_)
            | Self::NoStart(_)
            | Self::Global { .. }
            | Self::Search { .. }
            | Self::Figure { .. }
            | Self::Lines { .. }
            | Self::NotHeld { .. } => exit::FAILED,
        }
        .into()
    }
}

#[cfg(test)]
mod tests;
