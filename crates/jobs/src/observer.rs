//! Observers of a job.

use crate::Error;
use serde_json::Value;
use std::path::Path;

/// Receives the output and the progress of a job; methods that it does not implement ignore theirs. A command line prints them, a page may
/// draw them, [`Silent`] ignores all.
pub trait Observer: Sync {
    /// Receives a line of the result, as soon as it is known.
    fn result(&self, _line: &str) -> Result<(), Error> {
        Ok(())
    }
    /// Receives the best result of a stage, in case the user stops there.
    fn so_far(&self, _line: &str) -> Result<(), Error> {
        Ok(())
    }
    /// Receives a line of the log.
    fn log(&self, _line: &str) -> Result<(), Error> {
        Ok(())
    }
    /// Receives a warning; the job continues.
    fn warn(&self, _words: &str) {}
    /// An evaluation begins: who wants to end the job may unwind from here.
    fn begin(&self) {}
    /// A stage of `count` evaluations begins.
    fn progress(&self, _stage: &'static str, _count: u64) -> Box<dyn Progress> {
        Box::new(Silent)
    }
    /// From here on the job can be resumed if the process ends.
    fn resumable(&self) {}
    /// The job is done and its answer is in a file, see [`crate::answer`].
    fn answered(&self, _file: &Path) -> Result<(), Error> {
        Ok(())
    }
    /// The job is done; its answer as JSON is in no file.
    fn answered_with(&self, _json: &Value) -> Result<(), Error> {
        Ok(())
    }
}

/// The progress of a stage.
pub trait Progress: Sync {
    /// An evaluation begins: who wants to end the job may unwind from here.
    fn begin(&self) {}
    /// One evaluation is known from an earlier run and takes no time; [`Self::inc`] counts it as well.
    fn known(&self) {}
    /// Another `more` evaluations are done.
    fn inc(&self, _more: u64) {}
    /// The best so far, in words.
    fn best(&self, _words: &str) {}
    /// Runs `write`, which prints a line while the stage is running, so that both stay readable.
    fn aside(&self, write: &mut dyn FnMut()) {
        write();
    }
    /// The stage is finished.
    fn finish(&self) {}
}

/// Ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {}

impl Progress for Silent {}

/// Passes on warnings only: for a search whose answer is reported as part of a larger one.
#[derive(Clone, Copy)]
pub struct Quiet<'a>(pub &'a dyn Observer);

impl Observer for Quiet<'_> {
    fn warn(&self, words: &str) {
        self.0.warn(words);
    }
    fn resumable(&self) {
        self.0.resumable();
    }
    fn begin(&self) {
        self.0.begin();
    }
}
