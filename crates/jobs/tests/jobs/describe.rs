//! Descriptions of studies in words.

use crate::band::ssvi_band;
use retune_jobs::describe;
use retune_jobs::simulate::simulate;
use retune_study::read::from_text;
use retune_testkit::desk::{committed, global, tiny};
use serde_json::{Value, json};

#[track_caller]
fn said(study: &Value) -> String {
    describe::study(&from_text(&study.to_string(), "study.json").unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn contract_the_objective_is_described() {
    let line = "for the worst E1max over omega = 4 to 4.6 rad/s, in the window, on 5 samples and refined at their peaks";
    let band = said(&ssvi_band());
    assert!(band.contains(line), "{band}");
    let steady = said(&committed("tmd-free.json"));
    assert!(steady.contains("for the worst E1max over omega = 5 to 8 rad/s, steady, exact"), "{steady}");
}

#[test]
fn contract_the_law_of_the_walls_is_described() {
    let without = said(&committed("ssvi.json"));
    assert!(without.contains("4.95558e7 and 4.59684e7 N/m^1.5, Hertz without loss"), "{without}");
    let rigid = said(&committed("ssvi-rigid.json"));
    assert!(rigid.contains("damper of 60 kg; rigid walls, restitution e = 0.7 at every speed"), "{rigid}");
    let with = said(&committed("ssvi-loss.json"));
    assert!(
        with.contains("Hunt and Crossley's loss with lambda = 0.453449 s/m: restitution 0.970655 at 0.1 m/s"),
        "{with}"
    );
}

#[test]
fn contract_every_part_of_an_objective_is_described() {
    let robust = json!({
        "omega": { "from": 0.9, "to": 1.1, "samples": 3, "relative": true },
        "k1": { "set": [3e4, 4e4] },
        "ensemble": { "members": 4, "statistic": { "quantile": 0.9 } }
    });
    let sum = json!({ "sum": [{ "weight": 2, "objective": robust }, { "weight": 1, "objective": {} }] });
    let words = said(&global(robust, json!({ "cavity": 0.4 })));
    for line in [
        "for the 0.9 quantile of 4 members (all phases, errors to 0.1 %), worst E1max over omega = 0.9 to 1.1 times √(k1/m1) \
         and k1 = 30000, 40000 N/m, in the window, on 3 samples",
        "under limits: cavity at most 0.4 m",
        "a global search (24 designs, 2 CMA-ES searches)",
    ] {
        assert!(words.contains(line), "{line}: {words}");
    }
    let words = said(&global(sum, json!({})));
    assert!(words.contains("weighted sum of 2 objectives"), "{words}");
    assert!(words.contains("1 times E1max, omega = 6.28 rad/s"), "{words}");
}

/// A strong dashpot is told where the model of a run is told, and what its steps are; a weak one, or another method, is not.
#[test]
fn contract_runs_in_long_steps_say_what_is_left_out() {
    let left_out =
        "longer ones once the fast part of the motion, that of a strong dashpot, has decayed and is left out";
    let mut study = tiny();
    study["scene"]["damper"]["c2"] = json!(1e7);
    let words = said(&study);
    assert!(words.contains(left_out) && !words.contains("refused"), "{words}");
    let model = |study: &Value| {
        let study = from_text(&study.to_string(), "study.json").expect("a study");
        let words = simulate(&study, None).expect("a run").to_string();
        words.lines().find(|line| line.starts_with("model")).expect("the model").to_owned()
    };
    let told = model(&study);
    assert!(told.ends_with("; longer steps once the fast part of the motion, that of a strong dashpot, has decayed and is left out"), "{told}");
    assert!(!said(&tiny()).contains("left out"));
    assert_eq!(model(&tiny()), "model       with contacts");
    study["scene"]["damper"]["c2"] = json!(232);
    study["solver"] = json!({ "method": "dop853" });
    assert_eq!(model(&study), "model       with contacts");
}
