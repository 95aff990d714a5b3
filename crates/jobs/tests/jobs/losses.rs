//! `losses`: dampers tuned for each restitution of their contacts and for all at once.

use crate::{found, request};
use retune_jobs::Silent;
use retune_jobs::losses::{Losses, Point, Tuning, losses};
use retune_model::{Design, Measure};
use retune_testkit::desk::{Desk, tiny};
use retune_testkit::observers::{good, refused};
use retune_testkit::verified;
use serde_json::{Value, json};

/// The tiny study with contacts of a restitution, tuned for the worst of these.
fn lossy(restitutions: &[f64]) -> Value {
    let mut study = tiny();
    study["scene"]["damper"]["contact"]["loss"] = json!({ "restitution": 0.8 });
    let optimize = &mut study["optimize"];
    optimize["surf"].take();
    // With one start certificates are quick.
    optimize["objective"] = json!({ "restitution": restitutions, "starts": 1 });
    optimize["refine"] = json!({ "MaxFunEvals": 12 });
    study
}

fn of(losses: &Losses, tuning: Tuning, restitution: f64) -> &Point {
    losses.of(tuning).find(|point| point.restitution == restitution).expect("a point")
}

/// Each damper at each restitution, and without loss, which is not asked for; every row is what its design has, and nothing is lost in
/// impacts that lose nothing.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_each_damper_is_compared_at_each_restitution() {
    let desk = Desk::with(&lossy(&[0.7]));
    let found = found(good(losses(&request(&desk, "study.json", "out"), &Silent)));
    let quantity = found.study.quantity();
    assert_eq!(quantity, Measure::Energy);
    let tunings = found.tunings();
    assert!(tunings.len() == 4 && !tunings.contains(&Tuning::Study), "the structure is the paper's");
    for tuning in tunings {
        let restitutions: Vec<f64> = found.of(tuning).map(|point| point.restitution).collect();
        assert_eq!(restitutions, [1.0, 0.7], "{tuning:?}");
        let [.., without] = of(&found, tuning, 1.0).powers;
        let [.., with] = of(&found, tuning, 0.7).powers;
        assert_eq!(without, 0.0, "{tuning:?}");
        let strikes = of(&found, tuning, 0.7).impact_speed > 0.0;
        assert_eq!(with > 0.0, strikes, "{tuning:?}: {with} W");
    }
    let [lossless, anew] = [Tuning::Lossless, Tuning::Anew].map(|tuning| of(&found, tuning, 1.0));
    assert_eq!((lossless.design, lossless.value), (anew.design, anew.value));
    let at = |tuning| of(&found, tuning, 0.7).value;
    assert!(at(Tuning::Anew) <= at(Tuning::Lossless), "it starts from the other");
    assert!(found.of(Tuning::Paper).all(|point| point.impact_speed > 0.0), "the paper's damper strikes");
    let said = verified::holds(&desk, "out", 8);
    assert!(said.contains("losses.csv"), "{said}");
}

/// The paper's damper means nothing for another structure: that of the study is compared.
#[test]
fn contract_an_own_structure_keeps_its_own_damper() {
    let mut study = lossy(&[0.7]);
    study["scene"]["primary"]["m1"] = json!(900);
    let desk = Desk::with(&study);
    let found = found(good(losses(&request(&desk, "study.json", "out"), &Silent)));
    assert_eq!(found.tunings(), [Tuning::Study, Tuning::Lossless, Tuning::Hedged, Tuning::Anew]);
    let kept = of(&found, Tuning::Study, 0.7).design;
    assert_eq!(Some(kept), found.study.scene.damper.as_ref().map(Design::of));
    let page = desk.read("out/README.md");
    assert!(page.contains("The damper of the study: ") && !page.contains("The paper's damper"), "{page}");
    assert!(desk.read("out/losses.csv").contains("\nof the study,0.7,"));
    verified::holds(&desk, "out", 8);
}

/// A soft spring in a wide cavity touches nothing, so that the damper tuned without loss is the best for all restitutions. The search for all ended 7 %
/// above it; and was said to be for a restitution, 1, that it had not been tuned for.
#[test]
fn regress_the_damper_for_all_is_not_above_another_that_was_found() {
    let mut study = lossy(&[0.9, 0.6]);
    study["scene"]["primary"] = json!({ "m1": 1e5, "c1": 12570, "k1": 157900 });
    study["scene"]["forcing"] = json!({ "P": 500, "omega": 1.257 });
    let damper = &mut study["scene"]["damper"];
    for (name, value) in [("m2", 3000.0), ("k2", 2000.0), ("c2", 300.0), ("D", 0.05), ("C", 1.0)] {
        damper[name] = json!(value);
    }
    study["window"] = json!({ "t0": 150, "T": 250 });
    let optimize = &mut study["optimize"];
    optimize["vary"] = json!(["k2", "c2"]);
    optimize["bounds"] = json!({ "k2": [100, 3000], "c2": [10, 3000] });
    optimize["objective"]["omega"] = json!({ "from": 1.13, "to": 1.38, "samples": 7 });
    optimize["refine"] = json!({ "scaled": true, "MaxFunEvals": 60 });
    let desk = Desk::with(&study);
    let found = found(good(losses(&request(&desk, "study.json", "out"), &Silent)));
    let worst = |tuning| found.of(tuning).map(|point| point.value).fold(0.0, f64::max);
    let [hedged, lossless] = [Tuning::Hedged, Tuning::Lossless].map(worst);
    assert!(hedged <= 1.0001 * lossless, "{hedged} {lossless}");
    assert!(desk.path("out/all-further").exists(), "its own search ends above");
    let page = desk.read("out/README.md");
    assert!(page.contains("One damper tuned for the worst of e = 0.9, 0.6 ("), "{page}");
    verified::holds(&desk, "out", 8);
}

#[test]
fn contract_restitutions_to_compare_are_asked_for() {
    let mut study = lossy(&[0.7]);
    study["optimize"]["objective"]["restitution"].take();
    let desk = Desk::with(&study);
    let error = refused(losses(&request(&desk, "study.json", "out"), &Silent)).to_string();
    assert!(error.contains("optimize.objective.restitution: missing"), "{error}");
    assert!(!desk.path("out").exists(), "nothing is made");
}
