//! An installed program: any directory, any file name.

use crate::common::{Answer, Desk, Program, begun};
use retune_testkit::desk::tiny;

/// Without `studies/` the plans built in are used, and it says so.
#[test]
fn contract_plans_are_found_in_an_empty_directory() {
    let desk = Desk::new();
    let said = desk.good(&["figure", "6", "--quiet"]);
    let note = "studies/paper.json is not here: the plan of this name that is built into Retune is used\n";
    assert!(said.starts_with(note) && said.contains("results in results/paper: "), "{said}");
    for (arguments, out) in [
        (vec!["table2", "--quiet"], "results/table2/table2-ssvi"),
        (vec!["retention", "30000", "--quiet"], "results/retune/k1-39500/retune-ssvi"),
        (vec!["fronts", "--quiet"], "results/fronts"),
    ] {
        let mut child = begun(&desk, &arguments, out, 2);
        child.kill().and_then(|()| child.wait()).expect("the program");
    }
    // A study is no plan: what is not there is not made up.
    assert!(desk.refused(&["simulate", "studies/tmd.json"]).contains("studies/tmd.json: cannot be read"));
    // And a plan that is there is used.
    desk.write("studies/table2.json", "{ \"rows\": [] }");
    assert!(desk.refused(&["table2"]).contains("rows: empty"));
}

#[test]
fn contract_a_study_file_may_have_any_name() {
    let desk = Desk::new();
    desk.write_json("My Study (2).json", &tiny());
    let study = "My Study (2).json";
    assert!(desk.good(&["check", study]).ends_with("My Study (2).json: good\n"));
    assert!(desk.good(&["simulate", study]).starts_with("study My-Study--2-, omega = "));
    let said =
        desk.good(&["sweep", study, "--over", "P", "--from", "1", "--to", "9", "--points", "2", "--quiet"]);
    assert!(said.contains("results in results/sweep-My-Study--2--P: "), "{said}");
    let said = desk.good(&["optimize", study, "--quiet"]);
    assert!(said.contains("results in results/My-Study--2-: "), "{said}");
    let mut own = tiny();
    own["scene"]["damper"]["k2"] = 216.into();
    desk.write_json(study, &own);
    desk.write_json("My Table.json", &serde_json::json!({ "rows": [{ "damper": "NES", "study": study }] }));
    let said = desk.good(&["table2", "My Table.json", "--quiet"]);
    assert!(said.contains("\nof the study  ") && said.contains("results in results/My-Table: "), "{said}");
}

/// The whole of standard output is one object.
#[test]
fn contract_a_sweep_is_one_object_on_standard_output() {
    let desk = Desk::with(&tiny());
    let range = ["--from", "0.9Hz", "--to", "66", "--points", "3"];
    let arguments =
        [&["sweep", "study.json", "--over", "omega", "--json", "--out", "out"], &range[..]].concat();
    let json: serde_json::Value = serde_json::from_str(&desk.good(&arguments)).expect("an object");
    assert_eq!(json, desk.read_json("out/sweep.json"));
    assert!(json["rows"][0]["impacts"].is_u64() && json["units"]["x1max"] == "m", "{json}");
    let Answer { code, stderr, .. } =
        desk.run(&["sweep", "study.json", "--over", "omga", "--from", "1", "--to", "2"]);
    assert!(code == Some(2) && stderr.contains("give one of k2, c2, D"), "{stderr}");
}

/// So is the answer of every job that makes results; a table has the units of its columns. A search that was finished before has it, too.
#[test]
fn contract_the_answer_of_a_job_is_one_object_on_standard_output() {
    let desk = Desk::with(&tiny());
    let answer = |arguments: &[&str]| -> serde_json::Value {
        serde_json::from_str(&desk.good(arguments)).unwrap_or_else(|error| panic!("{arguments:?}: {error}"))
    };
    let optimize = ["optimize", "study.json", "--out", "out", "--json"];
    let optimum = answer(&optimize);
    assert_eq!(optimum, desk.read_json("out/optimum.json"));
    assert_eq!(answer(&[&optimize[..], &["--resume"]].concat()), optimum);
    assert_eq!(answer(&["certify", "out", "--json"]), desk.read_json("out/certificate.json"));
    desk.write_json(
        "table.json",
        &serde_json::json!({ "rows": [{ "damper": "NES", "study": "study.json" }] }),
    );
    let table = answer(&["table2", "table.json", "--json"]);
    assert_eq!(table["units"]["E1max_none"], "J");
    assert_eq!(table["rows"][1]["damper"], "NES");
    assert!(table["rows"][1]["k2"].is_number() && table["rows"][1]["E1max_printed"].is_null(), "{table}");
}

/// `branches` answers with one object, too; its results are verified by the program, and a wrong parameter is refused.
#[test]
fn contract_branches_are_one_object_on_standard_output_and_are_verified() {
    let desk = Desk::with(&tiny());
    let options = ["--from", "5.2", "--to", "0.86Hz", "--samples", "3", "--starts", "1", "--out", "out"];
    let json: serde_json::Value =
        serde_json::from_str(&desk.good(&[&["branches", "study.json", "--json"], &options[..]].concat()))
            .expect("an object");
    assert_eq!(json, desk.read_json("out/branches.json"));
    assert_eq!(json["branches"][0]["events"][1]["kind"], "period doubling", "{json}");
    assert!(desk.good(&["verify", "out"]).contains("holds: "));
    let Answer { code, stderr, .. } = desk.run(&["branches", "study.json", "--over", "zeta"]);
    assert!(code == Some(2) && stderr.contains("give one of k2, c2, D"), "{stderr}");
    let Answer { code, stderr, .. } = desk.run(&["branches", "study.json", "--from", "8", "--to", "5"]);
    assert!(code == Some(2) && stderr.contains("--to: 5 is not above --from 8"), "{stderr}");
}

/// `check` and `verify` make no file: their answer as JSON is all that they print, and says what the words say.
#[test]
fn contract_checks_answer_as_json() {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    let answer = |arguments: &[&str]| -> (Option<i32>, serde_json::Value) {
        let ran = desk.run(arguments);
        (ran.code, serde_json::from_str(&ran.stdout).unwrap_or_else(|error| panic!("{arguments:?}: {error}")))
    };
    let (code, checked) = answer(&["check", "study.json", "--json"]);
    assert_eq!((code, &checked["file"], &checked["kind"]), (Some(0), &"study.json".into(), &"study".into()));
    let words = desk.good(&["check", "study.json"]);
    for line in checked["words"].as_array().expect("lines") {
        assert!(words.contains(line.as_str().expect("a line")), "{line}");
    }
    assert!(checked["files"]["optimize"].to_string().contains("optimum.json"), "{checked}");
    desk.good(&["optimize", "study.json", "--out", "out", "--quiet"]);
    let verify = ["verify", "out", "--sample", "3", "--json", "--threads", "1"];
    let (code, verified) = answer(&verify);
    assert_eq!((code, &verified["holds"]), (Some(0), &true.into()), "{verified}");
    assert!(
        verified["findings"]
            .as_array()
            .is_some_and(|all| all.len() >= 4 && all.iter().all(|f| f["holds"] == true))
    );
    desk.write("out/notes.txt", "mine");
    let (code, verified) = answer(&verify);
    assert_eq!((code, &verified["holds"]), (Some(4), &serde_json::Value::Null), "{verified}");
    desk.write("out/fminsearch.txt", "another");
    let (code, verified) = answer(&verify);
    assert_eq!((code, &verified["holds"]), (Some(1), &false.into()), "{verified}");
}
