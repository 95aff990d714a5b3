//! Any valid parameters through every kind of run: a finite answer or a typed error, within the work allowed.
#![no_main]

use libfuzzer_sys::fuzz_target;
use retune_testkit::anything::Anything;

fuzz_target!(|bytes: &[u8]| Anything::of_bytes(bytes).check());
