//! `prove` from its arguments to the screen.

use crate::common::{Answer, Desk, Program};
use retune_testkit::desk::committed;
use serde_json::Value;

fn desk() -> Desk {
    let desk = Desk::new();
    for name in ["tmd.json", "ssvi.json"] {
        desk.write_json(name, &committed(name));
    }
    desk
}

#[test]
fn contract_prove_shows_the_theorem_in_words_and_as_json() {
    let desk = desk();
    let words = desk.good(&["prove", "tmd.json", "--omega", "57.3rpm"]);
    assert!(words.starts_with("study tmd, omega = 6.0004"), "{words}");
    assert!(words.contains(" rad/s: proven by interval arithmetic\n"), "{words}");
    let answer = desk.good(&["prove", "tmd.json", "--omega", "57.3rpm", "--json"]);
    let answer: Value = serde_json::from_str(&answer).expect("JSON");
    for key in [
        "/omega",
        "/periods",
        "/width",
        "/events/0/phase/0",
        "/events/0/state/3/1",
        "/stability/stable",
        "/largest/E1max/0",
        "/largest/stroke/1",
        "/largest/contact_force/1",
    ] {
        assert!(answer.pointer(key).is_some_and(Value::is_number), "{key}");
    }
    // No box: no other motion that touches no wall repeats.
    assert_eq!(answer.pointer("/alone_within"), Some(&Value::Null));
    assert!(words.contains(&answer["largest"]["E1max"][1].to_string()), "{words}");
    // Any guess will do where there is one motion only.
    let from = ["prove", "tmd.json", "--omega", "57.3rpm", "--from", "0.1,-0.2,0.3,0"];
    assert!(desk.good(&from).contains("\nstable        all multipliers are below "));
}

#[test]
fn contract_what_is_not_proven_ends_with_code_1() {
    let desk = desk();
    let Answer { code, stdout, stderr } = desk.run(&["prove", "ssvi.json"]);
    assert_eq!((code, stdout.as_str()), (Some(1), ""));
    assert!(stderr.starts_with("error: study ssvi: not proven: none found: "), "{stderr}");
    for (arguments, said) in [
        (
            &["prove", "tmd.json", "--omega", "-1"] as &[&str],
            "omega: -1 is not allowed here: give a finite number not below 0",
        ),
        (&["prove", "tmd.json", "--periods", "2"], "--from <X1,V1,X2,V2>"),
        (&["prove", "tmd.json", "--from", "1"], "\"1\" is no state: give x1,v1,x2,v2"),
        (&["prove", "none.json"], "none.json: cannot be read"),
        (&["prove", "tmd.json", "--omega", "6", "--set", "omega=5"], "--omega: omega is given by --set, too"),
    ] {
        let refused = desk.refused(arguments);
        assert!(refused.contains(said), "{refused}");
    }
}

/// A bound that holds at some frequencies of a band alone is not proven: what is shows, and the code is 1.
#[test]
fn contract_a_bound_must_hold_at_every_frequency() {
    let band = ["prove", "tmd.json", "--omega", "5", "--to", "6.5"];
    let desk = desk();
    let whole = desk.good(&[&band[..], &["--json"]].concat());
    let whole: Value = serde_json::from_str(&whole).expect("JSON");
    let largest = whole.pointer("/E1max/1").and_then(Value::as_f64).expect("a bound");
    let less = (0.5 * largest).to_string();
    let Answer { code, stdout, stderr } = desk.run(&[&band[..], &["--most", &less]].concat());
    assert_eq!(code, Some(1), "{stdout}");
    assert!(stdout.contains("every omega") && stdout.contains("but for"), "{stdout}");
    assert!(stderr.starts_with("error: study tmd: not proven: an E1max of at most "), "{stderr}");
    desk.good(&[&band[..], &["--most", &(1.01 * largest).to_string()]].concat());
}

/// The theorem that `docs/proof.md` shows, but for its last digits, which depend on the processor's rounding of the guess.
#[test]
fn contract_the_document_shows_what_is_proven() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/proof.md")).expect("the document");
    let results = root.join("results/ssvi");
    let proven = Desk::new().good(&["prove", results.to_str().expect("a path")]);
    let first = proven.lines().next().expect("a line").split(" = ").next().expect("its beginning");
    let shown = page.lines().skip_while(|line| !line.starts_with(first));
    assert_eq!(shown.clone().take_while(|line| *line != "```").count(), proven.lines().count());
    for (shown, proven) in shown.zip(proven.lines()) {
        let words: [Vec<&str>; 2] = [shown, proven].map(|line| line.split(' ').collect());
        assert_eq!(words[0].len(), words[1].len(), "{shown}\n{proven}");
        for (a, b) in words[0].iter().zip(&words[1]) {
            let close = match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) if a.abs() < 1e-6 => a < 10.0 * b && b < 10.0 * a,
                (Ok(a), Ok(b)) => (a - b).abs() < 1e-8 * a.abs(),
                _ => a == b,
            };
            assert!(close, "{shown}\n{proven}");
        }
    }
}
