//! Whatever a page sends, broken or meant to do harm, is refused or answered within bounds.

use crate::session::{answers, kind, place, start};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use retune_explore::protocol::{DamperKind, Message, read};
use retune_explore::{limits, motion};
use serde_json::{Value, json};

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
            quantity: None,
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
        let message = Message::Look { id: 1, place: place(damper, &set), span, columns, branches: false, quantity: None };
        let text = serde_json::to_string(&message).expect("a message");
        let Ok(Message::Look { place, span, columns, .. }) = read(&text) else { return Ok(()) };
        let Ok(mut study) = start().at(&place) else { return Ok(()) };
        prop_assert!(study.solver.max_steps <= limits::MOST_STEPS);
        study.solver.max_steps = 5000; // so that four hundred of them take seconds
        let Ok(span) = limits::shown(&study, span) else { return Ok(()) };
        prop_assert!(0.0 <= span[0] && span[0] < span[1] && span[1] <= study.window.end.get(), "{span:?}");
        if let Ok(shown) = motion::look(&study, span, columns) {
            // Six rows at most of each of five quantities in a column, and one column beyond the last.
            for (name, most) in [("t", 12 * (columns + 1)), ("forcing", 4 * (columns + 1) + 2), ("contacts", 8 * (columns + 1)), ("drawn.t", 1200), ("crest.x1", 4001)] {
                let rows = shown.numbers(name).map_or(0, |numbers| numbers.len());
                prop_assert!(rows <= most, "{name}: {rows} of {most}");
            }
        }
    }
}

/// The parameters of a place.
const NAMES: [&str; 14] =
    ["omega", "k2", "c2", "D", "C", "m2", "k1", "c1", "m1", "P", "R", "T", "t0", "imbalance"];
