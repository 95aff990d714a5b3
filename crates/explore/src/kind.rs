//! The kind of motion that a run settles to and, if it is irregular, the spread of neighbouring runs.

use crate::limits::{of_periods, rows};
use crate::motion::{CRESTS, period};
use crate::protocol::Answer;
use crate::response::Stale;
use crate::thin::Spread;
use rayon::prelude::*;
use retune_dynamics::record::state;
use retune_dynamics::{Kind, Record, Regime, Stretch, classify, follow};
use retune_model::Source;
use retune_optim::Ensemble;
use retune_solver::{Sample, Window, trajectory};
use retune_study::{Study, rounded};

/// Neighbours of an irregular motion: k1, k2, c2, D and C within 0.1 %. Like the motion itself, each begins at a crest of the force.
const NEIGHBOURS: Ensemble =
    Ensemble { members: 24, phases: false, errors: 1e-3, statistic: retune_optim::Statistic::Worst, seed: 0 };

/// The kind of the settled motion of a study, and its states at crests of the force; also whether it is irregular.
pub fn kind(study: &Study) -> (Answer, bool) {
    let answer = Answer::new("motion kind");
    let scene = &study.scene;
    if scene.damper.is_none() || scene.forcing.frequency.get() == 0.0 || scene.forcing.is_transient() {
        let label = match scene.forcing.source {
            Source::History(_) => "transient",
            _ if scene.forcing.frequency.get() == 0.0 => "free decay",
            _ => "1T, linear",
        };
        return (answer.with("label", label).with("irregular", false), false);
    }
    let record = match follow(scene, None, Stretch::default(), &of_periods(study)) {
        Ok(record) => record,
        Err(error) => return (answer.with("label", "unknown").with("problem", error.to_string()), false),
    };
    let regime = classify(&record);
    let irregular = matches!(regime.kind, Kind::Chaotic | Kind::Intermittent);
    let answer = answer
        .with("label", regime.label())
        .with("words", words(&regime))
        .with("irregular", irregular)
        .with("exponent", rounded(regime.exponent.value, 3));
    (
        crests(study, &record)
            .into_iter()
            .zip(CRESTS)
            .fold(answer, |a, (column, name)| a.column(name, &column)),
        irregular,
    )
}

fn words(regime: &Regime) -> String {
    let on = |impacts: f64, wall: &str| {
        let count = rounded(impacts, 3);
        format!("{count} {} on the {wall}", if count == "1" { "impact" } else { "impacts" })
    };
    let [structure, obstacle] = regime.impacts;
    let each = match structure + obstacle {
        0.0 => "without impacts".to_owned(),
        _ => format!("with {} and {}", on(structure, "structure"), on(obstacle, "obstacle")),
    };
    match (regime.kind, regime.period) {
        (Kind::Periodic, Some(1)) => format!("repeats every period of the force, {each}"),
        (Kind::Periodic, Some(n)) => format!("repeats every {n} periods of the force, {each}"),
        (kind, _) => format!("{}, {each} per period of the force", kind.words()),
    }
}

/// x1, v1, x2 - x1 and v2 - v1 at the settled crests.
fn crests(study: &Study, record: &Record) -> [Vec<f64>; 4] {
    let mut columns: [Vec<f64>; 4] = Default::default();
    for sample in &record.samples[record.settle.min(record.samples.len())..] {
        let [x1, v1, x2, v2] = state(&study.scene, sample);
        columns.iter_mut().zip([x1, v1, x2 - x1, v2 - v1]).for_each(|(column, value)| column.push(value));
    }
    columns
}

/// The spread of E1 over the neighbours of a run: of E1max, and at each time of a span.
///
/// # Errors
/// The work has become stale.
pub fn spread(
    study: &Study,
    span: [f64; 2],
    columns: usize,
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<Answer, Stale> {
    let settings = study.solver.settings();
    let window = Window { from: span[0], to: span[1] };
    let columns = columns.min(400);
    let interval = ((span[1] - span[0]) / (4 * columns) as f64).min(period(study) / 24.0);
    let Ok(rows) = rows(span, interval, true) else { return Ok(Answer::new("spread").with("members", 0)) };
    let member = |i: u32| {
        if is_stale() {
            return Err(Stale);
        }
        let Ok((scene, _)) = NEIGHBOURS.member(&study.scene, i) else { return Ok(None) };
        let mut spread = Spread::new(span, columns);
        let visit = &mut |row: &Sample| spread.push(row.t, row.e1);
        let run = trajectory(&scene, window, &settings, rows, visit);
        let peak = retune_solver::e1_max(&scene, study.window.window(), &settings, f64::INFINITY);
        Ok(run.ok().zip(peak.ok()).map(|((), peak)| (spread, peak.value)))
    };
    let members = (0..NEIGHBOURS.members).into_par_iter().map(member).collect::<Result<Vec<_>, Stale>>()?;
    let mut all = Spread::new(span, columns);
    let mut peaks = Vec::new();
    for (spread, peak) in members.into_iter().flatten() {
        peaks.push(peak);
        for (all, own) in all.ends.iter_mut().zip(&spread.ends) {
            *all = [all[0].min(own[0]), all[1].max(own[1])];
        }
    }
    peaks.sort_by(f64::total_cmp);
    let ends = peaks.first().zip(peaks.last()).map(|(least, largest)| [*least, *largest]);
    let times: Vec<f64> = (0..all.ends.len()).map(|column| all.at(column)).collect();
    let [least, largest] = [0, 1].map(|end| all.ends.iter().map(|ends| ends[end]).collect::<Vec<f64>>());
    Ok(Answer::new("spread")
        .with("members", peaks.len())
        .with("ends", ends.map(|ends| ends.map(|value| rounded(value, 4))))
        .with("range", ends)
        .column("t", &times)
        .column("least", &least)
        .column("largest", &largest))
}
