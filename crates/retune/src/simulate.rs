//! `simulate`: one run.

use crate::cli;
use crate::error::Error;
use crate::results::{Pending, order::may_write};
use crate::screen::Screen;
use crate::study::{self, Study};
use crate::summary::Summary;
use retune_solver::{Rows, Sample, trajectory};
use std::path::Path;

/// Most rows of a trajectory.
const MOST_ROWS: u32 = 100_000_000;

/// What every trajectory begins with, of this and of earlier versions: by it a file is known as one.
const HEAD: &str = "t,x1,v1,x2,v2,";

/// Runs the scene of a study, changed as the arguments say, and shows what happened.
///
/// # Errors
/// An input is wrong, the run fails, or the trajectory cannot be written.
pub fn simulate(arguments: &cli::Simulate) -> Result<(), Error> {
    let mut study = study::read(&arguments.study)?;
    study.solver.method = arguments.solver.unwrap_or(study.solver.method);
    study.solver.contacts = arguments.contacts.unwrap_or(study.solver.contacts);
    study.solver.rtol = arguments.rtol.unwrap_or(study.solver.rtol);
    let study = study.with(&arguments.settings)?;

    if let Some(file) = &arguments.trajectory {
        may_write(file, &[&arguments.study], HEAD)?;
    }
    let response = retune_solver::simulate(&study.scene, study.window.window(), &study.solver.settings())?;
    if let Some(file) = &arguments.trajectory {
        write_trajectory(&study, file, arguments.interval)?;
    }
    let summary = Summary::new(&study, study.scene, &response);
    let text = if arguments.json { json(&summary)? } else { summary.to_string() };
    Screen::new(false).line(text)
}

/// A result as indented JSON.
///
/// # Errors
/// None that is known: numbers that are none become null.
pub fn json(value: &impl serde::Serialize) -> Result<String, Error> {
    serde_json::to_string_pretty(value)
        .map_err(|error| Error::Output { path: "standard output".into(), source: error.into() })
}

/// Writes the motion in the window: a row each `interval` seconds, and one for each moment that lies between (column `moment`).
/// A row says which it is in its last column, so that `df[df.moment == "grid"]` are the equidistant ones.
fn write_trajectory(study: &Study, file: &Path, interval: f64) -> Result<(), Error> {
    let window = study.window.window();
    let rows = (window.to - window.from) / interval;
    if !(interval > 0.0 && rows <= f64::from(MOST_ROWS)) {
        return Err(Error::Interval { value: interval, most: MOST_ROWS });
    }
    let mut csv = Pending::create(file)?;
    csv.push("t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment\n")?;
    let mut written = Ok(());
    let mut row = |sample: &Sample| {
        let Sample { t, state: [x1, v1, x2, v2], e1, e2, forces: [left, right], moment } = sample;
        let text = format!("{t},{x1},{v1},{x2},{v2},{e1},{e2},{left},{right},{}\n", moment.name());
        if written.is_ok() {
            written = csv.push(&text);
        }
    };
    trajectory(&study.scene, window, &study.solver.settings(), Rows { interval, events: true }, &mut row)?;
    written?;
    csv.finish()
}
