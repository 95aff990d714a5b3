//! The committed JSON Schemas: they are current, and every study is valid.

use crate::common::{Desk, Program};
use retune_testkit::desk::studies;
use retune_testkit::schema::errors;
use serde_json::Value;

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
        let errors = errors(&schema, &study);
        assert!(errors.is_empty(), "{name}: {errors:?}");
        assert!(desk.good(&["check", path.to_str().expect("UTF-8")]).ends_with("good\n"));
        seen += 1;
    }
    assert!(seen >= 12, "{seen}");
}
