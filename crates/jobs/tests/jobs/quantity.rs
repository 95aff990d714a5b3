//! Objectives other than E1max: `optimize.objective.quantity`.

use crate::{request, search};
use retune_jobs::{Silent, verify};
use retune_model::{Parameter, Primary, den_hartog, nishihara_asami};
use retune_solver::{Settings, Window, decay_time, simulate};
use retune_testkit::desk::{Desk, committed, flat, number, tiny};
use retune_testkit::observers::good;
use serde_json::json;

/// `studies/tmd-asami.json`, an undamped structure of unit mass and stiffness under a unit force, so that x1max is in static deflections: a
/// search from a grid, which knows no formula, ends at the exact optimum of Nishihara and Asami (J. Vib. Acoust. 124 (2002) 576).
#[test]
fn reference_the_least_displacement_is_that_of_nishihara_and_asami() {
    let study = committed("tmd-asami.json");
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let found = desk.read_json("out/optimum.json");
    let [k2, c2, peak] = ["/k2", "/c2", "/x1max"].map(|name| number(&found, name));
    let (frequency, zeta) = ((k2 / 0.06).sqrt(), c2 / (2.0 * (k2 * 0.06).sqrt()));
    assert!((frequency - 0.943_384).abs() < 5e-7, "{frequency}");
    assert!((zeta - 0.146_093).abs() < 5e-7, "{zeta}");
    assert!((peak - 5.864_689).abs() < 5e-7, "{peak}");
    let primary: Primary = serde_json::from_value(study["scene"]["primary"].clone()).expect("a structure");
    let exact = nishihara_asami(&primary, 0.06);
    for (found, exact) in [k2, c2].into_iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    }
    let [k2_dh, c2_dh] = den_hartog(&primary, 0.06);
    assert!((k2_dh / k2 - 1.0).abs() < 0.003 && (c2_dh / c2 - 1.0).abs() < 0.02, "{k2_dh} {c2_dh}");
}

/// A study for the decay time after a shock: its certificate compares methods and the other sign, `verify` finds it again, and a run that is too short
/// for any design says so.
#[test]
fn contract_a_decay_time_is_made_small_and_certified() {
    let mut study = committed("shock-ssvi.json");
    study["window"] = json!({ "t0": 0, "T": 12 });
    study["optimize"]["objective"]["quantity"] = json!("decay_time");
    for axis in ["k2", "c2", "D", "C"] {
        study["optimize"]["surf"][axis]["points"] = json!(2);
    }
    study["optimize"]["refine"]["MaxFunEvals"] = json!(20);
    let desk = Desk::with(&study);
    let said = flat(&search(&desk, "study.json", "out").report());
    assert!(said.contains(": decay_time ") && said.contains("methods and tolerances differ by"), "{said}");
    let found = desk.read_json("out/optimum.json");
    let [own, none] = ["/decay_time", "/decay_time_none"].map(|name| number(&found, name));
    let k1 = number(&found, "/objective/worst_k1");
    let scene = retune_study::read(&desk.path("out")).expect("the study with the design found").scene;
    let scene = Parameter::K1.at(scene, k1).expect("a scene");
    let time = decay_time(&scene, 12.0, &Settings::default()).expect("a run");
    assert!(time == Some(own) && own < none, "{time:?} {own} {none}");
    let certificate = desk.read_json("out/certificate.json");
    assert!(number(&certificate, "/records/each/0/value").is_finite(), "{certificate}");
    assert!(number(&certificate, "/error_bar") < 1e-6 * own, "{certificate}");
    let page = desk.read("out/report.html");
    assert!(page.contains("until E1 stays below 5 % of its largest value, decay_time, is"));
    good(verify::verify(&desk.path("out"), 4, 1e-9, &Silent));

    study["window"]["T"] = json!(2);
    let short = Desk::with(&study);
    let error =
        retune_jobs::tune::tune(&request(&short, "study.json", "out"), &Silent).expect_err("a short run");
    let words = "it has no decay time within the run: at the end, t = 2 s, its energy exceeds 5 % of its largest value";
    assert!(error.to_string().contains(words), "{error}");
}

/// A quantity has its own name and unit in every file and line, and `verify` finds it again.
#[test]
fn contract_a_quantity_has_its_name_and_unit_everywhere() {
    let mut study = tiny();
    study["optimize"]["objective"] =
        json!({ "quantity": "a1max", "omega": { "from": 5, "to": 8, "samples": 3 } });
    let desk = Desk::with(&study);
    let optimum = search(&desk, "study.json", "out");
    let said = flat(&optimum.report());
    assert!(said.contains("a1max ") && said.contains(" m/s², worst at omega = "), "{said}");
    for file in
        ["optimum.json", "certificate.json", "surf.csv", "fminsearch.csv", "fminsearch.txt", "band.csv"]
    {
        let text = desk.read(&format!("out/{file}"));
        assert!(text.contains("a1max"), "{file}");
        // The run at the worst frequency has its energy, too, among all that was measured of it.
        assert_eq!(text.contains("E1max"), file == "optimum.json", "{file}");
    }
    let page = desk.read("out/report.html");
    assert!(
        page.contains("a1max, m/s²") && page.contains("the largest acceleration of the structure, a1max")
    );

    let found = desk.read_json("out/optimum.json");
    let largest = number(&found, "/a1max");
    assert!(largest < number(&found, "/a1max_none"));
    let read = retune_study::read(&desk.path("out")).expect("the study with the design found");
    let mut scene = read.scene;
    let omega = number(&found, "/objective/worst_omega");
    scene.forcing.frequency = serde_json::from_value(json!(omega)).expect("a frequency");
    let run = simulate(&scene, Window { from: 1.0, to: 4.0 }, &Settings::default()).expect("a run");
    assert!((run.structure.acceleration.value / largest - 1.0).abs() < 1e-9, "{largest} {run:?}");
    good(verify::verify(&desk.path("out"), 100, 1e-9, &Silent));
}
