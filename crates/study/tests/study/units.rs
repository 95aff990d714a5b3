//! Numbers with a unit in a study.

use retune_study::read::from_text;
use retune_study::{Study, schema};
use retune_testkit::desk::tiny;
use retune_testkit::schema::is_valid;
use serde_json::{Value, json};

/// Fields as they may be typed, and what they are in SI units.
const TYPED: [(&str, &str, f64); 17] = [
    ("/scene/primary/m1", "2 t", 2000.0),
    ("/scene/primary/k1", "40 kN/m", 40_000.0),
    ("/scene/forcing/P", "0.9 kN", 900.0),
    ("/scene/forcing/omega", "60rpm", 2.0 * std::f64::consts::PI),
    ("/scene/damper/k2", "220 N/m", 220.0),
    ("/scene/damper/D", "70 mm", 0.07),
    ("/scene/damper/contact/R", "210 cm", 2.1),
    ("/scene/damper/contact/E1", "200 GPa", 2e11),
    ("/window/t0", "500 ms", 0.5),
    ("/optimize/bounds/k2/0", "10 N/m", 10.0),
    ("/optimize/bounds/k2/1", "0.6 kN/m", 600.0),
    ("/optimize/surf/k2/from", "0.1 kN/m", 100.0),
    ("/optimize/objective/omega/from", "0.8 Hz", 1.6 * std::f64::consts::PI),
    ("/optimize/objective/k1/set/0", "30 kN/m", 30_000.0),
    ("/optimize/limits/stroke", "400mm", 0.4),
    ("/optimize/limits/from", "0.1 s", 0.1),
    ("/certificate/force", "10 %", 0.1),
];

fn study() -> Value {
    let mut study = tiny();
    study["window"] = json!({ "t0": 0, "T": 2 });
    study["certificate"] = json!({ "force": 0.05 });
    study["optimize"]["bounds"] = json!({ "k2": [0, 900] });
    study["optimize"]["surf"] = json!({ "k2": { "from": 50, "to": 300, "points": 2 } });
    study["optimize"]["vary"] = json!(["k2"]);
    study["optimize"]["objective"] =
        json!({ "omega": { "from": 5, "to": 8, "samples": 3 }, "k1": { "set": [39500, 41000] } });
    study["optimize"]["limits"] = json!({ "stroke": 1, "from": 0.5 });
    study
}

fn set(study: &mut Value, pointer: &str, value: impl Into<Value>) {
    *study.pointer_mut(pointer).expect(pointer) = value.into();
}

/// Each field, and all at once, is the same study as with the number in SI units; the schema knows both.
#[test]
fn exact_a_number_with_its_unit_is_the_number_in_si_units() {
    let read = |value: &Value| from_text(&value.to_string(), "mine.json").expect("a study");
    let of_schema = json!(schema::<Study>());
    let (mut typed, mut si) = (study(), study());
    for (pointer, text, value) in TYPED {
        let (mut one, mut other) = (study(), study());
        set(&mut one, pointer, text);
        set(&mut other, pointer, value);
        assert_eq!(read(&one), read(&other), "{pointer} {text}");
        assert_ne!(read(&other), read(&study()), "{pointer} is another number");
        assert!(is_valid(&of_schema, &one), "{pointer} {text}");
        set(&mut typed, pointer, text);
        set(&mut si, pointer, value);
    }
    assert_eq!(read(&typed), read(&si));
    assert_eq!(json!(read(&typed).resolved())["scene"]["primary"]["k1"], 40_000.0, "SI in files");
}

/// A band that moves with the structure has shares, and what is no number stays a text.
#[test]
fn exact_a_relative_band_has_shares_and_texts_stay() {
    let mut relative = study();
    relative["optimize"]["objective"]["omega"] =
        json!({ "from": "80 %", "to": 1.25, "samples": 3, "relative": true });
    relative["name"] = json!("mm");
    relative["optimize"]["surf"]["k2"]["scale"] = json!("log");
    let read = from_text(&relative.to_string(), "mine.json").expect("a study");
    assert_eq!(read.objective().omega.expect("a band").from.get(), 0.8);
    assert_eq!(read.name(), "mm");
}

#[test]
fn contract_another_unit_is_refused_with_the_field_its_line_and_its_units() {
    for (pointer, text, words) in [
        (
            "/scene/primary/k1",
            "20 kN",
            "scene.primary.k1: \"20 kN\" is not a number in N/m, nor one with its unit: N/m, kN/m, MN/m, N/mm",
        ),
        ("/optimize/bounds/k2/1", "1 m", "optimize.bounds.k2[1]: \"1 m\" is not a number in N/m"),
        (
            "/optimize/objective/omega/to",
            "2 kHz",
            "optimize.objective.omega.to: \"2 kHz\" is not a number in rad/s",
        ),
        ("/scene/forcing/P", "inf N", "scene.forcing.P: \"inf N\" is not allowed here: give a finite number"),
        (
            "/scene/primary/m1",
            "-1 t",
            "scene.primary.m1: -1000 is not allowed here: give a finite number above 0",
        ),
    ] {
        let mut bad = study();
        set(&mut bad, pointer, text);
        let file = serde_json::to_string_pretty(&bad).expect("JSON");
        let line = file[..file.find(text).expect("the text")].matches('\n').count() + 1;
        let error = from_text(&file, "mine.json").expect_err(pointer).to_string();
        let place =
            if text.starts_with('-') { "mine.json:".to_owned() } else { format!("mine.json:{line}:") };
        assert!(error.starts_with(&place), "{error}");
        assert!(error.contains(words), "{error}");
    }
}

/// Anything that is no JSON comes to the parser as it is.
#[test]
fn contract_what_is_no_json_is_told_by_the_parser() {
    let whole = study().to_string().replace("39500,", "\"39.5 kN/m\",");
    for end in (0..whole.len()).filter(|end| whole.is_char_boundary(*end)) {
        assert!(from_text(&whole[..end], "cut.json").is_err(), "{end}");
    }
    let deep = format!("{{ \"k1\": {}\"1 N/m\"{} }}", "[".repeat(5000), "]".repeat(5000));
    assert!(from_text(&deep, "deep.json").is_err());
}
