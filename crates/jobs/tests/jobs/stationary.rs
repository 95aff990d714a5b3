//! Stationary random motion: what is said of it is what draws have, and what refused.

use crate::{read, request};
use retune_jobs::simulate::simulate;
use retune_jobs::tune::tune;
use retune_jobs::{Silent, certify::certify};
use retune_solver::{Rows, trajectory};
use retune_testkit::desk::{Desk, committed, number};
use retune_testkit::observers::good;
use serde_json::{Value, json};

/// The committed study with other fields of its forcing.
fn study(forcing: &Value) -> Value {
    let mut study = committed("random-tmd.json");
    for (name, value) in forcing.as_object().expect("an object") {
        study["scene"]["forcing"][name] = value.clone();
    }
    study
}

/// Over a whole draw, whose harmonics are orthogonal there, the mean squares of a run are those of the spectrum, but for the beginning from rest.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn reference_the_root_mean_squares_are_those_of_a_long_run() {
    let spectrum = json!({ "omega": [0, 3, 6, 9, 12], "density": [0.004, 0.01, 0.02, 0.01, 0], "seed": 3 });
    for of in ["base acceleration", "force"] {
        let unit = if of == "force" { "kN" } else { "m/s²" };
        let mut long = study(&json!({ "spectrum": spectrum, "of": of, "unit": unit, "duration": 2000 }));
        long["window"] = json!({ "t0": 0, "T": 2000 });
        let desk = Desk::with(&long);
        let study = read(&desk, "study.json");
        let told = json!(good(simulate(&study, None)));
        let (mut squares, mut count) = ([0.0; 3], 0.0);
        let rows = Rows { interval: 0.05, events: false };
        trajectory(&study.scene, study.window.window(), &study.solver.settings(), rows, &mut |row| {
            let [x1, v1, x2, _] = row.state;
            for (sum, value) in squares.iter_mut().zip([x1, v1, x2 - x1]) {
                *sum += value * value;
            }
            count += 1.0;
        })
        .expect("a run");
        for (name, square) in ["x1rms", "v1rms", "stroke_rms"].into_iter().zip(squares) {
            let (own, found) = (number(&told, &format!("/stationary/{name}")), (square / count).sqrt());
            assert!((found / own - 1.0).abs() < 0.01, "{of} {name}: {own} {found}");
        }
        assert!(number(&told, "/stationary/relative_error") <= 1e-10);
    }
}

/// A search ends where no neighbour has less; what its certificate says is of the same integral at three tolerances.
#[test]
fn exact_a_search_ends_at_the_least_root_mean_square() {
    let desk = Desk::with(&committed("random-tmd.json"));
    drop(good(tune(&request(&desk, "study.json", "out"), &Silent)));
    let found = desk.read_json("out/optimum.json");
    let own = number(&found, "/x1rms");
    let value = |k2: f64, c2: f64| {
        let mut other = committed("random-tmd.json");
        other["scene"]["damper"] =
            json!({ "m2": 60, "k2": k2 * number(&found, "/k2"), "c2": c2 * number(&found, "/c2") });
        let study = read(&Desk::with(&other), "study.json");
        study.energy(&study.scene).expect("a value")
    };
    assert!((value(1.0, 1.0) / own - 1.0).abs() < 1e-9);
    for [k2, c2] in [[0.98, 1.0], [1.02, 1.0], [1.0, 0.9], [1.0, 1.1]] {
        assert!(value(k2, c2) > own, "{k2} {c2}");
    }
    let study = read(&Desk::with(&committed("random-tmd.json")), "study.json");
    let certificate = json!(good(certify(&study)));
    let runs = certificate["convergence"].as_array().expect("runs");
    assert!(runs.len() == 3 && certificate["records"].is_null(), "{certificate}");
}

#[test]
fn contract_what_has_no_stationary_motion_is_refused_with_the_reason() {
    let committed = || committed("random-tmd.json");
    let with = |place: &str, value: Value| {
        let mut study = committed();
        *study.pointer_mut(place).expect("a field") = value;
        study
    };
    let objective = |value: Value| with("/optimize/objective", value);
    let mut walls = committed();
    walls["scene"]["damper"] = retune_testkit::desk::committed("quake.json")["scene"]["damper"].clone();
    let mut limited = committed();
    limited["optimize"]["limits"] = json!({ "stroke": 0.1 });
    let mut white = with("/scene/forcing/spectrum", json!({ "white": 1, "to": 20 }));
    white["scene"]["forcing"]["of"] = json!("force");
    white["optimize"]["objective"]["quantity"] = json!("a1rms");
    let pulse = json!({ "pulse": "half sine", "of": "force", "peak": 1, "duration": 1 });
    for (study, words) in [
        (walls, "a random stroke exceeds every gap at some time"),
        (limited, "limits are on largest values, of which a stationary random motion has none"),
        (white, "white noise that acts on a mass accelerates it without bound"),
        (with("/scene/forcing", pulse), "only a motion under a `spectrum` is stationary and random"),
        (objective(json!({ "quantity": "x1rms" })), "`response` \"steady\" beside it"),
        (objective(json!({ "quantity": "x1max", "response": "steady" })), "give `quantity` \"x1rms\""),
        (
            objective(json!({ "quantity": "x1rms", "response": "steady", "ensemble": { "members": 2 } })),
            "without omega, ensemble and records",
        ),
    ] {
        let desk = Desk::with(&study);
        let sentence = retune_study::read(&desk.path("study.json")).expect_err(words).to_string();
        assert!(sentence.contains(words), "{sentence}");
    }
}
