//! The runs of the comparison: each method of each program, with each treatment of contacts, at ever tighter settings.

use crate::decades;
use crate::moreau_jean::{self, STEPPER};
use crate::peers::{self, PEERS};
use crate::runs::{self, Found, Row};
use crate::scenes::Case;
use crate::system;
use retune_solver::Method;
use std::time::{Duration, Instant};

/// A series of settings ends after the first whose runs together take longer than this.
const TIME_LIMIT: Duration = Duration::from_millis(500);

/// Program, method, and how it treats contacts.
type Way = (&'static str, &'static str, &'static str);

/// All series of a scene. Contacts with rigid walls are never stepped over: without an impact the damper would pass through the wall.
fn all(case: &Case) -> Vec<(Way, Vec<f64>)> {
    let rigid = system(&case.scene).is_some_and(|system| system.is_rigid());
    let mut series: Vec<(Way, Vec<f64>)> = Vec::new();
    for method in Method::ALL.into_iter().filter(|method| !rigid || *method == Method::Hybrid) {
        let settings = match method {
            Method::Hybrid | Method::Dop853 => decades(2, 12),
            Method::Ode45 => decades(2, 11),
            Method::Ode23 | Method::Ode23s => decades(2, 8),
            Method::Rk4 | Method::Euler => (3..=10).map(|k| 10f64.powf(-f64::from(k) / 2.0)).collect(),
        };
        let ways = runs::ways(method).iter();
        series.extend(ways.map(|(_, way)| (("retune", method.name(), *way), settings.clone())));
    }
    for peer in &PEERS {
        let least = 0.5 * peer.tightest;
        let tight = |step| decades(3, 12).into_iter().step_by(step).filter(|rtol| *rtol > least).collect();
        series.push(((peer.program, peer.method, "located"), tight(1)));
        if !rigid {
            series.push(((peer.program, peer.method, "stepped"), tight(3)));
        }
    }
    if rigid {
        series.push(((STEPPER, "theta 1/2", "stepped"), decades(2, 6)));
    }
    series
}

/// The full name of a built-in program that begins with `begins`.
pub fn program(begins: &str) -> Option<&'static str> {
    PEERS.iter().map(|peer| peer.program).find(|program| program.starts_with(begins))
}

/// One run, with its time or without.
pub fn attempt(
    case: &Case,
    (program, method, contacts): (&str, &str, &str),
    setting: f64,
    is_timed: bool,
) -> Result<Found, String> {
    if program == STEPPER {
        return moreau_jean::run(case, setting, is_timed);
    }
    if program == "retune" {
        let method = Method::ALL.into_iter().find(|own| own.name() == method).ok_or("no such method")?;
        let way = runs::ways(method).iter().find(|(_, name)| *name == contacts).ok_or("no such way")?;
        return runs::run(case, &runs::settings(method, way.0, setting), is_timed);
    }
    let peer = PEERS.iter().find(|peer| peer.program == program && peer.method == method);
    peers::run(peer.ok_or("no such program")?, case, contacts == "located", setting, is_timed)
}

/// The rows of a scene, timed.
pub fn rows(case: &Case, reference: &Found) -> Vec<Row> {
    let mut rows = Vec::new();
    for (way, settings) in all(case) {
        for setting in settings {
            let begun = Instant::now();
            rows.push(Row::of(case, reference, way, setting, attempt(case, way, setting, true)));
            if begun.elapsed() > TIME_LIMIT {
                break;
            }
        }
    }
    rows
}

/// How a row differs from a rerun without timing; none if it does not, or if the program is not built in.
pub fn change(row: &Row, case: &Case, reference: &Found) -> Option<String> {
    let built_in = ["retune", STEPPER].contains(&row.program.as_str())
        || PEERS.iter().any(|peer| peer.program == row.program);
    let way = (row.program.as_str(), row.method.as_str(), row.contacts);
    let repeated = built_in
        .then(|| Row::of(case, reference, way, row.setting, attempt(case, way, row.setting, false)))?;
    // The fields of the table, with its digits, except time and spread.
    let fields_of = |row: &Row| -> Vec<String> {
        let text = runs::csv(std::slice::from_ref(row));
        let fields = text.lines().nth(1).unwrap_or_default().split(',').enumerate();
        fields.filter(|(i, _)| ![5, 6].contains(i)).map(|(_, field)| field.to_owned()).collect()
    };
    let (before, after) = (fields_of(row), fields_of(&repeated));
    (before != after).then(|| format!("{} became {}", before.join(","), after.join(",")))
}
