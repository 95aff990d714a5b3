//! What appears on the screen: results and the log on standard output, errors and progress on standard error.

use crate::error::Error;
use crate::progress::Progress;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Where output goes.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    quiet: bool,
}

impl Screen {
    /// A screen that shows results, and unless `quiet` also the log and progress.
    pub fn new(quiet: bool) -> Self {
        Self { quiet }
    }

    /// Shows a line of the result.
    ///
    /// # Errors
    /// Standard output cannot be written. A reader that has gone (`retune ... | head`) is no error: the work is finished and
    /// its files are written all the same.
    pub fn line(&self, text: impl Display) -> Result<(), Error> {
        let mut out = std::io::stdout().lock();
        match writeln!(out, "{text}").and_then(|()| out.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            Err(source) => Err(Error::Output { path: "standard output".into(), source }),
            Ok(()) => Ok(()),
        }
    }

    /// Shows a line of the log.
    ///
    /// # Errors
    /// As [`Self::line`].
    pub fn log(&self, text: impl Display) -> Result<(), Error> {
        if self.quiet { Ok(()) } else { self.line(text) }
    }

    /// The progress over `count` evaluations, with rate and time left.
    pub fn progress(&self, what: &'static str, count: u64) -> Progress {
        Progress::new(what, count, self.quiet)
    }
}

/// Shows why a command failed. Where even that cannot be written, the exit code must do.
pub fn show_error(error: &Error) {
    let _ = writeln!(std::io::stderr(), "error: {error}");
}
