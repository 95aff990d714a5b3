//! Progress of a stage: a bar if standard error is a terminal, else a line every half minute.
//!
//! Rate and remaining time count new work only: values from the journal of an interrupted run take no time. A stage that reports the best
//! so far shows that instead: `2 of 4: SSVI NES, 27 s, best 21.3 kJ`.

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two lines if standard error is not a terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(30);

/// The progress of a stage.
pub struct Stage {
    bar: ProgressBar,
    count: Arc<Count>,
    /// Whether lines replace the bar.
    lines: bool,
}

/// The work done so far.
struct Count {
    what: &'static str,
    all: u64,
    begun: Instant,
    done: AtomicU64,
    /// How many of these were already known.
    known: AtomicU64,
    /// When the last line was due, ms after the beginning.
    last_line: AtomicU64,
    /// The best so far in words, if the stage reports it.
    best: Mutex<Option<String>>,
}

impl Stage {
    /// A stage of `all` evaluations; nothing is shown if `quiet`.
    pub fn new(what: &'static str, all: u64, quiet: bool) -> Self {
        let [done, known, last_line] = [0; 3].map(AtomicU64::new);
        let count = Arc::new(Count {
            what,
            all,
            begun: Instant::now(),
            done,
            known,
            last_line,
            best: Mutex::default(),
        });
        let bar = if quiet { ProgressBar::hidden() } else { bar(&count) };
        Self { bar, count, lines: !quiet && !std::io::stderr().is_terminal() }
    }
}

impl retune_jobs::Progress for Stage {
    fn known(&self) {
        self.count.known.fetch_add(1, Relaxed);
    }

    fn inc(&self, more: u64) {
        self.count.done.fetch_add(more, Relaxed);
        self.bar.inc(more);
        if let Some(line) = self.lines.then(|| self.count.due_line(self.count.begun.elapsed())).flatten() {
            let _ = writeln!(std::io::stderr(), "{line}"); // a closed standard error does not end the run
        }
    }

    fn best(&self, words: &str) {
        *self.count.best.lock().unwrap_or_else(PoisonError::into_inner) = Some(words.to_owned());
        self.bar.tick();
    }

    fn aside(&self, write: &mut dyn FnMut()) {
        self.bar.suspend(write);
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

fn bar(count: &Arc<Count>) -> ProgressBar {
    let template = "{prefix} [{bar:30}] {human_pos}/{human_len}  {state}";
    let shown = Arc::clone(count);
    let style = ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("state", move |_: &ProgressState, out: &mut dyn std::fmt::Write| {
            let _ = out.write_str(&shown.state(shown.begun.elapsed()));
        });
    ProgressBar::new(count.all).with_style(style.progress_chars("=> ")).with_prefix(count.what)
}

impl Count {
    /// The line to print, if one is due.
    fn due_line(&self, elapsed: Duration) -> Option<String> {
        let (now, last) = (elapsed.as_millis() as u64, self.last_line.load(Relaxed));
        let due = now >= last + LINE_INTERVAL.as_millis() as u64;
        let mine = due && self.last_line.compare_exchange(last, now, Relaxed, Relaxed).is_ok();
        let Self { what, all, .. } = self;
        let done = self.done.load(Relaxed);
        mine.then(|| match self.best() {
            Some(_) => format!("{done} of {all}: {what}, {}", self.state(elapsed)),
            None => format!("{what}: {done} of {all}, {}", self.state(elapsed)),
        })
    }

    /// Time and the best so far; for a stage that reports none, rate and remaining time.
    fn state(&self, elapsed: Duration) -> String {
        match self.best() {
            Some(best) => format!("{} s, best {best}", elapsed.as_secs()),
            None => format!("{}, {}", words(self.rate(elapsed)), self.remaining(elapsed)),
        }
    }

    fn best(&self) -> Option<String> {
        self.best.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// New evaluations a second.
    fn rate(&self, elapsed: Duration) -> f64 {
        let new = self.done.load(Relaxed).saturating_sub(self.known.load(Relaxed));
        new as f64 / elapsed.as_secs_f64().max(1e-9)
    }

    /// The remaining time, in words.
    fn remaining(&self, elapsed: Duration) -> String {
        let rest = self.all.saturating_sub(self.done.load(Relaxed)) as f64;
        match Duration::try_from_secs_f64(rest / self.rate(elapsed)) {
            Ok(remaining) => format!("{} left", HumanDuration(remaining)),
            Err(_) => "time left not known yet".to_owned(),
        }
    }
}

/// A rate to two or three digits: `3.4/s`, `1250/s`.
fn words(per_second: f64) -> String {
    if per_second < 10.0 { format!("{per_second:.1}/s") } else { format!("{per_second:.0}/s") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_jobs::Progress as _;

    #[test]
    fn contract_rates_have_few_digits() {
        assert_eq!([0.0, 3.4219, 1249.8].map(words), ["0.0/s", "3.4/s", "1250/s"]);
    }

    /// 900 of 1000 were known, so 50 new ones in 25 s are 2/s, and the remaining 50 take another 25 s.
    #[test]
    fn contract_known_values_do_not_count_in_the_rate() {
        let progress = Stage::new("surf", 1000, true);
        progress.inc(950);
        (0..900).for_each(|_| progress.known());
        let count = &progress.count;
        let at = Duration::from_secs;
        assert_eq!((count.rate(at(25)), count.remaining(at(25)).as_str()), (2.0, "25 seconds left"));
        assert_eq!(count.due_line(at(25)), None, "not yet due");
        assert_eq!(count.due_line(at(30)).as_deref(), Some("surf: 950 of 1000, 1.7/s, 30 seconds left"));
        assert_eq!(count.due_line(at(59)), None);
        assert!(count.due_line(at(60)).is_some());
        progress.best("21.3 kJ");
        assert_eq!(count.due_line(at(91)).as_deref(), Some("950 of 1000: surf, 91 s, best 21.3 kJ"));
        let fresh = Stage::new("surf", 10, true);
        assert_eq!(fresh.count.remaining(at(1)), "time left not known yet");
    }
}
