//! Observers for tests, and calls of jobs that must succeed or fail.

use retune_jobs::{Error, Observer, Progress, Silent};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// Records every line that a job reports, with its kind.
#[derive(Default)]
pub struct Record {
    said: Mutex<Vec<(Kind, String)>>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Result,
    Log,
    Warning,
    Stage,
}

impl Record {
    fn keep(&self, kind: Kind, line: &str) -> Result<(), Error> {
        self.said.lock().expect("no panic").push((kind, line.to_owned()));
        Ok(())
    }

    fn of(&self, kinds: &[Kind]) -> String {
        let said = self.said.lock().expect("no panic");
        said.iter().filter(|(kind, _)| kinds.contains(kind)).map(|(_, line)| format!("{line}\n")).collect()
    }

    /// The lines of the result.
    pub fn results(&self) -> String {
        self.of(&[Kind::Result])
    }

    /// The lines of the result and of the log, in order.
    pub fn all(&self) -> String {
        self.of(&[Kind::Result, Kind::Log])
    }

    /// The stages whose progress was reported, and the number of parts of each.
    pub fn stages(&self) -> String {
        self.of(&[Kind::Stage])
    }

    /// The warnings.
    pub fn warnings(&self) -> String {
        self.of(&[Kind::Warning])
    }
}

impl Observer for Record {
    fn so_far(&self, line: &str) -> Result<(), Error> {
        self.result(line)
    }
    fn result(&self, line: &str) -> Result<(), Error> {
        self.keep(Kind::Result, line)
    }
    fn log(&self, line: &str) -> Result<(), Error> {
        self.keep(Kind::Log, line)
    }
    fn warn(&self, words: &str) {
        let _ = self.keep(Kind::Warning, words);
    }
    fn progress(&self, stage: &'static str, count: u64) -> Box<dyn Progress> {
        let _ = self.keep(Kind::Stage, &format!("{stage} {count}"));
        Box::new(Silent)
    }
    fn resumable(&self) {}
}

/// Unwinds a job at one of its evaluations or log lines, like a crash: the job has no chance to save anything.
struct Cut(Arc<AtomicU64>);

impl Cut {
    fn count(&self) {
        if self.0.fetch_sub(1, Relaxed) == 1 {
            resume_unwind(Box::new("cut off")); // no message, unlike a panic
        }
    }
}

impl Observer for Cut {
    fn result(&self, _line: &str) -> Result<(), Error> {
        Ok(())
    }
    fn log(&self, _line: &str) -> Result<(), Error> {
        self.count();
        Ok(())
    }
    fn warn(&self, _words: &str) {}
    fn progress(&self, _stage: &'static str, _count: u64) -> Box<dyn Progress> {
        Box::new(Self(Arc::clone(&self.0)))
    }
    fn resumable(&self) {}
}

impl Progress for Cut {
    fn known(&self) {}
    fn inc(&self, more: u64) {
        (0..more).for_each(|_| self.count());
    }
    fn finish(&self) {}
}

/// Runs a job and aborts it at its `at`-th evaluation or log line.
#[track_caller]
pub fn cut_off<T>(at: u64, job: impl FnOnce(&dyn Observer) -> Result<T, Error>) {
    let watch = Cut(Arc::new(AtomicU64::new(at)));
    let ended = catch_unwind(AssertUnwindSafe(|| job(&watch).map(drop)));
    assert!(ended.is_err(), "the job has fewer moments than {at}: {ended:?}");
}

/// Unwinds a job at the beginning of a stage.
struct CutBefore(&'static str, AtomicU64);

impl Observer for CutBefore {
    fn progress(&self, stage: &'static str, _count: u64) -> Box<dyn Progress> {
        if stage == self.0 && self.1.fetch_sub(1, Relaxed) == 1 {
            resume_unwind(Box::new("cut off"));
        }
        Box::new(Silent)
    }
}

/// Runs a job and aborts it when it begins a stage for the `times`-th time.
#[track_caller]
pub fn cut_off_before<T>(
    (stage, times): (&'static str, u64),
    job: impl FnOnce(&dyn Observer) -> Result<T, Error>,
) {
    let watch = CutBefore(stage, AtomicU64::new(times));
    let ended = catch_unwind(AssertUnwindSafe(|| job(&watch).map(drop)));
    assert!(ended.is_err(), "{stage} does not begin {times} times: {ended:?}");
}

/// The error of a job that must be refused.
#[track_caller]
pub fn refused<T>(result: Result<T, Error>) -> Error {
    match result {
        Ok(_) => panic!("it is not refused"),
        Err(error) => error,
    }
}

/// The result of a job that must succeed.
#[track_caller]
pub fn good<T>(result: Result<T, Error>) -> T {
    result.unwrap_or_else(|error| panic!("{error}"))
}
