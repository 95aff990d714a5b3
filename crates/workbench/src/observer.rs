//! Who follows a job.

use crate::Error;

/// Follows a job: what it says, and how far it is. A command line shows it, a page may draw it, [`Silent`] drops it.
pub trait Observer: Sync {
    /// A line of the result, as soon as it is known.
    ///
    /// # Errors
    /// It could not be shown; the job ends.
    fn result(&self, line: &str) -> Result<(), Error>;
    /// A line of the log.
    ///
    /// # Errors
    /// As [`Self::result`].
    fn log(&self, line: &str) -> Result<(), Error>;
    /// What a person should know of a job that goes on.
    fn warn(&self, words: &str);
    /// A stage of `count` evaluations begins.
    fn progress(&self, stage: &'static str, count: u64) -> Box<dyn Progress>;
    /// From now on the process may end at any moment and the job be gone on with.
    fn resumable(&self);
}

/// How far a stage is.
pub trait Progress: Sync {
    /// One evaluation is to be answered from before, in no time; [`Self::inc`] counts it, too.
    fn known(&self);
    /// So many more are done.
    fn inc(&self, more: u64);
    /// All is done.
    fn finish(&self);
}

/// Nobody follows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn result(&self, _line: &str) -> Result<(), Error> {
        Ok(())
    }
    fn log(&self, _line: &str) -> Result<(), Error> {
        Ok(())
    }
    fn warn(&self, _words: &str) {}
    fn progress(&self, _stage: &'static str, _count: u64) -> Box<dyn Progress> {
        Box::new(Self)
    }
    fn resumable(&self) {}
}

impl Progress for Silent {
    fn known(&self) {}
    fn inc(&self, _more: u64) {}
    fn finish(&self) {}
}
