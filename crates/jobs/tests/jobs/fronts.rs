//! Pareto fronts of dampers: the least E1max under bounds on the spring and on the stroke.

use crate::{request, resume};
use retune_jobs::describe;
use retune_jobs::fronts::fronts;
use retune_jobs::{Error, Request, Silent};
use retune_model::Parameter;
use retune_study::{Rule, StudyError};
use retune_testkit::desk::{Desk, committed, count_lines, few_starts};
use retune_testkit::observers::{cut_off_before, good, refused};
use serde_json::json;

/// A study of fronts with searches of a few runs.
fn desk() -> Desk {
    let desk = Desk::new();
    let fronts = json!({
        "dampers": [
            { "damper": "TMD", "study": "tmd.json" },
            { "damper": "SSVI NES", "study": "ssvi.json" }
        ],
        "k2": [400, 100],
        "stroke": [0.1, 0.4],
        "contact_force": [20000],
        "samples": 5,
        "check": 9,
        "certificates": 1,
        "rounds": 1
    });
    desk.write_json("fronts.json", &fronts);
    for (name, base) in [("tmd.json", "fronts-tmd.json"), ("ssvi.json", "fronts-ssvi.json")] {
        let mut study = committed(base);
        study["window"] = json!({ "t0": 6, "T": 10 });
        // Beside the resonance, where motions are regular and certificates quick.
        let band = &mut study["optimize"]["objective"]["omega"];
        (band["from"], band["to"], band["samples"]) = (json!(7.2), json!(7.8), json!(3));
        study["optimize"]["global"] = json!({ "samples": 8, "searches": 1, "evaluations": 10 });
        study["optimize"]["refine"] = json!({ "scaled": true, "MaxFunEvals": 10 });
        few_starts(&mut study);
        desk.write_json(name, &study);
    }
    desk
}

/// The columns of a table: bound, damper, E1max, k2, stroke.
fn rows(desk: &Desk, name: &str) -> Vec<(f64, String, f64, f64, f64)> {
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let row = |fields: &Vec<String>| {
        (number(&fields[0]), fields[1].clone(), number(&fields[2]), number(&fields[4]), number(&fields[8]))
    };
    desk.rows(name)[1..].iter().map(row).collect()
}

#[test]
#[ignore = "slow: `just lab test-slow`"]
fn invariant_a_looser_bound_is_never_worse_and_each_is_kept() {
    let desk = desk();
    // With one thread here, with two below.
    good(fronts(&Request { threads: Some(1), ..request(&desk, "fronts.json", "out") }, &Silent));
    let names = desk.names("out");
    for name in [
        "README.md",
        "report.html",
        "front.csv",
        "front.svg",
        "k2.csv",
        "k2.svg",
        "stroke.csv",
        "contact_force.svg",
    ] {
        assert!(names.iter().any(|other| other == name), "{name} is not among {names:?}");
    }
    assert!(!names.iter().any(|name| name == "unfinished"));
    for table in ["k2", "stroke"] {
        let rows = rows(&desk, &format!("out/{table}.csv"));
        assert_eq!(rows.len(), 4);
        for damper in ["TMD", "SSVI NES"] {
            let own: Vec<_> = rows.iter().filter(|row| row.1 == damper).collect();
            assert!(own[0].0 < own[1].0 && (own[0].2.is_nan() || own[1].2 <= own[0].2), "{own:?}");
            for (bound, _, _, k2, stroke) in own {
                let reached = if table == "k2" { k2 } else { stroke };
                assert!(reached.is_nan() || *reached <= bound * (1.0 + 1e-5), "{rows:?}");
            }
        }
    }
    let page = desk.read("out/README.md");
    assert!(
        page.starts_with("# What the SSVI NES is good for\n")
            && page.contains("on 5 frequencies")
            && page.contains("on 9 frequencies"),
        "{page}"
    );

    let force = desk.rows("out/contact_force.csv");
    assert!(force[0][..4] == ["contact_force_most", "damper", "E1max", "E1max_check"], "{force:?}");
    for row in force[1..].iter().filter(|row| !row[2].is_empty()) {
        let number = |i: usize| row[i].parse::<f64>().expect("a number");
        assert!(number(9) <= 2e4, "{row:?}");
        // What the structure does from rest on is at least what it does in the window.
        assert!(number(10) >= 0.9 * (2.0 * number(2) / 6.4e4).sqrt(), "{row:?}");
    }

    good(fronts(&Request { threads: Some(2), ..request(&desk, "fronts.json", "two") }, &Silent));
    desk.assert_same("out", "two");
}

/// A small front, cut off before its best designs are looked at on the finest samples, and after: what was seen there is kept.
#[test]
fn contract_fronts_that_are_cut_off_resume_and_end_in_the_same_bytes() {
    let desk = desk();
    let mut plan = desk.read_json("fronts.json");
    for (field, value) in [("k2", json!([100])), ("stroke", json!([])), ("contact_force", json!([]))] {
        plan[field] = value;
    }
    desk.write_json("fronts.json", &plan);
    good(fronts(&request(&desk, "fronts.json", "whole"), &Silent));
    let kept = [1, 2].map(|times| {
        let stage = ("best designs, looked at once more", times);
        let out = format!("cut-{times}");
        cut_off_before(stage, |watch| fronts(&request(&desk, "fronts.json", &out), watch));
        count_lines(&desk.path(&out).join("unfinished/journal"))
    });
    assert_eq!(kept[1], kept[0] + 2, "a line for each damper");
    good(fronts(&resume(&desk, "fronts.json", "cut-2"), &Silent));
    desk.assert_same("whole", "cut-2");
}

/// No search comes to a spring as soft as this, so nothing dominates the design.
#[test]
fn contract_a_design_that_is_known_stands_beside_those_that_are_found() {
    let desk = desk();
    let mut plan = desk.read_json("fronts.json");
    plan["dampers"][1]["designs"] = json!([{ "k2": 12.5, "C": 0.5 }]);
    for (field, value) in [("k2", json!([100])), ("stroke", json!([])), ("contact_force", json!([]))] {
        plan[field] = value;
    }
    desk.write_json("fronts.json", &plan);
    good(fronts(&request(&desk, "fronts.json", "out"), &Silent));
    let front = desk.rows("out/front.csv");
    // What it leaves out is as in the scene: c2 and D.
    let own = ["12.5", "232", "0.06", "0.5"];
    assert!(front.iter().any(|row| row[0] == "SSVI NES" && row[3..7] == own), "{front:?}");
    // Each was evaluated on the finest samples, and stands there once.
    assert!(front.iter().all(|row| !row[2].is_empty()), "{front:?}");
    let mut designs: Vec<&[String]> = front.iter().map(|row| &row[3..7]).collect();
    designs.sort();
    designs.dedup();
    assert_eq!(designs.len(), front.len(), "{front:?}");
}

/// The damper of a study is stiffer than a bound, and its search begins there: it begins at the bound.
#[test]
fn regress_a_search_begins_within_a_bound_that_the_damper_of_its_study_breaks() {
    let desk = desk();
    let mut study = desk.read_json("tmd.json");
    study["optimize"]["global"].take();
    study["scene"]["damper"]["k2"] = json!(500);
    desk.write_json("tmd.json", &study);
    let plan = retune_study::read_fronts(&desk.path("fronts.json")).expect("a plan");
    let (_, tmd) = &plan.dampers[0];
    let bounded = retune_study::bounded(tmd, retune_study::Sweep::K2, 100.0, Vec::new()).expect("a study");
    assert!(bounded.search().is_ok());
    let starts = bounded.optimize.expect("a search").starts;
    assert_eq!(starts.iter().map(|start| start.get(Parameter::K2)).collect::<Vec<_>>(), [Some(100.0)]);
}

#[test]
fn contract_a_wrong_study_of_fronts_is_refused_with_a_remedy() {
    let desk = desk();
    let plan = retune_study::read_fronts(&desk.path("fronts.json")).expect("a plan");
    assert!(describe::fronts(&plan).contains("each for k2 at most 100, 400 N/m"));
    let good = desk.read_json("fronts.json");
    let rule = |plan: &serde_json::Value| {
        desk.write_json("wrong.json", plan);
        let error = refused(fronts(&request(&desk, "wrong.json", "wrong"), &Silent));
        assert!(!desk.path("wrong").exists(), "nothing may be left behind");
        error
    };
    for (field, bad, words) in [
        ("dampers", json!([]), "dampers: an empty list is not allowed here: give at least one"),
        ("k2", json!([100, 5]), "k2[1]: 5 N/m, with a smallest k2 of 10 N/m in "),
        ("samples", json!(1), "samples: 1 is not allowed here: give a whole number from 2 to 10000"),
        ("rounds", json!(25), "rounds: 25 is not allowed here: give a whole number from 0 to 24"),
    ] {
        let mut plan = good.clone();
        plan[field] = bad.clone();
        match rule(&plan) {
            Error::Study(StudyError::Rule { rule, .. }) => {
                assert!(rule.to_string().starts_with(words), "{field} = {bad}: {rule}");
            }
            other => panic!("{field} = {bad}: {other}"),
        }
    }
    let mut plan = good.clone();
    for sweep in ["k2", "stroke", "contact_force"] {
        plan[sweep] = json!([]);
    }
    let words =
        "k2: an empty list is not allowed here: give at least one bound on k2, stroke or contact_force";
    assert!(rule(&plan).to_string().ends_with(words));
    let mut plan = good.clone();
    plan["stroke"] = json!([-1]);
    match rule(&plan) {
        Error::Study(StudyError::Field { problem, .. }) => {
            assert!(problem.starts_with("stroke[0]: "), "{problem}");
        }
        other => panic!("{other}"),
    }
    let mut plan = good.clone();
    plan["dampers"][1]["designs"] = json!([{ "k2": 100 }, { "C": -1 }]);
    let words =
        "dampers[1].designs[1].C: -1 is not allowed here: give what the damper of the study has and may be";
    assert!(rule(&plan).to_string().ends_with(words));
    let mut plan = good;
    plan["dampers"][1]["study"] = json!("tmd.json");
    match rule(&plan) {
        Error::Study(StudyError::Rule { rule: Rule::NotAllowed { field, allowed, .. }, .. }) => {
            assert_eq!((field.as_str(), allowed), ("dampers", "each name and each study once"));
        }
        other => panic!("{other}"),
    }
}
