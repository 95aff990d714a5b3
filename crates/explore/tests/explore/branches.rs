//! The motions beside those from rest: as `retune branches` finds them, and given up as soon as another place is shown.

use retune_explore::branches::{SAMPLES, STARTS, follow};
use retune_explore::protocol::{Answer, DamperKind, Message, Place};
use retune_explore::response::Stale;
use retune_explore::session::serve;
use retune_explore::start::Start;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// 225.8 J from rest, 735.6 J from other starts.
fn isola() -> Start {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    Start::read(Some(&here.join("../../studies/ssvi-isola.json"))).expect("a study")
}

fn kind(answer: &Answer) -> &str {
    answer.get("kind").and_then(Value::as_str).expect("a kind")
}

/// `retune branches` with 64 starts at each frequency found the same largest motion.
#[test]
fn reference_the_largest_motion_is_that_of_the_branches() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../results/branches/isola/branches.json");
    let results: Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("results")).expect("JSON");
    let motions = results["branches"].as_array().expect("branches").iter();
    let energy = |branch: &&Value| branch["largest_stable"]["E1max"].as_f64();
    let most = motions
        .filter(|branch| energy(branch).is_some())
        .max_by(|a, b| energy(a).partial_cmp(&energy(b)).expect("numbers"));
    let expected = &most.expect("a largest motion")["largest_stable"];

    let told = AtomicUsize::new(0);
    let send = |answer: Answer| {
        assert_eq!(kind(&answer), "following");
        told.fetch_add(1, SeqCst);
    };
    let found = follow(isola().study(), &send, &|| false).expect("not stale");
    assert_eq!(told.into_inner(), SAMPLES);
    let largest = found.get("largest").expect("a motion");
    let near = |value: &Value, expected: &Value| {
        let [value, expected] = [value, expected].map(|number| number.as_f64().expect("a number"));
        assert!((value / expected - 1.0).abs() < 1e-6, "{value} {expected}");
    };
    near(&largest["value"], &expected["E1max"]);
    near(&largest["omega"], &expected["value"]);
    assert_eq!(
        (&largest["words"], &largest["rest"], &largest["impacts"]),
        (&json!("735.6"), &json!(false), &json!("OOS"))
    );
    assert_eq!(found.get("ended"), Some(&json!(false)));

    let [omega, value, stable] =
        ["omega", "value", "stable"].map(|name| found.numbers(name).expect("a column"));
    assert!(omega.len() > 300 && omega.len() == value.len() && value.len() == stable.len());
    let gaps = omega.iter().filter(|omega| omega.is_nan()).count();
    assert_eq!(found.get("branches"), Some(&json!(gaps)));
    let highest = |is: f64| {
        value.iter().zip(&stable).filter(|(_, one)| **one == is).map(|(value, _)| *value).fold(0.0, f64::max)
    };
    assert!(highest(1.0) > 700.0 && highest(0.0) > 100.0, "{} {}", highest(1.0), highest(0.0));
    let folds = found
        .get("events")
        .and_then(Value::as_array)
        .expect("events")
        .iter()
        .filter(|event| event[0] == "fold");
    assert!(folds.count() >= 2);
}

#[test]
fn contract_what_is_not_struck_has_no_other_motions() {
    let place = Place { damper: DamperKind::Tmd, set: [("k2".to_owned(), 300.0)].into() };
    let study = isola().at(&place).expect("a place");
    let found = follow(&study, &|_| panic!("no search"), &|| false).expect("not stale");
    assert!(found.get("problem").is_some_and(Value::is_string));
}

#[test]
fn contract_a_stale_search_ends_at_its_next_run() {
    let asked = AtomicUsize::new(0);
    let stale = || asked.fetch_add(1, SeqCst) >= 40;
    assert_eq!(follow(isola().study(), &|_| (), &stale).err(), Some(Stale));
    let asked = asked.into_inner();
    // Once more for each start from rest and each other one over the band, at the samples, and at the end.
    assert!(asked < 40 + SAMPLES * (1 + STARTS) + SAMPLES + 20, "asked {asked} times");
}

/// A slider that moves while motions are looked for: it is answered at once, and of the earlier place nothing comes any more.
#[test]
fn contract_another_place_ends_the_search() {
    let look = |id: u64, k2: f64, branches: bool| {
        let place = Place { damper: DamperKind::Ssvi, set: [("k2".to_owned(), k2)].into() };
        serde_json::to_string(&Message::Look {
            id,
            place,
            span: None,
            columns: 400,
            branches,
            quantity: None,
        })
        .expect("a message")
    };
    let (sender, receiver) = channel();
    let (sender, found) = (Mutex::new(sender), Mutex::new(Vec::new()));
    let mut messages = vec![look(1, 597.0, true), look(2, 590.0, false)].into_iter();
    let begun = Mutex::new(Instant::now());
    serve(
        &isola(),
        &|answer| {
            let started = kind(&answer) == "following" && answer.get("done") == Some(&json!(1));
            if started || kind(&answer) == "done" && answer.get("id") == Some(&json!(2)) {
                let _ = sender.lock().expect("no panic").send(());
            }
            found.lock().expect("no panic").push((Instant::now(), answer));
            true
        },
        || {
            if messages.len() < 2 {
                receiver.recv_timeout(Duration::from_secs(60)).expect("an answer");
                let mut begun = begun.lock().expect("no panic");
                if messages.len() == 1 {
                    *begun = Instant::now();
                }
            }
            messages.next()
        },
    );
    let (found, begun) = (found.into_inner().expect("no panic"), begun.into_inner().expect("no panic"));
    assert!(found.iter().all(|(_, answer)| kind(answer) != "branches"));
    let motion =
        |(_, answer): &&(Instant, Answer)| kind(answer) == "motion" && answer.get("id") == Some(&json!(2));
    let (at, _) = found.iter().find(motion).expect("a motion");
    assert!(*at - begun < Duration::from_secs(2), "{:?}", *at - begun);
}
