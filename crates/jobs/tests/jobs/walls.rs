//! What a certificate says of other walls than those of a study: restitutions, and stiffnesses.

use crate::search;
use retune_jobs::Silent;
use retune_jobs::certify::certify;
use retune_jobs::verify::verify;
use retune_model::Parameter;
use retune_study::Setting;
use retune_testkit::desk::{Desk, committed, few_starts, flat, global, number};
use retune_testkit::observers::good;
use serde_json::{Value, json};

/// The design of a study in the words and in the data of its certificate.
fn certified(study: &Value) -> (String, Value) {
    let desk = Desk::with(study);
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    let certificate = good(certify(&study));
    (certificate.to_string(), json!(certificate))
}

/// The tuned damper of the paper's structure.
fn tuned() -> Value {
    let mut study = committed("ssvi.json");
    for (name, value) in [("k2", 583.9), ("c2", 94.97), ("D", 0.02885), ("C", 1.105)] {
        study["scene"]["damper"][name] = json!(value);
    }
    study
}

/// SciPy's DOP853 with events (`tests/reference/restitution_tuned.py`): by the same law, and by one with the speed of each touch-down, which has
/// other values where contacts are disturbed.
#[test]
fn reference_a_certificate_has_the_values_at_five_restitutions() {
    let (said, certificate) = certified(&tuned());
    let others = certificate["restitutions"].as_array().expect("a list");
    assert_eq!(others.len(), 5);
    let known = [
        (1.0, 225.839_84, 225.839_84),
        (0.9, 231.869_39, 231.797_91),
        (0.8, 246.002_51, 245.780_25),
        (0.7, 270.788_96, 270.454_80),
        (0.6, 298.471_21, 298.066_21),
    ];
    for (other, (e, value, by_touch_down)) in others.iter().zip(known) {
        assert_eq!(number(other, "/restitution"), e);
        assert!((number(other, "/value") - value).abs() < 2e-5, "{other}");
        assert!((number(other, "/value") - by_touch_down).abs() < 0.5, "{other}");
        assert!((5.0..=8.0).contains(&number(other, "/omega")), "{other}");
    }
    assert_eq!(others[0]["value"], certificate["E1max"], "the study's contacts lose nothing");
    assert_eq!(certificate["verdict"], "robust");
    let contacts = certificate["contacts"].as_str().expect("words");
    let verdict =
        format!("{}\n              Contacts: {contacts}\n", certificate["words"].as_str().expect("words"));
    assert!(said.contains(&verdict), "{said}");
    for words in [
        "E1max 225.8",
        " J without loss, 298.",
        " J at e = 0.6, more than any parameter off by 1 % gives: the largest of the restitutions 1, 0.9, 0.8, 0.7, 0.6 in runs from rest, not a bound; ",
        "; tune for all of these restitutions: `objective.restitution` (studies/ssvi-hedged.json)",
    ] {
        assert!(contacts.contains(words), "{words}: {contacts}");
    }
}

/// K is proportional to √R: the values with half and with twice of it are those of walls with R/4 and 4R.
#[test]
fn exact_a_certificate_has_the_values_with_half_and_twice_the_stiffness() {
    let study = tuned();
    let (_, certificate) = certified(&study);
    let others = certificate["stiffness"].as_array().expect("a list");
    assert_eq!(others.len(), 2);
    for (other, (factor, radius)) in others.iter().zip([(0.5, 0.5), (2.0, 8.0)]) {
        assert_eq!(number(other, "/factor"), factor);
        let desk = Desk::with(&study);
        let study = retune_study::read(&desk.path("study.json")).expect("a study");
        let study = study.with(&[Setting::new(Parameter::R, radius)]).expect("a study");
        let value = study.energy(&study.scene).expect("a value");
        assert!((number(other, "/value") / value - 1.0).abs() < 1e-9, "{value}: {other}");
        assert!((value / number(&certificate, "/E1max") - 1.0).abs() > 1e-3, "it matters");
    }
}

/// A loss of another law is replaced; one that the objective is tuned for already needs no advice.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_other_walls_replace_the_loss_of_the_study() {
    let mut study = tuned();
    study["scene"]["damper"]["contact"]["loss"] = json!({ "lambda": 0.3 });
    study["optimize"]["objective"]["omega"]["samples"] = json!(7);
    few_starts(&mut study);
    let (_, lossy) = certified(&study);
    study["scene"]["damper"]["contact"]["loss"] = Value::Null;
    let (_, lossless) = certified(&study);
    assert_eq!(lossy["restitutions"], lossless["restitutions"]);
    assert_ne!(lossy["stiffness"], lossless["stiffness"], "they have the study's own loss");
    assert!(number(&lossy, "/E1max") > 1.01 * number(&lossy, "/restitutions/0/value"), "{lossy}");
    let contacts = lossless["contacts"].as_str().expect("words");
    assert!(contacts.contains("; tune for all of these restitutions: "), "{contacts}");
}

/// Rigid walls have their own restitution in that range, and no stiffness.
#[test]
fn contract_rigid_walls_have_other_restitutions_and_no_stiffness() {
    let study = committed("ssvi-rigid.json");
    let (said, certificate) = certified(&study);
    let others = certificate["restitutions"].as_array().expect("a list");
    let own = others.iter().find(|other| other["restitution"] == 0.7).expect("its own");
    assert_eq!(own["value"], certificate["E1max"]);
    assert!(number(&others[4], "/value") > number(own, "/value"), "{certificate}");
    assert!(certificate.get("stiffness").is_none() && !said.contains("stiffness of both walls"), "{said}");
    assert!(
        said.contains("\n              Contacts: E1max 250.0") && !said.contains("tune for all"),
        "{said}"
    );
}

/// A damper without walls, and one that touches none, has no word of contacts.
#[test]
fn contract_a_damper_that_touches_nothing_has_no_word_of_contacts() {
    let mut studies = vec![committed("tmd.json"), tuned()];
    (studies[1]["scene"]["damper"]["D"], studies[1]["scene"]["damper"]["C"]) = (json!(5), json!(5));
    let mut open = studies[0].clone();
    for name in ["D", "C", "contact"] {
        open["scene"]["damper"].as_object_mut().expect("a damper").remove(name);
    }
    studies.push(open);
    for study in studies {
        let (said, certificate) = certified(&study);
        assert!(!said.contains("Contacts: "), "{said}");
        for name in ["contacts", "restitutions", "stiffness"] {
            assert!(certificate.get(name).is_none(), "{name}: {certificate}");
        }
    }
}

/// The answer of a search, its file and its page tell the same.
#[test]
fn contract_a_search_tells_what_other_walls_do() {
    let mut study = global(json!({}), json!({ "stroke": 1e3 }));
    study["optimize"]["bounds"]["D"] = json!([0, 0.001]);
    let desk = Desk::with(&study);
    let optimum = search(&desk, "study.json", "out");
    let certificate = desk.read_json("out/certificate.json");
    let contacts = certificate["contacts"].as_str().expect("words");
    let said = flat(&optimum.report());
    assert!(said.contains(&format!(") Contacts: {contacts}")), "{said}");
    assert_eq!(desk.read_json("out/optimum.json")["certificate"]["contacts"], contacts);
    assert_eq!(certificate["restitutions"][0]["value"], certificate["E1max"]);
    let kept = |list: &str| {
        certificate[list].as_array().expect("a list").iter().all(|one| one["keeps_limits"] == true)
    };
    assert!(kept("restitutions") && kept("stiffness"), "{certificate}");
    let page = desk.read("out/report.html");
    for words in ["<dt>Contacts</dt>", "E1max with other walls", "at e = 0.6", "with 0.5 K"] {
        assert!(page.contains(words), "{words}");
    }
    good(verify(&desk.path("out"), 20, 0.0, &Silent));
}
