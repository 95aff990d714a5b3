//! Motions beside those from rest: what certificates and searches make of them.

use crate::{found, request};
use retune_jobs::Silent;
use retune_jobs::certify::certify;
use retune_jobs::tune::objective::searched;
use retune_jobs::tune::tune;
use retune_model::Parameter;
use retune_study::{Margins, Settable, Setting, Study};
use retune_testkit::desk::{Desk, committed, number, studies, tiny};
use retune_testkit::observers::good;
use serde_json::{Value, json};

/// The best damper by runs from rest that `fronts` once found: an isola from 5.8155 to 6.0684 rad/s reaches 735.639 J
/// (`just lab branches-all`, results/branches/isola).
fn isola() -> Study {
    retune_study::read(&studies().join("ssvi-isola.json")).expect("a study")
}

#[test]
fn regress_a_damper_with_an_isola_is_robust_from_rest_only() {
    let certificate = good(certify(&isola()));
    let said = certificate.to_string();
    let seen = json!(certificate);
    assert_eq!(seen["verdict"], "from rest only", "{said}");
    assert!((number(&seen, "/E1max") - 225.796).abs() < 1e-3);
    let largest = &seen["motions"]["largest"];
    assert!((number(largest, "/E1max") - 735.639).abs() < 1e-3, "{largest}");
    assert!((number(largest, "/omega") - 5.98192).abs() < 1e-4 && largest["from_rest"] == false, "{largest}");
    let share = number(largest, "/ends") / number(largest, "/starts");
    assert!(largest["periods"] == 2 && (0.25..0.5).contains(&share), "{largest}");
    assert!((0.9..1.0).contains(&number(&seen, "/motions/covered")), "{said}");
    assert!(said.contains("a motion has 735.639 J at omega = 5.98192 rad/s (2 periods, impacts "), "{said}");

    // Its state is where it can be run again from.
    let state: Vec<String> = (0..4).map(|i| largest["state"][i].to_string()).collect();
    let omega = Setting::new(Parameter::Omega, number(largest, "/omega"));
    let mut again = isola().with(&[omega, Setting::new(Settable::From, 0.0)]).expect("a study");
    assert!(said.contains(" --from "), "{said}");
    again.scene.forcing.begin(retune_study::start(&state.join(",")).expect("a state"));
    let run = json!(good(retune_jobs::simulate::simulate(&again, None)));
    assert!((number(&run, "/E1max") - number(largest, "/E1max")).abs() < 1e-6, "{run}");
}

/// With 44 mm more D the isola is gone, and back for a quarter of a per cent more force, or as much less D: an edge that runs at the design's own
/// force alone do not show. With smaller margins asked for, it is robust.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn regress_a_design_beside_the_birth_of_an_isola_is_on_an_edge() {
    let at = [
        (Parameter::K2, 584.6096238462073),
        (Parameter::C2, 95.01688820226694),
        (Parameter::D, 0.6511167192459107),
        (Parameter::C, 0.029018702541945184),
    ];
    let design = isola().with(&at.map(|(name, value)| Setting::new(name, value))).expect("a study");
    let seen = json!(good(certify(&design)));
    assert_eq!(seen["verdict"], "edge", "{}", seen["words"]);
    let margin = &seen["margin"];
    let safe_to = number(margin, "/safe_to");
    assert!((1.0023..1.0026).contains(&safe_to), "{margin}");
    let d = margin["parameters"].as_array().and_then(|all| all.iter().find(|one| one["parameter"] == "D"));
    assert!((-0.3..-0.2).contains(&number(d.expect("D"), "/percent")), "{margin}");
    let words = seen["words"].as_str().expect("words");
    assert!(
        words.starts_with("on the edge of another motion: safe to 1.0024 P; from there on a motion has "),
        "{words}"
    );
    let mut loose = design;
    loose.certificate = Margins { force: 0.002, errors: 0.001 };
    assert_eq!(json!(good(certify(&loose)))["verdict"], "robust");
}

/// A window that ends before the motion has settled misses what the same run reaches later: no other start is needed for it.
#[test]
fn contract_a_window_too_short_is_not_said_to_be_another_start() {
    let desk = Desk::with(&tiny());
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    let certificate = good(certify(&study));
    let seen = json!(certificate);
    assert_eq!(seen["verdict"], "from rest only", "{certificate}");
    assert_eq!(seen["motions"]["largest"]["from_rest"], true, "{certificate}");
    let words = "; but runs from rest between its samples, or longer ones, lead to ";
    let said = seen["words"].as_str().expect("words");
    assert!(said.starts_with("robust on the runs of the study only: ") && said.contains(words), "{said}");
}

/// The damper of `results/ssvi` has 225.814 J, 0.02 J more than that with the isola, and is taken.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_of_two_as_good_the_search_takes_the_one_that_is_safe() {
    let mut study = committed("ssvi-isola.json");
    let at = |k2: f64, c2: f64, d: f64, c: f64| json!({ "k2": k2, "c2": c2, "D": d, "C": c });
    study["optimize"]["starts"] =
        json!([at(597.274, 95.72416, 0.6072129, 0.037405), at(583.9214, 94.970517, 0.0288498, 1.1045446)]);
    // The ends are the starts, or with a smaller D: the value does not depend on it, and with 30 mm more the isola is gone.
    study["optimize"]["refine"]["MaxIter"] = json!(0);
    study["optimize"]["bounds"]["D"] = json!([0.0, 0.6072129]);
    let desk = Desk::with(&study);
    let optimum = found(good(tune(&request(&desk, "study.json", "out"), &Silent)));
    let seen = desk.read_json("out/optimum.json");
    assert!((number(&seen, "/k2") - 583.9214).abs() < 5.0, "{seen}");
    let passed = seen["passed_over"].as_array().expect("one");
    assert_eq!(passed.len(), 1);
    assert!(passed[0]["start"] == 1 && number(&passed[0], "/E1max") < number(&seen, "/E1max"));
    assert!(optimum.report().contains("passed over for it: start 1"), "{}", optimum.report());
}

/// As an objective: the same damper has the energy of its isola, and with the response "window" that of the run from rest.
#[test]
fn regress_the_response_motions_has_what_other_starts_lead_to() {
    let mut study = committed("ssvi-isola.json");
    let value = |study: &Value| {
        let desk = Desk::with(study);
        let study = retune_study::read(&desk.path("study.json")).expect("a study");
        study.energy(&study.scene).expect("a value")
    };
    assert!((value(&study) - 225.796).abs() < 1e-3);
    study["optimize"]["objective"]["response"] = json!("motions");
    assert!((value(&study) - 735.639).abs() < 1e-3);
    study["optimize"]["objective"]["quantity"] = json!("a1max");
    let all = value(&study);
    study["optimize"]["objective"]["response"] = json!("window");
    assert!(all > value(&study), "{all}");
}

/// A search follows the motions that it has learned to designs like the one where it did, and comes to the values of a whole look there.
#[test]
fn exact_a_search_follows_the_motions_that_it_has_learned() {
    let mut study = committed("ssvi-isola.json");
    study["optimize"]["objective"]["response"] = json!("motions");
    study["optimize"]["objective"]["omega"] = json!({ "from": 5.8, "to": 6.1, "samples": 4 });
    let desk = Desk::with(&study);
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    let search = study.search().expect("a search");
    let mut objective = searched(&study, &search, &search.variables);
    let own = [597.2737982898645, 95.72415913882642, 0.6072128825900359, 0.03740508433492577];
    let from_rest = objective.value(&own, f64::INFINITY);
    assert!(from_rest < 226.0, "{from_rest}");
    let all = objective.learn(&own).expect("a value").ranked;
    assert!((all - 735.639).abs() < 1e-3, "{all}");
    let near = [596.0, 95.9, 0.604, 0.0374];
    let followed = objective.value(&near, f64::INFINITY);
    let whole =
        study.goal().evaluate(&objective.scene(&near).expect("a scene"), objective.settings(), f64::INFINITY);
    let whole = whole.expect("a value").ranked;
    assert!(followed > 700.0 && (followed / whole - 1.0).abs() < 1e-9, "{followed} {whole}");
}
