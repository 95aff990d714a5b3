//! `design` as a newcomer uses it.

use crate::common::{Desk, Program};
use retune_testkit::desk::flat;
use std::path::Path;

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/examples").join(name);
    path.canonicalize().expect("the example").display().to_string()
}

/// The command of the README and its lines, in their order; the results hold, and the same again discards nothing.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_the_answer_of_the_readme_is_that_of_the_program() {
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let readme = std::fs::read_to_string(readme).expect("the README");
    let section = readme.split("\n## Your own structure").nth(1).expect("the section");
    let command =
        section.split("\nretune ").nth(1).and_then(|rest| rest.lines().next()).expect("the command");
    let desk = Desk::new();
    let arguments: Vec<&str> = command.split(' ').collect();
    let answer = desk.run(&arguments);
    assert_eq!(answer.code, Some(0), "{}", answer.stderr);
    assert!(answer.stdout.contains("\nSSVI NES so far: E1max "), "what Ctrl-C leaves: {}", answer.stdout);
    let lines = section.split("```text\n").nth(1).and_then(|rest| rest.split("\n```").next()).expect("lines");
    let mut rest = answer.stdout.as_str();
    for line in lines.lines() {
        let at = rest.find(line).unwrap_or_else(|| panic!("{line}\n{}", answer.stdout));
        rest = &rest[at + line.len()..];
    }
    assert!(answer.stdout.lines().all(|line| line.chars().count() <= 100 || line.starts_with("results in")));
    // What takes the time: 57 known designs, and four descents of some 20 each.
    let tried = desk.read_json("results/design/design.json")["designs_evaluated"].as_u64();
    assert!(tried.is_some_and(|tried| tried < 200), "{tried:?}");
    let verified = desk.run(&["verify", "results/design"]);
    assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
    let quiet = desk.run(&[&arguments[..], &["--quiet"]].concat());
    assert!(quiet.code == Some(0) && !quiet.stdout.contains("so far"), "{}{}", quiet.stdout, quiet.stderr);
}

#[test]
fn contract_another_question_leaves_earlier_results_as_they_are() {
    let desk = Desk::new();
    let lab = example("lab.json");
    let run = |more: &[&str]| {
        let answer = desk.run(&[&["design", &lab, "--damper", "tmd"], more].concat());
        assert_eq!(answer.code, Some(0), "{}", answer.stderr);
        answer.stdout
    };
    let first = run(&[]);
    assert!(first.contains("in results/design-lab:"), "{first}");
    let earlier = desk.everything("results/design-lab");
    assert!(run(&["--mass", "3%"]).contains("in results/design-lab-2:"));
    assert!(run(&[]).contains("in results/design-lab:"), "the same question has the same place");
    assert_eq!(desk.everything("results/design-lab"), earlier);
    let json: serde_json::Value = serde_json::from_str(&run(&["--json"])).expect("one JSON object");
    assert_eq!(json["build"], "TMD");
    assert_eq!(json["candidates"][1]["binding"], serde_json::json!(["stroke"]));
}

/// A table of modes takes the place of m1, f1 and zeta; the mode that the damper works on is that of the largest response, or the one named.
#[test]
fn contract_a_mode_of_a_table_is_the_structure() {
    let desk = Desk::new();
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/modes/building.csv");
    let table = table.to_string_lossy().into_owned();
    let rest = ["--force", "2kN", "--mass", "1%", "--damper", "tmd"];
    let run = |more: &[&str]| desk.run(&[&["design", "--modes", &table], more, &rest].concat());
    let first = run(&["--out", "first"]);
    let said = "mode 1 of 5, 3.141 rad/s (0.4999 Hz), is at the damper a structure of m1 = 127317 kg";
    assert!(flat(&first.stdout).contains(said), "{} {}", first.stdout, first.stderr);
    assert!(flat(&first.stdout).contains("left out add 1.5 % to"), "{}", first.stdout);
    assert!(flat(&run(&["--mode", "2", "--out", "second"]).stdout).contains("mode 2 of 5, 9.168 rad/s"));
    for (more, words) in [
        (&["--mode", "6"][..], "error: --mode: 6 is not allowed here: give a number from 1 to 5"),
        (&["--mode", "0"], "error: --mode: 0 is not allowed here"),
        (&["--m1", "2t"], "cannot be used with"),
    ] {
        let answer = run(more);
        assert!(answer.code == Some(2) && answer.stderr.contains(words), "{}", answer.stderr);
    }
    for (text, words) in [
        ("", "modes.csv: is empty: give a table"),
        ("f,zeta,M\n1,0.01,5\n", "modes.csv: has no column phi"),
        ("f,zeta,M,phi\n", "modes.csv: has no mode"),
        ("f,zeta,M,phi\n1,0.01,5,x\n", "modes.csv: line 2: phi: \"x\" is not a number"),
        ("f,zeta,M,phi\n-14,0.01,5,1\n", "modes.csv: line 2: f: -14 is not allowed here"),
        ("f,zeta,M,phi,M\n14,0.01,5,1,6\n", "modes.csv: has the column M twice: give it once"),
        ("f,zeta,M,phi\n1,0.01,-5,1\n", "modes.csv: line 2: M: -5 is not allowed here"),
        ("f,zeta,M,phi\n1,0.01,5,0\n", "modes.csv: mode 1: phi = 0: it does not move the damper"),
    ] {
        desk.write("modes.csv", text);
        let answer = desk.run(&[&["design", "--modes", "modes.csv"], &rest[..]].concat());
        assert!(answer.code == Some(2) && answer.stderr.contains(words), "{}", answer.stderr);
    }
}

#[test]
fn contract_slips_name_the_option_or_the_field_and_limits_that_fail_exit_with_3() {
    let desk = Desk::new();
    let lab = example("lab.json");
    for (arguments, code, words) in [
        (&["design", "--m1", "40t"][..], 2, "error: --f1: missing: the natural frequency"),
        (&["design", &lab, "--k1-error", "10"], 2, "error: --k1-error: 10 is 1000 %: write 10%"),
        (
            &["design", &lab, "--limit", "stroke=1um", "--limit", "x1max=10um"],
            3,
            "error: study design: the limits are not kept",
        ),
        (&["design", "none.json"], 2, "error: none.json: cannot be read"),
    ] {
        let answer = desk.run(&[arguments, &["--damper", "tmd"]].concat());
        assert_eq!(answer.code, Some(code), "{arguments:?} {}", answer.stderr);
        assert!(flat(&answer.stderr).contains(words), "{}", answer.stderr);
        assert!(!answer.stderr.contains("--restart"), "nothing is discarded: {}", answer.stderr);
    }
    desk.write(
        "slip.json",
        r#"{ "m1": "2 kg", "f1": "8 Hz", "zeta": "1 %", "force": "1 N", "mass": "5 kg" }"#,
    );
    let stderr = desk.run(&["design", "slip.json"]).stderr;
    assert!(stderr.starts_with("error: slip.json: mass: 5 kg is more than the structure's 2 kg"), "{stderr}");
}
