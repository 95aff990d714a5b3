//! Objectives other than E1max: `optimize.objective.quantity`.

use crate::search;
use retune_jobs::{Silent, verify};
use retune_model::{Primary, den_hartog};
use retune_solver::{Settings, Window, simulate};
use retune_testkit::desk::{Desk, committed, flat, number, tiny};
use retune_testkit::observers::good;
use serde_json::json;

/// The damper of least displacement on an undamped structure, as shares of what Den Hartog chose: exact fixed points are not exact
/// peaks. O. Nishihara and T. Asami, Closed-form solutions to the exact optimizations of dynamic vibration absorbers (minimizations of
/// the maximum amplitude magnification factors), J. Vib. Acoust. 124 (2002): the compliance of an undamped structure.
fn nishihara_asami(ratio: f64) -> [f64; 2] {
    let root = (4.0 + 3.0 * ratio).sqrt();
    let tuning = 2.0 * (16.0 + 23.0 * ratio + 9.0 * ratio * ratio + 2.0 * (2.0 + ratio) * root)
        / (3.0 * (64.0 + 80.0 * ratio + 27.0 * ratio * ratio));
    let frequency = 2.0 / (1.0 + ratio) * tuning.sqrt();
    let zeta = 0.25 * ((8.0 + 9.0 * ratio - 4.0 * root) / (1.0 + ratio)).sqrt();
    [frequency, zeta]
}

/// The displacement of an undamped structure, exact over a band.
#[test]
fn exact_the_least_displacement_is_that_of_the_closed_form() {
    let mut study = committed("tmd-free.json");
    study["scene"]["primary"]["c1"] = json!(0);
    study["optimize"]["objective"] = json!({
        "quantity": "x1max", "omega": { "from": 0.5, "to": 1.5, "relative": true }, "response": "steady"
    });
    let desk = Desk::with(&study);
    search(&desk, "study.json", "out");
    let found = desk.read_json("out/optimum.json");
    let primary: Primary = serde_json::from_value(study["scene"]["primary"].clone()).expect("a structure");
    let [frequency, zeta] = nishihara_asami(0.06);
    let natural = frequency * primary.natural_frequency();
    let expected = [60.0 * natural * natural, 2.0 * 60.0 * natural * zeta];
    let [k2, c2] = ["/k2", "/c2"].map(|name| number(&found, name));
    assert!((k2 / expected[0] - 1.0).abs() < 1e-6, "{k2} {expected:?}");
    assert!((c2 / expected[1] - 1.0).abs() < 1e-6, "{c2} {expected:?}");
    let [k2_dh, c2_dh] = den_hartog(&primary, 60.0);
    assert!((k2_dh / k2 - 1.0).abs() < 0.003 && (c2_dh / c2 - 1.0).abs() < 0.02, "{k2_dh} {c2_dh}");
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
