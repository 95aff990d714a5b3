//! What is said of structures that are not the paper's: slow, undamped, in a range of stiffnesses, under one frequency.

use crate::{request, search};
use retune_jobs::branches::{Options, branches};
use retune_jobs::evaluate::{Streams, evaluate};
use retune_jobs::table2::table2;
use retune_jobs::{Request, Silent};
use retune_model::Parameter;
use retune_study::read::from_text;
use retune_testkit::desk::{Desk, flat, number, tiny};
use retune_testkit::observers::{good, refused};
use retune_testkit::verified::{self, End, look};
use serde_json::{Value, json};
use std::path::Path;

/// A study of a TMD in its steady motion.
fn tmd(primary: &Value, omega: f64, damper: &Value, objective: &Value, bounds: &Value) -> Value {
    json!({
        "kind": "study",
        "scene": { "primary": primary, "forcing": { "P": 50, "omega": omega }, "damper": damper },
        "window": "settled",
        "optimize": {
            "vary": ["k2", "c2"],
            "objective": objective,
            "bounds": bounds,
            "refine": { "starts": 1, "scaled": true, "TolX": 1e-8, "TolFun": 1e-12 }
        }
    })
}

/// A tower of 20 t at 0.5 Hz with 0.3 % damping and a damper that is hardly damped: methods that step in time take longer than 2000 s to settle.
fn tower(objective: Value) -> Value {
    let objective = objective.as_object().cloned().unwrap_or_default();
    let steady = json!({ "response": "steady", "quantity": "x1max" });
    let all: serde_json::Map<String, Value> =
        steady.as_object().cloned().unwrap_or_default().into_iter().chain(objective).collect();
    let primary = json!({ "m1": 20000, "c1": 376.991, "k1": 197_392.088 });
    let damper = json!({ "m2": 200, "k2": 1932.5, "c2": 0.6 });
    let bounds = json!({ "k2": [100, 1e4], "c2": [0.5, 1000] });
    tmd(&primary, std::f64::consts::PI, &damper, &Value::Object(all), &bounds)
}

#[test]
fn contract_a_slow_linear_motion_is_neither_chaotic_nor_unpredictable() {
    let desk = Desk::with(&tower(json!({ "omega": { "from": "0.49Hz", "to": "0.5Hz" } })));
    let said = flat(&search(&desk, "study.json", "out").report());
    let certificate = desk.read_json("out/certificate.json");
    assert_eq!((&certificate["predictable"], &certificate["verdict"]), (&json!(true), &json!("sensitive")));
    assert!(number(&certificate, "/error_bar") < 1e-9, "{certificate}");
    assert!(!said.contains("chaotic") && !said.contains("not predictable"), "{said}");
    // Beyond ten times its c2, where it ends, much more: nothing is said of that.
    assert!(said.contains("flat c2 from 0.5 to ") && !said.contains("any c2"), "{said}");
}

#[test]
fn contract_the_best_tmd_of_one_frequency_is_searched_for() {
    let study = tower(json!({}));
    let desk = Desk::with(&study);
    let said = flat(&search(&desk, "study.json", "out").report());
    let optimum = desk.read_json("out/optimum.json");
    // Without its dashpot it cancels all motion at this frequency, but for what that of the structure leaves.
    let [own, best] = ["/x1max", "/needs/TMD/x1max"].map(|path| number(&optimum, path));
    assert!(best < 1e-3 * own, "{own} {best}");
    assert!(
        said.contains("a linear damper of the same mass is better") && said.contains("c2 = 0 N·s/m"),
        "{said}"
    );
}

#[test]
fn contract_more_stiffnesses_are_looked_at_than_a_study_samples() {
    let range = json!({ "range": { "from": 158_000, "to": 237_000, "samples": 3 } });
    let objective = json!({ "omega": { "from": 2.8, "to": 3.5 }, "k1": range, "quantity": "ground_force" });
    let desk = Desk::with(&tower(objective));
    let said = flat(&search(&desk, "study.json", "out").report());
    let certificate = desk.read_json("out/certificate.json");
    assert!(number(&certificate, "/finer") > 1.05 * number(&certificate, "/ground_force"), "{certificate}");
    assert!(said.contains("4 times as many"), "{said}");
}

#[test]
fn contract_an_undamped_resonance_is_named() {
    let objective = json!({ "omega": { "from": 10, "to": 40 }, "response": "steady" });
    let primary = json!({ "m1": 10, "c1": 0, "k1": 4000 });
    let damper = json!({ "m2": 1, "k2": 100, "c2": 0 });
    let mut study = tmd(&primary, 20.0, &damper, &objective, &json!({ "k2": [0, 1e4], "c2": [0, 5] }));
    study["window"] = json!({ "t0": 10, "T": 20 });
    let study = from_text(&study.to_string(), "study.json").expect("a study");
    let (mut answers, mut complain) = (Vec::new(), |_: &str| {});
    let streams = Streams { input: "100 0\n".as_bytes(), answers: &mut answers, complaints: &mut complain };
    refused(evaluate(&study, false, &Request::new(Path::new("study.json")), streams));
    let answer = String::from_utf8(answers).expect("UTF-8");
    assert!(answer.starts_with("error: it has no steady motion: nothing damps its resonance"), "{answer}");
}

/// A stroke changed in a table, and its hash with it: the row is computed again.
#[test]
fn contract_every_number_of_a_design_in_a_table_is_verified() {
    let desk = verified::desk();
    good(table2(&request(&desk, "table2.json", "out"), &Silent));
    let whole = desk.read("out/table2.csv");
    let names: Vec<&str> = whole.lines().next().expect("a header").split(',').collect();
    for name in ["stroke", "contact_force", "x1max", "a1max", "ground_force"] {
        let place = names.iter().position(|other| *other == name).expect(name);
        let mut rows: Vec<Vec<String>> =
            whole.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
        // There is a comma in the name of the damper, before all numbers.
        let place = rows[1].len() - names.len() + place;
        let value: f64 = rows[1][place].parse().expect("a number");
        rows[1][place] = (value + 1.0).to_string();
        let text: String = rows.iter().map(|row| row.join(",") + "\n").collect();
        desk.write("out/table2.csv", text);
        let End::Not(problem) = look(&desk, "out", 20, 0.0).1 else { panic!("{name}: it holds") };
        assert!(problem.contains(&format!("{name} in row 1")), "{problem}");
    }
}

/// Branches between two values, of the fewest runs.
fn between(from: &str, to: &str) -> Options {
    let [from, to] = [from, to].map(|end| Some(end.to_owned()));
    Options { from, to, samples: 2, starts: 0, apart: 0, fine: 0, ..Options::default() }
}

/// The page of the branches of a study.
fn traced(desk: &Desk, options: &Options) -> String {
    let request = Request { replace: true, ..request(desk, "study.json", "out") };
    good(branches(&request, options, &Silent));
    desk.read("out/README.md")
}

/// A damper without walls has one motion at each frequency, whatever the rounding of the ends of a band.
#[test]
fn regress_one_motion_is_one_branch() {
    let primary = json!({ "m1": 4e4, "c1": 753.982_236_861_550_4, "k1": 142_122.303_375_686_75 });
    let damper = json!({ "m2": 800, "k2": 2592, "c2": 250 });
    let mut study = tmd(&primary, 1.8, &damper, &json!({}), &json!({}));
    study["optimize"] = Value::Null;
    let desk = Desk::with(&study);
    for from in ["1.69", "1.7"] {
        let options = Options { samples: 5, starts: 2, ..between(from, "2.23") };
        let said = traced(&desk, &options);
        assert!(said.contains("of 1 branch, cover 100 %"), "{said}");
    }
}

/// A restitution ends at 1: so does its branch, and it is one.
#[test]
fn contract_a_branch_ends_where_its_parameter_does() {
    let mut study = tiny();
    let contact = study["scene"]["damper"]["contact"].clone();
    study["scene"] = json!({
        "primary": { "m1": 250, "c1": 126, "k1": 39478 },
        "forcing": { "P": 120, "omega": 12.566 },
        "damper": { "m2": 12.5, "k2": 500, "c2": 40, "D": 0.12, "C": 0.0075, "contact": contact }
    });
    study["window"] = json!({ "t0": 25, "T": 50 });
    study["optimize"] = Value::Null;
    let desk = Desk::with(&study);
    let options = Options { over: Parameter::Restitution, ..between("0.97", "1") };
    let said = traced(&desk, &options);
    assert!(said.contains("ends where the range ends") && !said.contains("was lost"), "{said}");
}

/// The points of a global search may all lie far from a narrow optimum.
#[test]
fn regress_no_search_of_a_steady_objective_ends_far_above_the_best_tmd() {
    let objective =
        json!({ "omega": { "from": 255.75, "to": 335.99 }, "response": "steady", "quantity": "a1max" });
    let primary = json!({ "m1": 573.83, "c1": 3.3642, "k1": 4.931e7 });
    let damper = json!({ "m2": 5.7383, "k2": 493_096, "c2": 168.21 });
    let mut study =
        tmd(&primary, 293.14, &damper, &objective, &json!({ "k2": [0, 4.93096e8], "c2": [0, 1.68212e6] }));
    study["scene"]["forcing"] = json!({ "imbalance": 0.57383, "omega": 293.14 });
    study["window"] = json!({ "t0": 0, "T": 0.43 });
    study["optimize"]["global"] = json!({ "samples": 128, "searches": 3, "evaluations": 200 });
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let optimum = desk.read_json("out/optimum.json");
    assert!(number(&optimum, "/a1max") < 1220.0, "{optimum}");
}
