//! Limits and certificates: whether a design keeps its limits, and whether its E1max can be relied on.

use crate::{found, request, resume, search};
use retune_jobs::certify::{certify, certify_file};
use retune_jobs::simulate::simulate;
use retune_jobs::tune::tune;
use retune_jobs::verify::verify;
use retune_jobs::{Error, Request, Silent};
use retune_model::{Coupled, Parameter, Scene};
use retune_store::Error as StoreError;
use retune_study::{Rule, Setting, StudyError};
use retune_testkit::desk::{Desk, committed, flat, global, number, studies, tiny};
use retune_testkit::observers::{Record, good, refused};
use serde_json::{Value, json};

/// A limit that the unconstrained optimum breaks is kept and reported as active.
#[test]
fn contract_limits_are_kept_and_reported() {
    let desk = Desk::with(&global(json!({}), json!({ "stroke": 1e3, "contact_force": 1e9 })));
    let free = found(good(tune(&request(&desk, "study.json", "free"), &Silent)));
    assert!(free.check_limits().is_ok());
    let free = desk.read_json("free/optimum.json");
    assert_eq!((&free["limits"]["active"], number(&free, "/limits/infeasible")), (&json!([]), 0.0));
    let stroke = 0.7 * number(&free, "/limits/stroke");
    let mut study = global(json!({}), json!({ "stroke": stroke }));
    // Enough to come to the limit.
    study["optimize"]["refine"] = json!({ "starts": 2, "scaled": true, "MaxFunEvals": 150 });
    desk.write_json("kept.json", &study);
    let optimum = search(&desk, "kept.json", "kept");
    assert!(optimum.check_limits().is_ok());
    let said = flat(&optimum.report());
    let kept = desk.read_json("kept/optimum.json");
    assert!(number(&kept, "/limits/stroke") <= stroke && kept["limits"]["feasible"] == true);
    assert!(number(&kept, "/limits/infeasible") > 0.0 && said.contains("limits kept: stroke "), "{said}");
    assert!(number(&kept, "/E1max") >= number(&free, "/E1max"));
    let certificate = desk.read_json("kept/certificate.json");
    assert_ne!(certificate["verdict"], "robust", "1 % more breaks an active limit: {certificate}");
    let near = &certificate["limits"]["broken_near"][0];
    assert_eq!((&near["limit"], &certificate["limits"]["broken"]), (&json!("stroke"), &json!([])));
    let [reached, over] = ["/reached", "/over_percent"].map(|path| number(near, path));
    assert!(reached > stroke && (over - 100.0 * (reached / stroke - 1.0)).abs() < 1e-9, "{near}");
    let words = certificate["words"].as_str().expect("words");
    assert!(
        words.contains("on the edge of a limit: stroke is ") && words.contains(" % over its limit of "),
        "{words}"
    );
    assert!(said.contains(words), "{said}");
}

/// Between its 15 samples this damper, a structure of the hunt of limits, has 18 % more; another motion has 300 times as much. The answer begins
/// with the former, the verdict names both beside what it calls sensitive.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_a_verdict_names_all_it_found_and_an_answer_the_peak_that_samples_miss() {
    let contact = &tiny()["scene"]["damper"]["contact"];
    let study = json!({
        "name": "missed",
        "scene": {
            "primary": { "m1": 10_741.659_083_234_55, "c1": 329.158_420_826_044_33, "k1": 1_898_702.376_550_688_2 },
            "forcing": { "P": 3_037.079_013_817_777, "omega": 13.295_135_400_672_84 },
            "damper": {
                "m2": 112.940_689_224_228_65, "k2": 19_477.464_265_435_494, "c2": 173.134_023_652_855_2,
                "D": 0.237_829_598_706_407_2, "C": 0.287_943_874_778_143_8, "contact": contact
            }
        },
        "window": { "t0": 4.725_928_031_437_428, "T": 9.451_856_062_874_857 },
        "solver": { "rtol": 1e-8 },
        "optimize": {
            "vary": ["k2", "c2"],
            "objective": { "omega": { "from": 9.304_950_326_988_111, "to": 17.486_734_091_649_154, "samples": 15 } },
            "bounds": { "k2": [19_477.4, 19_477.5], "c2": [173.1, 173.2] },
            "refine": { "starts": 1, "scaled": true, "MaxFunEvals": 2 }
        }
    });
    let desk = Desk::with(&study);
    let optimum = search(&desk, "study.json", "out");
    let said = flat(&optimum.report());
    let certificate = desk.read_json("out/certificate.json");
    let [value, finer] = ["/E1max", "/finer"].map(|path| number(&certificate, path));
    assert!(value < 420.0 && finer > 480.0, "{value} {finer}");
    let words = certificate["words"].as_str().expect("words");
    assert!(words.starts_with("sensitive: designs within 0.1 % of it have "), "{words}");
    for other in ["; k2 off by -1 % gives ", "; 4 times as many samples have 48", "; a motion has 1"] {
        assert!(words.contains(other), "{other}: {words}");
    }
    let note = "note: E1max of this design is more between the samples of the study: 4 times as many have 48";
    let [note, instead] =
        [note, "instead "].map(|words| said.find(words).unwrap_or_else(|| panic!("{words}: {said}")));
    assert!(note < instead, "{said}");
    let page = std::fs::read_to_string(desk.path("out/report.html")).expect("a page");
    assert!(page.contains("data-flag=\"missed-peak\""));
}

/// One that cannot be kept is reported as broken: by the search, by one that is finished already, and by its certificate.
#[test]
fn contract_limits_that_no_design_keeps_leave_no_verdict() {
    let mut study = global(json!({}), json!({ "stroke": 1e-6 }));
    // Walls out of reach: linear motions, whose certificates are quick.
    (study["optimize"]["bounds"]["D"], study["optimize"]["bounds"]["C"]) =
        (json!([0.4, 0.5]), json!([0.4, 0.5]));
    let desk = Desk::with(&study);
    let optimum = found(good(tune(&request(&desk, "study.json", "out"), &Silent)));
    let said = flat(&optimum.report());
    assert!(said.contains(" evaluations; this one comes nearest. Broken: stroke "), "{said}");
    let no_verdict = "no verdict, for the design breaks the limit of stroke: ";
    assert!(said.contains(&format!("verdict {no_verdict}")), "{said}");
    let infeasible = |error| match error {
        Error::Infeasible { name, words } => (name, words),
        other => panic!("{other}"),
    };
    let (name, words) = infeasible(refused(optimum.check_limits()));
    assert!(name == "study" && words.starts_with(no_verdict), "{words}");
    let again = infeasible(refused(tune(&resume(&desk, "study.json", "out"), &Silent)));
    assert_eq!(again, (name.clone(), words.clone()), "nor has it one when it is finished already");
    let certificate = good(certify_file(&Request::new(&desk.path("out")), &Silent));
    assert_eq!(infeasible(refused(certificate.check_limits())), (name, words));
    let certificate = desk.read_json("out/certificate.json");
    assert_eq!(certificate["verdict"], Value::Null);
    assert_eq!(certificate["limits"]["broken"][0]["limit"], "stroke");
    let none = desk.read_json("out/optimum.json");
    assert_eq!(none["certificate"]["verdict"], Value::Null);
    assert!(number(&none, "/limits/violation") > 0.0 && none["limits"]["active"] == json!(["stroke"]));
    assert!(number(&none, "/E1max") < 1e4, "an energy, not a rank");
}

/// Table 2's SSVI NES: predictable by every method, and yet a single chaotic realisation; the TMD is robust.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn paper_table_2_is_certified() {
    let [_, tmd] = [("ssvi", "single chaotic realisation", "chaotic"), ("tmd", "robust", "T, 0, 0")].map(
        |(name, verdict, regime)| {
            let study =
                retune_study::read(&studies().join(format!("{name}-resonance.json"))).expect("a study");
            let certificate = good(certify(&study));
            let said = certificate.to_string();
            let certificate = json!(certificate);
            assert_eq!(certificate["verdict"], verdict, "{said}");
            assert_eq!(certificate["motion"]["regime"], regime);
            assert_eq!(certificate["predictable"], true);
            assert!(number(&certificate, "/error_bar") < 1e-5);
            // Methods that share nothing but the equations agree.
            let runs = certificate["convergence"].as_array().expect("runs");
            assert_eq!(runs.len(), 5);
            let value = number(&certificate, "/E1max");
            assert!(runs.iter().all(|run| (number(run, "/E1max") - value).abs() < 1e-5));
            assert!(said.contains("verdict ") && said.contains("rule ") && said.contains("c2 "), "{said}");
            (study, certificate)
        },
    );
    let (study, certificate) = tmd;
    // Without contacts C has no effect, and the slope in k2 is that of two runs.
    let slope = |name: &str| {
        let rows = certificate["sensitivity"].as_array().expect("rows");
        number(rows.iter().find(|row| row["parameter"] == name).expect("a row"), "/slope_per_percent")
    };
    assert_eq!(slope("C"), 0.0);
    let at = |k2: f64| {
        let study = study.with(&[Setting::new(Parameter::K2, k2)]).expect("a study");
        number(&json!(good(simulate(&study, None))), "/E1max")
    };
    let expected = (at(600.0 * 1.0025) - at(600.0 * 0.9975)) / 0.5;
    assert!((slope("k2") - expected).abs() < 1e-6, "{expected}");
}

/// Where contacts lose energy λ is one of the parameters that may be off, and results are made and verified like all others.
#[test]
fn contract_a_loss_is_among_the_sensitivities() {
    let parameters = |loss: bool| {
        let mut study = global(json!({}), json!({}));
        if loss {
            study["scene"]["damper"]["contact"]["loss"] = json!({ "restitution": 0.7, "at": 1 });
        }
        let desk = Desk::with(&study);
        search(&desk, "study.json", "made");
        good(verify(&desk.path("made"), 20, 0.0, &Silent));
        let certificate = desk.read_json("made/certificate.json");
        let rows = certificate["sensitivity"].as_array().expect("rows").clone();
        rows.iter().map(|row| row["parameter"].as_str().expect("a name").to_owned()).collect::<Vec<_>>()
    };
    let without = parameters(false);
    assert_eq!(parameters(true), [without.as_slice(), &["lambda".to_owned()]].concat());
    assert!(!without.contains(&"lambda".to_owned()));
}

#[test]
fn contract_results_of_a_search_are_certified_in_place() {
    let mut study = global(json!({}), json!({}));
    study["optimize"]["global"] = Value::Null;
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let first = desk.read("out/certificate.json");
    for path in ["out", "out/optimum.json"] {
        desk.remove("out/certificate.json");
        good(certify_file(&Request::new(&desk.path(path)), &Silent));
        assert_eq!(desk.read("out/certificate.json"), first, "{path}");
    }
    good(certify_file(&request(&desk, "out", "out"), &Silent));
    good(verify(&desk.path("out"), 20, 0.0, &Silent));
    let error = refused(certify_file(&request(&desk, "study.json", "out"), &Silent));
    assert!(error.to_string().contains("the results of a search stand there"), "{error}");
    assert!(
        matches!(&error, Error::Store(StoreError::Output { path, .. }) if *path == desk.path("out")),
        "{error}"
    );
    let optimum = desk.read_json("out/optimum.json");
    let certificate = desk.read_json("out/certificate.json");
    assert_eq!(optimum["certificate"]["verdict"], certificate["verdict"]);
    assert_eq!(optimum["E1max"], certificate["E1max"]);
}

#[test]
fn contract_a_certificate_of_a_study_has_a_directory_of_its_own() {
    let desk = Desk::with(&tiny());
    let record = Record::default();
    good(certify_file(&request(&desk, "study.json", "out"), &record));
    assert_eq!(desk.names("out"), ["certificate.json", "manifest.json", "study.json"]);
    let words = desk.read_json("out/certificate.json")["words"].as_str().expect("words").to_owned();
    assert!(record.results().contains(&words), "{}", record.results());
    good(verify(&desk.path("out"), 20, 0.0, &Silent));
}

#[test]
fn contract_only_a_damper_can_be_certified() {
    let mut bare = tiny();
    bare["scene"]["damper"] = Value::Null;
    bare["optimize"] = Value::Null;
    let desk = Desk::with(&bare);
    let error = refused(certify_file(&request(&desk, "study.json", "out"), &Silent));
    assert!(
        matches!(&error, Error::Rule { rule: Rule::NotAllowed { field, .. }, .. } if field == "scene.damper"),
        "{error}"
    );
    assert!(error.to_string().contains("scene.damper: none is not allowed here: give a damper"), "{error}");
    let error = refused(certify_file(&request(&desk, "nothing.json", "out"), &Silent));
    assert!(matches!(error, Error::Study(StudyError::Unreadable { .. })), "{error}");
    assert!(!desk.path("out").exists(), "nothing may be left behind");
}

/// A damper that just clears its walls: some of its neighbours strike them, and have no steady value.
#[test]
fn contract_a_neighbour_without_a_value_is_told_in_words() {
    let mut study = committed("tmd.json");
    let scene: Scene = serde_json::from_value(study["scene"].clone()).expect("a scene");
    let damper = scene.damper.as_ref().expect("a damper");
    let stroke = Coupled::new(&scene.primary, &scene.forcing, damper).steady_stroke_max([5.0, 8.0]).value;
    study["scene"]["damper"]["D"] = json!(1.0005 * stroke);
    study["optimize"]["bounds"] = json!({});
    study["optimize"]["surf"] = Value::Null;
    let desk = Desk::with(&study);
    let record = Record::default();
    good(certify_file(&request(&desk, "study.json", "out"), &record));
    let said = record.results();
    assert!(said.contains("no value at "), "{said}");
    assert!(said.contains("J or more, and some of them no value, the median "), "{said}");
    let word = |word: &str| said.split(|c: char| !c.is_alphanumeric()).any(|other| other == word);
    assert!(!word("inf") && !word("NaN"), "{said}");
}
