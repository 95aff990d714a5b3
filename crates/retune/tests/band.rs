//! The worst over a band as an objective, from the study to the results.

mod common;

use common::{Desk, studies, tiny};
use serde_json::{Value, json};

fn tmd_band() -> Value {
    let text = std::fs::read_to_string(studies().join("tmd-band.json")).expect("the study");
    serde_json::from_str(&text).expect("JSON")
}

/// Rows of `band.csv`; an empty field is NaN.
fn band(desk: &Desk, out: &str) -> Vec<Vec<f64>> {
    let text = desk.read(&format!("{out}/band.csv"));
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("omega,E1max_none,E1max_study,E1max_tuned"));
    lines.map(|line| line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect()).collect()
}

fn largest(rows: &[Vec<f64>], column: usize) -> f64 {
    rows.iter().map(|row| row[column]).fold(0.0, f64::max)
}

/// The H∞ optimum over [5, 8] rad/s, made by `tests/reference/tmd_band.py`.
#[test]
fn reference_the_study_of_the_tmd_over_the_band_finds_the_closed_form_optimum() {
    let desk = Desk::new();
    desk.write_json("tmd-band.json", &tmd_band());
    let screen = desk.good(&["optimize", "tmd-band.json", "--quiet"]);
    assert!(screen.contains("study tmd-band, worst over omega = 5 to 8 rad/s, steady; Retune "), "{screen}");
    let optimum = desk.read_json("results/tmd-band/optimum.json");
    let number = |name: &str| optimum[name].as_f64().expect(name);
    assert!((number("k2") - 2083.081).abs() < 0.01, "{}", number("k2"));
    assert!((number("c2") - 111.893).abs() < 0.01, "{}", number("c2"));
    assert!((number("E1max") - 160.605_045).abs() < 1e-5, "{}", number("E1max"));
    assert_eq!(optimum["objective"]["omega"], json!({ "from": 5.0, "to": 8.0, "samples": 61 }));
    assert_eq!(optimum["objective"]["response"], "steady");
    // The run of the best design is at its worst frequency, and late in it the motion is steady.
    let simulation = &optimum["simulation"];
    assert_eq!(simulation["omega"], optimum["objective"]["worst_omega"]);
    assert_eq!(simulation["scene"], "linear");
    assert!((simulation["E1max"].as_f64().expect("a number") / number("E1max") - 1.0).abs() < 1e-4);

    let rows = band(&desk, "results/tmd-band");
    assert_eq!((rows.len(), rows[0][0], rows[600][0]), (601, 5.0, 8.0));
    assert!((largest(&rows, 1) - 1568.0).abs() < 15.0 && (largest(&rows, 2) - 660.4).abs() < 0.5);
    let tuned = largest(&rows, 3);
    assert!(tuned <= number("E1max") && tuned > 0.9999 * number("E1max"), "{tuned}");
    assert!(desk.read("results/tmd-band/band.svg").contains("tuned for the band: 160.605 J"));
}

/// A short band of the impacting damper, evaluated by runs.
fn ssvi_band() -> Value {
    let mut study = tiny();
    study["optimize"]["objective"] = json!({ "omega": { "from": 6.0, "to": 6.6, "samples": 5 } });
    study
}

#[test]
fn contract_a_band_of_runs_has_the_same_bytes_with_one_thread_and_two() {
    let desk = Desk::new();
    desk.write_json("band.json", &ssvi_band());
    for threads in ["1", "2"] {
        desk.good(&["optimize", "band.json", "--quiet", "--threads", threads, "--out", threads]);
    }
    let names = desk.names("1");
    assert!(names.contains(&"band.csv".to_owned()) && names.contains(&"band.svg".to_owned()), "{names:?}");
    for name in &names {
        assert_eq!(desk.read(&format!("1/{name}")), desk.read(&format!("2/{name}")), "{name}");
    }
    // The search reports the run of the best design at its worst frequency, and no sample exceeds it.
    let optimum = desk.read_json("1/optimum.json");
    let [found, run] =
        [&optimum["E1max"], &optimum["simulation"]["E1max"]].map(|e| e.as_f64().expect("a number"));
    assert!((found / run - 1.0).abs() < 1e-12, "{found} {run}");
    let rows = band(&desk, "1");
    let expected = [6.0, 6.15, 6.3, 6.45, 6.6];
    let samples = rows.iter().step_by(4);
    assert!(rows.len() == 17 && samples.zip(expected).all(|(row, omega)| (row[0] - omega).abs() < 1e-12));
    assert!(rows.iter().step_by(4).all(|row| row[3] <= found));
    assert!(desk.read("1/fminsearch.txt").contains("worst over omega = 6 to 6.6 rad/s, t0 = 1 s, T = 4 s; "));
}

#[test]
fn contract_the_resolved_study_of_a_band_repeats_its_results() {
    let desk = Desk::new();
    desk.write_json("band.json", &ssvi_band());
    desk.good(&["optimize", "band.json", "--quiet", "--out", "first"]);
    desk.good(&["optimize", "first/study.json", "--quiet", "--out", "again"]);
    // The manifest names the study file.
    for name in desk.names("first").into_iter().filter(|name| name != "manifest.json") {
        assert_eq!(desk.read(&format!("first/{name}")), desk.read(&format!("again/{name}")), "{name}");
    }
}

#[test]
fn contract_check_says_what_is_minimised() {
    let desk = Desk::new();
    desk.write_json("band.json", &ssvi_band());
    let said = desk.good(&["check", "band.json"]);
    let line = "for the worst E1max over omega = 6 to 6.6 rad/s, in the window, on 5 samples and refined at their peaks";
    assert!(said.contains(line), "{said}");
    desk.write_json("steady.json", &tmd_band());
    let said = desk.good(&["check", "steady.json"]);
    assert!(said.contains("for the worst E1max over omega = 5 to 8 rad/s, steady, exact"), "{said}");
}

/// A start whose steady motion reaches a wall has no value, and the message says where and what to do.
#[test]
fn contract_a_steady_motion_that_reaches_a_wall_is_an_error() {
    let desk = Desk::new();
    let mut study = tmd_band();
    study["scene"]["damper"]["D"] = json!(0.01);
    study["optimize"]["surf"] = Value::Null;
    desk.write_json("walls.json", &study);
    let answer = desk.run(&["optimize", "walls.json", "--quiet"]);
    assert_eq!(answer.code, Some(1));
    assert!(
        answer.stderr.contains("the damper reaches a wall: its steady stroke at omega = "),
        "{}",
        answer.stderr
    );
    assert!(answer.stderr.contains("of which D and C leave 0.01 m"), "{}", answer.stderr);
}
