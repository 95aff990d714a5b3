//! Run times for extreme parameters: no scene may take longer than a user would wait.

use super::scenes;
use cpu_time::ThreadTime;
use rayon::prelude::*;
use retune_solver::{Settings, SolverError, Window, simulate};
use retune_testkit::hunt::Hunt;
use std::time::Duration;

/// The longest time allowed for a run, whether it ends with a result or an error.
const ALLOWED: Duration = Duration::from_secs(2);

/// Runs of 100 s with default settings and every quantity observed, over 6, 10.5 and 15 orders of magnitude about the paper's numbers.
/// Times are CPU times of the thread.
pub fn durations(count: usize) -> Hunt {
    let settings = Settings::default();
    let run = |scene: &_| {
        let start = ThreadTime::now();
        let found = simulate(scene, Window { from: 0.0, to: 100.0 }, &settings);
        (start.elapsed(), found.err())
    };
    let scenes = scenes::drawn(count);
    let runs: Vec<_> = scenes.par_iter().map(run).collect();
    let given_up =
        |error: &SolverError| matches!(error, SolverError::TooManySteps { .. } | SolverError::TooSlow { .. });
    let refused = |wanted: bool| {
        runs.iter().filter(|(_, error)| error.as_ref().is_some_and(|error| given_up(error) == wanted)).count()
    };
    let mut times: Vec<Duration> = runs.iter().map(|(time, _)| *time).collect();
    times.sort_unstable();
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize].as_secs_f64();
    let above = |time| times.iter().filter(|taken| **taken > time).count();
    let mut hunt = Hunt::default();
    hunt.row(format!(
        "| {} | {} | {} | {:.2} | {:.0} | {} | {} | {:.2} |",
        scenes.len(),
        refused(true),
        refused(false),
        1e3 * at(0.5),
        1e3 * at(0.99),
        above(ALLOWED / 2),
        above(ALLOWED),
        at(1.0),
    ));
    for (scene, (time, _)) in scenes.iter().zip(&runs).filter(|(_, (time, _))| *time > ALLOWED) {
        hunt.faults.push(format!("{time:?}: {scene:?}"));
    }
    hunt
}
