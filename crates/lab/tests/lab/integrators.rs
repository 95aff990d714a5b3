//! The wrapped integrators of others find the motion: differences on the chart are theirs, not the wrapper's.
#![cfg(feature = "integrators")]

use retune_lab::atlas::others::{OTHERS, cell};
use retune_lab::atlas::{difficulties, truth};
use retune_lab::comparison;
use retune_lab::peers::{PEERS, run};
use retune_lab::reference::REFERENCE;
use retune_lab::runs::{self, errors};
use retune_lab::scenes::cases;
use retune_solver::{Contacts, Method};
use std::path::Path;

#[test]
fn reference_every_peer_finds_every_motion() {
    for case in cases() {
        let tight = runs::settings(Method::Hybrid, Contacts::Located, 1e-12);
        let reference = runs::run(&case, &tight, false).expect("runs");
        for peer in &PEERS {
            let level = 1e-7_f64.max(peer.tightest);
            let best = [true, false]
                .into_iter()
                .filter_map(|located| run(peer, &case, located, level, false).ok())
                .map(|found| errors(&found, &reference, case.omega())[0])
                .fold(f64::INFINITY, f64::min);
            assert!(best < 1e-3, "{} {} on {}: {best:e}", peer.program, peer.method, case.name);
        }
    }
}

/// Errors, counts and evaluations of the committed runs, every fiftieth and of no more than 50,000 evaluations.
#[test]
fn regress_committed_runs_are_made_again() {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../results/accuracy/runs.csv");
    let (table, cases) = (std::fs::read_to_string(table).expect("the committed runs"), cases());
    let names: Vec<&'static str> = cases.iter().map(|case| case.name).collect();
    let rows = runs::parse(&table, &names);
    let short = rows.iter().filter(|row| row.found.as_ref().is_ok_and(|found| found.evaluations < 50_000));
    let sample: Vec<_> = short.step_by(50).collect();
    assert!(sample.len() > 30, "{}", sample.len());
    let tight = runs::settings(Method::Hybrid, Contacts::Located, REFERENCE);
    for row in sample {
        let case = cases.iter().find(|case| case.name == row.scene).expect("a scene");
        let reference = runs::run(case, &tight, false).expect("runs");
        assert_eq!(comparison::change(row, case, &reference), None);
    }
}

/// Cells of the committed atlas of the integrators that are built in, of every sixth difficulty.
#[test]
fn regress_cells_of_others_are_as_committed() {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../results/stability/others.csv");
    let table = std::fs::read_to_string(table).expect("the committed atlas");
    let mut seen = 0;
    for difficulty in difficulties::all().expect("runs").iter().step_by(6) {
        let truth = truth(difficulty).expect("runs");
        for other in OTHERS.iter().filter(|other| !other.name.starts_with("CVODE")) {
            let start = format!(",{},{},", difficulty.case.name.replace(',', ";"), other.name);
            let line = table.lines().find(|line| line.contains(&start)).expect("a cell");
            let found = cell(other, &difficulty.case, &truth, None);
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields[3], found.verdict.name(), "{start}");
            assert_eq!(fields[7], found.evaluations.to_string(), "{start}");
            seen += 1;
        }
    }
    assert!(seen == 30, "{seen}");
}
