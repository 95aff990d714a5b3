//! `design` under shocks and records.

use crate::{asked, make};
use retune_jobs::design::Requirements;
use retune_jobs::{Error, Silent};
use retune_model::{Design, Parameter};
use retune_solver::Method;
use retune_testkit::desk::{Desk, flat};
use retune_testkit::observers::{good, refused};
use serde_json::{Value, json};

/// A building in a record with a file beside, and the studies of its dampers.
fn in_a_record(more: &[(&str, Value)]) -> (Desk, Result<Requirements, Error>) {
    let desk = Desk::new();
    let line = |i: u32| {
        let t = 0.02 * f64::from(i);
        format!("{t},{}\n", 0.3 * (6.0 * t).sin() * (-0.1 * t).exp())
    };
    let text: String = (0..=500).map(line).collect();
    std::fs::write(desk.path("shaking.csv"), format!("t,a\n{text}")).expect("a file");
    let mut specification =
        json!({ "m1": "2t", "f1": "1Hz", "zeta": "1%", "mass": "5%", "record": "shaking.csv,unit=g" });
    for (name, value) in more {
        specification[*name] = value.clone();
    }
    let file = desk.path("asked.json").display().to_string();
    let requirements = asked(specification).within(&file).requirements();
    (desk, requirements)
}

/// The TMD of a record has the least value of runs that another method makes; its numbers are those of such runs.
#[test]
fn reference_the_tmd_of_a_record_is_the_best_of_runs_by_another_method() {
    for (goal, after) in [("x1max", "0 s"), ("E1max", "12 s")] {
        let (desk, requirements) =
            in_a_record(&[("goal", json!(goal)), ("damper", json!("tmd")), ("after", json!(after))]);
        let requirements = good(requirements);
        make(&desk, &requirements, &Silent);
        let found = desk.read_json("out/design.json");
        let tmd = &found["candidates"][1];
        let own = tmd["in_window"][goal]["value"].as_f64().expect("a number");
        // Drawn to scale is the largest motion of the whole run.
        let page = std::fs::read_to_string(desk.path("out/report.html")).expect("a page");
        let drawn = page.split("the structure moves by ± ").nth(1).and_then(|rest| rest.split(' ').next());
        let drawn: f64 = drawn.expect("a drawing").parse().expect("a number");
        let [whole, window] = ["from_rest", "in_window"]
            .map(|run| 1e3 * tmd[run]["x1max"]["value"].as_f64().expect("a number"));
        assert!((drawn / whole - 1.0).abs() < 1e-3, "{drawn} {whole}");
        assert!(after == "0 s" || whole > 1.01 * window, "{whole} {window}");
        let mut study = good(requirements.tmd());
        assert_eq!(
            (study.window.t0.get(), study.window.end.get()),
            if goal == "x1max" { (0.0, 20.0) } else { (12.0, 22.0) }
        );
        study.solver.method = Method::Dop853;
        study.solver.rtol = 1e-9;
        let value = |shares: [f64; 2]| {
            let number =
                |parameter: Parameter| tmd["design"][parameter.symbol()].as_f64().unwrap_or(f64::NAN);
            let at = |parameter: Parameter| match parameter {
                Parameter::K2 => shares[0] * number(parameter),
                Parameter::C2 => shares[1] * number(parameter),
                _ => f64::NAN,
            };
            let scene = study.scene_at(&Design::new(at).expect("a design")).expect("a scene");
            study.energy(&scene).expect("a run")
        };
        assert!((value([1.0; 2]) / own - 1.0).abs() < 1e-6, "{own}");
        for shares in [[0.9, 1.0], [1.1, 1.0], [1.0, 0.8], [1.0, 1.25], [0.97, 1.1], [1.03, 0.9], [0.5, 2.0]]
        {
            assert!(value(shares) > own, "{goal} {shares:?}");
        }
        let formula = &found["formulas"][0]["damper"]["in_window"][goal]["value"];
        assert!(formula.as_f64().is_some_and(|formula| formula > own), "{formula}");
        let page = desk.read("out/README.md");
        assert!(page.contains("shaking.csv, 501 samples to 10 s") && page.contains("motion.svg"), "{page}");
    }
}

/// The SSVI NES of a shock comes from runs: what is told of it is what its study finds, under either sign of the shock.
#[test]
fn exact_the_ssvi_nes_of_a_shock_has_what_its_study_finds() {
    let desk = Desk::new();
    let of = |peak: &str| {
        json!({
            "m1": "2t", "f1": "3Hz", "zeta": "1%", "mass": "5%", "shock": format!("half-sine,0.1s,{peak}"),
            "after": "2s", "limits": { "k2": "10 kN/m" }, "damper": "both"
        })
    };
    let requirements = good(asked(of("20kN")).requirements());
    make(&desk, &requirements, &Silent);
    let found = desk.read_json("out/design.json");
    assert_eq!(found["build"], "SSVI NES", "{found}");
    let ssvi = &found["candidates"][2];
    let number = |parameter: Parameter| ssvi["design"][parameter.symbol()].as_f64().unwrap_or(f64::NAN);
    let energy = |peak: &str| {
        let study = good(good(asked(of(peak)).requirements()).ssvi());
        study
            .energy(&study.scene_at(&Design::new(number).expect("a design")).expect("a scene"))
            .expect("a run")
    };
    let own = ssvi["in_window"]["E1max"]["value"].as_f64().expect("a number");
    assert!((energy("20kN") / own - 1.0).abs() < 1e-9, "{own}");
    let other = found["SSVI_NES_with_other_sign"].as_f64().expect("a number");
    assert!((energy("-20kN") / other - 1.0).abs() < 1e-9 && other != own, "{other}");
    assert!(number(Parameter::K2) <= 10e3, "the limit holds");
    let answer = desk.read("out/answer.txt");
    assert!(
        flat(&answer).contains("a half sine of 20000 N for 0.1 s") && answer.contains("With the other sign"),
        "{answer}"
    );
    // A damper that is worse than the TMD under the other sign is said to be.
    let tmd = found["candidates"][1]["in_window"]["E1max"]["value"].as_f64().expect("a number");
    assert_eq!(flat(&answer).contains("more than the"), other > tmd, "{other} {tmd}: {answer}");
}

#[test]
fn contract_a_shock_and_a_record_are_refused_with_what_to_give() {
    let null = Value::Null;
    for (more, words) in [
        (vec![("band", json!("1Hz..2Hz"))], "band: record is given, which has no band of frequencies"),
        (vec![("force", json!("1kN"))], "force: record is given too: leave one of them out"),
        (vec![("shock", json!("half-sine,20ms,5g"))], "record: shock is given too"),
        (vec![("after", json!("-1s"))], "after: -1s is not allowed here: give a time not below 0"),
        (vec![("record", null.clone()), ("after", json!("1s"))], "after: is for a shock or a record"),
        (vec![("record", json!("none.csv"))], "none.csv: cannot be read"),
        (vec![("record", json!("shaking.csv,unit=kg"))], "`unit`: \"kg\" is not allowed here"),
        (vec![("record", json!("shaking.csv,column=b"))], "no values in a column \"b\""),
        (vec![("record", json!("shaking.csv,colum=a"))], "\"colum=a\" is not known: give FILE and"),
        (vec![("record", json!("shaking.csv,scale=much"))], "scale: \"much\" is not a number"),
        (vec![("record", json!("shaking.csv,scale=0"))], "is zero all the time"),
    ] {
        let (_desk, requirements) = in_a_record(&more);
        let sentence = refused(requirements).to_string();
        assert!(sentence.contains(words), "{sentence}");
    }
    for (shock, words) in [
        ("half,20ms,5g", "\"half\" is none: give one of half-sine, versed-sine, rectangle"),
        ("half-sine,5g", "is not of the form SHAPE,DURATION,PEAK"),
        ("half-sine,20ms,5", "\"5\" is no peak: give an acceleration of the base with its unit"),
        ("half-sine,20ms,nan g", "is no peak"),
        ("half-sine,20kg,5g", "\"20kg\" is not a number in s"),
        ("half-sine,0s,5g", "the duration 0s is not allowed here: give a time above 0"),
        ("rectangle,20ms,0N", "is zero all the time: nothing moves the structure"),
    ] {
        let (_desk, requirements) = in_a_record(&[("record", null.clone()), ("shock", json!(shock))]);
        let sentence = refused(requirements).to_string();
        assert!(sentence.contains("asked.json: shock: ") && sentence.contains(words), "{sentence}");
    }
}

/// The certificate is over every stiffness that the value is over: at a quarter of them a damper was called sensitive, since what one parameter off
/// gives stood beside a smaller value.
#[test]
fn regress_the_certificate_is_over_all_stiffnesses_of_a_record() {
    let (desk, requirements) =
        in_a_record(&[("goal", json!("E1max")), ("damper", json!("tmd")), ("k1_error", json!("20 %"))]);
    make(&desk, &good(requirements), &Silent);
    let said = desk.read_json("out/design.json");
    let study = retune_study::read(&desk.path("out/studies-tmd.json")).expect("a study");
    let certificate = good(retune_jobs::certify::judge(&study));
    assert_eq!(said["certificate"]["words"], certificate.reason(), "{said}");
    let value = said["candidates"][1]["in_window"]["E1max"]["value"].as_f64().expect("a number");
    let certified = json!(certificate)["E1max"].as_f64().expect("a number");
    assert!((certified / value - 1.0).abs() < 1e-9, "{certified} {value}");
}
