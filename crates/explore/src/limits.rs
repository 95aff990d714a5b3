//! Limits on the work of one message. A study file may ask for more; a page that follows a slider may not.

use crate::refused::Refused;
use retune_solver::{Rows, Settings};
use retune_study::Study;
use std::f64::consts::TAU;

/// Most bytes of a message, and of the head of a request.
pub const MOST_BYTES: usize = 16 << 10;
/// Most bytes of a message with a record.
pub const MOST_RECORD: usize = 4 << 20;
/// Most pages at once.
pub const MOST_PAGES: usize = 16;
/// Most pixel columns of a time series.
pub const MOST_COLUMNS: usize = 2000;
/// Most periods of the force, or of the structure, in a run.
pub const MOST_PERIODS: f64 = 4000.0;
/// Longest run, s.
pub const MOST_SECONDS: f64 = 20_000.0;
/// Most steps of a run.
pub const MOST_STEPS: u64 = 500_000;
/// Most steps per period of the force in a run that goes from period to period.
pub const MOST_STEPS_OF_A_PERIOD: u64 = 2_000;
/// Most rows of a motion, not counting those of its contacts and maxima.
pub const MOST_ROWS: f64 = 200_000.0;
/// The shortest span that a page may show is a run's length divided by this.
pub const MOST_PARTS: f64 = 1e6;
/// Most frequencies of a response curve.
pub const MOST_SAMPLES: usize = 601;
/// Most runs behind one value of an objective tuned from the page.
pub const MOST_RUNS: usize = 20_000;
/// Most evaluations of a descent.
pub const MOST_EVALUATIONS_OF_DESCENT: u64 = 100;
/// Most runs behind one value in a descent, which cannot be stopped on its way.
pub const MOST_RUNS_OF_DESCENT: usize = 500;
/// Most runs and motions of a search for branches.
pub const MOST_MOTIONS: u64 = 20_000;
/// Most evaluations of a tuning.
pub const MOST_EVALUATIONS: u64 = 20_000;

/// The span to show, s: the one asked for, cut at the end of the run; the window if none is asked for or nothing is left.
///
/// # Errors
/// It is too short a part of the run.
pub fn shown(study: &Study, asked: Option<[f64; 2]>) -> Result<[f64; 2], Refused> {
    let [t0, end] = [study.window.t0.get(), study.window.end.get()];
    let [from, to] = asked.map_or([t0, end], |[from, to]| [from, to.min(end)]);
    if from >= to {
        return Ok([t0, end]);
    }
    if asked.is_some() && to - from < end / MOST_PARTS {
        let least = end / MOST_PARTS;
        return Err(Refused::of(
            "span",
            format!("{from:e} to {to:e} s is too short to be shown: at least {least} s"),
        ));
    }
    Ok([from, to])
}

/// The moments of a motion over a span, an `interval` apart.
///
/// # Errors
/// There are too many of them.
pub fn rows([from, to]: [f64; 2], interval: f64, events: bool) -> Result<Rows, Refused> {
    let rows = (to - from) / interval;
    if rows <= MOST_ROWS {
        return Ok(Rows { interval, events });
    }
    let problem =
        format!("{rows:.0} rows from {from} to {to} s are too many for this page: at most {MOST_ROWS}");
    Err(Refused::of("span", problem))
}

/// The settings of runs that go from period to period: their limit on steps applies to each period, so it is lower.
pub fn of_periods(study: &Study) -> Settings {
    let settings = study.solver.settings();
    Settings { max_steps: settings.max_steps.min(MOST_STEPS_OF_A_PERIOD), ..settings }
}

/// The study with its steps limited to what a message may ask for.
///
/// # Errors
/// Its run is too long.
pub fn bounded(mut study: Study) -> Result<Study, Refused> {
    let end = study.window.end.get();
    if end > MOST_SECONDS {
        return Err(Refused::of("T", format!("{end} s is too long for this page: at most {MOST_SECONDS} s")));
    }
    let fastest = study.scene.forcing.frequency.get().max(study.scene.primary.natural_frequency());
    let periods = end * fastest / TAU;
    if periods > MOST_PERIODS {
        let problem =
            format!("a run of {periods:.0} periods is too long for this page: at most {MOST_PERIODS}");
        return Err(Refused::of("T", problem));
    }
    study.solver.max_steps = study.solver.max_steps.min(MOST_STEPS);
    Ok(study)
}
