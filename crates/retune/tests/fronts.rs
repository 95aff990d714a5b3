//! Pareto fronts of dampers: the least E1max under bounds on the spring and on the stroke.

mod common;

use common::{Desk, studies};
use serde_json::{Value, json};

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
        "samples": 5,
        "certificates": 1
    });
    desk.write_json("fronts.json", &fronts);
    for (name, base) in [("tmd.json", "fronts-tmd.json"), ("ssvi.json", "fronts-ssvi.json")] {
        let text = std::fs::read_to_string(studies().join(base)).expect(base);
        let mut study: Value = serde_json::from_str(&text).expect("JSON");
        study["window"] = json!({ "t0": 10, "T": 15 });
        study["optimize"]["objective"]["omega"]["samples"] = json!(3);
        study["optimize"]["global"] = json!({ "samples": 16, "searches": 1, "evaluations": 20 });
        study["optimize"]["refine"] = json!({ "scaled": true, "MaxFunEvals": 20 });
        desk.write_json(name, &study);
    }
    desk
}

/// The columns of a table: bound, damper, E1max, k2, stroke.
fn rows(desk: &Desk, name: &str) -> Vec<(f64, String, f64, f64, f64)> {
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        (number(fields[0]), fields[1].to_owned(), number(fields[2]), number(fields[3]), number(fields[7]))
    };
    desk.read(name).lines().skip(1).map(row).collect()
}

#[test]
fn invariant_a_looser_bound_is_never_worse_and_each_is_kept() {
    let desk = desk();
    desk.good(&["fronts", "fronts.json", "--quiet", "--out", "out"]);
    let names = desk.names("out");
    for name in ["README.md", "front.csv", "front.svg", "k2.csv", "k2.svg", "stroke.csv", "stroke.svg"] {
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
    assert!(page.starts_with("# What the SSVI NES is good for\n") && page.contains("on 5 samples"), "{page}");
}

#[test]
fn contract_the_fronts_are_the_same_with_one_thread_and_two() {
    let desk = desk();
    for threads in ["1", "2"] {
        desk.good(&["fronts", "fronts.json", "--quiet", "--threads", threads, "--out", threads]);
    }
    for name in desk.names("1").iter().filter(|name| name.contains('.') && !name.starts_with("stroke-")) {
        assert_eq!(desk.read(&format!("1/{name}")), desk.read(&format!("2/{name}")), "{name}");
    }
}

#[test]
fn contract_a_wrong_study_of_fronts_is_refused_with_a_remedy() {
    let desk = desk();
    assert!(desk.good(&["check", "fronts.json"]).contains("each for k2 at most 100, 400 N/m"));
    let good = desk.read_json("fronts.json");
    for (field, bad, words) in [
        ("dampers", json!([]), "dampers: an empty list is not allowed here: give at least one"),
        ("k2", json!([]), "k2: an empty list is not allowed here: give at least one"),
        ("k2", json!([5]), "optimize.bounds.k2: [10, 5] is not allowed here"),
        ("stroke", json!([-1]), "stroke[0]: "),
        ("samples", json!(1), "samples: 1 is not allowed here: give a whole number from 2 to 10000"),
    ] {
        let mut fronts = good.clone();
        fronts[field] = bad.clone();
        desk.write_json("wrong.json", &fronts);
        let answer = desk.run(&["fronts", "wrong.json", "--quiet", "--out", "wrong"]);
        assert_eq!(answer.code, Some(2), "{field} = {bad}: {}", answer.stderr);
        assert!(answer.stderr.contains(words), "{field} = {bad}: {}", answer.stderr);
        assert!(!desk.path("wrong").exists());
    }
    let mut fronts = good;
    fronts["dampers"][1]["study"] = json!("tmd.json");
    desk.write_json("wrong.json", &fronts);
    let answer = desk.run(&["fronts", "wrong.json"]);
    assert!(answer.stderr.contains("give each name and each study once"), "{}", answer.stderr);
}
