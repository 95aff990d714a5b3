//! `evaluate`: the objective of a study, from lines of designs to lines of values.

use crate::search;
use retune_jobs::evaluate::{Streams, evaluate};
use retune_jobs::{Error, Request};
use retune_study::Rule;
use retune_study::read::from_text;
use retune_testkit::desk::{Desk, committed, tiny};
use retune_testkit::observers::{good, refused};
use serde_json::{Value, json};
use std::io::Cursor;
use std::path::Path;

/// The answers to `input`, the complaints, and the end.
fn said(
    study: &Value,
    json: bool,
    threads: Option<u16>,
    input: impl Into<Vec<u8>>,
) -> (Vec<String>, Vec<String>, Result<(), Error>) {
    let study = from_text(&study.to_string(), "study.json").expect("a study");
    let request = Request { threads, ..Request::new(Path::new("study.json")) };
    let (mut answers, mut complaints) = (Vec::new(), Vec::new());
    let mut complain = |words: &str| complaints.push(words.to_owned());
    let streams =
        Streams { input: Cursor::new(input.into()), answers: &mut answers, complaints: &mut complain };
    let end = evaluate(&study, json, &request, streams);
    let answers = String::from_utf8(answers).expect("UTF-8");
    (answers.lines().map(str::to_owned).collect(), complaints, end)
}

/// The answers to lines that all have a value.
#[track_caller]
fn answers(study: &Value, json: bool, threads: Option<u16>, input: impl Into<Vec<u8>>) -> Vec<String> {
    let (answers, complaints, end) = said(study, json, threads, input);
    good(end);
    assert_eq!(complaints, Vec::<String>::new());
    answers
}

#[test]
fn contract_values_are_those_of_the_logs_at_any_number_of_threads() {
    let desk = Desk::with(&tiny());
    search(&desk, "study.json", "out");
    let surf = desk.read("out/surf.csv");
    let rows: Vec<(&str, &str)> = surf.lines().skip(1).filter_map(|line| line.rsplit_once(',')).collect();
    assert_eq!(rows.len(), 24);
    let designs: String = rows.iter().map(|(design, _)| format!("{design}\n")).collect();
    let expected: Vec<&str> = rows.iter().map(|(_, value)| *value).collect();
    assert_eq!(answers(&tiny(), false, None, designs.as_str()), expected);
    assert_eq!(answers(&tiny(), false, Some(7), designs.repeat(4)), expected.repeat(4));
    assert_eq!(answers(&tiny(), false, Some(1), designs.replace(',', " \t")), expected);
}

#[test]
fn contract_a_bad_line_is_answered_by_an_error_and_the_next_is_evaluated() {
    let input = b"600\n\nsoft 1\n-1 1\ninf 1\nNaN 1\n600 1e9 2 3\n\xff\xfe 1\n1800 0\n600 262";
    let (said, told, end) = said(&committed("tmd-free.json"), false, None, input.as_slice());
    assert!(matches!(end, Err(Error::Lines { failed: 9, lines: 10 })), "{end:?}");
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
    // The same as complaints, with the line number.
    let numbered =
        |(i, line): (usize, &String)| line.replacen("error: ", &format!("error: line {}: ", i + 1), 1);
    assert_eq!(told, said[..9].iter().enumerate().map(numbered).collect::<Vec<_>>());
}

/// An absurdly long line is neither stored nor echoed.
#[test]
fn contract_a_line_without_end_and_a_word_of_megabytes_cost_nothing() {
    let good = b"215 232 0.06 0.34\n";
    let long = [
        vec![b'x'; 50_000_000],
        b"\n".to_vec(),
        good.to_vec(),
        b"\x1b[31m".to_vec(),
        vec![b'y'; 3000],
        b" 1 2 3".to_vec(),
    ];
    let (lines, told, end) = said(&tiny(), false, Some(2), long.concat());
    assert!(matches!(end, Err(Error::Lines { failed: 2, lines: 3 })), "{end:?}");
    assert_eq!(lines[0], "error: the line is longer than 4096 bytes");
    assert_eq!(answers(&tiny(), false, None, good.as_slice()), lines[1..2]);
    let shown = format!("error: k2: \"\\u{{1b}}[31m{}...\" is not a number", "y".repeat(35));
    assert_eq!(lines[2], shown);
    assert!(
        told.iter().map(String::len).sum::<usize>() < 1000 && !told.concat().contains('\x1b'),
        "{told:?}"
    );
}

/// A full pipe of complaints must not block the answers.
#[test]
fn contract_the_first_hundred_lines_without_a_value_are_complained_of() {
    let (answers, told, end) = said(&tiny(), true, None, b"soft\n".repeat(5000));
    assert!(matches!(end, Err(Error::Lines { failed: 5000, lines: 5000 })), "{end:?}");
    assert_eq!((answers.len(), told.len()), (5000, 101));
    assert_eq!(told[100], "further lines without a value are answered on standard output only");
    let error = "{\"error\":\"give one number for each of k2 c2 D C; found 1\"}";
    assert!(answers.iter().all(|line| line == error), "{}", answers[0]);
}

#[test]
fn contract_a_design_beyond_a_limit_is_infinite_or_reported_by_how_much() {
    let mut study = tiny();
    study["optimize"]["limits"] = json!({ "cavity": 0.2 });
    let designs = "215 232 0.06 0.1\n215 232 0.06 0.34\n";
    let said = answers(&study, false, None, designs);
    let values: Vec<f64> = said.iter().map(|text| text.parse().expect("a number")).collect();
    assert!(values[0] < 1e4, "{values:?}");
    assert_eq!((values.len(), values[1]), (2, f64::INFINITY));
    let said = answers(&study, true, None, designs);
    let told: Vec<Value> = said.iter().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(told[0], json!({ "E1max": values[0], "violation": 0.0, "reached": { "cavity": 0.16 } }));
    assert!(said[0].contains("\"violation\": 0.0,"), "{said:?}");
    let [energy, violation] = ["E1max", "violation"].map(|name| told[1][name].as_f64());
    let cavity = told[1]["reached"]["cavity"].as_f64();
    assert!(energy.is_some_and(|energy| energy < 1e4), "an energy, not a rank: {said:?}");
    assert!(violation.is_some_and(|violation| (violation - 1.0).abs() < 1e-12), "twice the cavity: {said:?}");
    assert_eq!(cavity, Some(0.4));
}

#[test]
fn contract_a_study_that_tunes_nothing_has_no_value_to_answer_with() {
    let mut study = tiny();
    study["optimize"] = Value::Null;
    let (answers, _, end) = said(&study, false, None, "215 232 0.06 0.34\n");
    assert!(matches!(refused(end), Error::Rule { rule: Rule::NoOptimize, .. }));
    assert!(answers.is_empty(), "{answers:?}");
}

/// The value is that of the window, what a limit is on that of the whole run: both have the same name.
#[test]
fn contract_a_value_and_what_its_limit_is_on_are_told_apart() {
    let mut study = tiny();
    study["optimize"]["limits"] = json!({ "E1max": 1e9, "from": 0.0 });
    let said = answers(&study, true, None, "215 232 0.06 0.34\n");
    assert_eq!(said[0].matches("E1max").count(), 2, "{said:?}");
    let told: Value = serde_json::from_str(&said[0]).expect("JSON");
    let [own, reached] = [&told["E1max"], &told["reached"]["E1max"]].map(Value::as_f64);
    let alone: f64 = answers(&study, false, None, "215 232 0.06 0.34\n")[0].parse().expect("a number");
    assert_eq!(own, Some(alone));
    assert!(reached >= own, "{said:?}");
}
