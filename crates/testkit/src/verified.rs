//! Results that are verified.

use crate::desk::{Desk, altered, tiny};
use crate::observers::Record;
use retune_jobs::Error;
use retune_jobs::verify::verify;
use serde_json::json;

/// The outcome of a verification.
#[derive(Debug, PartialEq)]
pub enum End {
    /// Everything that was checked holds.
    Holds,
    /// Something does not hold.
    Not(String),
    /// Something cannot be checked; all else holds.
    Unchecked(String),
}

/// Verifies the results in a directory of the desk; returns the report and the outcome.
#[track_caller]
pub fn look(desk: &Desk, out: &str, sample: usize, within: f64) -> (String, End) {
    let record = Record::default();
    let end = match verify(&desk.path(out), sample, within, &record) {
        Ok(()) => End::Holds,
        Err(Error::NotHeld { path, problem }) if path == desk.path(out) => End::Not(problem),
        Err(Error::NotChecked { path, problem }) if path == desk.path(out) => End::Unchecked(problem),
        Err(other) => panic!("{other}"),
    };
    let said = record.results();
    assert_eq!(end == End::Holds, said.contains("holds: "), "{said}");
    (said, end)
}

/// Verifies results that must hold; returns the report.
#[track_caller]
pub fn holds(desk: &Desk, out: &str, sample: usize) -> String {
    let (said, end) = look(desk, out, sample, 0.0);
    assert_eq!(end, End::Holds, "{said}");
    said
}

/// A study of a few runs, `study.json`, and a table and fronts of its damper, `table2.json` and `fronts.json`.
pub fn desk() -> Desk {
    let mut study = tiny();
    study["optimize"]["surf"] = json!(null);
    study["optimize"]["vary"] = json!(["k2", "c2"]);
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 8 });
    study["optimize"]["objective"] =
        json!({ "omega": { "from": 7.5, "to": 7.8, "samples": 2 }, "starts": 1 });
    let desk = Desk::with(&study);
    let damper = json!({ "damper": "NES, \"single-sided\"", "study": "study.json" });
    let mut row = damper.clone();
    row["reference"] = json!({ "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 });
    desk.write_json("table2.json", &json!({ "rows": [row] }));
    let fronts = json!({ "dampers": [damper], "k2": [300], "stroke": [0.9], "samples": 5 });
    desk.write_json("fronts.json", &fronts);
    desk
}

/// Verifies results that must hold, then again with one digit changed in each of `files`.
#[track_caller]
pub fn a_changed_digit_is_found(desk: &Desk, out: &str, files: &[&str]) {
    let said = holds(desk, out, 20);
    assert!(said.contains("files as they were made\n"), "{said}");
    for name in files {
        let line = said.lines().find(|line| line.starts_with(&format!("  {name} "))).expect(name);
        assert!(line.ends_with(": the same to the last bit"), "{line}");
        assert!(!line.contains(" 0 of "), "{line}");
        let file = format!("{out}/{name}");
        let whole = desk.read(&file);
        desk.write(&file, altered(&whole));
        let End::Not(problem) = look(desk, out, 1000, 0.0).1 else { panic!("{name}: it holds") };
        assert!(problem.contains(&format!("{name} is not as it was made; ")), "{problem}");
        assert!(problem.contains(&format!("{name}, 1 differs, by at most ")), "{problem}");
        desk.write(&file, whole);
    }
}
