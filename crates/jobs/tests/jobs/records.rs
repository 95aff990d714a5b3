//! Searches and certificates over records.

use retune_jobs::certify::certify;
use retune_testkit::desk::{Desk, committed, number};
use retune_testkit::observers::good;
use serde_json::{Value, json};

/// A building and a TMD in two draws of a random shaking and in a record of a file.
fn study() -> Value {
    let spectrum = |seed: u64| {
        json!({
            "spectrum": { "omega": [1, 6, 20], "density": [0, 0.02, 0], "seed": seed },
            "of": "base acceleration", "duration": 12
        })
    };
    let mut study = committed("quake-tmd.json");
    study["scene"]["forcing"] = spectrum(1);
    study["window"] = json!({ "t0": 0, "T": 15 });
    let optimize = json!({
        "vary": ["k2", "c2"],
        "objective": {
            "quantity": "x1max",
            "records": [spectrum(1), spectrum(2), { "record": "a.csv", "of": "base acceleration", "scale": 2 }],
            "records_by": "mean"
        }
    });
    study["optimize"] = optimize;
    study
}

/// What a study finds of its own design.
fn value(study: &Value) -> f64 {
    let desk = with_record(study);
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    study.energy(&study.scene).expect("a value")
}

fn with_record(study: &Value) -> Desk {
    let desk = Desk::with(study);
    let line = |i: u32| format!("{},{}\n", 0.02 * f64::from(i), (0.1 * f64::from(i)).sin());
    let text: String = (0..=200).map(line).collect();
    std::fs::write(desk.path("a.csv"), format!("t,a\n{text}")).expect("a file");
    desk
}

/// After the last sample nothing acts, and a study says so where its run goes on.
#[test]
fn contract_a_record_that_ends_before_the_run_is_told() {
    let mut study = study();
    study["scene"]["forcing"] = json!({ "record": "a.csv", "of": "base acceleration" });
    for (end, told) in
        [(15, Some("the record ends at 4 s; from there to T = 15 s the motion is free")), (4, None)]
    {
        study["window"]["T"] = json!(end);
        let desk = with_record(&study);
        let read = retune_study::read(&desk.path("study.json")).expect("a study");
        assert_eq!(read.transient().as_deref(), told);
        assert_eq!(
            told.is_some_and(|told| retune_jobs::describe::study(&read).contains(told)),
            told.is_some()
        );
        let simulated = json!(good(retune_jobs::simulate::simulate(&read, None)));
        assert_eq!(simulated["transient"].as_str(), told);
    }
}

/// A certificate has the values under the other sign, with every second sample and with other seeds; a resolved study needs no file.
#[test]
fn exact_a_certificate_has_the_values_under_other_records() {
    let desk = with_record(&study());
    let read = retune_study::read(&desk.path("study.json")).expect("a study");
    let certificate = good(certify(&read));
    let (said, certificate) = (certificate.to_string(), json!(certificate));
    assert!((number(&certificate, "/x1max") - value(&study())).abs() < 1e-15);
    let others = certificate["records"]["each"].as_array().expect("a list");
    assert_eq!(others.len(), 7);
    let with = |i: usize, change: &dyn Fn(&mut Value)| {
        let mut other = study();
        change(&mut other);
        assert!((number(&others[i], "/value") - value(&other)).abs() < 1e-12, "{}", others[i]);
    };
    let own = number(&certificate, "/x1max");
    // A linear damper does not know the sign.
    assert!((number(&others[0], "/value") / own - 1.0).abs() < 1e-12, "{}", others[0]);
    assert!(
        (number(&others[1], "/value") / own - 1.0).abs() < 0.01 && others[1]["value"] != certificate["x1max"]
    );
    with(4, &|study| {
        for (i, seed) in [(0, 4), (1, 5)] {
            study["optimize"]["objective"]["records"][i]["spectrum"]["seed"] = json!(seed);
        }
    });
    let words = certificate["records"]["words"].as_str().expect("words");
    assert!(words.contains(" with the other sign, ") && said.contains(words), "{said}");
    let elsewhere = Desk::with(&json!(read.resolved()));
    let again = retune_study::read(&elsewhere.path("study.json")).expect("a study without its file");
    assert_eq!(again.energy(&again.scene), Some(own));
}
