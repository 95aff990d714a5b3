//! What `design` tells, while it searches and at the end.

use crate::design::largest;
use crate::{asked, make};
use retune_jobs::{Error, Observer, Progress, Silent};
use retune_model::{Measure, unit};
use retune_testkit::desk::{Desk, flat};
use retune_testkit::observers::good;
use retune_testkit::verified::holds;
use serde_json::json;
use std::sync::{Arc, Mutex};

/// What a search tells of its best, J, in the order in which it does.
#[derive(Clone, Default)]
struct Told(Arc<Mutex<Vec<f64>>>);

impl Told {
    fn keep(&self, words: &str) {
        let value = unit::read(words, Measure::Energy.units()).expect("an energy");
        self.0.lock().expect("no panic").push(value);
    }
}

impl Progress for Told {
    fn best(&self, words: &str) {
        self.keep(words);
    }
}

impl Observer for Told {
    fn so_far(&self, line: &str) -> Result<(), Error> {
        let value = line.strip_prefix("SSVI NES so far: E1max ").and_then(|rest| rest.split_once(','));
        self.keep(value.expect("a value").0);
        Ok(())
    }
    fn progress(&self, _stage: &'static str, _count: u64) -> Box<dyn Progress> {
        Box::new(self.clone())
    }
}

/// With a short stroke the motion of a lightly damped structure builds up for hundreds of periods: the damper with walls is compared once it has
/// settled, not in periods 50 to 100, in which it has less.
#[test]
fn regress_a_damper_with_walls_is_compared_once_the_structure_has_settled() {
    let tight = json!({
        "m1": "1t", "f1": "10Hz", "zeta": "0.1%", "force": "100N", "band": "9Hz..11Hz", "mass": "1%", "limits": { "stroke": "2 mm" }
    });
    let desk = Desk::new();
    make(&desk, &good(asked(tight).requirements()), &Silent);
    let found = desk.read_json("out/design.json");
    let mut study = desk.read_json("out/studies-ssvi.json");
    let t0 = study["window"]["t0"].as_f64().expect("a time");
    assert!(t0 > 15.0, "{t0}");
    let mut from = |t0: f64| {
        study["window"] = json!({ "t0": t0, "T": t0 + 5.0 });
        study["optimize"]["limits"]["from"] = json!(t0);
        let other = retune_study::read::from_text(&study.to_string(), "other").expect("a study");
        other.energy(&other.scene).expect("a value")
    };
    let (own, early, later) = (largest(&found, 2, "E1max"), from(5.0), from(10.0 * t0));
    assert!((own / later - 1.0).abs() < 5e-3 && own > 15.0 && early < 0.95 * own, "{early} {own} {later}");
    holds(&desk, "out", 20);
}

/// The best damper with near walls far below resonance touches them just after rest, and never again: no force stands in its column.
#[test]
fn contract_walls_that_are_struck_after_rest_alone_are_said_to_be() {
    let far =
        json!({ "m1": "2t", "f1": "10Hz", "zeta": "5%", "force": "1kN", "band": "4Hz..6Hz", "mass": "5%" });
    let desk = Desk::new();
    make(&desk, &good(asked(far).requirements()), &Silent);
    let answer = flat(&desk.read("out/answer.txt"));
    assert!(answer.contains(", and strikes its walls only on the way from rest, with "), "{answer}");
    assert!(!answer.contains("with 0 N") && !answer.contains("contact force"), "{answer}");
}

/// With walls that lose energy, where runs take several times as long, an answer takes seconds: of a certain number of evaluations,
/// not of a time. What is told of the best on the way never rises.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_walls_that_lose_energy_are_answered_within_a_number_of_evaluations() {
    let rig = json!({
        "m1": "2 kg", "f1": "8 Hz", "zeta": "0.5 %", "force": "1 N", "mass": "5 %", "wall": "R=20mm,steel,e=0.6"
    });
    let desk = Desk::new();
    let told = Told::default();
    make(&desk, &good(asked(rig).requirements()), &told);
    let told = told.0.lock().expect("no panic").clone();
    assert!(told.len() > 3 && told.is_sorted_by(|before, after| after <= before), "{told:?}");
    let answer = desk.read_json("out/design.json");
    let evaluated = answer["designs_evaluated"].as_u64().expect("a number");
    assert!((58..=58 + 4 * 60).contains(&evaluated), "{evaluated}");
    // The last that is told is the one of the table, to the four digits of its words.
    let last = told[told.len() - 1];
    assert!((largest(&answer, 2, "E1max") / last - 1.0).abs() < 5e-4, "{last}: {answer}");
    assert!(largest(&answer, 2, "E1max") < 1.6 * largest(&answer, 1, "E1max"), "{answer}");
}
