//! What bounds the work of one message. A study may ask for more in a file; a page that follows a slider may not.

use crate::refused::Refused;
use retune_study::Study;
use std::f64::consts::TAU;

/// Bytes of a message, and of the head of a request.
pub const MOST_BYTES: usize = 16 << 10;
/// Pages at once.
pub const MOST_PAGES: usize = 16;
/// Columns of pixels of a time series.
pub const MOST_COLUMNS: usize = 2000;
/// Periods of the force, or of the structure, in a run.
pub const MOST_PERIODS: f64 = 4000.0;
/// Seconds of a run.
pub const MOST_SECONDS: f64 = 20_000.0;
/// Steps of a run.
pub const MOST_STEPS: u64 = 1_000_000;
/// Frequencies of a response curve.
pub const MOST_SAMPLES: usize = 601;
/// Runs behind one value of an objective that is tuned from the page.
pub const MOST_RUNS: usize = 20_000;
/// Runs and motions of a search for branches.
pub const MOST_MOTIONS: u64 = 20_000;
/// Evaluations of a tuning.
pub const MOST_EVALUATIONS: u64 = 20_000;

/// The study with no more steps than a message may ask for.
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
