//! The wrapped integrators of others find the motion: differences on the chart are theirs, not the wrapper's.
#![cfg(feature = "integrators")]

use retune_lab::peers::{PEERS, run};
use retune_lab::runs::{self, errors};
use retune_lab::scenes::cases;
use retune_solver::{Contacts, Method};

#[test]
fn reference_every_peer_finds_every_motion() {
    for case in cases() {
        let tight = runs::settings(Method::Hybrid, Contacts::Located, 1e-12);
        let reference = runs::run(&case, &tight, false).expect("runs");
        for peer in &PEERS {
            let level = 1e-7_f64.max(peer.tightest);
            let best = [true, false]
                .into_iter()
                .filter_map(|located| run(peer, &case, located, level).ok())
                .map(|found| errors(&found, &reference, case.omega())[0])
                .fold(f64::INFINITY, f64::min);
            assert!(best < 1e-3, "{} {} on {}: {best:e}", peer.program, peer.method, case.name);
        }
    }
}
