//! `retune evaluate`: the objective of a study, from standard input to standard output.

mod common;

use common::{Answer, Desk, studies, tiny};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

/// The output of `evaluate` for the whole `input`.
fn said(desk: &Desk, study: &str, options: &[&str], input: &[u8]) -> Answer {
    let mut command = desk.command(&[&["evaluate", study], options].concat());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program");
    let mut pipe = child.stdin.take().expect("a pipe");
    let input = input.to_owned();
    let writing = std::thread::spawn(move || pipe.write_all(&input).expect("written"));
    let output = child.wait_with_output().expect("an answer");
    writing.join().expect("written");
    let [stdout, stderr] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
    Answer { code: output.status.code(), stdout, stderr }
}

/// The answers to lines that all have a value.
fn answers(desk: &Desk, study: &str, options: &[&str], input: &[u8]) -> Vec<String> {
    let Answer { code, stdout, stderr } = said(desk, study, options, input);
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    stdout.lines().map(str::to_owned).collect()
}

#[test]
fn contract_values_are_those_of_the_logs_at_any_number_of_threads() {
    let desk = Desk::new();
    desk.write_json("tiny.json", &tiny());
    desk.good(&["optimize", "tiny.json", "--quiet"]);
    let surf = desk.read("results/tiny/surf.csv");
    let rows: Vec<(&str, &str)> = surf.lines().skip(1).filter_map(|line| line.rsplit_once(',')).collect();
    assert_eq!(rows.len(), 24);
    let designs: String = rows.iter().map(|(design, _)| format!("{design}\n")).collect();
    let expected: Vec<&str> = rows.iter().map(|(_, value)| *value).collect();
    assert_eq!(answers(&desk, "tiny.json", &[], designs.as_bytes()), expected);
    let many: String = designs.repeat(4);
    assert_eq!(answers(&desk, "tiny.json", &["--threads", "7"], many.as_bytes()), expected.repeat(4));
    let blanks = designs.replace(',', " \t");
    assert_eq!(answers(&desk, "tiny.json", &["--threads", "1"], blanks.as_bytes()), expected);
}

#[test]
fn contract_a_line_is_answered_before_the_next_is_sent() {
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
fn contract_a_bad_line_is_answered_by_an_error_and_the_next_is_evaluated() {
    let desk = Desk::new();
    let study = studies().join("tmd-band.json");
    let study = study.to_str().expect("UTF-8");
    let input = b"600\n\nsoft 1\n-1 1\ninf 1\nNaN 1\n600 1e9 2 3\n\xff\xfe 1\n1800 0\n600 262";
    let Answer { code, stdout, stderr } = said(&desk, study, &[], input);
    let said: Vec<&str> = stdout.lines().collect();
    assert_eq!((code, said.len()), (Some(1), 10), "{said:?}");
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
    // The same on standard error, with the line number.
    let told: Vec<&str> = stderr.lines().collect();
    assert_eq!(told.len(), 10, "{stderr}");
    assert_eq!(told[2], "error: line 3: k2: \"soft\" is not a number");
    assert_eq!(told[9], "error: standard input: 9 of 10 lines had no value");
}

/// An absurdly long line is neither stored nor echoed.
#[test]
fn contract_a_line_without_end_and_a_word_of_megabytes_cost_nothing() {
    let desk = Desk::new();
    desk.write_json("tiny.json", &tiny());
    let good = b"215 232 0.06 0.34\n";
    let long = [
        vec![b'x'; 50_000_000],
        b"\n".to_vec(),
        good.to_vec(),
        b"\x1b[31m".to_vec(),
        vec![b'y'; 3000],
        b" 1 2 3".to_vec(),
    ];
    let Answer { code, stdout, stderr } = said(&desk, "tiny.json", &["--threads", "2"], &long.concat());
    let lines: Vec<&str> = stdout.lines().collect();
    assert_eq!((code, lines.len()), (Some(1), 3), "{stderr}");
    assert_eq!(lines[0], "error: the line is longer than 4096 bytes");
    assert_eq!(answers(&desk, "tiny.json", &[], good), lines[1..2]);
    let shown = format!("error: k2: \"\\u{{1b}}[31m{}...\" is not a number", "y".repeat(35));
    assert_eq!(lines[2], shown);
    assert!(stderr.len() < 1000 && !stderr.contains('\x1b'), "{stderr}");
}

/// A full pipe of standard error does not block the answers.
#[test]
fn contract_standard_error_names_the_first_hundred_lines() {
    let desk = Desk::new();
    desk.write_json("tiny.json", &tiny());
    let Answer { code, stdout, stderr } = said(&desk, "tiny.json", &["--json"], &b"soft\n".repeat(5000));
    assert_eq!((code, stdout.lines().count(), stderr.lines().count()), (Some(1), 5000, 102));
    let error = "{\"error\":\"give one number for each of k2 c2 D C; found 1\"}";
    assert!(stdout.lines().all(|line| line == error), "{}", &stdout[..100]);
}

#[test]
fn contract_a_design_beyond_a_limit_is_infinite_or_reported_by_how_much_and_a_study_must_tune() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["limits"] = serde_json::json!({ "cavity": 0.2 });
    desk.write_json("limited.json", &study);
    let said = answers(&desk, "limited.json", &[], b"215 232 0.06 0.1\n215 232 0.06 0.34\n");
    let values: Vec<f64> = said.iter().map(|text| text.parse().expect("a number")).collect();
    assert!(values[0] < 1e4, "{values:?}");
    assert_eq!((values.len(), values[1]), (2, f64::INFINITY));
    let said = answers(&desk, "limited.json", &["--json"], b"215 232 0.06 0.1\n215 232 0.06 0.34\n");
    let told: Vec<Value> = said.iter().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(told[0], json!({ "E1max": values[0], "violation": 0.0, "cavity": 0.16 }));
    assert!(said[0].contains("\"violation\": 0.0,"), "{said:?}");
    let [energy, violation, cavity] = ["E1max", "violation", "cavity"].map(|name| told[1][name].as_f64());
    assert!(energy.is_some_and(|energy| energy < 1e4), "an energy, not a rank: {said:?}");
    assert!(violation.is_some_and(|violation| (violation - 1.0).abs() < 1e-12), "twice the cavity: {said:?}");
    assert_eq!(cavity, Some(0.4));
    study["optimize"] = Value::Null;
    desk.write_json("nothing.json", &study);
    let answer = desk.run(&["evaluate", "nothing.json"]);
    assert_eq!((answer.code, answer.stdout.as_str()), (Some(2), ""));
    assert!(answer.stderr.contains("nothing"), "{}", answer.stderr);
}
