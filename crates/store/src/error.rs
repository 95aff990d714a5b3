//! Errors of reading, making and replacing results.

use std::path::PathBuf;
use thiserror::Error;

/// An error of reading, making or replacing results.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "its words say what each is and holds")]
pub enum Error {
    #[error("{}: cannot be written: {source}", path.display())]
    Output { path: PathBuf, source: std::io::Error },
    #[error("{}: cannot be read: {source}", path.display())]
    Input { path: PathBuf, source: std::io::Error },
    #[error(
        "{}: {problem}: choose another directory with --out, or give --replace to have it replaced",
        path.display()
    )]
    Standing { path: PathBuf, problem: String },
    #[error("{}: not replaced: {problem}: move it away, or choose another place", path.display())]
    Protected { path: PathBuf, problem: String },
    #[error(
        "{}: {problem}: move it away to look at it, or discard the unfinished work with --restart",
        path.display()
    )]
    Journal { path: PathBuf, problem: &'static str },
    #[error(
        "{}: another run{} is at work here: wait for it, stop it, or choose another directory with --out",
        path.display(),
        holder.map(|process| format!(" (process {process})")).unwrap_or_default()
    )]
    Busy { path: PathBuf, holder: Option<u32> },
    #[error("{}: {}", path.display(), unfinished(*lines, *damaged, difference.as_deref()))]
    Unfinished { path: PathBuf, lines: u64, damaged: u64, difference: Option<String> },
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
