//! Replacement of results: without an option, only those that the same command made of the same study are replaced.

mod common;

use common::{Answer, Desk, studies, tiny};
use serde_json::{Value, json};
use std::path::Path;

/// Runs a command that must be refused; returns its message.
#[track_caller]
fn refused(desk: &Desk, arguments: &[&str]) -> String {
    let Answer { code, stdout, stderr } = desk.run(arguments);
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{arguments:?}: {stderr}");
    stderr
}

/// Every file below a directory with its bytes.
fn everything(path: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(path).expect("a directory").flatten() {
        let path = entry.path();
        if path.is_dir() {
            all.extend(everything(&path));
        } else {
            all.push((path.display().to_string(), std::fs::read(&path).expect("a file")));
        }
    }
    all.sort();
    all
}

/// The study with one number changed.
fn edited(k1: f64) -> Value {
    let mut study = tiny();
    study["scene"]["primary"]["k1"] = json!(k1);
    study
}

#[test]
fn contract_an_edited_study_replaces_its_own_results() {
    let desk = Desk::new();
    desk.write_json("studies/small.json", &tiny());
    desk.good(&["optimize", "studies/small.json", "--quiet"]);
    desk.write_json("studies/small.json", &edited(3e4));
    desk.good(&["optimize", "studies/small.json", "--quiet"]);
    assert_eq!(desk.read_json("results/small/study.json")["scene"]["primary"]["k1"], 3e4);
    let manifest = desk.read_json("results/small/manifest.json");
    assert_eq!(manifest["made_by"], json!({ "command": "optimize", "study": "../../studies/small.json" }));
    assert_eq!(manifest.get("earlier"), None);
    desk.good(&["optimize", "./studies/../studies/small.json", "--quiet"]);
}

#[test]
fn contract_results_of_another_study_are_not_replaced_unasked() {
    let desk = Desk::new();
    desk.write_json("studies/small.json", &tiny());
    desk.write_json("other/small.json", &edited(3e4));
    desk.write_json("table2.json", &json!({ "rows": [
        { "damper": "a", "study": "other/small.json", "paper": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } }
    ]}));
    desk.good(&["optimize", "studies/small.json", "--quiet"]);
    desk.write("results/small/notes.txt", "mine");
    let before = everything(&desk.path("results"));
    let out = "results/small";
    for arguments in [
        &["optimize", "other/small.json", "--quiet"][..],
        &["optimize", "other/small.json", "--quiet", "--resume"],
        &["optimize", "other/small.json", "--quiet", "--restart"],
        &["certify", "other/small.json", "--quiet", "--out", out],
        &["table2", "table2.json", "--quiet", "--out", out],
        &["track", "3e4", "--study", "table2.json", "--quiet", "--out", out],
    ] {
        let said = refused(&desk, arguments);
        assert!(said.contains("results/small: "), "{said}");
        assert_eq!(everything(&desk.path("results")), before, "{arguments:?}");
    }
    let said = refused(&desk, &["optimize", "other/small.json"]);
    assert_eq!(
        said,
        "error: results/small: the results of `retune optimize` with studies/small.json stand here: \
         choose another directory with --out, or give --replace to have it replaced\n"
    );
    desk.good(&["table2", "table2.json", "--quiet", "--out", out, "--replace"]);
    let names = ["manifest.json", "notes.txt", "resolved.json", "small", "table2.csv", "table2.txt"];
    assert_eq!(desk.names(out), names, "nothing of the replaced, all of the others");
}

/// A copy of the study: its results are the same, and remain those of the original.
#[test]
fn contract_a_copy_is_another_study_once_it_differs() {
    let desk = Desk::new();
    let mut study = tiny();
    study["name"] = json!("small");
    desk.write_json("small.json", &study);
    desk.good(&["optimize", "small.json", "--quiet"]);
    let before = everything(&desk.path("results"));
    desk.write_json("copy/small.json", &study);
    desk.good(&["optimize", "copy/small.json", "--quiet"]);
    desk.good(&["optimize", "results/small/study.json", "--quiet"]);
    assert_eq!(everything(&desk.path("results")), before);
    desk.write_json("copy/small.json", &edited(3e4));
    refused(&desk, &["optimize", "copy/small.json", "--quiet"]);
    desk.good(&["optimize", "small.json", "--quiet"]);
}

#[test]
fn contract_files_that_retune_did_not_make_are_kept() {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    let before = desk.read("study.json");
    for options in [&[][..], &["--replace"]] {
        let said = refused(&desk, &[&["optimize", "study.json", "--quiet", "--out", "."], options].concat());
        assert!(said.contains("not replaced: it is the study itself"), "{said}");
        assert_eq!(desk.read("study.json"), before);
    }
    desk.write("out/surf-mine.svg", "mine");
    let said = refused(&desk, &["optimize", "study.json", "--quiet", "--out", "out"]);
    assert!(said.contains("out: surf-mine.svg stands here, which Retune did not make"), "{said}");
    std::fs::remove_file(desk.path("out/surf-mine.svg")).expect("the file");
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    desk.write("out/optimum.json", "{ \"changed\": \"by hand\" }");
    let said = refused(&desk, &["optimize", "study.json", "--quiet", "--out", "out"]);
    assert!(
        said.contains("optimum.json stands here, which Retune did not make or which was changed since"),
        "{said}"
    );
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out", "--replace"]);
    // This file is not replaced: a later search does not write a picture of that name.
    desk.write("out/surf-k2-D.svg", "changed");
    let mut other = tiny();
    other["optimize"] = json!({ "vary": ["c2"], "refine": { "MaxFunEvals": 5 } });
    desk.write_json("study.json", &other);
    refused(&desk, &["optimize", "study.json", "--quiet", "--out", "out"]);
    assert_eq!(desk.read("out/surf-k2-D.svg"), "changed");
}

/// Results from before manifests named their study: those of the repository.
#[test]
fn contract_committed_results_are_replaced_without_a_word() {
    let desk = Desk::new();
    desk.write_json("studies/small.json", &tiny());
    desk.good(&["optimize", "studies/small.json", "--quiet"]);
    let mut manifest = desk.read_json("results/small/manifest.json");
    manifest.as_object_mut().expect("fields").remove("made_by");
    desk.write_json("results/small/manifest.json", &manifest);
    desk.write_json("studies/small.json", &edited(3e4));
    desk.write_json("studies/other.json", &tiny());
    desk.write_json("studies/other.json", &edited(2e4));
    refused(&desk, &["optimize", "studies/other.json", "--quiet", "--out", "results/small"]);
    desk.good(&["optimize", "studies/small.json", "--quiet"]);
}

/// Table 2's studies with short runs.
fn short_table2(desk: &Desk, name: &str) {
    for name in ["ssvi.json", "tmd.json"] {
        let text = std::fs::read_to_string(studies().join(name)).expect("a study");
        let mut study: Value = serde_json::from_str(&text).expect("JSON");
        study["window"] = json!({ "t0": 1, "T": 4 });
        study["optimize"]["surf"] = Value::Null;
        study["optimize"]["refine"] = json!({ "MaxFunEvals": 20 });
        desk.write_json(name, &study);
    }
    desk.write(name, std::fs::read_to_string(studies().join("table2.json")).expect("a table"));
}

#[test]
fn contract_results_of_a_run_are_exactly_its_own() {
    let desk = Desk::new();
    short_table2(&desk, "mine.json");
    desk.good(&["track", "30000", "5e4", "--study", "mine.json", "--quiet"]);
    let out = "results/mine";
    let parts = |desk: &Desk| {
        let mut names = desk.names(out);
        names.retain(|name| name.starts_with("k1-"));
        names
    };
    assert_eq!(parts(&desk), ["k1-30000", "k1-39500", "k1-50000"], "named after the study");
    desk.write("results/mine/k1-30000/tmd/notes.txt", "mine");
    desk.write("results/mine/k1-77/notes.txt", "mine");
    desk.good(&["track", "2e4", "--study", "mine.json", "--quiet"]);
    assert_eq!(parts(&desk), ["k1-20000", "k1-30000", "k1-39500", "k1-77"]);
    assert_eq!(desk.names("results/mine/k1-30000"), ["tmd"]);
    assert_eq!(desk.names("results/mine/k1-30000/tmd"), ["notes.txt"]);
    refused(&desk, &["table2", "mine.json", "--quiet"]);
}

/// Interrupted work on other stiffnesses is unfinished work, in any directory below.
#[test]
fn contract_unfinished_searches_below_are_found() {
    let desk = Desk::new();
    short_table2(&desk, "mine.json");
    let mut study = desk.read_json("ssvi.json");
    study["window"] = json!({ "t0": 50, "T": 150 });
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 400, "TolX": 1e-9, "TolFun": 1e-9 });
    desk.write_json("ssvi.json", &study);
    let run = ["track", "30000", "--study", "mine.json", "--quiet", "--out", "out"];
    let mut child = common::begun(&desk, &run, "out/k1-30000/ssvi", 20);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let other = ["track", "2e4", "--study", "mine.json", "--quiet", "--out", "out"];
    for option in ["--quiet", "--resume"] {
        let arguments = if option == "--resume" { [&other[..], &[option]].concat() } else { other.to_vec() };
        let said = refused(&desk, &arguments);
        assert!(said.starts_with("error: out: unfinished work was found here ("), "{said}");
        assert!(said.contains("but it is of another study"), "{said}");
    }
    desk.good(&[&other[..], &["--restart"]].concat());
    assert!(!desk.path("out/k1-30000").exists());
    desk.good(&["track", "2e4", "--study", "mine.json", "--quiet", "--out", "whole"]);
    assert_eq!(desk.names("out"), desk.names("whole"));
}

/// A figure that is made again keeps the others in the manifest.
#[test]
fn contract_figures_made_one_by_one_stay_retunes() {
    let desk = Desk::new();
    for name in ["ssvi.json", "tmd.json", "table2.json", "paper.json"] {
        desk.write(name, std::fs::read_to_string(studies().join(name)).expect(name));
    }
    let mut plan = desk.read_json("paper.json");
    plan["k1_range"] = json!({ "from": 2.0e4, "to": 6.0e4, "points": 3 });
    plan["omega"] = json!({ "from": 4, "to": 9, "points": 11 });
    desk.write_json("paper.json", &plan);
    let figure5 = ["figure", "5", "--study", "paper.json", "--quiet"];
    desk.good(&figure5);
    desk.write("results/paper/figure5-notes.txt", "mine");
    desk.write("results/paper/notes.txt", "mine");
    let said = refused(&desk, &figure5);
    assert!(said.contains("figure5-notes.txt stands here"), "{said}");
    std::fs::rename(desk.path("results/paper/figure5-notes.txt"), desk.path("notes.txt")).expect("moved");
    desk.good(&["figure", "3", "--study", "paper.json", "--quiet"]);
    let manifest = desk.read_json("results/paper/manifest.json");
    let files = manifest["files"].as_object().expect("files");
    assert!(files.contains_key("figure3.svg") && files.contains_key("figure5.svg"), "{files:?}");
    plan["omega"] = json!({ "from": 4, "to": 9, "points": 12 });
    desk.write_json("paper.json", &plan);
    desk.good(&figure5);
    let manifest = desk.read_json("results/paper/manifest.json");
    let earlier = manifest["earlier"].as_object().expect("earlier");
    assert!(earlier.contains_key("figure3.svg") && !earlier.contains_key("figure5.svg"), "{earlier:?}");
    desk.good(&["figure", "3", "--study", "paper.json", "--quiet"]);
    assert_eq!(desk.read_json("results/paper/manifest.json").get("earlier"), None);
    assert!(desk.path("results/paper/notes.txt").exists());
}

#[test]
fn contract_a_trajectory_replaces_only_trajectories() {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    let before = desk.read("study.json");
    let run = |file| ["simulate", "study.json", "--interval", "1", "--trajectory", file];
    for file in ["study.json", "./study.json"] {
        let said = refused(&desk, &run(file));
        assert!(said.contains("not replaced: it is an input of this command"), "{said}");
    }
    desk.write("notes.csv", "t,x\n1,2\n");
    desk.write("surf.csv", "k2,c2,D,C,E1max\n");
    for file in ["notes.csv", "surf.csv"] {
        let said = refused(&desk, &run(file));
        assert!(said.contains("a file stands there that Retune did not make"), "{said}");
    }
    assert_eq!([desk.read("study.json"), desk.read("notes.csv")], [before, "t,x\n1,2\n".to_owned()]);
    desk.write("empty.csv", "");
    for file in ["motion.csv", "motion.csv", "empty.csv"] {
        desk.good(&run(file));
        assert!(desk.read(file).starts_with("t,x1,v1,x2,v2,"));
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("motion.csv", desk.path("link.csv")).expect("a link");
        let said = refused(&desk, &run("link.csv"));
        assert!(said.contains("it is a symbolic link"), "{said}");
        let said = refused(&desk, &run("/dev/null"));
        assert!(said.contains("it is no plain file"), "{said}");
    }
}

/// The names of locks, journals and temporary files are predictable.
#[cfg(unix)]
#[test]
fn contract_no_link_is_followed() {
    use std::os::unix::fs::symlink;
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    desk.write("treasure", "mine");
    desk.write("chest/journal", "mine");
    std::fs::create_dir(desk.path("out")).expect("a directory");
    let run = ["optimize", "study.json", "--quiet", "--out", "out"];
    for (link, target) in [
        (".lock", "../treasure"),
        ("unfinished", "../chest"),
        ("surf.csv", "../treasure"),
        ("manifest.json", "../treasure"),
    ] {
        symlink(target, desk.path("out").join(link)).expect("a link");
        refused(&desk, &run);
        refused(&desk, &[&run[..], &["--restart"]].concat());
        assert_eq!([desk.read("treasure"), desk.read("chest/journal")], ["mine", "mine"], "{link}");
        std::fs::remove_file(desk.path("out").join(link)).expect("the link");
    }
    std::fs::create_dir(desk.path("out/unfinished")).expect("a directory");
    symlink("../../treasure", desk.path("out/unfinished/journal")).expect("a link");
    let said = refused(&desk, &run);
    assert!(said.contains("out/unfinished/journal: cannot be read: it is a symbolic link"), "{said}");
    assert_eq!(desk.read("treasure"), "mine");
}

/// File and field names must not send control sequences to a terminal.
#[test]
fn contract_no_message_carries_control_characters() {
    let desk = Desk::new();
    let evil = "\u{1b}]0;owned\u{7}\u{9b}2J\r";
    let mut study = tiny();
    study[evil] = json!(1);
    desk.write_json("field.json", &study);
    let mut study = tiny();
    study["name"] = json!(evil);
    desk.write_json("name.json", &study);
    let mut study = tiny();
    study["solver"] = json!({ "method": evil });
    desk.write_json("value.json", &study);
    desk.write_json("study.json", &tiny());
    let missing = format!("{evil}.json");
    let out = format!("{evil}/out");
    let setting = format!("{evil}=1");
    for arguments in [
        &["check", "field.json"][..],
        &["check", "name.json"],
        &["check", "value.json"],
        &["check", &missing],
        &["optimize", &missing],
        &["optimize", "study.json", "--quiet", "--out", &out],
        &["simulate", "study.json", "--set", &setting],
        &["simulate", "study.json", evil],
        &["simulate", "study.json", "--solver", evil],
        &["verify", &out],
        &[evil],
    ] {
        let Answer { stdout, stderr, .. } = desk.run(arguments);
        let said = stdout + &stderr;
        assert!(!said.contains(|c: char| c.is_control() && c != '\n'), "{arguments:?}: {said:?}");
        assert!(!said.is_empty());
    }
    let said = desk.run(&["check", &missing]).stderr;
    assert!(
        said.starts_with("error: \\u001b]0;owned\\u0007\\u009b2J\\u000d.json: cannot be read: "),
        "{said}"
    );
}
