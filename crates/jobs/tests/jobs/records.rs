//! Searches and certificates over records.

use crate::search;
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

/// A certificate has the values with every second sample and with other seeds, and under the other sign where there are walls: a linear damper does not
/// know the sign; a resolved study needs no file.
#[test]
fn exact_a_certificate_has_the_values_under_other_records() {
    let desk = with_record(&study());
    let read = retune_study::read(&desk.path("study.json")).expect("a study");
    let certificate = good(certify(&read));
    let (said, certificate) = (certificate.to_string(), json!(certificate));
    assert!((number(&certificate, "/x1max") - value(&study())).abs() < 1e-15);
    let others = certificate["records"]["each"].as_array().expect("a list");
    assert_eq!(others.len(), 6);
    let with = |i: usize, change: &dyn Fn(&mut Value)| {
        let mut other = study();
        change(&mut other);
        assert!((number(&others[i], "/value") - value(&other)).abs() < 1e-12, "{}", others[i]);
    };
    let own = number(&certificate, "/x1max");
    assert!(
        (number(&others[0], "/value") / own - 1.0).abs() < 0.01 && others[0]["value"] != certificate["x1max"]
    );
    with(3, &|study| {
        for (i, seed) in [(0, 4), (1, 5)] {
            study["optimize"]["objective"]["records"][i]["spectrum"]["seed"] = json!(seed);
        }
    });
    let words = certificate["records"]["words"].as_str().expect("words");
    assert!(words.contains(" with every second sample, ") && said.contains(words), "{said}");
    assert!(!words.contains("other sign"), "{words}");
    let elsewhere = Desk::with(&json!(read.resolved()));
    let again = retune_study::read(&elsewhere.path("study.json")).expect("a study without its file");
    assert_eq!(again.energy(&again.scene), Some(own));
}

/// A damper with one wall nearer than the other has another value under the other sign: its certificate and its answer tell it.
#[test]
fn exact_a_certificate_has_the_value_under_the_other_sign() {
    let mut study = committed("shock-ssvi.json");
    study["scene"]["damper"]["c2"] = json!(40);
    let own = Desk::with(&study);
    study["scene"]["forcing"]["peak"] = json!(-10);
    let other = Desk::with(&study);
    let [own, other] =
        [own, other].map(|desk| retune_study::read(&desk.path("study.json")).expect("a study"));
    let certificate = good(certify(&own));
    let json = json!(certificate);
    let told = number(&json["records"]["each"][0], "/value");
    assert_eq!(Some(told), other.energy(&other.scene));
    assert!((told / number(&json, "/E1max") - 1.0).abs() > 0.01, "{json}");
    assert!(certificate.to_string().contains(" with the other sign"), "{certificate}");
}

/// What contacts are like is told of the run with the largest force, under a pulse, too; not of the scene's own where another record has more.
#[test]
fn contract_contacts_are_those_of_the_run_with_the_largest_force() {
    let mut study = committed("shock-ssvi.json");
    study["optimize"]["surf"] = Value::Null;
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 10 });
    study["optimize"]["objective"] = json!({});
    let answered = |study: &Value| {
        let desk = Desk::with(study);
        let said = search(&desk, "study.json", "out").report();
        (said, desk.read_json("out/optimum.json"))
    };
    let (said, optimum) = answered(&study);
    let impacts = number(&optimum, "/needs/contacts/structure/impacts");
    assert!(impacts > 0.0 && said.contains(" impacts at up to "), "{said}");
    let mut stronger = study["scene"]["forcing"].clone();
    stronger["peak"] = json!(15);
    study["optimize"]["objective"] = json!({ "records": [study["scene"]["forcing"], stronger] });
    let (said, optimum) = answered(&study);
    assert_eq!(optimum["needs"]["contacts"], Value::Null);
    assert!(said.contains("walls for ") && !said.contains(" impacts at up to "), "{said}");
}
