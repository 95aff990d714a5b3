//! Errors of reading, making and replacing results.

use std::path::PathBuf;
use thiserror::Error;

/// An error of reading, making or replacing results.
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
    /// There are files in the directory that the run was not allowed to replace.
    #[error(
        "{}: {problem}: choose another directory with --out, or give --replace to have it replaced",
        path.display()
    )]
    Standing {
        /// The directory.
        path: PathBuf,
        /// Description of these files.
        problem: String,
    },
    /// There is something that is never replaced where a file is to be written.
    #[error("{}: not replaced: {problem}: move it away, or choose another place", path.display())]
    Protected {
        /// Its path.
        path: PathBuf,
        /// Its description.
        problem: String,
    },
    /// The work of a journal cannot be identified.
    #[error(
        "{}: {problem}: move it away to look at it, or discard the unfinished work with --restart",
        path.display()
    )]
    Journal {
        /// The journal.
        path: PathBuf,
        /// The reason.
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
    /// There is unfinished work, which the run was asked neither to resume nor to discard.
    #[error("{}: {}", path.display(), unfinished(*lines, *damaged, difference.as_deref()))]
    Unfinished {
        /// The directory.
        path: PathBuf,
        /// Number of values and marks that are kept.
        lines: u64,
        /// Lines that are damaged.
        damaged: u64,
        /// Its difference to this run, where that prevents resuming.
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
        None => {
            format!("unfinished work was found here ({kept}): --resume continues it, --restart discards it")
        }
        Some(difference) => format!(
            "unfinished work was found here ({kept}), but it is {difference}: finish it as it was begun, \
             choose another directory with --out, or discard it with --restart"
        ),
    }
}
