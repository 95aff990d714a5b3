//! Any bytes as a study file: a checked study or one sentence, and what is accepted means the same when written out and read
//! again.
#![no_main]

#[path = "../../crates/retune/src"]
#[allow(dead_code, unused_imports, reason = "the program uses the rest")]
mod program {
    pub mod study;
}

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| program::study::any_text::check(bytes));
