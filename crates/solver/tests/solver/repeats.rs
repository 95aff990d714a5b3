//! Runs that end when their motion repeats, beside the same runs to the end.

use retune_testkit::hunt::repeats::{differences, repeats};

#[test]
fn invariant_a_run_that_repeats_has_seen_its_largest_values() {
    repeats(600).passes();
}

/// Irregular runs that once come close to a motion, look ahead in vain, and go on: to the last bit as if they had not looked.
#[test]
fn regress_a_look_ahead_in_vain_changes_nothing() {
    for number in [1834, 1940, 7228, 10769, 12980, 13042, 15339, 15802, 17454, 21079, 22424, 35212] {
        let missed = differences(number);
        assert!(missed.iter().all(|missed| *missed == 0.0), "{number}: {missed:?}");
    }
}
