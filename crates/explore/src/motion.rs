//! One run as the page shows it: the figures of `retune simulate`, time series for the screen, the last periods for the drawing and the
//! phase portrait, and the state at each crest of the force.

use crate::forcing::curve;
use crate::limits::rows;
use crate::protocol::Answer;
use crate::refused::Refused;
use crate::thin::{Thin, Thinning};
use retune_jobs::simulate::{Simulation, simulate};
use retune_model::{Coupled, Measure};
use retune_solver::{Moment, Sample, Window, trajectory};
use retune_study::{Study, rounded};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Periods of the force in the animation.
const ANIMATED_PERIODS: f64 = 12.0;
/// Rows per period in the animation.
const ANIMATED_ROWS: f64 = 96.0;
/// Least rows per period from which time series are thinned. Contacts and maxima of E1 are additional rows.
const ROWS_PER_PERIOD: f64 = 48.0;
/// Rows per pixel column before thinning.
const ROWS_PER_COLUMN: f64 = 2.0;

/// The period of the force, s; of the structure alone if the forcing is not periodic.
pub fn period(study: &Study) -> f64 {
    let omega = study.scene.forcing.frequency.get();
    let own = study.scene.primary.natural_frequency();
    let fallback = if own > 0.0 { TAU / own } else { study.window.end.get() };
    if omega > 0.0 { TAU / omega } else { fallback }
}

/// Runs the study; the time series cover `span`, s, in `columns` pixels.
///
/// # Errors
/// The run fails, with the time reached.
pub fn look(study: &Study, span: [f64; 2], columns: usize) -> Result<Answer, Refused> {
    let Window { from: t0, to: end } = study.window.window();
    // Each part makes its own run; two threads, because a page waits for them.
    let (series, (simulation, animated, crests)) = rayon::join(
        || series(study, span, columns),
        || (simulate(study, None), animated(study), crests(study)),
    );
    let simulation = simulation.map_err(Refused::whole)?;
    let Thin { t: moments, columns: [forcing] } = curve(&study.scene.forcing, span, columns);
    let (series, contacts) = series?;
    let mut answer = Answer::new("motion")
        .with("span", span)
        .with("window", [t0, end])
        .with("walls", walls(study))
        .with("figures", figures(&simulation))
        .with("run", &simulation)
        .with("text", simulation.to_string())
        .column("t", &series.t);
    for (name, column) in ["x1", "gap", "E1", "FconL", "FconR"].into_iter().zip(&series.columns) {
        answer = answer.column(name, column);
    }
    answer = answer.column("forcing.t", &moments).column("forcing", &forcing);
    for (name, column) in
        ["drawn.t", "drawn.x1", "drawn.v1", "drawn.x", "drawn.v"].into_iter().zip(&animated?)
    {
        answer = answer.column(name, column);
    }
    for (name, column) in CRESTS.into_iter().zip(&crests?) {
        answer = answer.column(name, column);
    }
    Ok(answer.column("contacts", &contacts))
}

fn visit(
    study: &Study,
    [from, to]: [f64; 2],
    (interval, events): (f64, bool),
    visit: &mut dyn FnMut(&Sample),
) -> Result<(), Refused> {
    let (settings, rows) = (study.solver.settings(), rows([from, to], interval, events)?);
    trajectory(&study.scene, Window { from, to }, &settings, rows, visit).map_err(Refused::whole)
}

/// x1, x2 - x1, E1 and both contact forces over time, thinned to pixels; and t and x2 - x1, alternating, at the largest force of each
/// contact.
///
/// # Errors
/// The run fails.
pub fn series(study: &Study, span: [f64; 2], columns: usize) -> Result<(Thin<5>, Vec<f64>), Refused> {
    let interval =
        ((span[1] - span[0]) / (ROWS_PER_COLUMN * columns as f64)).min(period(study) / ROWS_PER_PERIOD);
    let (mut series, mut contacts) = (Thinning::new(span, columns), Thinning::new(span, columns));
    visit(study, span, (interval, true), &mut |row: &Sample| {
        let [x1, _, x2, _] = row.state;
        series.push(row.t, [x1, x2 - x1, row.e1, row.forces[0], row.forces[1]]);
        if row.moment == Moment::ForceMax {
            contacts.push(row.t, [x2 - x1]);
        }
    })?;
    let Thin { t, columns: [places] } = contacts.finish();
    Ok((series.finish(), t.into_iter().zip(places).flat_map(|(t, place)| [t, place]).collect()))
}

/// The animated motion: the last periods, or the first of a transient: t, x1, v1, x2 - x1, v2 - v1.
fn animated(study: &Study) -> Result<[Vec<f64>; 5], Refused> {
    let (period, end) = (period(study), study.window.end.get());
    let mut columns: [Vec<f64>; 5] = Default::default();
    let span = match study.scene.forcing.is_transient() {
        true => [0.0, end.min(ANIMATED_PERIODS * period)],
        false => [(end - ANIMATED_PERIODS * period).max(0.0), end],
    };
    visit(study, span, (period / ANIMATED_ROWS, false), &mut |row: &Sample| {
        let [x1, v1, x2, v2] = row.state;
        columns
            .iter_mut()
            .zip([row.t, x1, v1, x2 - x1, v2 - v1])
            .for_each(|(column, value)| column.push(value));
    })?;
    Ok(columns)
}

/// The states at crests of the force in the window, as [`CRESTS`]; none without a period.
fn crests(study: &Study) -> Result<[Vec<f64>; 4], Refused> {
    let (period, end) = (period(study), study.window.end.get());
    let mut columns: [Vec<f64>; 4] = Default::default();
    let first = (study.window.t0.get() / period).ceil() * period;
    if study.scene.forcing.frequency.get() > 0.0 && first < end {
        visit(study, [first, end], (period, false), &mut |row: &Sample| {
            let [x1, v1, x2, v2] = row.state;
            columns.iter_mut().zip([x1, v1, x2 - x1, v2 - v1]).for_each(|(column, value)| column.push(value));
        })?;
    }
    Ok(columns)
}

/// The columns with the states at crests of the force.
pub const CRESTS: [&str; 4] = ["crest.x1", "crest.v1", "crest.x", "crest.v"];

/// x2 - x1 at touch-down on the structure and on the obstacle, m; none without walls.
fn walls(study: &Study) -> Option<[f64; 2]> {
    let damper = study.scene.damper.filter(|damper| damper.contact.is_some())?;
    let system = Coupled::new(&study.scene.primary, &study.scene.forcing, &damper);
    Some(retune_model::Side::BOTH.map(|side| system.wall(side)))
}

/// The main figures of a run, to four digits: its largest values and its impacts.
pub fn figures(simulation: &Simulation) -> Value {
    let run = &simulation.summary;
    let mut figures = largest(|measure| run.largest(measure));
    figures.insert(IMPACTS.to_owned(), json!(run.impacts()));
    figures.into()
}

/// One of the figures as text; a dash if there is none.
pub fn look_up(figures: &Value, measure: Measure) -> String {
    figures.get(measure.name()).and_then(Value::as_str).unwrap_or("–").to_owned()
}

/// The name of the number of impacts.
pub const IMPACTS: &str = "impacts";

/// The largest value of each quantity by its name, to four digits.
pub fn largest(of: impl Fn(Measure) -> f64) -> serde_json::Map<String, Value> {
    Measure::ALL
        .map(|measure| (measure.name().to_owned(), json!(rounded(of(measure), 4))))
        .into_iter()
        .collect()
}
