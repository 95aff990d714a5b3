//! No largest value is missed: the search for maxima beside looking everywhere, and beside another method.

mod problems;

use problems::scenes::{Numbers, SSVI};
use retune_solver::{Method, Response, Settings, Window, simulate};

fn run(numbers: &Numbers, to: f64, method: Method, rtol: f64) -> Response {
    let settings = Settings { method, rtol, atol: rtol * 1e-3, ..Settings::default() };
    simulate(&numbers.scene(), Window { from: 0.0, to }, &settings).expect("a run")
}

/// Scenes in which one flight step holds two maxima, with a dip between them: both of its ends are concave.
const TWO_MAXIMA: [Numbers; 3] = [
    Numbers {
        c: 0.69253168895597,
        d: 0.0595372531637714,
        r: 0.6350272881550908,
        c2: 8.649689386577819,
        k1: 62235.81747936603,
        k2: 1662.5681305782794,
        m2: 1094.99843495297,
        omega: 8.576461062918153,
        ..SSVI
    },
    Numbers {
        c: 0.6547348308830689,
        d: 0.010795415058871565,
        r: 0.25090151211446055,
        c2: 91.73069507472201,
        k1: 54619.709078149644,
        k2: 2645.4926686046892,
        m2: 148.56181808078918,
        omega: 6.9442298065176935,
        ..SSVI
    },
    Numbers {
        c: 0.4200649481193844,
        d: 0.04287275399728375,
        r: 2.951804640003278,
        c2: 64.81813716232124,
        k1: 13249.426510843248,
        k2: 2926.076768240964,
        m2: 50.37249528206486,
        omega: 9.692919717021919,
        ..SSVI
    },
];

#[test]
fn reference_two_maxima_in_one_step_are_both_seen() {
    for numbers in TWO_MAXIMA {
        let expected = run(&numbers, 20.0, Method::Dop853, 1e-12);
        for rtol in [1e-6, 1e-8, 1e-10, 1e-12] {
            let found = run(&numbers, 20.0, Method::Hybrid, rtol);
            for (found, expected) in [(found.e1_max, expected.e1_max), (found.e2_max, expected.e2_max)] {
                let error = (found.value / expected.value - 1.0).abs();
                assert!(error < 10.0 * rtol.max(1e-9), "{rtol:e}: {found:?} {expected:?} {error:e}");
            }
        }
    }
}
