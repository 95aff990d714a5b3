//! `retune evaluate`: the objective of a study, from standard input to standard output.

mod common;

use common::{Desk, studies, tiny};
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

/// What `evaluate` answers to `input`, given as a whole.
fn answers(desk: &Desk, study: &str, options: &[&str], input: &[u8]) -> Vec<String> {
    let mut command = desk.command(&[&["evaluate", study], options].concat());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the program");
    child.stdin.take().expect("a pipe").write_all(input).expect("written");
    let output = child.wait_with_output().expect("an answer");
    assert!(output.status.success());
    String::from_utf8(output.stdout).expect("UTF-8").lines().map(str::to_owned).collect()
}

#[test]
fn exact_values_are_those_of_the_logs_at_any_number_of_threads() {
    let desk = Desk::new();
    desk.write_json("tiny.json", &tiny());
    desk.good(&["optimize", "tiny.json", "--quiet"]);
    let surf = desk.read("results/tiny/surf.csv");
    let rows: Vec<(&str, &str)> = surf.lines().skip(1).filter_map(|line| line.rsplit_once(',')).collect();
    assert_eq!(rows.len(), 24);
    let designs: String = rows.iter().map(|(design, _)| format!("{design}\n")).collect();
    let expected: Vec<&str> = rows.iter().map(|(_, value)| *value).collect();
    assert_eq!(answers(&desk, "tiny.json", &[], designs.as_bytes()), expected);
    let blanks = designs.replace(',', " \t");
    assert_eq!(answers(&desk, "tiny.json", &["--threads", "1"], blanks.as_bytes()), expected);
}

#[test]
fn exact_a_line_is_answered_before_the_next_is_sent() {
    let study = studies().join("tmd-band.json");
    let mut child = Command::new(env!("CARGO_BIN_EXE_retune"))
        .args(["evaluate".as_ref(), study.as_os_str()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program");
    let mut input = child.stdin.take().expect("a pipe");
    let mut output = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    for (design, expected) in [("600 262", 660.41), ("2083.081, 111.893", 160.605)] {
        writeln!(input, "{design}").expect("written");
        let value: f64 = output.next().expect("a line").expect("text").parse().expect("a number");
        assert!((value - expected).abs() < 0.05, "{design}: {value}");
    }
    drop(input);
    assert!(output.next().is_none() && child.wait().expect("an end").success());
}

#[test]
fn exact_a_bad_line_is_answered_in_words_and_the_next_is_served() {
    let desk = Desk::new();
    let study = studies().join("tmd-band.json");
    let study = study.to_str().expect("UTF-8");
    let input = b"600\n\nsoft 1\n-1 1\ninf 1\nNaN 1\n600 1e9 2 3\n\xff\xfe 1\n1800 0\n600 262";
    let said = answers(&desk, study, &[], input);
    assert_eq!(said.len(), 10, "{said:?}");
    for (line, words) in said.iter().zip([
        "error: give one number for each of k2 c2; found 1",
        "error: give one number for each of k2 c2; found 0",
        "error: k2: \"soft\" is not a number",
        "error: k2: ",
        "error: k2: ",
        "error: k2: ",
        "error: give one number for each of k2 c2; found 4",
        "error: k2: \"",
        "error: the damper reaches a wall",
        "660.4",
    ]) {
        assert!(line.starts_with(words), "{line}, not {words}");
    }
}

#[test]
fn exact_a_design_beyond_a_limit_has_a_rank_and_a_study_must_tune() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["limits"] = serde_json::json!({ "cavity": 0.2 });
    desk.write_json("limited.json", &study);
    let said = answers(&desk, "limited.json", &[], b"215 232 0.06 0.1\n215 232 0.06 0.34\n");
    let values: Vec<f64> = said.iter().map(|text| text.parse().expect("a number")).collect();
    assert!(values[0] < 1e4, "{values:?}");
    assert!((values[1] / 2e100 - 1.0).abs() < 1e-12, "twice the cavity breaks the limit by 1: {values:?}");
    study["optimize"] = serde_json::Value::Null;
    desk.write_json("nothing.json", &study);
    let answer = desk.run(&["evaluate", "nothing.json"]);
    assert_eq!((answer.code, answer.stdout.as_str()), (Some(2), ""));
    assert!(answer.stderr.contains("nothing"), "{}", answer.stderr);
}
