//! Each cell of the atlas in which the hybrid "works", against another method: DOP853 with located contacts.

use retune_peers::atlas::difficulties::all;
use retune_peers::atlas::{Verdict, WAYS, cell, reference};
use retune_peers::own;
use retune_solver::{Contacts, Method};

#[test]
fn exact_the_hybrid_works_on_every_difficulty() {
    for difficulty in all().expect("valid numbers") {
        let reference = reference(&difficulty).expect("runs");
        let found = cell(&WAYS[0], &difficulty.case, &reference);
        assert_eq!(found.verdict, Verdict::Works, "{}: {:e}", difficulty.case.name, found.error);
    }
}

#[test]
fn reference_of_every_difficulty_is_confirmed_by_another_method() {
    for difficulty in all().expect("valid numbers") {
        let reference = reference(&difficulty).expect("runs");
        let settings = own::settings(Method::Dop853, Contacts::Located, 1e-11);
        let other = own::run(&difficulty.case, &settings, false).expect("runs");
        let error = (other.e1_max / reference.e1_max - 1.0).abs();
        assert!(error < 1e-6, "{}: {error:e}", difficulty.case.name);
    }
}
