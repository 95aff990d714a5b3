//! The protocol of a page: what is refused, what is bounded, and that the latest message wins.

use retune_explore::limits::{MOST_BYTES, MOST_COLUMNS, MOST_RECORD};
use retune_explore::protocol::{Answer, DamperKind, Message, Place, read};
use retune_explore::response;
use retune_explore::session::serve;
use retune_explore::start::Start;
use retune_explore::tuning::tune;
use retune_testkit::desk::{Desk, FOOTBRIDGE, footbridge};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

pub fn start() -> Start {
    Start::read(None).expect("the built-in study")
}

pub fn place(damper: DamperKind, set: &[(&str, f64)]) -> Place {
    let set: BTreeMap<String, f64> = set.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    Place { damper, set }
}

/// The message that looks at an SSVI NES with these numbers.
pub fn look(id: u64, set: &[(&str, f64)]) -> String {
    let message = Message::Look {
        id,
        place: place(DamperKind::Ssvi, set),
        span: None,
        columns: 400,
        branches: false,
        quantity: None,
    };
    serde_json::to_string(&message).expect("a message")
}

/// The answers to some messages, until `last` has come.
pub fn answers(messages: Vec<String>, last: impl Fn(&Answer) -> bool + Sync) -> Vec<Answer> {
    let (sender, receiver) = channel();
    let found = Mutex::new(Vec::new());
    let sender = Mutex::new(sender);
    let mut messages = messages.into_iter();
    serve(
        &start(),
        &|answer| {
            let end = last(&answer);
            found.lock().expect("no panic").push(answer);
            if end {
                sender.lock().expect("no panic").send(()).expect("still waiting");
            }
            true
        },
        || {
            messages.next().or_else(|| {
                receiver.recv_timeout(Duration::from_secs(60)).expect("the last answer");
                None
            })
        },
    );
    found.into_inner().expect("no panic")
}

pub fn kind(answer: &Answer) -> &str {
    answer.get("kind").and_then(Value::as_str).expect("a kind")
}

#[test]
fn contract_a_curve_is_refined_and_kept_while_only_omega_changes() {
    let found = answers(vec![look(1, &[("k2", 300.0)])], |answer| kind(answer) == "done");
    let kinds: Vec<&str> = found.iter().map(kind).collect();
    assert_eq!(kinds[..5], ["hello", "motion", "response", "response", "motion kind"], "{kinds:?}");
    let curves = found.iter().filter(|answer| answer.get("whose") == Some(&json!("now"))).count();
    assert_eq!(curves, 3); // 31 frequencies, the worst, 301 frequencies

    let (sender, receiver) = channel();
    let (sender, count) = (Mutex::new(sender), Mutex::new(0));
    let mut messages = vec![look(1, &[("k2", 300.0)]), look(2, &[("k2", 300.0), ("omega", 7.0)])].into_iter();
    serve(
        &start(),
        &|answer| {
            if answer.get("id") == Some(&json!(2)) && kind(&answer) == "response" {
                *count.lock().expect("no panic") += 1;
            }
            if kind(&answer) == "done" {
                sender.lock().expect("no panic").send(()).expect("still waiting");
            }
            true
        },
        || {
            let next = messages.next();
            if next.is_none() || messages.len() == 0 {
                receiver.recv_timeout(Duration::from_secs(60)).expect("done");
            }
            next
        },
    );
    assert_eq!(count.into_inner().expect("no panic"), 0);
}

/// Back before the curve of another design was whole: the page has a part of it, and is sent the first again.
#[test]
fn regress_a_curve_is_sent_again_after_part_of_another() {
    let (sender, receiver) = channel();
    let (sender, found) = (Mutex::new(sender), Mutex::new(Vec::new()));
    let mut messages =
        vec![look(1, &[("k2", 300.0)]), look(2, &[("k2", 301.0)]), look(3, &[("k2", 300.0)])].into_iter();
    serve(
        &start(),
        &|answer| {
            let begun = kind(&answer) == "response" && answer.get("id") == Some(&json!(2));
            if kind(&answer) == "done" || begun {
                let _ = sender.lock().expect("no panic").send(());
            }
            found.lock().expect("no panic").push(answer);
            true
        },
        || {
            if messages.len() < 3 {
                receiver.recv_timeout(Duration::from_secs(60)).expect("an answer");
            }
            messages.next()
        },
    );
    let found = found.into_inner().expect("no panic");
    let fine = |id: u64| {
        found.iter().any(|answer| answer.get("id") == Some(&json!(id)) && answer.get("fine").is_some())
    };
    assert_eq!([fine(1), fine(2), fine(3)], [true, false, true]);
}

/// A hundred positions in a row: the last is answered, hardly any other, in less time than all would take.
#[test]
fn contract_the_latest_position_wins() {
    let messages: Vec<String> = (0..100).map(|i| look(i, &[("k2", 200.0 + i as f64)])).collect();
    let found = answers(messages, |answer| kind(answer) == "done");
    let done: Vec<&Value> =
        found.iter().filter(|answer| kind(answer) == "done").filter_map(|answer| answer.get("id")).collect();
    assert_eq!(done, [&json!(99)]);
    let fine = found.iter().filter(|answer| answer.get("fine").is_some()).count();
    assert_eq!(fine, 1, "curves for older positions were finished");
}

#[test]
fn contract_stale_work_ends_at_its_next_run() {
    let curve = response::Curve::of(start().study(), start().study().quantity());
    let looks = std::sync::atomic::AtomicUsize::new(0);
    let stale = || looks.fetch_add(1, std::sync::atomic::Ordering::SeqCst) >= 10;
    assert_eq!(curve.over(100_000, &stale), Err(response::Stale));
    assert!(looks.into_inner() < 1000);
    assert_eq!(curve.worst(&|| true), Err(response::Stale));
}

#[test]
fn contract_a_page_that_has_gone_ends_its_session() {
    let begun = Instant::now();
    let mut messages = vec![look(1, &[]), look(2, &[("k2", 100.0)])].into_iter();
    serve(&start(), &|_| false, || messages.next());
    assert!(begun.elapsed() < Duration::from_secs(10));
}

#[test]
fn contract_wrong_messages_are_refused_with_the_field() {
    let refused = |set: &[(&str, f64)]| start().at(&place(DamperKind::Ssvi, set)).expect_err("wrong");
    assert_eq!(refused(&[("k2", -1.0)]).field.as_deref(), Some("k2"));
    assert!(refused(&[("k2", -1.0)]).problem.contains("-1 is not allowed here"));
    assert!(refused(&[("k3", 1.0)]).problem.contains("unknown parameter `k3`"));
    assert!(refused(&[("t0", 100.0)]).problem.contains("the window is empty"));
    assert_eq!(refused(&[("T", 1e6)]).field.as_deref(), Some("T"));
    assert!(refused(&[("omega", 1e5)]).problem.contains("periods is too long for this page"));
    let walls = start().at(&place(DamperKind::Tmd, &[("D", 0.1)])).expect_err("no walls");
    assert_eq!(walls.problem, "D: the damper has no walls");
    let none = start().at(&place(DamperKind::None, &[("k2", 1.0)])).expect_err("no damper");
    assert_eq!(none.problem, "k2: the scene has no damper");
}

#[test]
fn contract_messages_are_capped() {
    let problem = |text: &str| read(text).expect_err("refused").problem;
    assert!(problem(&" ".repeat(MOST_BYTES + 1)).contains("at most"));
    let wide = format!(
        r#"{{"look":{{"id":1,"place":{{"damper":"ssvi","set":{{}}}},"columns":{}}}}}"#,
        MOST_COLUMNS + 1
    );
    assert!(problem(&wide).contains("columns"));
    assert!(problem(r#"{"pin":{"slot":2,"place":{"damper":"none","set":{}}}}"#).contains("slot"));
    assert!(
        problem(r#"{"look":{"id":1,"place":{"damper":"none","set":{}},"span":[3,2],"columns":9}}"#)
            .contains("span")
    );
    assert!(problem(r#"{"stop":{},"tune":{}}"#).contains("expected"));
    assert!(
        problem(r#"{"look":{"id":1,"place":{"damper":"none","set":{}},"columns":9,"more":1}}"#)
            .contains("more")
    );
    assert!(problem(r#"{"run":{"command":"ls"}}"#).contains("unknown variant"));
}

/// What is no pulse and no record is refused with its field; no file of the server is read.
#[test]
fn contract_what_is_no_pulse_and_no_record_is_refused() {
    let under = |forcing: Value, text: Option<&str>| {
        let Value::Object(fields) = forcing else { panic!("an object") };
        start().under(fields, text).expect_err("refused")
    };
    let file = json!({ "record": concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/records/quake.csv"), "of": "force" });
    assert_eq!(under(file.clone(), None).problem, "record: the text of its file is missing");
    for (text, words) in [
        ("", "is empty"),
        ("t,a\n0,1\n", "1 sample:"),
        ("t,a\n0,1\n0,2\n", "does not come after"),
        ("t,a\n0,x\n", "line 2"),
    ] {
        let refused = under(file.clone(), Some(text));
        assert_eq!(refused.field.as_deref(), Some("record"));
        assert!(refused.problem.contains(words), "{}", refused.problem);
    }
    let harmonics = json!({ "harmonics": [], "of": "force", "duration": 1 });
    assert_eq!(under(harmonics, None).field.as_deref(), Some("harmonics"));
    let long = json!({ "pulse": "rectangle", "of": "force", "peak": 1, "duration": 1e6 });
    assert_eq!(under(long, None).field.as_deref(), Some("T"));
    let padded = format!("{{\"force\":{{\"forcing\":null{}}}}}", " ".repeat(MOST_BYTES));
    assert!(read(&padded).is_ok(), "a record may be long");
    assert!(
        read(&format!("{{\"force\":{}", " ".repeat(MOST_RECORD)))
            .expect_err("too long")
            .problem
            .contains("at most")
    );
}

/// The search starts from here, every iteration is logged, and after a stop the best design is kept.
#[test]
fn contract_tune_from_here_stops_and_keeps_the_best() {
    let tune = serde_json::to_string(&Message::Tune { place: place(DamperKind::Tmd, &[("k2", 500.0)]) });
    let (sender, receiver) = channel();
    let (sender, found) = (Mutex::new(sender), Mutex::new(Vec::new()));
    let mut messages = vec![tune.expect("a message"), r#"{"stop":{}}"#.to_owned()].into_iter();
    serve(
        &start(),
        &|answer| {
            let rows = kind(&answer) == "row"
                && answer.get("text").is_some_and(|text| {
                    text.as_str().is_some_and(|text| text.trim_start().starts_with("4 "))
                });
            if rows || kind(&answer) == "tuned" {
                let _ = sender.lock().expect("no panic").send(());
            }
            found.lock().expect("no panic").push(answer);
            true
        },
        || {
            let next = messages.next();
            if next.as_ref().is_none_or(|text| text.contains("stop")) {
                receiver.recv_timeout(Duration::from_secs(60)).expect("rows");
            }
            next
        },
    );
    let found = found.into_inner().expect("no panic");
    let tuned = found.iter().find(|answer| kind(answer) == "tuned").expect("a design");
    assert_eq!(tuned.get("stop"), Some(&json!("stopped; the best design so far is kept")));
    let rows: Vec<f64> = found
        .iter()
        .filter(|answer| kind(answer) == "row")
        .filter_map(|answer| answer.get("value")?.as_f64())
        .collect();
    assert!(rows.len() >= 5 && rows.windows(2).all(|pair| pair[1] <= pair[0]), "{rows:?}");
    assert_eq!(tuned.get("value").and_then(Value::as_f64), rows.last().copied());
    assert!(tuned.get("design").is_some_and(|design| design["k2"].is_number() && design["D"].is_null()));
}

#[test]
fn reference_a_tuning_does_not_stop_in_the_kink_of_a_limit() {
    let desk = Desk::with(&footbridge());
    let start = Start::read(Some(&desk.path("study.json"))).expect("a study");
    let found = Mutex::new(None);
    let keep = |answer: Answer| {
        if kind(&answer) == "tuned" {
            *found.lock().expect("no panic") = answer.get("value").and_then(Value::as_f64);
        }
    };
    tune(&start, &place(DamperKind::Tmd, &[]), &keep, &|| false).expect("a tuning");
    let value = found.into_inner().expect("no panic").expect("a value");
    assert!((value / FOOTBRIDGE - 1.0).abs() < 1e-4, "{value} J");
}
