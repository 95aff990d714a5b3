//! The protocol of a page: what is refused, what is bounded, and that the latest message wins.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use retune_explore::limits::{self, MOST_BYTES, MOST_COLUMNS};
use retune_explore::protocol::{Answer, DamperKind, Message, Place, What, read};
use retune_explore::session::serve;
use retune_explore::start::Start;
use retune_explore::{motion, response, texts};
use retune_jobs::simulate::simulate;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

fn start() -> Start {
    Start::read(None).expect("the built-in study")
}

fn place(damper: DamperKind, set: &[(&str, f64)]) -> Place {
    let set: BTreeMap<String, f64> = set.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    Place { damper, set }
}

fn look(id: u64, set: &[(&str, f64)]) -> String {
    let message =
        Message::Look { id, place: place(DamperKind::Ssvi, set), span: None, columns: 400, branches: false };
    serde_json::to_string(&message).expect("a message")
}

/// The answers to some messages, until `last` has come.
fn answers(messages: Vec<String>, last: impl Fn(&Answer) -> bool + Sync) -> Vec<Answer> {
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

fn kind(answer: &Answer) -> &str {
    answer.get("kind").and_then(Value::as_str).expect("a kind")
}

#[test]
fn contract_the_built_in_study_is_that_of_the_repository() {
    let here = env!("CARGO_MANIFEST_DIR");
    let read = |path: &str| std::fs::read_to_string(format!("{here}/{path}")).expect("a file");
    assert_eq!(read("src/study.json"), read("../../studies/ssvi.json"));
}

/// What the page shows of a run is what `retune simulate` prints.
#[test]
fn contract_figures_are_those_of_simulate() {
    let set = [("k2", 583.9), ("c2", 94.97), ("D", 0.02885), ("C", 1.105), ("omega", 6.631)];
    let found = answers(vec![look(7, &set)], |answer| kind(answer) == "done");
    let motion = found.iter().find(|answer| kind(answer) == "motion").expect("a motion");
    let study = start().file_at(&place(DamperKind::Ssvi, &set)).expect("a study");
    let run = simulate(&study, None).expect("a run");
    assert_eq!(motion.get("text"), Some(&json!(run.to_string())));
    let e1_max = json!(run)["E1max"].clone();
    assert_eq!(motion.get("run").map(|run| run["E1max"].clone()), Some(e1_max));
    assert_eq!(motion.get("id"), Some(&json!(7)));
    let worst = found.iter().find(|answer| kind(answer) == "worst").expect("a worst");
    assert_eq!(worst.get("words"), Some(&json!("225.8"))); // README: what `just optimize-ssvi` finds
}

/// The settled states come from the record of the regime, in other coordinates: they are where the run ends, too.
#[test]
fn reference_settled_crests_are_those_of_the_run() {
    let set = [("k2", 583.9), ("c2", 94.97), ("D", 0.02885), ("C", 1.105), ("omega", 6.631)];
    let found = answers(vec![look(1, &set)], |answer| kind(answer) == "done");
    let last = |of: &str, column: &str| {
        let answer = found.iter().find(|answer| kind(answer) == of).expect("an answer");
        *answer.numbers(column).expect("a column").last().expect("a crest")
    };
    for (column, size) in [("crest.x1", 0.09), ("crest.v1", 0.6), ("crest.x", 0.5), ("crest.v", 1.5)] {
        let [run, settled] = ["motion", "motion kind"].map(|of| last(of, column));
        assert!((run - settled).abs() < 1e-3 * size, "{column}: {run} {settled}");
    }
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
    let curve = response::Curve::of(start().study());
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

/// A saved study is a study file, with the numbers of the page, whichever damper hangs there.
#[test]
fn contract_a_saved_study_is_read_again() {
    for (damper, set) in [
        (DamperKind::Ssvi, &[("k2", 300.0), ("omega", 6.5)][..]),
        (DamperKind::Tmd, &[("k2", 450.0)][..]),
        (DamperKind::None, &[("P", 500.0)][..]),
    ] {
        let place = place(damper, set);
        let written =
            texts::written(&start(), &place, What::Study, &[None, None], &|| false).expect("written");
        let text = written.get("text").and_then(Value::as_str).expect("text");
        let study = retune_study::read::from_text(text, "saved.json").expect("a study");
        assert_eq!(study.scene, start().at(&place).expect("a place").scene, "{damper:?}");
    }
    let outside = texts::written(
        &start(),
        &place(DamperKind::Ssvi, &[("k2", -5.0)]),
        What::Study,
        &[None, None],
        &|| false,
    );
    assert_eq!(outside.expect_err("refused").field.as_deref(), Some("k2"));
}

#[test]
fn contract_the_command_line_says_what_differs() {
    let named =
        Start::read(Some(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/study.json"))));
    let named = named.expect("a study");
    let text = |start: &Start, place: &Place, what| {
        let written = texts::written(start, place, what, &[None, None], &|| false).expect("written");
        written.get("text").and_then(Value::as_str).expect("text").to_owned()
    };
    let here = place(DamperKind::Ssvi, &[("k2", 300.0), ("c2", 232.0)]);
    assert!(text(&named, &here, What::Command).ends_with("src/study.json --set k2=300"));
    assert!(text(&named, &here, What::Python).contains(".at(k2=300)\nrun = problem.simulate()"));
    let other = place(DamperKind::Tmd, &[("k2", 300.0)]);
    assert!(text(&named, &other, What::Command).starts_with("retune simulate study-explored.json  #"));
    assert!(text(&start(), &here, What::Motion).starts_with("t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment\n50,"));
    for what in [What::Picture, What::Response] {
        assert!(text(&start(), &here, what).starts_with("<svg "));
    }
}

/// A figure of the response has what the page has: each curve, and which design it is.
#[test]
fn contract_a_figure_has_the_pinned_designs() {
    let pin = |k2: f64| Some(place(DamperKind::Ssvi, &[("k2", k2)]));
    let text = |pins: [Option<Place>; 2]| {
        let written =
            texts::written(&start(), &place(DamperKind::Ssvi, &[]), What::Response, &pins, &|| false)
                .expect("written");
        written.get("text").and_then(Value::as_str).expect("text").to_owned()
    };
    let lines = |text: &str| text.matches("<path").count();
    let (alone, both) = (text([None, None]), text([pin(300.0), pin(450.0)]));
    assert!(lines(&both) >= lines(&alone) + 2, "{} {}", lines(&alone), lines(&both));
    for words in [" = 300 N/m", " = 450 N/m"] {
        assert!(both.contains(words) && !alone.contains(words), "{words}");
    }
    let second = text([None, pin(450.0)]);
    assert!(second.contains(">B<") && !second.contains(">A<"));
    let wrong =
        texts::written(&start(), &place(DamperKind::Ssvi, &[]), What::Response, &[pin(-1.0), None], &|| {
            false
        });
    assert_eq!(wrong.expect_err("refused").field.as_deref(), Some("k2"));
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

/// Irregular motion is said to be one, and its neighbours are run.
#[test]
fn contract_an_irregular_motion_comes_with_its_neighbours() {
    let found = answers(vec![look(1, &[])], |answer| kind(answer) == "done");
    let of = |name: &str| found.iter().find(|answer| kind(answer) == name);
    let irregular = of("motion kind").and_then(|answer| answer.get("irregular")).cloned();
    assert_eq!(irregular, Some(json!(true))); // the paper's damper at its ω
    let range = of("spread").and_then(|answer| answer.get("range")).cloned().expect("a spread");
    let own =
        of("motion").and_then(|answer| answer.get("run")).map(|run| run["E1max"].clone()).expect("a run");
    assert!(range[0].as_f64() < range[1].as_f64() && own.is_number(), "{range} {own}");
}

/// Values as they come from a broken page, or from one that means no good.
fn any_json() -> impl Strategy<Value = Value> {
    let word = prop_oneof![
        Just("look".to_owned()),
        Just("pin".to_owned()),
        Just("tune".to_owned()),
        Just("stop".to_owned()),
        Just("write".to_owned()),
        Just("place".to_owned()),
        Just("set".to_owned()),
        Just("damper".to_owned()),
        Just("ssvi".to_owned()),
        Just("id".to_owned()),
        Just("columns".to_owned()),
        Just("span".to_owned()),
        Just("k2".to_owned()),
        Just("T".to_owned()),
        Just("omega".to_owned()),
        ".{0,8}".prop_map(String::from),
    ];
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        word.clone().prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 32, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            prop::collection::btree_map(word.clone(), inner, 0..6)
                .prop_map(|map| Value::Object(map.into_iter().collect())),
        ]
    })
}

/// The same draws on every machine: a test that fails by luck is none.
fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(7),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config(4000))]

    /// No text is more than refused.
    #[test]
    fn invariant_any_text_is_read_or_refused(text in ".{0,200}", json in any_json()) {
        let _ = read(&text);
        if let Ok(message) = read(&json.to_string()) {
            prop_assert_eq!(read(&serde_json::to_string(&message).expect("a message")).expect("the same"), message);
        }
    }
}

/// A time span of one denormal number took all memory: whatever numbers a message has, its rows are counted before they are made.
#[test]
fn regress_a_span_of_no_length_is_refused() {
    let look = |span: [f64; 2]| {
        let message = Message::Look {
            id: 1,
            place: place(DamperKind::Ssvi, &[]),
            span: Some(span),
            columns: 400,
            branches: false,
        };
        serde_json::to_string(&message).expect("a message")
    };
    for span in [[0.0, 5e-324], [0.0, 1e-300], [99.0, 99.00000000000001]] {
        let found = answers(vec![look(span)], |answer| kind(answer) == "refused");
        let refused = found.last().expect("an answer");
        assert_eq!(refused.get("field"), Some(&json!("span")), "{span:?}");
    }
    let study = start().at(&place(DamperKind::Ssvi, &[])).expect("a study");
    for (asked, expected) in
        [(None, [50.0, 100.0]), (Some([20.0, 1e308]), [20.0, 100.0]), (Some([1e300, 1e308]), [50.0, 100.0])]
    {
        assert_eq!(limits::shown(&study, asked).map_err(|refused| refused.problem), Ok(expected));
    }
    assert!(limits::rows([0.0, 5e-324], 5e-324 / 800.0, true).is_err(), "an interval of zero");
    assert!(
        limits::rows([0.0, 200.0], 1e-3, false).is_ok() && limits::rows([0.0, 200.1], 1e-3, false).is_err()
    );
}

/// Ends of the ranges of numbers, and what lies beside the study's own.
fn extreme() -> impl Strategy<Value = f64> {
    let ends = [0.0, -0.0, 5e-324, 1e-308, 1e-160, 1e-16, 1.0, 1e16, 1e160, 1.7e308, -1.0, -1.7e308];
    prop_oneof![prop::sample::select(ends.to_vec()), (-324.0..308.0_f64).prop_map(|power| 10f64.powf(power))]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: RngSeed::Fixed(5), ..ProptestConfig::default() })]

    /// Any numbers in any field: refused, or answered with as few rows as the page has pixels, from a run of as few steps as are allowed.
    #[test]
    fn contract_extreme_numbers_are_refused_or_answered_within_bounds(
        sets in prop::collection::vec((0..NAMES.len(), extreme()), 0..3),
        span in prop::option::of([extreme(), extreme()]),
        columns in 1..2000_usize,
        damper in prop::sample::select(vec![DamperKind::None, DamperKind::Tmd, DamperKind::Ssvi]),
    ) {
        let set: Vec<(&str, f64)> = sets.iter().map(|(name, value)| (NAMES[*name], *value)).collect();
        let message = Message::Look { id: 1, place: place(damper, &set), span, columns, branches: false };
        let text = serde_json::to_string(&message).expect("a message");
        let Ok(Message::Look { place, span, columns, .. }) = read(&text) else { return Ok(()) };
        let Ok(mut study) = start().at(&place) else { return Ok(()) };
        prop_assert!(study.solver.max_steps <= limits::MOST_STEPS);
        study.solver.max_steps = 5000; // so that four hundred of them take seconds
        let Ok(span) = limits::shown(&study, span) else { return Ok(()) };
        prop_assert!(0.0 <= span[0] && span[0] < span[1] && span[1] <= study.window.end.get(), "{span:?}");
        if let Ok(shown) = motion::look(&study, span, columns) {
            // Six rows at most of each of five quantities in a column, and one column beyond the last.
            for (name, most) in [("t", 12 * (columns + 1)), ("contacts", 8 * (columns + 1)), ("drawn.t", 1200), ("crest.x1", 4001)] {
                let rows = shown.numbers(name).map_or(0, |numbers| numbers.len());
                prop_assert!(rows <= most, "{name}: {rows} of {most}");
            }
        }
    }
}

/// The parameters of a place.
const NAMES: [&str; 14] =
    ["omega", "k2", "c2", "D", "C", "m2", "k1", "c1", "m1", "P", "R", "T", "t0", "imbalance"];
