//! Any bytes as a study file: a checked study that means the same when it is written out and read again, or one sentence.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| retune_study::any_text::check(bytes));
