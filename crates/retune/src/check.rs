//! `check`: whether a study file is right, and what it asks for.

use crate::error::Error;
use crate::optimize::log::{joined, short};
use crate::paper::Plan;
use crate::screen::Screen;
use crate::study::{self, Response, Study};
use retune_optim::Band;
use std::path::Path;

/// Checks a study file and shows what it asks for.
///
/// # Errors
/// What is wrong with it.
pub fn check(path: &Path) -> Result<(), Error> {
    let screen = Screen::new(false);
    if study::is_table2(path)? {
        for row in study::read_table2(path)? {
            screen.line(format!("{}: {}", row.damper, describe(&row.study)))?;
        }
    } else if study::is_paper(path)? {
        Plan::read(path, screen)?;
        screen.line("every table and figure of the paper".to_owned())?;
    } else {
        screen.line(describe(&study::read(path)?))?;
    }
    screen.line(format!("{}: good", path.display()))
}

fn describe(study: &Study) -> String {
    let (primary, forcing) = (study.scene.primary, study.scene.forcing);
    let mut lines = vec![format!(
        "study {}: k1 = {} N/m, forced at omega = {} rad/s; maxima from t0 = {} s to T = {} s",
        study.name(),
        primary.stiffness.get(),
        forcing.frequency.get(),
        study.window.t0.get(),
        study.window.end.get(),
    )];
    match study.scene.damper {
        None => lines.push("no damper".to_owned()),
        Some(damper) => lines.push(format!(
            "damper of {} kg; contact stiffnesses {} N/m^1.5",
            damper.mass.get(),
            joined(&damper.contact.stiffness().map(short), " and "),
        )),
    }
    if let Ok(search) = study.search() {
        let from = match &search.surf {
            Some((variables, grid)) => {
                format!("a grid of {} points over {}", grid.len(), joined(variables, ", "))
            }
            None => "the damper of the scene".to_owned(),
        };
        lines.push(format!("tunes {} from {from}", joined(&search.variables, ", ")));
        let objective = study.objective();
        if let Some(Band { from, to, samples }) = objective.band() {
            let how = match objective.response {
                Response::Window => format!("in the window, on {samples} samples and refined at their peaks"),
                Response::Steady => "steady, exact".to_owned(),
            };
            lines.push(format!("for the worst E1max over omega = {from} to {to} rad/s, {how}"));
        } else if objective.response == Response::Steady {
            lines.push("for the steady E1max".to_owned());
        }
    }
    lines.join("\n  ")
}
