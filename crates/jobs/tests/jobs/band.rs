//! The worst over a band as an objective, from the study to the results.

use crate::{request, search};
use retune_jobs::tune::tune;
use retune_jobs::{Error, Request, Silent};
use retune_optim::Unusable;
use retune_testkit::desk::{Desk, committed, few_starts, flat, number, tiny};
use retune_testkit::observers::{good, refused};
use serde_json::{Value, json};

/// Rows of `band.csv`; an empty field is NaN.
fn band(desk: &Desk, out: &str) -> Vec<Vec<f64>> {
    let rows = desk.rows(&format!("{out}/band.csv"));
    assert_eq!(rows[0].join(","), "omega,E1max_none,E1max_study,E1max_tuned");
    let numbers =
        |row: &Vec<String>| row.iter().map(|field| field.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    rows[1..].iter().map(numbers).collect()
}

fn largest(rows: &[Vec<f64>], column: usize) -> f64 {
    rows.iter().map(|row| row[column]).fold(0.0, f64::max)
}

/// The H∞ optimum over [5, 8] rad/s, made by `tests/reference/tmd_band.py`.
#[test]
fn reference_the_study_of_the_tmd_over_the_band_finds_the_closed_form_optimum() {
    let desk = Desk::new();
    desk.write_json("tmd-free.json", &committed("tmd-free.json"));
    let report = flat(&search(&desk, "tmd-free.json", "out").report());
    assert!(report.contains("study tmd-free, worst over omega = 5 to 8 rad/s, steady; Retune "), "{report}");
    let optimum = desk.read_json("out/optimum.json");
    let e1_max = number(&optimum, "/E1max");
    assert!((number(&optimum, "/k2") - 2083.081).abs() < 0.01, "{}", number(&optimum, "/k2"));
    assert!((number(&optimum, "/c2") - 111.893).abs() < 0.01, "{}", number(&optimum, "/c2"));
    assert!((e1_max - 160.605_045).abs() < 1e-5, "{e1_max}");
    assert_eq!(optimum["objective"]["omega"], json!({ "from": 5.0, "to": 8.0, "samples": 61 }));
    assert_eq!(optimum["objective"]["response"], "steady");
    // The run of the best design is at its worst frequency, and late in it the motion is steady.
    let simulation = &optimum["simulation"];
    assert_eq!(simulation["omega"], optimum["objective"]["worst_omega"]);
    assert_eq!(simulation["scene"], "linear");
    assert!((number(simulation, "/E1max") / e1_max - 1.0).abs() < 1e-4);

    let rows = band(&desk, "out");
    assert_eq!((rows.len(), rows[0][0], rows[600][0]), (601, 5.0, 8.0));
    assert!((largest(&rows, 1) - 1568.0).abs() < 15.0 && (largest(&rows, 2) - 660.4).abs() < 0.5);
    let tuned = largest(&rows, 3);
    assert!(tuned <= e1_max && tuned > 0.9999 * e1_max, "{tuned}");
    assert!(desk.read("out/band.svg").contains("tuned for the band: 160.605 J"));
}

/// A short band of the impacting damper, evaluated by runs: below the resonance, where motions are regular and certificates quick.
pub fn ssvi_band() -> Value {
    let mut study = tiny();
    study["optimize"]["objective"] = json!({ "omega": { "from": 4.0, "to": 4.6, "samples": 5 } });
    few_starts(&mut study);
    study
}

#[test]
fn contract_a_band_of_runs_has_the_same_bytes_with_one_thread_and_two() {
    let desk = Desk::with(&ssvi_band());
    for (threads, out) in [(1, "1"), (2, "2")] {
        let request = request(&desk, "study.json", out);
        good(tune(&Request { threads: Some(threads), ..request }, &Silent));
    }
    let names = desk.names("1");
    assert!(names.contains(&"band.csv".to_owned()) && names.contains(&"band.svg".to_owned()), "{names:?}");
    desk.assert_same("1", "2");
    // The search reports the run of the best design at its worst frequency, and no sample exceeds it.
    let optimum = desk.read_json("1/optimum.json");
    let [found, run] = ["/E1max", "/simulation/E1max"].map(|path| number(&optimum, path));
    assert!((found / run - 1.0).abs() < 1e-12, "{found} {run}");
    let rows = band(&desk, "1");
    let expected = [4.0, 4.15, 4.3, 4.45, 4.6];
    let samples = rows.iter().step_by(4);
    assert!(rows.len() == 17 && samples.zip(expected).all(|(row, omega)| (row[0] - omega).abs() < 1e-12));
    assert!(rows.iter().step_by(4).all(|row| row[3] <= found));
    assert!(desk.read("1/fminsearch.txt").contains("worst over omega = 4 to 4.6 rad/s, t0 = 1 s, T = 4 s; "));
}

#[test]
fn contract_the_resolved_study_of_a_band_repeats_its_results() {
    let desk = Desk::with(&ssvi_band());
    search(&desk, "study.json", "first");
    search(&desk, "first/study.json", "again");
    // The manifest names the study file.
    for place in ["first", "again"] {
        desk.remove(&format!("{place}/manifest.json"));
    }
    desk.assert_same("first", "again");
}

/// A start whose steady motion reaches a wall has no value, and the error says where and by how much.
#[test]
fn contract_a_steady_motion_that_reaches_a_wall_is_an_error() {
    let mut study = committed("tmd-free.json");
    study["scene"]["damper"]["D"] = json!(0.01);
    study["optimize"]["surf"] = Value::Null;
    let desk = Desk::with(&study);
    let error = refused(tune(&request(&desk, "study.json", "out"), &Silent));
    let words = error.to_string();
    let Error::Search { failures, .. } = error else { panic!("{words}") };
    assert_eq!(failures.count, 1);
    let (_, reason) = *failures.example.expect("an example");
    let Unusable::Touches { omega, stroke, room } = reason else { panic!("{reason}") };
    assert!((5.0..=8.0).contains(&omega) && stroke > room && room == 0.01, "{reason}");
    assert!(words.contains("the damper reaches a wall: its steady stroke at omega = "), "{words}");
    assert!(words.contains("of which D and C leave 0.01 m"), "{words}");
}
