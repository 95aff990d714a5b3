//! Searches under limits: what a simplex alone ended with, and what they find.

use crate::{found, request};
use retune_jobs::Silent;
use retune_jobs::tune::ends::ends;
use retune_jobs::tune::tune;
use retune_store::{Identity, Journal};
use retune_testkit::desk::{Desk, FOOTBRIDGE, committed, footbridge, number};
use retune_testkit::observers::good;
use serde_json::{Value, json};

fn tuned(study: &Value) -> Value {
    let desk = Desk::with(study);
    json!(found(good(tune(&request(&desk, "study.json", "out"), &Silent))))
}

#[test]
fn reference_the_tmd_of_a_footbridge_keeps_its_stroke() {
    let optimum = tuned(&footbridge());
    assert_eq!(optimum["limits"]["feasible"], true, "{optimum}");
    let (energy, before) =
        (number(&optimum, "/E1max"), number(&optimum, "/refine/runs/0/descent/E1max_before"));
    assert!((energy / FOOTBRIDGE - 1.0).abs() < 1e-4 && before > 1.1 * energy, "{energy} {before}");
    assert!(number(&optimum, "/limits/stroke") <= 0.0012);
}

/// The best TMD under this stroke has 168.5406 J in closed form, and its gaps can be opened: a search of an SSVI NES that hardly looks must not end
/// with more.
#[test]
fn regress_an_ssvi_nes_is_not_worse_than_the_tmd_that_it_can_be() {
    let mut study = committed("fronts-ssvi.json");
    let optimize = &mut study["optimize"];
    optimize["objective"]["omega"]["samples"] = json!(7);
    optimize["limits"] = json!({ "stroke": 0.2475, "from": 50 });
    optimize["refine"]["MaxFunEvals"] = json!(5);
    optimize.as_object_mut().expect("an object").remove("global");
    let desk = Desk::with(&study);
    let study = retune_study::read(&desk.path("study.json")).expect("a study");
    let journal = Journal::begin(&desk.path("journal"), &Identity::of("limits")).expect("a journal");
    let found = good(ends(&study, &journal, "", &Silent));
    assert!(found.value < 168.5406 * 1.0002, "{} J", found.value);
}

/// The gaps of a TMD within a cavity need not be as wide as the limit allows, nor as wide as a bound. At the limit "on the edge" was said of
/// the better design, which was passed over for a narrower one that meets its walls at 1.06 times the force; at a bound, that a wider one may give less.
#[test]
fn regress_gaps_that_no_stroke_reaches_are_no_edge() {
    let mut study = committed("retune-ssvi-free.json");
    let optimize = &mut study["optimize"];
    optimize["objective"]["omega"]["samples"] = json!(9);
    optimize["refine"]["MaxFunEvals"] = json!(5);
    optimize["vary"] = json!(["k2", "c2", "D", "C"]);
    optimize.as_object_mut().expect("an object").remove("global");
    let on_bounds = tuned(&study);
    let [d, c] = ["/D", "/C"].map(|gap| number(&on_bounds, gap));
    assert!(d >= 1.0 && c >= 2.0 && on_bounds["on_bound"] == json!([]), "{on_bounds}");
    study["optimize"]["limits"] = json!({ "cavity": 0.8 });
    let optimum = tuned(&study);
    assert!(number(&optimum, "/limits/cavity") < 0.8 / 1.005, "{}", optimum["limits"]);
    let [verdict, on_bound] = [&optimum["certificate"]["verdict"], &optimum["on_bound"]];
    assert!(*verdict == "robust" && *on_bound == json!([]), "{verdict} {on_bound}");
}
