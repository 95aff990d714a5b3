//! Searches and objectives that contradict themselves: one clear message each.

use crate::refused::{problem, refused, refused_text};
use retune_optim::Scale;
use retune_study::read::from_text;
use retune_study::{Rule, StudyError};
use retune_testkit::desk::{global, tiny};
use serde_json::{Value, json};

#[test]
fn contract_contradictions_in_a_search_are_named() {
    let from_to = |from: f64, to: f64, points: u64| json!({ "from": from, "to": to, "points": points });
    refused(
        "/optimize/surf/k2",
        from_to(300.0, 200.0, 3),
        "optimize.surf.k2: the range is empty: `from` 300 is above `to` 200",
    );
    refused(
        "/optimize/surf/k2",
        from_to(5.0, 200.0, 3),
        "optimize.surf.k2: from 5 to 200 leaves the bounds [10, 1000]",
    );
    refused(
        "/optimize/surf/k2/from",
        json!(0),
        "optimize.surf.k2: `from` is 0: both ends of a logarithmic axis must be above zero",
    );
    refused(
        "/optimize/bounds/k2",
        json!([400, 100]),
        "optimize.bounds.k2: [400, 100] is not allowed here: give [smallest, largest] with 0 <= smallest < largest",
    );
    refused("/optimize/vary", json!([]), "optimize.vary: empty: name at least one of k2, c2, D, C, m2, R");
    refused("/optimize/vary", json!(["k2", "C", "k2"]), "optimize.vary: `k2` is named twice");
    refused(
        "/optimize/vary",
        json!(["k2", "c2", "D"]),
        "optimize.surf.C: `C` is not tuned: add it to `vary` or leave it out here",
    );
    refused("/scene/damper", Value::Null, "scene.damper: missing, but `optimize` tunes the damper");
    let mut study = tiny();
    study["optimize"]["surf"] = Value::Null;
    study["scene"]["damper"]["k2"] = json!(5);
    refused_text(
        &study.to_string(),
        "scene.damper.k2: 5 is where the refinement starts, but lies outside the bounds [10, 1000]",
    );
}

#[test]
fn contract_invalid_bands_are_refused() {
    let refused = |objective: Value, message: &str| {
        let mut study = tiny();
        study["optimize"]["objective"] = objective;
        refused_text(&study.to_string(), message);
    };
    refused(
        json!({ "omega": { "from": 8, "to": 5 } }),
        "optimize.objective.omega: from = 8 rad/s is not below to = 5 rad/s: the band is empty",
    );
    refused(
        json!({ "omega": { "from": 5, "to": 8, "samples": 1 } }),
        "optimize.objective.omega.samples: 1 is not allowed here: give a whole number from 2 to 10000",
    );
    refused(
        json!({ "omega": { "from": 0, "to": 8 } }),
        "optimize.objective.omega.from: 0 is not allowed here: give a finite number above 0",
    );
    refused(
        json!({ "omega": { "from": 5, "till": 8 } }),
        "optimize.objective.omega: unknown field `till`; allowed: from, to, samples, relative",
    );
    refused(json!({ "omega": { "from": 5 } }), "optimize.objective.omega.to: missing, and it has no default");
    refused(
        json!({ "omega": 6.5 }),
        "optimize.objective.omega: wrong type: number `6.5`, expected an object",
    );
    refused(
        json!({ "omga": { "from": 5, "to": 8 } }),
        "optimize.objective: unknown field `omga`; did you mean `omega`? allowed: quantity, omega, k1, restitution, records, records_by, response, starts, settle, ensemble, sum",
    );
    refused(
        json!({ "response": "stead" }),
        "optimize.objective.response: \"stead\" is not allowed here; did you mean `steady`? allowed: window, steady, settled, motions",
    );
}

/// A list of records stands in the place of a record, and has nothing but such.
#[test]
fn contract_records_stand_in_the_place_of_one() {
    let pulse = json!({ "pulse": "half sine", "of": "force", "peak": 1, "duration": 1 });
    let refused = |forcing: Option<&Value>, objective: Value, message: &str| {
        let mut study = tiny();
        if let Some(forcing) = forcing {
            study["scene"]["forcing"] = forcing.clone();
        }
        study["optimize"]["objective"] = objective;
        refused_text(&study.to_string(), message);
    };
    refused(
        None,
        json!({ "records": [pulse] }),
        "optimize.objective.records: a list is not allowed here: give nothing: `scene.forcing` is neither a record nor a pulse, whose place they could take",
    );
    refused(
        Some(&pulse),
        json!({ "records": [pulse, { "P": 1, "omega": 2 }] }),
        "optimize.objective.records[1]: `P` is not allowed here: give one of `pulse`, `record`, `harmonics`, `sweep` and `spectrum`",
    );
    refused(
        Some(&pulse),
        json!({ "records_by": "mean" }),
        "optimize.objective.records_by: a statistic is not allowed here: give nothing without `records`, or `records` beside it",
    );
    refused(
        Some(&pulse),
        json!({ "records": [pulse], "records_by": { "quantile": 2 } }),
        "optimize.objective.records_by.quantile: 2 is not allowed here: give a number above 0 and at most 1",
    );
    refused(
        Some(&pulse),
        json!({ "records": [{ "record": "none.csv", "of": "force" }] }),
        "optimize.objective.records: none.csv: cannot be read: No such file or directory (os error 2)",
    );
}

/// A decay time needs an end of what acts, within the run.
#[test]
fn contract_a_decay_time_counts_from_the_end_of_the_forcing() {
    let pulse = json!({ "pulse": "half sine", "of": "force", "peak": 1, "duration": 30 });
    let with = |forcing: Option<&Value>, objective: Value, limits: Value| {
        let mut study = tiny();
        study["window"] = json!({ "t0": 0, "T": 20 });
        if let Some(forcing) = forcing {
            study["scene"]["forcing"] = forcing.clone();
        }
        study["optimize"]["objective"] = objective;
        study["optimize"]["limits"] = limits;
        study.to_string()
    };
    let decay = || json!({ "quantity": "decay_time" });
    let limit = || json!({ "decay_time": "3 s" });
    let another = "give another quantity: a decay time is that after a pulse or a record, or of a free decay";
    let beyond = "with T = 20 s is not allowed here: give a T of `window` beyond the end of every pulse and record, from which a decay time counts";
    let quantity = "optimize.objective.quantity: decay_time";
    refused_text(&with(None, decay(), json!({})), &format!("{quantity} is not allowed here: {another}"));
    let refused = format!("optimize.limits.decay_time: 3 is not allowed here: {another}");
    refused_text(&with(None, json!({}), limit()), &refused);
    refused_text(&with(Some(&pulse), decay(), json!({})), &format!("{quantity} {beyond}"));
    refused_text(&with(Some(&pulse), json!({}), limit()), &format!("optimize.limits.decay_time: 3 {beyond}"));
    let mut short = pulse.clone();
    short["duration"] = json!(1);
    let records = json!({ "quantity": "decay_time", "records": [short, pulse] });
    refused_text(&with(Some(&short), records, json!({})), &format!("{quantity} {beyond}"));
    for (objective, limits) in [(decay(), json!({})), (json!({}), limit())] {
        let read = from_text(&with(Some(&short), objective, limits), "tiny");
        assert!(read.is_ok(), "{read:?}");
    }
}

#[test]
fn contract_a_million_million_points_are_refused_at_once() {
    let mut study = tiny();
    for axis in ["k2", "c2", "D", "C"] {
        study["optimize"]["surf"][axis]["points"] = json!(1000);
    }
    refused_text(&study.to_string(), "optimize.surf: the grid has 1e12 points: at most 10000000 are allowed");
}

/// Rules that several fields break together are values as well as words.
#[test]
fn contract_contradictions_are_typed() {
    let rule = |pointer: &str, value: Value| {
        let mut study = tiny();
        *study.pointer_mut(pointer).expect(pointer) = value;
        match from_text(&study.to_string(), "bad.json").expect_err("a contradiction") {
            StudyError::Rule { rule, .. } => rule,
            other => panic!("{other}"),
        }
    };
    assert_eq!(rule("/window/t0", json!(4)), Rule::EmptyWindow { t0: 4.0, end: 4.0 });
    assert_eq!(rule("/scene/damper", Value::Null), Rule::NoDamper);
    assert_eq!(rule("/optimize/vary", json!([])), Rule::NothingVaried);
    assert_eq!(
        rule("/optimize/refine/starts", json!(0)),
        Rule::not_allowed("optimize.refine.starts", 0, "a whole number above 0")
    );
}

#[test]
fn contract_invalid_objectives_are_refused() {
    for (objective, message) in [
        (
            json!({ "k1": { "set": [] } }),
            "optimize.objective.k1.set: an empty list is not allowed here: give at least one",
        ),
        (
            json!({ "k1": { "range": { "from": 4e4, "to": 4e4, "samples": 3 } } }),
            "optimize.objective.k1.range: from = 40000 N/m is not below to = 40000 N/m: the band is empty",
        ),
        (json!({ "settle": { "blocks": 1 } }), "optimize.objective.settle.blocks: 1 is not allowed here"),
        (
            json!({ "ensemble": { "members": 0 } }),
            "optimize.objective.ensemble.members: 0 is not allowed here",
        ),
        (
            json!({ "ensemble": { "members": 2, "statistic": { "quantile": 1.5 } } }),
            "optimize.objective.ensemble.statistic.quantile: 1.5 is not allowed here: give a number above 0 and at most 1",
        ),
        (
            json!({ "response": "steady", "sum": [{ "weight": 1, "objective": {} }] }),
            "optimize.objective.sum: stands in the place of quantity, omega, k1, response, starts, settle and ensemble",
        ),
        (
            json!({ "quantity": "contact_force", "response": "steady" }),
            "optimize.objective.quantity: contact_force is not allowed here: give another quantity, or another response",
        ),
        (
            json!({ "sum": [
                { "weight": 1, "objective": {} }, { "weight": 1, "objective": { "quantity": "x1max" } }
            ] }),
            "optimize.objective.sum[1].objective.quantity: x1max is not allowed here: give the same quantity in all parts",
        ),
        (
            json!({ "sum": [{ "weight": 1, "objective": { "omega": { "from": 8, "to": 5 } } }] }),
            "optimize.objective.sum[0].objective.omega: from = 8 rad/s is not below to = 5 rad/s",
        ),
    ] {
        let said = problem(&global(objective, json!({})).to_string());
        assert!(said.starts_with(message), "{message}: {said}");
    }
    let mut open = global(json!({}), json!({}));
    open["optimize"]["bounds"] = json!({});
    let said = problem(&open.to_string());
    let message = "optimize.global.box.k2: missing, and optimize.bounds.k2 has no largest value";
    assert!(said.starts_with(message), "{said}");
}

/// Unless it says otherwise.
#[test]
fn contract_a_side_of_a_box_that_spans_a_decade_is_logarithmic() {
    let sides = json!({ "k2": { "from": 10, "to": 100 }, "c2": { "from": 10, "to": 99 }, "D": { "from": 0, "to": 0.1 } });
    let mut scaled = global(json!({}), json!({}));
    scaled["optimize"]["global"]["box"] = sides;
    let study = from_text(&scaled.to_string(), "a.json").expect("a study");
    let (_, space, _) = study.search().expect("a search").global.expect("a global search");
    let scales: Vec<Scale> = space.0.iter().map(|side| side.scale).collect();
    assert_eq!(scales[..3], [Scale::Log, Scale::Linear, Scale::Linear]);
}
