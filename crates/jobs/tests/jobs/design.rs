//! `design`: from a structure to two dampers, on structures of very different size.

use crate::{asked, make};
use retune_jobs::design::{Driving, Requirements, Specification, Typed};
use retune_jobs::tune::optimize;
use retune_jobs::{Error, Request, Silent};
use retune_model::{Coupled, Damper, Design, Measure, NonNegative, Parameter};
use retune_optim::{Options, Scaling, minimize};
use retune_solver::{Method, Settings, Window, e1_max};
use retune_study::{Refine, Study};
use retune_testkit::desk::Desk;
use retune_testkit::observers::{good, refused};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;

/// The amplitude and the band of a harmonic.
fn harmonic(requirements: &Requirements) -> ((Parameter, f64), [f64; 2]) {
    match requirements.driving {
        Driving::Harmonic { amplitude: (of, size), band } => ((of.parameter(), size), band),
        Driving::History { .. } => panic!("a harmonic"),
    }
}

/// A structure of 500 kg, a machine foundation of 5 t at 12 Hz, a bench model of 2 kg at 25 Hz.
fn structures() -> [Requirements; 3] {
    let example =
        json!({ "m1": 500, "k1": "20 kN/m", "c1": 100, "P": "0.8 kN", "band": [5, 8], "mass": "5 %" });
    let at = |m1: f64, hertz: f64, share: &str| {
        let force = 1e-5 * m1 * (TAU * hertz).powi(2);
        json!({ "m1": m1, "f1": format!("{hertz} Hz"), "zeta": "1 %", "force": force, "band": "0.8 .. 1.25", "mass": share })
    };
    [example, at(5000.0, 12.0, "5 %"), at(2.0, 25.0, "10%")].map(|mut specification| {
        if specification["band"] == "0.8 .. 1.25" {
            let hertz: f64 = specification["f1"]
                .as_str()
                .and_then(|text| text.strip_suffix(" Hz")?.parse().ok())
                .expect("Hz");
            specification["band"] = json!(format!("{} .. {} Hz", 0.8 * hertz, 1.25 * hertz));
        }
        good(asked(specification).requirements())
    })
}

/// The answer with TMDs alone.
fn with_tmd(specification: Value) -> Value {
    let desk = Desk::new();
    let requirements = good(
        Specification { damper: Some(Typed::from("tmd".to_owned())), ..asked(specification) }.requirements(),
    );
    make(&desk, &requirements, &Silent);
    desk.read_json("out/design.json")
}

/// The largest steady value of a quantity that a candidate has, in its SI unit.
pub fn largest(answer: &Value, candidate: usize, name: &str) -> f64 {
    answer["candidates"][candidate]["steady"][name]["value"].as_f64().expect("a number")
}

/// The worst steady energy over the band is a closed form; another search of it, from Den Hartog's damper, finds the same optimum.
#[test]
fn reference_the_tmd_of_a_design_is_the_optimum_of_the_closed_form() {
    for requirements in structures() {
        let ((_, force), band) = harmonic(&requirements);
        let study = good(requirements.tmd());
        let damper = study.scene.damper.expect("a damper");
        let worst = |x: &[f64], _: f64| {
            let mut damper = damper;
            let [k2, c2] = [x[0], x[1]].map(NonNegative::new);
            let (Ok(k2), Ok(c2)) = (k2, c2) else { return f64::INFINITY };
            (damper.stiffness, damper.damping) = (k2, c2);
            Coupled::new(&study.scene.primary, &study.scene.forcing, &damper).steady_e1_max(band).value
        };
        let start = [damper.stiffness.get(), damper.damping.get()];
        let options = Options { scaling: Scaling::Start, tol_x: 1e-9, tol_fun: 1e-15, ..Options::default() };
        let own = minimize(worst, &start, options, |_| ControlFlow::Continue(())).expect("an optimum");
        let Requirements { m1, k1, c1, mass, .. } = requirements.clone();
        let found = with_tmd(json!({ "m1": m1, "k1": k1, "c1": c1, "P": force, "band": band, "mass": mass }));
        let e1_max = largest(&found, 1, "E1max");
        assert!((e1_max / own.value - 1.0).abs() < 1e-8, "{e1_max} {} {requirements:?}", own.value);
        for (name, value) in [("k2", own.x[0]), ("c2", own.x[1])] {
            let found = found["candidates"][1]["design"][name].as_f64().expect("a number");
            assert!((found / value - 1.0).abs() < 1e-3, "{name} {found} {value} {requirements:?}");
        }
    }
}

/// A structure that is driven off its resonance has its best TMD where it is driven: no design of a fine grid is better in closed form.
#[test]
fn reference_the_tmd_of_a_structure_driven_off_its_resonance() {
    let machine = json!({ "m1": "1200kg", "f1": "14Hz", "zeta": "1%", "mass": "120kg" });
    for (others, goal) in [
        (json!({ "imbalance": "0.02kg·m", "band": "30Hz..60Hz" }), Measure::Energy),
        (json!({ "imbalance": "0.02kg·m", "band": "30Hz..60Hz" }), Measure::Velocity),
        (json!({ "force": "180N", "band": "1Hz..3Hz", "mass": "40kg" }), Measure::GroundForce),
        (json!({ "imbalance": "0.02kg·m", "band": "32Hz..36Hz" }), Measure::Energy),
        (json!({ "base_acceleration": "0.1m/s²", "band": "40Hz..44Hz" }), Measure::Acceleration),
    ] {
        let mut all = machine.clone();
        all.as_object_mut().expect("an object").extend(others.as_object().cloned().expect("an object"));
        all["goal"] = json!(goal.name());
        let requirements = good(asked(all.clone()).requirements());
        let Driving::Harmonic { band, .. } = requirements.driving else { panic!("a harmonic") };
        let scene = good(requirements.tmd()).scene;
        let own = scene.damper.expect("a damper");
        let least = (0..100 * 20).map(|design| {
            let (tuning, zeta) = (f64::from(design % 100) / 99.0, f64::from(design / 100) / 19.0);
            let omega = 0.5 * band[0] * (3.0 * band[1] / band[0]).powf(tuning);
            let (k2, c2) =
                (own.mass.get() * omega * omega, 2.0 * own.mass.get() * omega * 0.001 * 500_f64.powf(zeta));
            let [stiffness, damping] = [k2, c2].map(|value| NonNegative::new(value).expect("a number"));
            let damper = Damper { stiffness, damping, ..own };
            Coupled::new(&scene.primary, &scene.forcing, &damper).steady_max(goal, band).value
        });
        let least = least.fold(f64::INFINITY, f64::min);
        let found = with_tmd(all);
        assert_eq!(found["build"], "TMD", "{found}");
        assert!(largest(&found, 1, goal.name()) <= 1.001 * least, "{goal:?}: {least}, {found}");
        assert_eq!(found["candidates"][0]["keeps_limits"], true);
    }
}

/// On an undamped structure no damper is below the fixed points, and the exact optimum is above them by less than one per cent: √(1 + 2/μ) static
/// deflections under a force (Den Hartog), and as many accelerations of the base in that of the structure, √(2 / (μ (1 + μ))) times m e / m1 under an imbalance (Warburton). The formula's own damper is no
/// better; under a force and on a moving base Nishihara and Asami's is as good.
#[test]
fn reference_the_formulas_of_textbooks_are_met_on_undamped_structures() {
    let mu: f64 = 0.05;
    let static_height = (1.0 + 2.0 / mu).sqrt();
    for (source, goal, size, height, exact) in [
        ("force", "x1max", 10.0 / (1000.0 * (TAU * 2.0).powi(2)), static_height, true),
        ("base", "x1max", 10.0, static_height, true),
        ("base_acceleration", "a1max", 10.0, static_height, true),
        ("imbalance", "x1max", 10.0 / 1000.0, (2.0 / (mu * (1.0 + mu))).sqrt(), false),
    ] {
        let found = with_tmd(json!({
            "m1": 1000, "f1": "2 Hz", "zeta": 0, source: 10, "band": "1 .. 3 Hz", "mass": "5 %", "goal": goal
        }));
        let own = largest(&found, 1, goal) / size / height;
        assert!((1.0 - 1e-9..1.01).contains(&own), "{source}: {own}");
        let formulas = found["formulas"].as_array().expect("formulas");
        let names: Vec<_> = formulas.iter().map(|formula| &formula["name"]).collect();
        let all = ["Nishihara and Asami's formula", "Den Hartog's formula", "Warburton's formula"];
        assert_eq!(names, if exact { &all[..2] } else { &all[2..] }, "{source}");
        let above = formulas.iter().map(|formula| {
            formula["damper"]["steady"][goal]["value"].as_f64().expect("a number") / size / height / own
        });
        let above: Vec<f64> = above.collect();
        assert!(above.iter().all(|above| (1.0 - 1e-9..1.01).contains(above)), "{source}: {above:?}");
        assert!(!exact || (above[0] < 1.0 + 1e-9 && above[1] > 1.0 + 1e-5), "{source}: {above:?}");
        assert!(found["candidates"][0]["steady"][goal]["value"].is_null(), "no bound without a damper");
    }
}

/// On a base of constant acceleration the force on the ground is made least, and a limit on it is kept.
#[test]
fn exact_the_force_on_an_accelerated_ground_is_made_small_or_limited() {
    let base = json!({
        "m1": "120 t", "f1": "0.3 Hz", "zeta": "1 %", "base_acceleration": "0.02 g", "band": "0.25..0.35Hz", "mass": "2%"
    });
    let with = |more: Value| {
        let mut specification = base.clone();
        specification
            .as_object_mut()
            .expect("an object")
            .extend(more.as_object().cloned().expect("an object"));
        with_tmd(specification)
    };
    let least = with(json!({ "goal": "ground-force" }));
    let force = largest(&least, 1, "ground_force");
    let other = with(json!({ "goal": "a1max" }));
    let limit = 0.5 * (force + largest(&other, 1, "ground_force"));
    assert!(force < 0.9999 * limit, "the goals differ: {force} {limit}");
    let limited = with(json!({ "goal": "a1max", "limits": { "ground_force": limit } }));
    assert_eq!(limited["candidates"][1]["binding"], json!(["ground_force"]));
    assert!((largest(&limited, 1, "ground_force") / limit - 1.0).abs() < 1e-3);
    assert!(largest(&limited, 1, "a1max") > largest(&other, 1, "a1max"));
    // Without a damper it is m1 times the acceleration in space.
    let bare = largest(&least, 0, "ground_force") / largest(&least, 0, "a1max");
    assert!((bare / 120e3 - 1.0).abs() < 1e-12, "{bare}");
}

/// Every quantity of a TMD is the amplitude of the closed form at the frequency that is told, and none is larger nearby.
#[test]
fn exact_the_values_of_the_comparison_are_amplitudes_of_the_closed_form() {
    let found = with_tmd(json!({
        "m1": "120 t", "f1": "0.3 Hz", "zeta": "1 %", "base": "10 mm", "band": "0.25..0.35Hz", "mass": "2%",
        "goal": "a1max", "limits": { "stroke": "300 mm" }
    }));
    let requirements = good(
        asked(json!({
            "m1": "120 t", "f1": "0.3 Hz", "zeta": "1 %", "base": "10 mm", "band": "0.25..0.35Hz", "mass": "2%"
        }))
        .requirements(),
    );
    let scene = good(requirements.tmd()).scene;
    let design = &found["candidates"][1]["design"];
    let value = |parameter: Parameter| design[parameter.symbol()].as_f64().unwrap_or(f64::NAN);
    let damper = Design::new(value).expect("a design").on(scene.damper.expect("a damper"));
    let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
    for measure in Measure::ALL {
        let told = &found["candidates"][1]["steady"][measure.name()];
        let (own, omega) =
            (told["value"].as_f64().expect("a value"), told["omega"].as_f64().expect("a frequency"));
        let at = |omega: f64| system.steady(omega).largest(system.bare(), omega, measure);
        assert!((own - at(omega)).abs() <= 1e-9 * own, "{measure:?}: {own} {}", at(omega));
        let (_, [from, to]) = harmonic(&requirements);
        for i in 0..=1000 {
            let other = at(from + (to - from) * f64::from(i) * 1e-3);
            assert!(other <= (1.0 + 1e-5) * own, "{measure:?}: {other} {own}");
        }
    }
    let stroke = largest(&found, 1, "stroke");
    assert!((0.2999..=0.3).contains(&stroke), "the limit binds: {stroke}");
    assert_eq!(found["candidates"][1]["binding"], json!(["stroke"]));
    let free = &found["limits"]["stroke"]["TMD_without"]["steady"]["a1max"]["value"];
    assert!(free.as_f64().expect("a value") < 0.5 * largest(&found, 1, "a1max"), "the limit costs: {free}");
}

/// A unit more or less is the same structure.
#[test]
fn exact_requirements_are_the_same_in_every_unit() {
    let one = json!({ "m1": "40t", "f1": "2Hz", "zeta": "0.5%", "force": "280N", "band": "1.8Hz..2.2Hz", "mass": "2%" });
    let one = good(asked(one).requirements());
    for other in [
        json!({ "m1": 40000, "f1": 2, "zeta": 0.005, "P": "0.28 kN", "band": "2Hz±10%", "mass": "800 kg" }),
        json!({ "m1": "40 t", "f1": "120 rpm", "c1": "5.026548 kN·s/m", "force": 280, "band": "108..132rpm", "mass": "0.8t" }),
        json!({ "m1": "4e7 g", "k1": "6.3165468 MN/m", "zeta": "0.5 %", "force": 280, "band": [11.309734, 13.823008], "mass": 800 }),
        json!({ "k1": "6316.5468 N/mm", "f1": "2 Hz", "zeta": "0.5 %", "force": 280, "mass": "2 %" }),
    ] {
        let other = good(asked(other).requirements());
        let numbers = |of: &Requirements| {
            let (_, [from, to]) = harmonic(of);
            [of.m1, of.k1, of.c1, from, to, of.mass]
        };
        for (own, other) in numbers(&one).into_iter().zip(numbers(&other)) {
            assert!((other / own - 1.0).abs() < 1e-6, "{own} {other}");
        }
        assert_eq!(harmonic(&one).0, harmonic(&other).0);
    }
}

#[test]
fn contract_the_examples_are_requirements_and_options_replace_their_fields() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/examples");
    let mut count = 0;
    for entry in std::fs::read_dir(examples).expect("the examples") {
        let specification = good(Specification::read(&entry.expect("an entry").path()));
        let own = good(specification.requirements());
        let other = asked(json!({ "k1": 2.0 * own.k1, "base": "1 mm", "stroke": "7 mm" }));
        let other = good(specification.with(other).requirements());
        assert_eq!((other.m1, other.k1, other.mass), (own.m1, 2.0 * own.k1, own.mass));
        assert_eq!(json!(other)["base"], 0.001);
        assert_eq!(json!(other)["limits"]["stroke"], 0.007);
        count += 1;
    }
    assert_eq!(count, 4);
}

#[test]
fn contract_slips_are_refused_with_what_to_give() {
    let good_ones = json!({ "m1": "40t", "f1": "2Hz", "zeta": "0.5%", "force": "280N", "mass": "2%" });
    for (change, words) in [
        (json!({ "m1": null }), "--m1: missing: the mass of the structure, for instance --m1 40t"),
        (json!({ "m1": -1 }), "--m1: -1 is not allowed here: give a number above 0"),
        (json!({ "m1": "40 kN" }), "--m1: \"40 kN\" is not a number in kg, nor one with its unit: kg, g, t"),
        (json!({ "k1": "6 MN/m" }), "--f1: m1 and k1 are given too, which make it 1.949 Hz"),
        (json!({ "zeta": null }), "--zeta: missing: "),
        (json!({ "zeta": 0.5 }), "--zeta: 0.5 is 50 %: write 0.5% if that is what is meant, else 50%"),
        (
            json!({ "zeta": "120 %" }),
            "--zeta: 120 % is 120 % of critical damping: such a structure does not vibrate",
        ),
        (json!({ "force": null }), "--force: missing: what moves the structure"),
        (json!({ "base": "1 mm" }), "--base: force is given too: leave one of them out"),
        (json!({ "band": "2.2Hz..1.8Hz" }), "--band: the lower end comes first: write 1.8..2.2Hz"),
        (json!({ "band": "2 Hz" }), "--band: \"2 Hz\" is no band: give its ends, for instance 1.8Hz..2.2Hz"),
        (
            json!({ "band": "1.8..2.2" }),
            "--band: without a unit it is 1.8..2.2 rad/s, which leaves out the structure's own 12.5664 rad/s: write 1.8..2.2Hz if",
        ),
        (
            json!({ "mass": 2 }),
            "--mass: 2 is 2 kg, 0.005 % of the structure: write 2% if that is what is meant, else 2kg",
        ),
        (json!({ "mass": "50 t" }), "--mass: 50 t is more than the structure's 40000 kg"),
        (json!({ "k1_error": 10 }), "--k1-error: 10 is 1000 %: write 10% if that is what is meant"),
        (json!({ "goal": "stroke" }), "--goal: \"stroke\" is none: give one of E1max, x1max"),
        (json!({ "limits": { "x2max": 1 } }), "--limit: there is no quantity \"x2max\": give one of E1max"),
        (
            json!({ "limits": { "stroke": "15 mm" }, "stroke": "20 mm" }),
            "--limit stroke: is limited twice, to 15 mm and to 20 mm: give one limit of it",
        ),
        (
            json!({ "limits": { "ground-force": "1 kN", "ground_force": "2 kN" } }),
            "--limit ground-force: is limited twice",
        ),
        (json!({ "limits": { "stroke": "15 N" } }), "--limit stroke: \"15 N\" is not a number in m"),
        (json!({ "damper": "nes" }), "--damper: \"nes\" is none: give tmd, ssvi or both"),
        (json!({ "wall": "R=20mm" }), "--wall: E is missing: for instance R=20mm,E=5MPa"),
        (json!({ "wall": "steel" }), "--wall: R is missing: for instance R=20mm,E=5MPa"),
        (json!({ "wall": "R=20mm,wood" }), "--wall: \"wood\" is not known: give the radius"),
        (json!({ "wall": "R=20mm,steel,e=1.2" }), "--wall: e = 1.2 is not allowed here: at most 1"),
    ] {
        let mut specification = good_ones.clone();
        specification
            .as_object_mut()
            .expect("an object")
            .extend(change.as_object().cloned().expect("an object"));
        match refused(asked(specification.clone()).requirements()) {
            error @ Error::Requirement { .. } => {
                let sentence = error.to_string();
                assert!(sentence.starts_with(words), "{sentence}");
            }
            other => panic!("{other}"),
        }
        let sentence = refused(asked(specification).within("a.json").requirements()).to_string();
        assert!(sentence.starts_with("a.json: ") || words.contains("missing: "), "{sentence}");
    }
}

/// A material in words is its numbers; all else of the walls is the paper's.
#[test]
fn exact_walls_in_words_are_their_numbers() {
    let of = |wall: &str| {
        let floor =
            json!({ "m1": "40t", "f1": "2Hz", "zeta": "0.5%", "force": "280N", "mass": "2%", "wall": wall });
        json!(good(good(asked(floor).requirements()).contact()))
    };
    assert_eq!(of("R=20mm,rubber"), of("E=5MPa, R=2cm"));
    let steel = of("R=20mm,steel,e=0.7");
    let number = |name: &str| steel[name].as_f64().expect(name);
    assert_eq!(["R", "E1", "E2", "E4", "nu2", "nu4"].map(number), [0.02, 2.1e11, 2.1e11, 2.1e11, 0.3, 0.3]);
    assert_eq!(steel["loss"], json!({ "restitution": 0.7 }));
}

/// Walls that are not given are those of a similar structure: with 8 times the mass, thrice the frequency and a quarter of the displacements
/// `K z^1.5` has the share of `m ω² z` that it had.
#[test]
fn invariant_walls_that_are_not_given_are_similar_on_similar_structures() {
    let of = |m1: f64, f1: f64, force: f64| {
        let floor = json!({ "m1": m1, "f1": format!("{f1} Hz"), "zeta": "2%", "force": force, "mass": "2%" });
        good(good(asked(floor).requirements()).contact()).stiffness()
    };
    let (own, other) = (of(1000.0, 2.0, 300.0), of(8000.0, 6.0, 300.0 * 8.0 * 9.0 / 4.0));
    for (own, other) in own.into_iter().zip(other) {
        let expected = own * 8.0 * 9.0 * 2.0;
        assert!((other / expected - 1.0).abs() < 1e-12, "{own} {other}");
    }
}

/// The energy that a short shock leaves is there before a damper has moved: nobody is told to build one.
#[test]
fn regress_a_damper_that_does_nothing_is_not_recommended() {
    let shock = json!({
        "m1": "40t", "f1": "2Hz", "zeta": "0.5%", "shock": "half-sine,20ms,5g", "mass": "2%", "damper": "tmd"
    });
    let desk = Desk::new();
    let requirements = good(asked(shock).requirements());
    make(&desk, &requirements, &Silent);
    let answer = desk.read("out/answer.txt");
    assert!(answer.contains("Build no damper for this") && !answer.contains("Build the TMD"), "{answer}");
    assert!(desk.read("out/README.md").starts_with("# Build no damper for this"));
    let found = desk.read_json("out/design.json");
    assert_eq!([&found["build"], &found["in_vain"]], [&Value::Null, &json!(true)]);
}

/// Each of two limits is kept by a TMD of this mass, and both by none: neither is said to be one that none keeps.
#[test]
fn contract_limits_that_none_keeps_together_are_said_to_be() {
    let tight = json!({
        "m1": "1200kg", "f1": "14Hz", "zeta": "1%", "imbalance": "0.02kg·m", "band": "12Hz..16Hz", "mass": "40kg",
        "damper": "tmd", "limits": { "stroke": "0.2 mm", "ground-force": "3 kN" }
    });
    let desk = Desk::new();
    make(&desk, &good(asked(tight).requirements()), &Silent);
    let answer = retune_testkit::desk::flat(&desk.read("out/answer.txt"));
    assert!(answer.contains("no TMD of this mass was found to keep with the others: without it"), "{answer}");
}

/// What no TMD of this mass keeps is told, with a mass that does.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_limits_that_are_not_kept_are_answered_with_a_mass_that_keeps_them() {
    let tight = json!({
        "m1": "40t", "f1": "2Hz", "zeta": "0.5%", "force": "280N", "mass": "1%",
        "limits": { "stroke": "2 mm", "x1max": "0.5 mm" }
    });
    let found = with_tmd(tight.clone());
    assert_eq!(found["build"], Value::Null);
    let mass = found["lightest_TMD"].as_f64().expect("a mass");
    assert!(mass > 400.0 && mass < 12e3, "{mass}");
    for (share, build) in [(0.99, Value::Null), (1.01, json!("TMD"))] {
        let mut other = tight.clone();
        other["mass"] = json!(share * mass);
        assert_eq!(with_tmd(other)["build"], build, "{share}");
    }
}

fn searched(study: &Study) -> Value {
    let desk = Desk::new();
    let order = Request::new(&desk.path("none.json")).order("design");
    let (optimum, results) = good(optimize(study, &desk.path("out"), &order, &Silent));
    drop(results);
    json!(optimum)
}

/// The worst run of the SSVI NES by methods that share nothing with the hybrid but the equations.
#[test]
fn reference_the_ssvi_nes_of_a_design_has_the_energy_that_other_methods_find() {
    for requirements in structures() {
        let mut study = good(requirements.ssvi());
        let optimize = study.optimize.as_mut().expect("a search");
        optimize.surf = None;
        optimize.refine = Refine { max_fun_evals: Some(12), ..optimize.refine };
        optimize.objective.omega.as_mut().expect("a band").samples = 7;
        optimize.objective.starts = Some(1);
        // A fifth of the run: descents from a damper that rests on a wall are long.
        let fifth = |x: f64| 0.2 * x;
        study.window.t0 = NonNegative::new(fifth(study.window.t0.get())).expect("a time");
        study.window.end = retune_model::Positive::new(fifth(study.window.end.get())).expect("a time");
        study.solver.search_rtol = Some(1e-6);
        let found = searched(&study);
        let number = |name: &str| found[name].as_f64().expect("a number");
        assert!(number("E1max") < number("E1max_none"), "{found}");
        // Twenty periods, so that not even a chaotic motion makes more of a rounding error than the tolerance below.
        let value = |parameter: Parameter| found[parameter.symbol()].as_f64().unwrap_or(f64::NAN);
        let design = Design::new(value).expect("a design");
        let found_scene = study.scene_at(&design).expect("a damper");
        // The damper that was found, and the one where the search starts, which strikes its walls.
        let worst = found["objective"]["worst_omega"].as_f64().expect("a number");
        let omegas = [harmonic(&requirements).1[0], worst, requirements.natural_frequency()];
        let mut impacts = 0;
        for (mut scene, omega) in
            [found_scene, study.scene].into_iter().flat_map(|scene| omegas.map(|omega| (scene, omega)))
        {
            scene.forcing.frequency = NonNegative::new(omega).expect("a frequency");
            let window = Window { from: 0.0, to: 20.0 * TAU / requirements.natural_frequency() };
            let [own, other] = [(Method::Hybrid, 1e-10), (Method::Dop853, 1e-12)].map(|(method, rtol)| {
                let settings = Settings { method, rtol, atol: 1e-14, ..Settings::default() };
                e1_max(&scene, window, &settings, f64::INFINITY).expect("a run").value
            });
            assert!((own / other - 1.0).abs() < 1e-6, "{own} {other} at {omega}: {requirements:?}");
            let run = retune_solver::simulate(&scene, window, &Settings::default()).expect("a run");
            impacts += run.impacts.iter().sum::<u64>();
        }
        assert!(impacts > 3, "{impacts}: {requirements:?}");
    }
}
