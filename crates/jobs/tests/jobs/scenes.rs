//! Whole searches of scenes that are not the paper's: no walls, a varied mass, other forcings.

use crate::search;
use retune_jobs::certify::certify;
use retune_jobs::{Silent, verify};
use retune_testkit::desk::{Desk, committed, flat, number, tiny};
use retune_testkit::observers::good;
use serde_json::{Value, json};

/// The free tuned mass damper without its gaps and surfaces.
fn open() -> Value {
    let mut study = committed("tmd-free.json");
    let damper = study["scene"]["damper"].as_object_mut().expect("a damper");
    for name in ["D", "C", "contact"] {
        damper.remove(name).expect(name);
    }
    study
}

#[test]
fn exact_a_tmd_without_walls_is_the_one_that_never_touches() {
    let desk = Desk::with(&open());
    desk.write_json("walled.json", &committed("tmd-free.json"));
    let optimum = search(&desk, "study.json", "open");
    search(&desk, "walled.json", "walled");
    let [open, walled] = ["open", "walled"].map(|out| desk.read_json(&format!("{out}/optimum.json")));
    for name in ["/k2", "/c2", "/E1max", "/E1max_none", "/E1max_study"] {
        assert_eq!(number(&open, name), number(&walled, name), "{name}");
    }
    assert!(open.get("D").is_none() && open.get("C").is_none(), "{open}");
    assert!(flat(&optimum.report()).contains(" N·s/m, no walls"), "{}", optimum.report());
    assert_eq!(desk.rows("open/fminsearch.csv")[1][5..7], ["", ""]);
    good(verify::verify(&desk.path("open"), 100, 1e-9, &Silent));
    // Its results stand for the study with the design found.
    let found = retune_study::read(&desk.path("open")).expect("a study");
    let damper = found.scene.damper.expect("a damper");
    assert_eq!((damper.stiffness.get(), damper.contact), (number(&open, "/k2"), None));
}

/// With k2 and c2 of Den Hartog's ratio the best mass is the largest; it is a column of every table, and `verify` sets it.
#[test]
fn contract_a_varied_mass_is_a_column_and_is_found_again() {
    let mut study = open();
    study["optimize"]["vary"] = json!(["m2", "k2", "c2"]);
    study["optimize"]["bounds"]["m2"] = json!([20, 80]);
    study["optimize"]["surf"]["m2"] = json!({ "from": 20, "to": 80, "points": 3 });
    for (name, points) in [("k2", 7), ("c2", 7)] {
        study["optimize"]["surf"][name]["points"] = json!(points);
    }
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let found = desk.read_json("out/optimum.json");
    assert!((number(&found, "/m2") - 80.0).abs() < 1e-3, "{found}");
    assert_eq!(desk.rows("out/surf.csv")[0], ["k2", "c2", "D", "C", "m2", "E1max"]);
    assert!(desk.read("out/fminsearch.txt").starts_with(
        "k2 opt N/m      c2 opt N·s/m    D opt m         C opt m         m2 opt kg       E1max J\n"
    ));
    good(verify::verify(&desk.path("out"), 100, 1e-9, &Silent));
    let read = retune_study::read(&desk.path("out")).expect("a study");
    assert_eq!(read.scene.damper.expect("a damper").mass.get(), number(&found, "/m2"));
}

/// Every kind of forcing is searched, certified and verified.
#[test]
fn contract_every_forcing_can_be_tuned_for() {
    for forcing in [
        json!({ "imbalance": 20, "omega": 6.2 }),
        json!({ "base": 0.02, "omega": 6.2 }),
        json!({ "start": { "v1": 2 } }),
    ] {
        let mut study = tiny();
        study["scene"]["forcing"] = forcing.clone();
        study["optimize"]["surf"] = Value::Null;
        study["optimize"]["refine"] = json!({ "MaxFunEvals": 20 });
        let desk = Desk::with(&study);
        search(&desk, "study.json", "out");
        let found = desk.read_json("out/optimum.json");
        assert!(number(&found, "/E1max") < number(&found, "/E1max_study"), "{found}");
        let resolved = desk.read_json("out/study.json");
        assert_eq!(
            resolved["scene"]["forcing"].as_object().map(|all| all.len()),
            forcing.as_object().map(|all| all.len())
        );
        good(verify::verify(&desk.path("out"), 100, 1e-9, &Silent));
    }
    let mut decay = tiny();
    decay["scene"]["forcing"] = json!({ "start": { "v1": 2 } });
    decay.as_object_mut().expect("a study").remove("optimize");
    let desk = Desk::with(&decay);
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    let certificate = good(certify(&study));
    assert!(certificate.to_string().contains("free decay"), "{certificate}");
}
