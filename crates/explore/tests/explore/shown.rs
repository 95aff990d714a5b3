//! What a page shows: the run, its curves and its controls, of the study or of a forcing and a structure of one's own.

use crate::session::{answers, kind, look, place, start};
use crate::written::text;
use retune_explore::protocol::{DamperKind, Message, What};
use retune_explore::response;
use retune_explore::start::Start;
use retune_jobs::simulate::simulate;
use retune_model::{Measure, Parameter};
use serde_json::{Value, json};

#[test]
fn contract_the_built_in_study_is_that_of_the_repository() {
    let here = env!("CARGO_MANIFEST_DIR");
    let read = |path: &str| std::fs::read_to_string(format!("{here}/{path}")).expect("a file");
    assert_eq!(read("src/study.json"), read("../../studies/ssvi.json"));
}

/// What the page shows of a run is what `retune simulate` prints.
#[test]
fn contract_figures_are_those_of_simulate() {
    let set = [("k2", 583.9), ("c2", 94.97), ("D", 0.02885), ("C", 1.105), ("omega", 6.631)];
    let found = answers(vec![look(7, &set)], |answer| kind(answer) == "done");
    let motion = found.iter().find(|answer| kind(answer) == "motion").expect("a motion");
    let study = start().file_at(&place(DamperKind::Ssvi, &set)).expect("a study");
    let run = simulate(&study, None).expect("a run");
    assert_eq!(motion.get("text"), Some(&json!(run.to_string())));
    let e1_max = json!(run)["E1max"].clone();
    assert_eq!(motion.get("run").map(|run| run["E1max"].clone()), Some(e1_max));
    assert_eq!(motion.get("id"), Some(&json!(7)));
    let worst = found.iter().find(|answer| kind(answer) == "worst").expect("a worst");
    assert_eq!(worst.get("words"), Some(&json!("225.8"))); // README: what `just optimize-ssvi` finds
}

/// The settled states come from the record of the regime, in other coordinates: they are where the run ends, too.
#[test]
fn reference_settled_crests_are_those_of_the_run() {
    let set = [("k2", 583.9), ("c2", 94.97), ("D", 0.02885), ("C", 1.105), ("omega", 6.631)];
    let found = answers(vec![look(1, &set)], |answer| kind(answer) == "done");
    let last = |of: &str, column: &str| {
        let answer = found.iter().find(|answer| kind(answer) == of).expect("an answer");
        *answer.numbers(column).expect("a column").last().expect("a crest")
    };
    for (column, size) in [("crest.x1", 0.09), ("crest.v1", 0.6), ("crest.x", 0.5), ("crest.v", 1.5)] {
        let [run, settled] = ["motion", "motion kind"].map(|of| last(of, column));
        assert!((run - settled).abs() < 1e-3 * size, "{column}: {run} {settled}");
    }
}

/// A curve of what has a limit is of all that the limit covers, the run from rest on; that of what the study makes small is of its window.
#[test]
fn exact_curves_of_any_quantity_are_of_what_limits_cover() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/src/study.json")).expect("a study");
    let limited = text.replace("\"vary\"", "\"limits\": { \"stroke\": 0.6, \"x1max\": 0.1 }, \"vary\"");
    let study = retune_study::read::from_text(&limited, "limited.json").expect("a study");
    let at = |omega: f64, t0: f64| {
        let set = [format!("omega={omega}"), format!("t0={t0}")].map(|set| set.parse().expect("a setting"));
        simulate(&study.with(&set).expect("a study"), None).expect("a run")
    };
    for (quantity, t0) in [(Measure::Energy, 50.0), (Measure::Stroke, 0.0), (Measure::ContactForce, 0.0)] {
        let run = at(5.9, t0).summary.largest(quantity);
        assert_eq!(response::Curve::of(&study, quantity).at(5.9), run, "{quantity:?}");
    }
    let [window, whole] = [50.0, 0.0].map(|t0| at(5.9, t0).summary.largest(Measure::Stroke));
    assert!(window < whole, "{window} {whole}: the case tells the two apart");
    let drawn = json!(Measure::ALL.map(|quantity| response::Drawn::of(&study, quantity)));
    let of =
        |name: &str| drawn.as_array().and_then(|all| all.iter().find(|one| one["name"] == name)).cloned();
    let stroke = of("stroke").expect("a quantity");
    assert_eq!(
        (&stroke["limit"], &stroke["part"], &stroke["limit_part"]),
        (&json!(0.6), &json!("from rest on"), &json!("from rest on"))
    );
    assert_eq!(
        of("E1max").map(|energy| (energy["limit"].clone(), energy["part"].clone())),
        Some((Value::Null, json!("from 50 s on")))
    );
    let bare = response::bare(&study);
    assert!(
        !response::Curve::of(&bare, Measure::Stroke).is_there()
            && response::Curve::of(&bare, Measure::Energy).is_there()
    );
}

/// A look at a quantity is answered with its curves alone, and the same look again with none.
#[test]
fn contract_curves_are_of_the_quantity_that_is_asked_for() {
    let look = |id: u64| {
        let place = place(DamperKind::Ssvi, &[]);
        let quantity = Some(Measure::Stroke);
        let message = Message::Look { id, place, span: None, columns: 400, branches: false, quantity };
        serde_json::to_string(&message).expect("a message")
    };
    let found = answers(vec![look(1)], |answer| kind(answer) == "done");
    let curves: Vec<_> = found.iter().filter(|answer| kind(answer) == "response").collect();
    assert!(curves.iter().all(|curve| curve.get("quantity") == Some(&json!("stroke"))));
    assert_eq!(curves.len(), 2, "none without a damper");
    let largest = curves[1].numbers("value").expect("a curve").into_iter().fold(0.0, f64::max);
    let worst = found.iter().find(|answer| kind(answer) == "worst").and_then(|worst| worst.get("figures"));
    let words = worst.and_then(|figures| figures["stroke"].as_str()?.parse::<f64>().ok()).expect("a number");
    assert!((largest / words - 1.0).abs() < 5e-3, "{largest} {words}");
}

/// A pulse and a record take the place of the study's forcing, whatever the damper: what is shown is the run of a study that says so.
#[test]
fn contract_a_pulse_or_a_record_moves_the_structure() {
    let pulse = json!({ "pulse": "half sine", "of": "force", "peak": 10, "unit": "kN", "duration": 0.1 });
    let record = json!({ "record": "a.csv", "of": "base acceleration", "unit": "g" });
    let force = |forcing: &Value, text: Option<&str>| {
        json!({ "force": { "forcing": forcing, "text": text } }).to_string()
    };
    let look = look(1, &[("k2", 300.0)]);
    for (forcing, text) in [(&pulse, None), (&record, Some("t,a\n0,0\n0.5,0.2\n1.5,-0.1\n2,0\n"))] {
        let found = answers(vec![force(forcing, text), look.clone()], |answer| kind(answer) == "done");
        let hello = found.iter().rfind(|answer| kind(answer) == "hello").expect("another study");
        assert_eq!([hello.get("transient"), hello.get("own")], [Some(&json!(true)), Some(&json!(false))]);
        assert!(
            found.iter().all(|answer| kind(answer) != "response"),
            "a transient has no response over frequencies"
        );
        let motion = found.iter().find(|answer| kind(answer) == "motion").expect("a motion");
        let Value::Object(fields) = forcing.clone() else { panic!("an object") };
        let start = start().under(fields, text).expect("a forcing");
        let saved = text_of(&start, &[("k2", 300.0)]);
        let study =
            retune_study::read::from_text(&saved, "ssvi.json").expect("a study that needs no other file");
        let run = simulate(&study, None).expect("a run");
        assert_eq!(motion.get("text"), Some(&json!(run.to_string())));
        let worst = found.iter().find(|answer| kind(answer) == "worst").expect("a worst");
        let energy = run.summary.largest(Measure::Energy);
        assert_eq!(worst.get("value").and_then(Value::as_f64), Some(energy));
        let curve = motion.numbers("forcing").expect("a curve").into_iter().fold(0.0, f64::max);
        let peak = if text.is_some() { 0.2 * 9.80665 } else { 10_000.0 };
        assert!((curve / peak - 1.0).abs() < 1e-2, "{curve} {peak}");
    }
    // Back to the study's own, after a slip that changed nothing.
    let slip = json!({ "pulse": "half sine", "of": "force", "peak": 10, "unit": "kg", "duration": 0.1 });
    let messages = vec![force(&pulse, None), force(&slip, None), force(&Value::Null, None), look];
    let found = answers(messages, |answer| kind(answer) == "done");
    let refused = found.iter().find(|answer| kind(answer) == "refused").expect("a slip");
    assert!(
        refused.get("force") == Some(&json!(true))
            && refused.get("problem").is_some_and(|words| words.to_string().contains("N, kN"))
    );
    let last = found.iter().rfind(|answer| kind(answer) == "hello").expect("the study");
    assert_eq!(last.get("transient"), Some(&json!(false)));
}

fn text_of(start: &Start, set: &[(&str, f64)]) -> String {
    text(start, &place(DamperKind::Ssvi, set), What::Study)
}

/// Every parameter that the scene has can be turned, within what a study may have.
#[test]
fn contract_every_parameter_of_the_scene_can_be_turned() {
    let controls = start().controls();
    let scene = start().study().scene;
    let there: Vec<&str> =
        Parameter::ALL.iter().filter(|one| one.of(&scene).is_some()).map(|one| one.symbol()).collect();
    assert!(there.len() >= 20 && controls.len() == there.len(), "{} {}", controls.len(), there.len());
    for control in &controls {
        assert!(there.contains(&control.name), "{}", control.name);
        for value in control.range {
            let found = start().at(&place(DamperKind::Ssvi, &[(control.name, value)]));
            assert!(found.is_ok(), "{} = {value}: {:?}", control.name, found.err());
        }
    }
    let sizes: Vec<_> =
        controls.iter().filter(|control| control.amplitude).map(|control| control.name).collect();
    assert_eq!(sizes, ["P"]);
    let k2 = controls.iter().find(|control| control.name == "k2").expect("a control");
    assert_eq!((k2.bounds, k2.of_contact), ([Some(10.0), Some(600.0)], false));
    assert!(
        controls
            .iter()
            .any(|control| control.name == "R" && control.of_contact && control.bounds == [None; 2])
    );
}

/// Irregular motion is said to be one, and its neighbours are run.
#[test]
fn contract_an_irregular_motion_comes_with_its_neighbours() {
    let found = answers(vec![look(1, &[])], |answer| kind(answer) == "done");
    let of = |name: &str| found.iter().find(|answer| kind(answer) == name);
    let irregular = of("motion kind").and_then(|answer| answer.get("irregular")).cloned();
    assert_eq!(irregular, Some(json!(true))); // the paper's damper at its ω
    let range = of("spread").and_then(|answer| answer.get("range")).cloned().expect("a spread");
    let own =
        of("motion").and_then(|answer| answer.get("run")).map(|run| run["E1max"].clone()).expect("a run");
    assert!(range[0].as_f64() < range[1].as_f64() && own.is_number(), "{range} {own}");
}

/// A structure in words is that of `retune design`, with its formula's TMD; a slip names its field, and the session goes on as it was.
#[test]
fn contract_a_structure_of_ones_own_takes_the_place_of_the_study() {
    let structure = json!({ "m1": "40 t", "f1": "2 Hz", "zeta": "0.5 %", "force": "280 N", "band": "1.8..2.2 Hz", "mass": "2 %" });
    let with = |field: &str, value: &str| {
        let mut other = structure.clone();
        other[field] = json!(value);
        json!({ "own": { "structure": other } }).to_string()
    };
    let place = json!({ "damper": "tmd", "set": {} });
    let look = json!({ "look": { "id": 3, "place": place, "columns": 100 } }).to_string();
    let found = answers(vec![with("m1", "40 kN"), with("m1", "40 t"), look], |answer| {
        kind(answer) == "done" && answer.get("id") == Some(&json!(3))
    });
    let refused = found.iter().find(|answer| kind(answer) == "refused").expect("a slip");
    assert_eq!([refused.get("field"), refused.get("own")], [Some(&json!("m1")), Some(&json!(true))]);
    let own = found.iter().filter(|answer| kind(answer) == "hello").nth(1).expect("another study");
    assert_eq!([own.get("own"), own.get("damper")], [Some(&json!(true)), Some(&json!("tmd"))]);
    let controls = own.get("controls").and_then(Value::as_array).expect("controls");
    let control = |name: &str| controls.iter().find(|control| control["name"] == name).expect("a control");
    let value = |name: &str| control(name)["value"].as_f64().expect("a number");
    let (natural, mu) = (2.0 * std::f64::consts::TAU, 0.02);
    // Den Hartog: ω2 = ω1 / (1 + μ).
    let k2 = 800.0 * (natural / (1.0 + mu)).powi(2);
    assert!((value("k2") / k2 - 1.0).abs() < 1e-12 && value("m2") == 800.0, "{} {k2}", value("k2"));
    assert!(control("k2")["units"].as_array().is_some_and(|units| units.contains(&json!(["kN/m", 1e3]))));
    let worst = found.iter().rev().find(|answer| kind(answer) == "worst").expect("a worst");
    assert!(worst.get("value").and_then(Value::as_f64).is_some_and(|worst| worst > 0.5 && worst < 0.7));
    // Without a damper the structure has not settled in the window: what is told is its steady motion, about F / 2 ζ k1.
    let none: f64 =
        worst.get("none").and_then(Value::as_str).and_then(|none| none.parse().ok()).expect("a number");
    let stiffness = 4e4 * natural * natural;
    let steady = 0.5 * stiffness * (280.0 / (2.0 * 0.005 * stiffness)).powi(2);
    assert!((none / steady - 1.0).abs() < 1e-3, "{none} {steady}");
    assert!(["D", "C"].iter().all(|gap| value(gap) > 1e-4), "the gaps of an SSVI NES are scaled");
}

/// A pulse moves a structure of one's own, too, whichever damper hangs on it.
#[test]
fn contract_a_pulse_moves_a_structure_of_ones_own() {
    let structure = json!({ "m1": "40 t", "f1": "2 Hz", "zeta": "0.5 %", "force": "280 N", "band": "1.8..2.2 Hz", "mass": "2 %" });
    let pulse = json!({ "pulse": "half sine", "of": "force", "peak": 10, "unit": "kN", "duration": 0.1 });
    for damper in ["tmd", "ssvi"] {
        let place = json!({ "damper": damper, "set": {} });
        let asked = [
            json!({ "own": { "structure": structure } }),
            json!({ "force": { "forcing": pulse, "text": null } }),
            json!({ "look": { "id": 5, "place": place, "columns": 100 } }),
        ];
        let found = answers(asked.map(|message| message.to_string()).to_vec(), |answer| {
            kind(answer) == "refused" || kind(answer) == "done" && answer.get("id") == Some(&json!(5))
        });
        assert!(found.iter().all(|answer| kind(answer) != "refused"), "{damper} is refused");
        let hello = found.iter().rfind(|answer| kind(answer) == "hello").expect("another study");
        assert_eq!([hello.get("transient"), hello.get("damper")], [Some(&json!(true)), Some(&json!("tmd"))]);
    }
}
