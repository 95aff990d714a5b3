//! `retention`: dampers tuned anew for other stiffnesses of the structure.

use crate::{request, restart, resume};
use retune_jobs::retention::{Point, retention};
use retune_jobs::{Done, Error, Silent};
use retune_model::Parameter;
use retune_store::Error as StoreError;
use retune_study::Setting;
use retune_testkit::desk::{Desk, committed, few_starts, global};
use retune_testkit::observers::{Record, cut_off, good, refused};
use serde_json::json;

fn stiffnesses(k1: &[f64]) -> Vec<Setting> {
    k1.iter().map(|k1| Setting::new(Parameter::K1, *k1)).collect()
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
    good(retention(&request(&desk, "table2.json", "out"), &stiffnesses(&[3e4, 5e4]), &Silent));
    let rows: Vec<String> = desk.rows("out/retune.csv")[1..].iter().map(|row| row[..3].join(",")).collect();
    let tunings = ["paper", "k1 = 30000", "k1 = 39500", "k1 = 50000", "k1-robust"];
    let expected = ["SSVI NES", "TMD"].map(|damper| tunings.map(|tuning| format!("{tuning},{damper},60")));
    assert_eq!(rows, expected.concat());
    assert_eq!(desk.read_json("out/k1-50000/tmd/study.json")["scene"]["primary"]["k1"], 5e4);
    let error =
        refused(retention(&request(&desk, "table2.json", "bad"), &stiffnesses(&[3e4, -1.0]), &Silent));
    assert!(matches!(error, Error::Setting(_)), "{error}");
    assert!(!desk.path("bad").exists(), "nothing may be left behind");
}

/// A study of one damper over a band that moves with k1, in a table.
fn moving() -> Desk {
    let desk = Desk::new();
    let omega = json!({ "from": 1.2, "to": 1.3, "samples": 2, "relative": true });
    let mut study = global(json!({ "omega": omega }), json!({}));
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 20 });
    desk.write_json("one.json", &study);
    let row = json!({ "damper": "SSVI NES", "study": "one.json", "reference": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } });
    desk.write_json("retune.json", &json!({ "rows": [row], "samples": 5 }));
    desk
}

/// At the nominal k1 the nominal tuning is the re-tuned one; at others tuning anew is no worse.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_retention_begins_at_the_tuned_design() {
    let desk = moving();
    let record = Record::default();
    good(retention(&request(&desk, "retune.json", "out"), &stiffnesses(&[3e4, 5e4]), &record));
    let words = "worst over omega = 1.2 to 1.3 times √(k1/m1), and from the design of the k1 beside it";
    assert!(record.all().contains(words), "{}", record.all());
    let rows = desk.rows("out/retention.csv");
    assert_eq!(rows[0].join(","), "damper,tuning,band,k1,E1max");
    let at = |tuning: &str, band: &str, k1: &str| -> f64 {
        let is_it = |row: &&Vec<String>| row[1] == tuning && row[2] == band && row[3] == k1;
        rows.iter().find(is_it).expect("a row")[4].parse().expect("a number")
    };
    assert_eq!(at("nominal", "own", "39500"), at("re-tuned", "own", "39500"));
    let tuned = rows[1..].iter().filter(|row| row[1] == "re-tuned").map(|row| &row[3]);
    assert_eq!(tuned.collect::<Vec<_>>(), ["30000", "39500", "50000"]);
    for tuning in ["none", "paper", "k1-robust"] {
        assert!(rows[1..].iter().filter(|row| row[1] == tuning).count() >= 61, "{tuning}");
    }
    // A band that stays is the same band at the nominal k1 alone, but for the rounding of its ends.
    for tuning in ["none", "nominal"] {
        let ratio = |k1: &str| at(tuning, "still", k1) / at(tuning, "own", k1) - 1.0;
        assert!(ratio("39500").abs() < 1e-6 && ratio("30000").abs() > 1e-3, "{tuning} {}", ratio("39500"));
    }
    // The neighbour's design, its spring in proportion, is one of the starts.
    let resolved = desk.read_json("out/k1-50000/one/study.json");
    let home = desk.read_json("out/k1-39500/one/optimum.json");
    let ratio = 5e4 / 3.95e4;
    let near = |a: &serde_json::Value, b: f64| (a.as_f64().expect("a number") / b - 1.0).abs() < 1e-12;
    assert!(near(&resolved["optimize"]["starts"][0]["k2"], ratio * home["k2"].as_f64().expect("k2")));
    assert_eq!(resolved["optimize"]["starts"][0]["D"], home["D"]);
    let page = desk.read("out/README.md");
    assert!(page.contains("on 5 frequencies") && page.contains("(range.svg)"), "{page}");
    let place = |words: &str| page.find(words).expect("it stands there");
    assert!(
        place("(range.svg)") < place("(retention.svg)")
            && place("Tuned for the worst") < place("Each design")
    );
    // The force of the study comes first, and with it the design's own E1max.
    let forces = desk.rows("out/force.csv");
    let home: f64 = forces[1][3].parse().expect("a number");
    assert_eq!(
        (forces[1][1].as_str(), forces[1][2].as_str(), home),
        ("kept", "800", at("nominal", "own", "39500"))
    );
    assert!(desk.read("out/report.html").contains("</html>"));
    for figure in ["retention.svg", "path.svg", "range.svg", "still.svg", "force.svg"] {
        assert!(desk.read(&format!("out/{figure}")).contains("</svg>"), "{figure}");
    }
}

/// A structure of other stiffness may have a spring of the same ratio, unless the table says otherwise. The damper has no walls, so that its
/// searches and certificates are quick.
#[test]
fn contract_bounds_on_k2_follow_k1_unless_they_are_fixed() {
    let desk = moving();
    let mut study = committed("retune-tmd-free.json");
    let damper = study["scene"]["damper"].as_object_mut().expect("a damper");
    for wall in ["D", "C", "contact"] {
        damper.remove(wall);
    }
    let mut table = desk.read_json("retune.json");
    table["rows"][0]["reference"] = json!({ "k2": 215, "c2": 232 });
    desk.write_json("retune.json", &table);
    study["optimize"]["bounds"]["k2"] = json!([10, 1000]);
    study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 20 });
    few_starts(&mut study);
    desk.write_json("one.json", &study);
    let bounds = |out: &str| {
        good(retention(&request(&desk, "retune.json", out), &stiffnesses(&[7.9e4]), &Silent));
        let study = |place: &str| desk.read_json(&format!("{out}/{place}/one/study.json"));
        ["k1-79000", "k1-39500", "k1-robust"].map(|place| study(place)["optimize"]["bounds"]["k2"].clone())
    };
    assert_eq!(bounds("scaled"), [json!([20.0, 2000.0]), json!([10.0, 1000.0]), json!([10.0, 1000.0])]);
    table["k2_bounds"] = json!("fixed");
    desk.write_json("retune.json", &table);
    assert_eq!(bounds("fixed"), [json!([10.0, 1000.0]), json!([10.0, 1000.0]), json!([10.0, 1000.0])]);
    let robust = desk.read_json("fixed/k1-robust/one/study.json");
    assert_eq!(robust["optimize"]["objective"]["k1"]["set"], json!([39500.0, 79000.0]));
    table["samples"] = json!(1);
    desk.write_json("retune.json", &table);
    let error = refused(retention(&request(&desk, "retune.json", "bad"), &stiffnesses(&[3e4]), &Silent));
    assert!(error.to_string().contains("samples: 1 is not allowed here: give a whole number"), "{error}");
}

/// A design loses what it does at both ends of its range, and no design of the front is dominated by another.
#[test]
fn invariant_ranges_end_where_half_of_the_work_ends() {
    let desk = moving();
    let mut study = committed("retune-tmd-free.json");
    study["optimize"]["global"] = json!({ "samples": 16, "searches": 1, "evaluations": 60 });
    desk.write_json("tmd.json", &study);
    let paper = json!({ "k2": 2000, "c2": 150, "D": 2.08, "C": 4.7 });
    desk.write_json(
        "tmds.json",
        &json!({ "rows": [{ "damper": "TMD", "study": "tmd.json", "reference": paper }] }),
    );
    let done = good(retention(&request(&desk, "tmds.json", "out"), &stiffnesses(&[3e4]), &Silent));
    let Done::Made(retained) = done else { panic!("it was finished before") };
    let (damper, threshold) = (&retained.dampers[0], &retained.dampers[0].thresholds[0]);
    let mut count = 0;
    for point in retained.kept.iter().chain(&retained.points) {
        let range = point.range().expect("a range");
        assert!(range.from < damper.nominal() && damper.nominal() < range.to, "{range:?}");
        let share = |k1: f64| damper.energy(&point.at, k1) / threshold.at(k1);
        for (end, outwards) in [(range.from, 0.999), (range.to, 1.001)] {
            assert!(share(end) <= 1.0 && share(end * outwards) > 1.0, "{end}: {}", share(end));
        }
        count += 1;
    }
    assert!(count > 10, "{count}");
    // A linear damper leaves the same share under any force; at home the widest range stands first.
    assert!(retained.forced.len() == 1 && retained.forced[0].is_constant(), "{:?}", retained.forced);
    // The design that is given is not one of the paper.
    assert!(desk.read("out/retune.csv").contains("of the study,TMD,"));
    assert!(desk.read("out/retune.txt").contains("the design of the study is not certified here"));
    let page = desk.read("out/README.md");
    assert!(page.starts_with("# How long a tuning lasts\n\n- At equal performance at home"), "{page}");
    let front: Vec<&Point> = retained
        .points
        .iter()
        .filter(|point| !retained.points.iter().any(|other| other.dominates(point)))
        .collect();
    let [least, widest] = [front.first(), front.last()].map(|point| point.expect("a front"));
    assert!(least.e1_max < widest.e1_max && least.factor() < widest.factor(), "{least:?} {widest:?}");
}

#[test]
fn contract_results_of_a_run_are_exactly_its_own() {
    let desk = table2_desk("mine.json");
    good(retention(&request(&desk, "mine.json", "out"), &stiffnesses(&[3e4, 5e4]), &Silent));
    let parts = || {
        let mut names = desk.names("out");
        names.retain(|name| name.starts_with("k1-"));
        names
    };
    assert_eq!(parts(), ["k1-30000", "k1-39500", "k1-50000", "k1-robust"]);
    desk.write("out/k1-30000/tmd/notes.txt", "mine");
    desk.write("out/k1-77/notes.txt", "mine");
    good(retention(&request(&desk, "mine.json", "out"), &stiffnesses(&[2e4]), &Silent));
    assert_eq!(parts(), ["k1-20000", "k1-30000", "k1-39500", "k1-77", "k1-robust"]);
    assert_eq!(desk.names("out/k1-30000"), ["tmd"]);
    assert_eq!(desk.names("out/k1-30000/tmd"), ["notes.txt"]);
    let error = refused(retune_jobs::table2::table2(&request(&desk, "mine.json", "out"), &Silent));
    assert!(matches!(error, Error::Store(StoreError::Standing { .. })), "{error}");
}

/// Interrupted work on other stiffnesses is unfinished work, in any directory below.
#[test]
fn contract_unfinished_searches_below_are_found() {
    let desk = table2_desk("mine.json");
    cut_off(40, |watch| retention(&request(&desk, "mine.json", "out"), &stiffnesses(&[3e4]), watch));
    assert!(desk.path("out/k1-30000/ssvi/unfinished/journal").exists(), "{:?}", desk.names("out"));
    let other = stiffnesses(&[2e4]);
    for request in [request(&desk, "mine.json", "out"), resume(&desk, "mine.json", "out")] {
        let error = refused(retention(&request, &other, &Silent));
        let Error::Store(StoreError::Unfinished { lines, damaged: 0, difference: Some(difference), path }) =
            error
        else {
            panic!("{error}")
        };
        assert!(lines > 0 && difference.starts_with("of another study (SHA-256 "), "{difference}");
        assert_eq!(path, desk.path("out"));
    }
    good(retention(&restart(&desk, "mine.json", "out"), &other, &Silent));
    assert!(!desk.path("out/k1-30000").exists());
    good(retention(&request(&desk, "mine.json", "whole"), &other, &Silent));
    desk.assert_same("out", "whole");
}
