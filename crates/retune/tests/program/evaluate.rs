//! `retune evaluate`: the objective of a study, from standard input to standard output.

use crate::common::{Answer, Desk, Program};
use retune_testkit::desk::{studies, tiny};
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
    output.into()
}

#[test]
fn contract_a_line_is_answered_before_the_next_is_sent() {
    let study = studies().join("tmd-free.json");
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

/// Answers on standard output; the same with the line number on standard error; and an exit code for the whole.
#[test]
fn contract_lines_without_a_value_are_told_on_both_streams() {
    let desk = Desk::with(&tiny());
    let Answer { code, stdout, stderr } =
        said(&desk, "study.json", &["--threads", "2"], b"soft 1 2 3\n215 232 0.06 0.34\n\x1b[31m 1 2 3");
    let lines: Vec<&str> = stdout.lines().collect();
    let shown = "k2: \"\\u{1b}[31m\" is not a number";
    assert_eq!((code, lines.len()), (Some(1), 3), "{stderr}");
    assert_eq!([lines[0], lines[2]], ["error: k2: \"soft\" is not a number", &format!("error: {shown}")]);
    assert!(lines[1].parse::<f64>().is_ok_and(f64::is_finite), "{stdout}");
    let expected = format!(
        "error: line 1: k2: \"soft\" is not a number\nerror: line 3: {shown}\n\
         error: standard input: 2 of 3 lines had no value\n"
    );
    let (note, errors) = stderr.split_once('\n').expect("a line");
    assert!(
        note.starts_with("note: at t0 = 1 s the slowest transient still has 72.53 % of its start"),
        "{note}"
    );
    assert_eq!(errors, expected);
}

/// A full pipe of standard error does not block the answers.
#[test]
fn contract_standard_error_names_the_first_hundred_lines() {
    let desk = Desk::with(&tiny());
    let Answer { code, stdout, stderr } = said(&desk, "study.json", &["--json"], &b"soft\n".repeat(5000));
    assert_eq!((code, stdout.lines().count(), stderr.lines().count()), (Some(1), 5000, 103));
}
