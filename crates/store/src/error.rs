//! Why results cannot be read, made or replaced.

use std::path::PathBuf;
use thiserror::Error;

/// Why results cannot be read, made or replaced.
#[derive(Debug, Error)]
pub enum Error {
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
}

fn unfinished(lines: u64, damaged: u64, difference: Option<&str>) -> String {
    let damaged = match damaged {
        0 => String::new(),
        1 => ", 1 line is damaged".to_owned(),
        many => format!(", {many} lines are damaged"),
    };
    let kept = if lines == 1 { "1 result is".to_owned() } else { format!("{lines} results are") };
    let kept = format!("{kept} kept{damaged}");
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
