//! `track`: dampers tuned anew for other stiffnesses of the structure.

use crate::desk::{Desk, global};
use crate::observers::{Record, cut_off, good, refused};
use crate::{request, restart, resume};
use retune_store::Error as StoreError;
use retune_study::Setting;
use retune_tradeoff::track::track;
use retune_workbench::{Error, Silent};
use serde_json::json;

fn stiffnesses(k1: &[f64]) -> Vec<Setting> {
    k1.iter().map(|k1| Setting::new("k1", *k1)).collect()
}

/// The studies of Table 2 with short runs and coarse grids.
fn table2_desk(table: &str) -> Desk {
    Desk::with_table2(table, |study| {
        study["window"] = json!({ "t0": 1, "T": 4 });
        for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
            axis["points"] = json!(2);
        }
        study["optimize"]["refine"] = json!({ "MaxFunEvals": 20 });
    })
}

#[test]
fn contract_retune_tunes_both_dampers_for_each_stiffness() {
    let desk = table2_desk("table2.json");
    good(track(&request(&desk, "table2.json", "out"), &stiffnesses(&[3e4, 5e4]), &Silent));
    let rows: Vec<String> = desk.rows("out/retune.csv")[1..].iter().map(|row| row[..3].join(",")).collect();
    let expected =
        ["30000", "39500", "50000"].map(|k1| [format!("{k1},SSVI NES,60"), format!("{k1},TMD,60")]);
    assert_eq!(rows, expected.concat());
    assert_eq!(desk.read_json("out/k1-50000/tmd/study.json")["scene"]["primary"]["k1"], 5e4);
    let error = refused(track(&request(&desk, "table2.json", "bad"), &stiffnesses(&[3e4, -1.0]), &Silent));
    assert!(matches!(error, Error::Setting(_)), "{error}");
    assert!(!desk.path("bad").exists(), "nothing may be left behind");
}

/// The curves of retention: at the nominal k1 the original tuning is the re-tuned one.
#[test]
fn contract_retention_begins_at_the_tuned_design() {
    let desk = Desk::new();
    let mut study =
        global(json!({ "omega": { "from": 0.9, "to": 1.1, "samples": 2, "relative": true } }), json!({}));
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 20 });
    desk.write_json("one.json", &study);
    let row = json!({ "damper": "SSVI NES", "study": "one.json", "paper": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } });
    desk.write_json("retune.json", &json!({ "rows": [row] }));
    let record = Record::default();
    good(track(&request(&desk, "retune.json", "out"), &stiffnesses(&[3e4, 5e4]), &record));
    let words = "worst over omega = 0.9 to 1.1 times √(k1/m1), and from the design of the k1 beside it";
    assert!(record.all().contains(words), "{}", record.all());
    let rows = desk.rows("out/retention.csv");
    assert_eq!(rows[0].join(","), "k1,none,SSVI NES tuned for 39500,SSVI NES re-tuned");
    let at = |k1: &str| rows.iter().find(|row| row[0] == k1).expect("a row");
    assert_eq!(at("39500")[2], at("39500")[3]);
    let tuned = rows[1..].iter().filter(|row| !row[3].is_empty()).map(|row| &row[0]);
    assert_eq!(tuned.collect::<Vec<_>>(), ["30000", "39500", "50000"]);
    for k1 in ["30000", "50000"] {
        let [kept, anew] = [2, 3].map(|column: usize| at(k1)[column].parse::<f64>().expect("a number"));
        assert!(anew <= kept, "{k1}: {anew} {kept}");
    }
    // The neighbour's design is one of the starts.
    let resolved = desk.read_json("out/k1-50000/one/study.json");
    let home = desk.read_json("out/k1-39500/one/optimum.json");
    assert_eq!(resolved["optimize"]["starts"][0]["k2"], home["k2"]);
    assert!(
        desk.read("out/retention.svg").contains("SSVI NES re-tuned")
            && desk.read("out/path.svg").contains("</svg>")
    );
}

#[test]
fn contract_results_of_a_run_are_exactly_its_own() {
    let desk = table2_desk("mine.json");
    good(track(&request(&desk, "mine.json", "out"), &stiffnesses(&[3e4, 5e4]), &Silent));
    let parts = || {
        let mut names = desk.names("out");
        names.retain(|name| name.starts_with("k1-"));
        names
    };
    assert_eq!(parts(), ["k1-30000", "k1-39500", "k1-50000"]);
    desk.write("out/k1-30000/tmd/notes.txt", "mine");
    desk.write("out/k1-77/notes.txt", "mine");
    good(track(&request(&desk, "mine.json", "out"), &stiffnesses(&[2e4]), &Silent));
    assert_eq!(parts(), ["k1-20000", "k1-30000", "k1-39500", "k1-77"]);
    assert_eq!(desk.names("out/k1-30000"), ["tmd"]);
    assert_eq!(desk.names("out/k1-30000/tmd"), ["notes.txt"]);
    let error = refused(retune_workbench::table2::table2(&request(&desk, "mine.json", "out"), &Silent));
    assert!(matches!(error, Error::Store(StoreError::Standing { .. })), "{error}");
}

/// Interrupted work on other stiffnesses is unfinished work, in any directory below.
#[test]
fn contract_unfinished_searches_below_are_found() {
    let desk = table2_desk("mine.json");
    cut_off(40, |watch| track(&request(&desk, "mine.json", "out"), &stiffnesses(&[3e4]), watch));
    assert!(desk.path("out/k1-30000/ssvi/unfinished/journal").exists(), "{:?}", desk.names("out"));
    let other = stiffnesses(&[2e4]);
    for request in [request(&desk, "mine.json", "out"), resume(&desk, "mine.json", "out")] {
        let error = refused(track(&request, &other, &Silent));
        let Error::Store(StoreError::Unfinished { lines, damaged: 0, difference: Some(difference), path }) =
            error
        else {
            panic!("{error}")
        };
        assert!(lines > 0 && difference.starts_with("of another study (SHA-256 "), "{difference}");
        assert_eq!(path, desk.path("out"));
    }
    good(track(&restart(&desk, "mine.json", "out"), &other, &Silent));
    assert!(!desk.path("out/k1-30000").exists());
    good(track(&request(&desk, "mine.json", "whole"), &other, &Silent));
    desk.assert_same("out", "whole");
}
