//! The JSON Schema of a study refuses what the rules refuse.

use retune_study::Study;
use retune_study::read::from_text;
use retune_testkit::desk::tiny;
use retune_testkit::schema::is_valid;
use serde_json::json;

#[test]
fn contract_schema_refuses_what_reading_refuses() {
    let schema = json!(retune_study::schema::<Study>());
    assert!(is_valid(&schema, &tiny()));
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
        assert!(is_valid(&schema, &study));
        assert!(from_text(&study.to_string(), "study.json").is_ok());
        *study.pointer_mut(pointer).expect(pointer) = bad.clone();
        assert!(!is_valid(&schema, &study), "{pointer} = {bad}");
        assert!(from_text(&study.to_string(), "study.json").is_err(), "{pointer} = {bad}");
    }
}
