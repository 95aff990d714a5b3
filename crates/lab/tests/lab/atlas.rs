//! The atlas of failures: its references against another method, the hybrid's cells, and every committed cell.

use retune_lab::atlas::difficulties::all;
use retune_lab::atlas::{Verdict, WAYS, cell, energy, energy_cell, missed, rigid, stable, truth};
use retune_lab::runs::{errors, run, settings};
use retune_solver::{Contacts, Method};
use std::path::Path;

/// Errors of another method with located contacts, DOP853 at rtol 1e-12, against the reference.
#[test]
fn reference_of_every_difficulty_is_confirmed_by_another_method() {
    for difficulty in all().expect("runs") {
        let case = &difficulty.case;
        let truth = truth(&difficulty).expect("runs");
        let other = run(case, &settings(Method::Dop853, Contacts::Located, 1e-12), false).expect("runs");
        let [e1, state, _] = errors(&other, &truth.found, case.omega());
        assert!(e1 < 1e-6 && state < 1e-5, "{}: {e1:e} {state:e}", case.name);
    }
}

#[test]
fn reference_the_hybrid_works_on_every_difficulty() {
    for difficulty in all().expect("runs") {
        let truth = truth(&difficulty).expect("runs");
        let found = cell(&WAYS[0], &difficulty.case, &truth);
        assert_eq!(found.verdict, Verdict::Works, "{}: {:e}", difficulty.case.name, found.error);
    }
}

/// The allowed change of the energy per contact: the tolerance of its steps.
#[test]
fn invariant_energy_of_the_hybrid_drifts_by_less_than_rtol_an_impact() {
    for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
        let drift = energy::drift(Method::Hybrid, Contacts::Located, rtol);
        assert_eq!(drift.impacts, energy::IMPACTS);
        let change = drift.change.expect("ends").abs();
        assert!(change < energy::IMPACTS as f64 * rtol, "{rtol:e}: {change:e}");
    }
}

/// E. Hairer & G. Wanner, Solving Ordinary Differential Equations II, IV.2.
#[test]
fn exact_largest_stable_steps_are_those_of_theory() {
    for moment in stable::moments().expect("runs") {
        for found in stable::stable(&moment) {
            let equal = (found.measured / found.theory - 1.0).abs() < 1e-3
                || (found.measured.is_infinite() && found.theory.is_infinite());
            assert!(equal, "{} {}: {} {}", moment.name, found.method.name(), found.measured, found.theory);
        }
    }
}

/// The duration of a contact is proportional to `K^(-2/5)`.
#[test]
fn order_of_the_approach_to_rigid_walls_is_two_fifths() {
    let [_, near] = rigid::distance(8).expect("runs");
    let [_, far] = rigid::distance(5).expect("runs");
    let slope = (far / near).log10() / 3.0;
    assert!((slope - 0.4).abs() < 0.02, "{slope}");
    assert!(near < 1e-2, "{near}");
}

#[test]
fn contract_the_hybrid_misses_no_contact() {
    for case in &missed::subjects() {
        for step in [1e-3, 1.0] {
            let found = missed::missed(case, Method::Hybrid, Contacts::Located, step).expect("runs");
            assert_eq!((found.jumped, found.said), (0, None), "{}", case.name);
            assert!(found.seen > 10);
        }
    }
}

/// Every verdict of the committed atlas, of every method.
#[test]
fn regress_every_cell_is_as_committed() {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../results/stability/atlas.csv");
    let table = std::fs::read_to_string(table).expect("the committed atlas");
    let committed = |name: &str, way: &str| {
        let start = format!(",{},{way},", name.replace(',', ";"));
        let line = table.lines().find(|line| line.contains(&start)).expect("a cell").to_string();
        line.split(',').nth(3).expect("a verdict").to_string()
    };
    let check = |name: &str, way: usize, verdict: Verdict| {
        assert_eq!(committed(name, WAYS[way].name), verdict.name(), "{name}, {}", WAYS[way].name);
    };
    for difficulty in all().expect("runs") {
        let truth = truth(&difficulty).expect("runs");
        for (j, way) in WAYS.iter().enumerate() {
            check(difficulty.case.name, j, cell(way, &difficulty.case, &truth).verdict);
        }
    }
    for (j, way) in WAYS.iter().enumerate() {
        check("1,000 lossless impacts: the energy", j, energy_cell(way).verdict);
    }
}

/// The damped oscillator under semi-implicit Euler: `hω = 2 (√(1 + ζ²) - ζ)`.
#[test]
fn exact_largest_stable_step_of_semi_implicit_euler_with_damping() {
    let moments = stable::moments().expect("runs");
    let bare = moments.iter().find(|m| m.name.starts_with("no damper")).expect("the bare structure");
    let (omega, zeta) = (39.5_f64.sqrt(), 452.0 / (2.0 * (3.95e4_f64 * 1000.0).sqrt()));
    let expected = 2.0 * ((1.0 + zeta * zeta).sqrt() - zeta) / omega;
    let found = stable::stable(bare).into_iter().find(|s| s.method == Method::Euler).expect("Euler").measured;
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
}
