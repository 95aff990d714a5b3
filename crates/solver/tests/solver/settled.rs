//! Settled responses beside much longer runs.

use retune_solver::{Ask, Method, Settings, Settle, Window, settled};
use retune_testkit::hunt::settled::{difference, late, rest, settled_stays};
use retune_testkit::scenes::{Numbers, SSVI};

#[test]
fn invariant_what_has_settled_stays() {
    settled_stays(150).passes();
}

/// Its E1max has settled long before the damper has crept to the wall.
#[test]
fn contract_a_damper_that_creeps_has_not_settled() {
    let numbers = Numbers {
        k2: 10.317_189_989_760_958,
        c2: 332.345_202_151_484_86,
        d: 0.084_375_876_743_818_79,
        c: 0.449_683_133_363_699_2,
        ..SSVI
    };
    for omega in [5.5, SSVI.omega, 7.0] {
        let scene = Numbers { omega, ..numbers }.scene();
        let late = late(&scene);
        if let Some(found) = rest(&scene) {
            assert!(
                difference(found, late).iter().all(|difference| *difference <= 1.0),
                "{omega} {found:?} {late:?}"
            );
        }
    }
}

/// A transient that falls by 5 % a period changes little from return to return, and twenty times as much in all that follows: only
/// the latter may be below the tolerance.
#[test]
fn exact_a_slow_decay_has_not_settled_before_all_that_is_left_of_it_is_small() {
    let numbers = Numbers { c1: 100.0, k2: 0.0, c2: 0.0, d: 5.0, c: 5.0, ..SSVI };
    let settings = Settings { method: Method::Dop853, rtol: 1e-9, atol: 1e-11, ..Settings::default() };
    let window = Window { from: 0.0, to: 600.0 };
    let found =
        settled(&numbers.scene(), window, Settle::default(), &settings, Ask::default()).expect("a run");
    let steady = numbers.bare().steady(numbers.omega).e1_max;
    let error = (found.largest.value / steady - 1.0).abs();
    assert!(found.settled && error < 5e-5, "{} {error:e}", found.settled);
}
