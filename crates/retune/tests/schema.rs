//! The committed JSON Schemas: they are current, and every study is valid.

mod common;

use common::{Desk, studies, tiny};
use serde_json::{Value, json};

fn committed(name: &str) -> Value {
    let text = std::fs::read_to_string(studies().join(name)).expect(name);
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn contract_committed_schemas_are_current() {
    let desk = Desk::new();
    for kind in ["study", "table2", "paper", "fronts"] {
        let printed = desk.good(&["schema", kind]);
        let file = std::fs::read_to_string(studies().join(format!("{kind}.schema.json"))).expect("a schema");
        assert_eq!(printed, file, "run `just schema`");
    }
    assert_eq!(desk.good(&["schema"]), desk.good(&["schema", "study"]));
}

#[test]
fn contract_every_study_of_the_repository_is_valid() {
    let desk = Desk::new();
    let mut seen = 0;
    let tutorial = studies().join("tutorial");
    let entries = [studies(), tutorial].map(|place| std::fs::read_dir(place).expect("studies"));
    for entry in entries.into_iter().flatten() {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if !name.ends_with(".json") || name.ends_with(".schema.json") {
            continue;
        }
        let study: Value =
            serde_json::from_str(&std::fs::read_to_string(&path).expect("text")).expect("JSON");
        let schema = study["$schema"].as_str().expect("each study names its schema");
        let schema = std::fs::read_to_string(path.with_file_name(schema)).expect("a schema");
        let schema = serde_json::from_str(&schema).expect("JSON");
        let validator = jsonschema::validator_for(&schema).expect("a schema");
        let errors: Vec<String> = validator.iter_errors(&study).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
        assert!(desk.good(&["check", path.to_str().expect("UTF-8")]).ends_with("good\n"));
        seen += 1;
    }
    assert!(seen >= 12, "{seen}");
}

#[test]
fn contract_schema_refuses_what_the_program_refuses() {
    let validator = jsonschema::validator_for(&committed("study.schema.json")).expect("a schema");
    assert!(validator.is_valid(&tiny()));
    for (pointer, bad) in [
        ("/scene/primary/m1", json!(0)),
        ("/scene/damper/D", json!(-0.1)),
        ("/scene/damper/contact/nu1", json!(0.6)),
        ("/scene/damper/k2", json!("215")),
        ("/window", json!({ "t0": 0 })),
        ("/window", json!({ "t0": 0, "T": 1, "dt": 1 })),
        ("/optimize/vary", json!(["k1"])),
        ("/optimize/vary", json!([])),
        ("/optimize/refine/starts", json!(0)),
        ("/optimize/objective", json!({ "omega": { "from": 5, "to": 8, "samples": 1 } })),
        ("/optimize/objective", json!({ "omega": { "from": 0, "to": 8 } })),
        ("/optimize/objective", json!({ "omega": 6.5 })),
        ("/optimize/objective", json!({ "response": "stead" })),
        ("/optimize/surf/k2/points", json!(0)),
        ("/optimize/surf/k2/scale", json!("cubic")),
    ] {
        let mut study = tiny();
        study["optimize"]["objective"] = json!({ "omega": { "from": 5, "to": 8, "samples": 3 } });
        assert!(validator.is_valid(&study));
        *study.pointer_mut(pointer).expect(pointer) = bad.clone();
        assert!(!validator.is_valid(&study), "{pointer} = {bad}");
        let desk = Desk::new();
        desk.write_json("study.json", &study);
        assert_eq!(desk.run(&["check", "study.json"]).code, Some(2), "{pointer} = {bad}");
    }
}
