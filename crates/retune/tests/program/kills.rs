//! Runs that are killed at random moments end in the bytes of an unbroken one.

use retune_testkit::hunt::kills::kills;
use std::path::Path;

#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_killed_runs_end_in_the_bytes_of_an_unbroken_one() {
    kills(Path::new(env!("CARGO_BIN_EXE_retune")), 12).passes();
}
