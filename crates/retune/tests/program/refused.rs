//! Refusals as a user sees them: one clear message each, an exit code that says whose fault it is, and no file left. The messages
//! about studies are tested in `study`, those of results in `jobs`.

use crate::common::{Answer, Desk, Program};
use retune_testkit::desk::{committed, edited, flat, global, studies, tiny};
use serde_json::{Value, json};

#[test]
fn contract_a_wrong_study_is_refused_with_its_line_and_leaves_nothing() {
    let desk = Desk::new();
    let mut study = tiny();
    study["scene"]["primary"]["k3"] = json!(1);
    desk.write("bad.json", study.to_string());
    for command in ["optimize", "check", "simulate", "certify", "evaluate"] {
        let said = desk.refused(&[command, "bad.json"]);
        let rest = said.strip_prefix("error: bad.json:1:").unwrap_or_else(|| panic!("{said}"));
        let (column, words) = rest.split_once(": ").expect("a column");
        assert!(column.parse::<usize>().is_ok(), "{said}");
        let expected = "scene.primary: unknown field `k3`; did you mean `k1`? allowed: m1, c1, k1\n";
        assert_eq!(words, expected, "{command}");
        assert_eq!(desk.names("."), ["bad.json"], "nothing may be left behind");
    }
    desk.write_json("rigid.json", &committed("ssvi-rigid.json"));
    let said = desk.refused(&["simulate", "rigid.json", "--from", "0,0,-5,0"]);
    assert!(said.contains("scene.forcing.start.x2: -5 is not allowed here: give a place from x1"), "{said}");
    desk.remove("rigid.json");
    let mut study = tiny();
    study["window"]["t0"] = json!(4);
    desk.write("bad.json", study.to_string());
    let said = desk.refused(&["optimize", "bad.json", "--out", "out"]);
    assert_eq!(said, "error: bad.json: window: t0 = 4 s is not before T = 4 s: the window is empty\n");
    assert_eq!(desk.names("."), ["bad.json"], "nothing may be left behind");
}

#[test]
fn contract_missing_files_and_places_that_cannot_be_written_are_named() {
    let desk = Desk::with(&tiny());
    desk.write("file", "");
    for (arguments, words) in [
        (&["check", "none.json"][..], "error: none.json: cannot be read: "),
        (&["optimize", "study.json", "--out", "file/out"], "error: file/out: cannot be written: "),
        (&["simulate", "study.json", "--trajectory", "none/t.csv"], "error: none/t.csv: cannot be written: "),
        (&["verify", "nowhere"], "error: nowhere: cannot be read: "),
        (&["figure", "6", "--study", "none.json"], "error: none.json: cannot be read: "),
    ] {
        let said = desk.refused(arguments);
        assert!(said.starts_with(words), "{said}");
    }
    assert_eq!(desk.names("."), ["file", "study.json"]);
}

#[test]
fn contract_wrong_arguments_are_told_with_what_is_allowed() {
    let mut flat = tiny();
    flat["optimize"]["surf"] = json!(null);
    let desk = Desk::with(&flat);
    let share = "for '--shard <i/N>': give i/N with 1 <= i <= N, for instance 3/64";
    let unknown = "unknown parameter `k3`; did you mean `k2`? allowed: k2, c2, D, C, m2, R, m1, c1, k1, P, imbalance, base, base_acceleration, omega, q, ";
    for (line, words) in [
        ("figure 8", "invalid value '8' for '<NUMBER>': 8 is not in 2..=7"),
        ("figure 1", "invalid value '1' for '<NUMBER>': 1 is not in 2..=7"),
        ("figure two", "invalid value 'two' for '<NUMBER>': invalid digit found in string"),
        ("table 3", "invalid value '3' for '<NUMBER>': 3 is not in 1..=2"),
        ("optimize study.json --shard 0/3", &format!("invalid value '0/3' {share}")),
        ("optimize study.json --shard a/b", &format!("invalid value 'a/b' {share}")),
        (
            "optimize study.json --shard 1/2",
            "study study: optimize.surf: missing, but only the grid can be made in parts",
        ),
        ("merge study.json", "study study: optimize.surf: missing, but only the grid can be made in parts"),
        ("simulate study.json --set k3=1", unknown),
        ("simulate study.json --set k1", "\"k1\" is not of the form NAME=VALUE, for instance k1=30000"),
        (
            "simulate study.json --set k1=soft",
            "k1: \"soft\" is not a number in N/m, nor one with its unit: N/m, kN/m",
        ),
        (
            "simulate study.json --set m1=-1",
            "command line: m1: -1 is not allowed here: give a finite number above 0",
        ),
        (
            "simulate study.json --trajectory t.csv --interval 1e-9",
            "--interval: 0.000000001 s is not allowed here",
        ),
    ] {
        let said = desk.refused(&line.split(' ').collect::<Vec<_>>());
        assert!(said.starts_with("error: ") && said.contains(words), "{line}: {said}");
    }
    assert_eq!(desk.names("."), ["study.json"], "nothing may be left behind");
    let table = studies().join("table2.json");
    let said = desk.refused(&["retention", "30000", "-1", "--study", table.to_str().expect("UTF-8")]);
    assert_eq!(said, "error: command line: k1: -1 is not allowed here: give a finite number above 0\n");
}

#[test]
fn contract_a_failed_run_exits_with_1_not_2() {
    let mut study = tiny();
    study["solver"] = json!({ "max_steps": 3 });
    let desk = Desk::with(&study);
    let Answer { code, stdout, stderr } = desk.run(&["simulate", "study.json"]);
    assert_eq!((code, stdout.as_str()), (Some(1), ""));
    assert!(stderr.starts_with("error: the run failed: the run needed more than 3 steps"), "{stderr}");
    let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--out", "out"]);
    assert_eq!(code, Some(1));
    let part = "no point of the grid could be computed (24 failed; at [100.0, 100.0, 0.05, 0.1]: the run needed more than";
    assert!(stderr.contains(part), "{stderr}");
    assert!(desk.names("out").is_empty(), "no half files, and nothing to resume");
}

/// As long as none is found that keeps the limits: by the search, by one that is finished already, and by the certificate.
#[test]
fn contract_limits_that_no_design_keeps_exit_with_3() {
    let desk = Desk::new();
    let mut study = global(json!({}), json!({ "stroke": 1e-6 }));
    // Walls out of reach: linear motions, whose certificates are quick.
    (study["optimize"]["bounds"]["D"], study["optimize"]["bounds"]["C"]) =
        (json!([0.4, 0.5]), json!([0.4, 0.5]));
    desk.write_json("none.json", &study);
    let Answer { code, stdout, stderr } = desk.run(&["optimize", "none.json", "--quiet"]);
    let stdout = flat(&stdout);
    assert!(stdout.contains("None found that keeps the limits in "), "{stdout}");
    let words = "no verdict, for the design breaks the limit of stroke: ";
    assert!(stdout.contains(&format!("verdict {words}")), "{stdout}");
    assert_eq!(code, Some(3));
    assert!(stderr.starts_with(&format!("error: study none: the limits are not kept: {words}")), "{stderr}");
    for arguments in [&["optimize", "none.json", "--quiet", "--resume"][..], &["certify", "results/none"]] {
        let again = desk.run(arguments);
        assert_eq!((again.code, &again.stderr), (Some(3), &stderr), "{arguments:?}");
    }
    let row = json!({ "damper": "NES", "study": "none.json", "reference": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } });
    desk.write_json("table2.json", &json!({ "rows": [row] }));
    let Answer { code, stderr, .. } = desk.run(&["table2", "table2.json", "--quiet"]);
    assert_eq!(code, Some(3));
    assert!(stderr.starts_with("error: study none: the limits are not kept: "), "{stderr}");
}

/// Each of the three answers of `verify` has its exit code: it holds, it does not, it cannot be checked.
#[test]
fn contract_verify_exits_with_0_1_or_4() {
    let desk = Desk::with(&tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    let verify = || desk.run(&["verify", "out", "--sample", "3"]);
    let Answer { code, stdout, stderr } = verify();
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    let rows = "  surf.csv               3 of 24 rows run again (E1max): the same to the last bit\n";
    let end = "holds: every file is as it was made, and all that was run or made again agrees\n";
    assert!(stdout.contains(rows) && stdout.ends_with(end), "{stdout}");

    let manifest = desk.read("out/manifest.json");
    desk.remove("out/manifest.json");
    let Answer { code, stdout, stderr } = verify();
    let none = "there is no manifest.json: what made these files, and whether they are as it made them";
    assert_eq!((code, stderr), (Some(4), format!("error: out: cannot be checked: {none}\n")));
    assert!(stdout.contains(&format!("  cannot be checked: {none}\n")), "{stdout}");

    desk.write("out/manifest.json", manifest);
    desk.remove("out/surf.csv");
    let Answer { code, stderr, .. } = verify();
    assert_eq!(code, Some(1));
    assert!(stderr.starts_with("error: out: does not hold: surf.csv is missing"), "{stderr}");
}

#[test]
fn contract_results_of_another_study_are_not_replaced_unasked() {
    let desk = Desk::new();
    desk.write_json("studies/small.json", &tiny());
    desk.write_json("other/small.json", &edited(3e4));
    desk.good(&["optimize", "studies/small.json", "--quiet"]);
    let said = desk.refused(&["optimize", "other/small.json"]);
    assert_eq!(
        said,
        "error: results/small: the directory holds results of `retune optimize` for studies/small.json: \
         choose another directory with --out, or give --replace to have it replaced\n"
    );
    desk.good(&["optimize", "other/small.json", "--quiet", "--replace"]);
}

#[test]
fn contract_missing_parts_are_named_with_what_to_type() {
    let desk = Desk::with(&tiny());
    for shard in ["1/4", "3/4"] {
        let said = desk.good(&["optimize", "study.json", "--quiet", "--out", "out", "--shard", shard]);
        assert!(said.starts_with("wrote out/parts/0000"), "{said}");
    }
    let words = "error: out/parts: no part holds points 6 to 11, 18 to 23 of 24: \
                 make what is missing with `retune optimize study.json --out out --shard i/N`, i/N = 2/4, 4/4\n";
    let merge = ["merge", "study.json", "--quiet", "--out", "out"];
    assert_eq!(desk.refused(&merge), words);
    let through_just = desk.command(&merge).env("RETUNE_RUN_AS", "just").output().expect("the program");
    assert_eq!(Answer::from(through_just).stderr, words.replace("`retune optimize", "`just optimize"));
}

/// File and field names must not send control sequences to a terminal.
#[test]
fn contract_no_message_carries_control_characters() {
    let evil = "\u{1b}]0;owned\u{7}\u{9b}2J\r";
    let desk = Desk::with(&tiny());
    let with = |file: &str, change: &dyn Fn(&mut Value)| {
        let mut study = tiny();
        change(&mut study);
        desk.write_json(file, &study);
    };
    with("field.json", &|study| study[evil] = json!(1));
    with("name.json", &|study| study["name"] = json!(evil));
    with("value.json", &|study| study["solver"] = json!({ "method": evil }));
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
