//! Long work without the interpreter's lock: Ctrl-C ends it, and it reports its progress.
//!
//! The work runs on other threads: a job on its own thread ([`monitored`]), anything else on a pool ([`on_pool`]). The calling thread waits
//! for it and periodically takes the lock to let Python handle signals and to report progress.

use crate::errors::{Fault, of_panic};
use crate::pool::abandon_pools;
use pyo3::prelude::*;
use rayon::ThreadPool;
use retune_jobs::{Error, Observer, Progress};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Time between two checks for signals and progress.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// The progress of a piece of work, and the request to stop it.
#[derive(Clone, Default)]
pub struct Monitor(Arc<State>);

#[derive(Default)]
struct State {
    stopped: AtomicBool,
    lines: Mutex<Vec<(&'static str, String)>>,
    stage: Mutex<Option<Arc<Stage>>>,
    answer: Mutex<Option<PathBuf>>,
}

/// A stage of a job.
struct Stage {
    name: &'static str,
    count: u64,
    done: AtomicU64,
    known: AtomicU64,
    finished: AtomicBool,
}

/// The payload that silently unwinds a job that was stopped: it has no other way to end early. Everything computed so far is in its
/// journal.
struct Stopped;

impl Monitor {
    /// Whether the work should stop.
    pub fn is_stopped(&self) -> bool {
        self.0.stopped.load(Relaxed)
    }

    fn stop(&self) {
        self.0.stopped.store(true, Relaxed);
    }

    /// Unwinds the job if it should stop.
    fn end_if_stopped(&self) {
        if self.is_stopped() {
            resume_unwind(Box::new(Stopped));
        }
    }

    /// The file with the answer of a finished job.
    pub fn answer(&self) -> Option<PathBuf> {
        self.0.answer.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn push_line(&self, kind: &'static str, words: &str) {
        let mut lines = self.0.lines.lock().unwrap_or_else(PoisonError::into_inner);
        lines.push((kind, words.to_owned()));
    }

    /// Reports new lines and the progress of the stage: `to(kind, words, done, known, count)`.
    fn report(&self, py: Python<'_>, to: Option<&Py<PyAny>>) -> PyResult<()> {
        let lines = std::mem::take(&mut *self.0.lines.lock().unwrap_or_else(PoisonError::into_inner));
        let stage = self.0.stage.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let Some(to) = to else { return Ok(()) };
        for (kind, words) in lines {
            to.call1(py, (kind, words, 0, 0, 0))?;
        }
        if let Some(stage) = stage {
            let kind = if stage.finished.load(Relaxed) { "finished" } else { "progress" };
            let (done, known) = (stage.done.load(Relaxed), stage.known.load(Relaxed));
            to.call1(py, (kind, stage.name, done, known, stage.count))?;
        }
        Ok(())
    }
}

/// Does `work` on a pool while the calling thread checks for Ctrl-C, which ends the wait at once. The work then runs on until it next
/// checks [`Monitor::is_stopped`], but nobody waits for it.
///
/// # Errors
/// The error of the work, or Ctrl-C.
pub fn on_pool<T: Send + 'static>(
    py: Python<'_>,
    pool: &ThreadPool,
    work: impl FnOnce(&Monitor) -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    let monitor = Monitor::default();
    let own = monitor.clone();
    let (answers, answer) = mpsc::sync_channel(1);
    pool.spawn(move || {
        // Fails if nobody waits for the answer any more.
        let _ = answers.send(catch_panic(|| work(&own)));
    });
    let found = py.detach(move || {
        loop {
            match answer.recv_timeout(POLL_INTERVAL) {
                Ok(found) => return found,
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = Python::attach(|py| py.check_signals()) {
                        monitor.stop();
                        abandon_pools();
                        return Err(Fault::Python(error));
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(no_answer()),
            }
        }
    });
    Ok(found?)
}

fn no_answer() -> Fault {
    Fault::Other("the work ended without an answer".to_owned())
}

/// Does `work` on its own thread and waits until it has ended, even after an error. Calls `tell` with what the [`Monitor`] receives.
///
/// # Errors
/// The error of the work, Ctrl-C, or an exception of `tell`.
pub fn monitored<T: Send>(
    py: Python<'_>,
    tell: Option<&Py<PyAny>>,
    work: impl FnOnce(&Monitor) -> Result<T, Fault> + Send,
) -> PyResult<T> {
    let monitor = Monitor::default();
    let result_of_work = py.detach(|| {
        let (answers, answer) = mpsc::sync_channel(1);
        std::thread::scope(|scope| {
            let own = monitor.clone();
            let thread =
                std::thread::Builder::new().name("retune".to_owned()).spawn_scoped(scope, move || {
                    // The receiver outlives this thread.
                    let _ = answers.send(catch_panic(|| work(&own)));
                });
            if let Err(error) = thread {
                return Err(Fault::Other(format!("cannot start a thread: {error}")));
            }
            let mut raised = None;
            loop {
                match answer.recv_timeout(POLL_INTERVAL) {
                    Ok(found) => return raised.map_or(found, |error| Err(Fault::Python(error))),
                    Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                        let poll =
                            |py: Python<'_>| py.check_signals().and_then(|()| monitor.report(py, tell));
                        raised = Python::attach(poll).err();
                        if raised.is_some() {
                            monitor.stop();
                        }
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(no_answer());
                    }
                }
            }
        })
    });
    let found = result_of_work?;
    monitor.report(py, tell)?;
    Ok(found)
}

/// Does `work` and converts a panic to an error, since it must not unwind into Python.
///
/// # Errors
/// Its own, or a panic.
pub fn catch_panic<T>(work: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| Err(of_panic(&*payload)))
}

impl Observer for Monitor {
    fn so_far(&self, line: &str) -> Result<(), Error> {
        self.result(line)
    }
    fn result(&self, line: &str) -> Result<(), Error> {
        self.end_if_stopped();
        self.push_line("result", line);
        Ok(())
    }
    fn log(&self, line: &str) -> Result<(), Error> {
        self.end_if_stopped();
        self.push_line("log", line);
        Ok(())
    }
    fn warn(&self, words: &str) {
        self.push_line("warning", words);
    }
    fn begin(&self) {
        self.end_if_stopped();
    }
    fn progress(&self, name: &'static str, count: u64) -> Box<dyn Progress> {
        let [done, known] = [0; 2].map(AtomicU64::new);
        let stage = Arc::new(Stage { name, count, done, known, finished: AtomicBool::new(false) });
        *self.0.stage.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&stage));
        Box::new(MonitoredStage { monitor: self.clone(), stage })
    }
    fn resumable(&self) {}
    fn answered(&self, file: &Path) -> Result<(), Error> {
        *self.0.answer.lock().unwrap_or_else(PoisonError::into_inner) = Some(file.to_owned());
        Ok(())
    }
}

/// A stage that is monitored.
struct MonitoredStage {
    monitor: Monitor,
    stage: Arc<Stage>,
}

impl Progress for MonitoredStage {
    fn begin(&self) {
        self.monitor.end_if_stopped();
    }
    fn known(&self) {
        self.stage.known.fetch_add(1, Relaxed);
    }
    fn inc(&self, more: u64) {
        self.stage.done.fetch_add(more, Relaxed);
        self.monitor.end_if_stopped();
    }
    fn finish(&self) {
        self.stage.finished.store(true, Relaxed);
    }
}
