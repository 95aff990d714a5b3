//! Any valid parameters through every kind of run: a finite answer or a typed error, within the work allowed.
#![no_main]

#[path = "../../crates/solver/tests/anything/mod.rs"]
mod anything;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| anything::Anything::of_bytes(bytes).check());
