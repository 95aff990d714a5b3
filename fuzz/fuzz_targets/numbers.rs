//! Any valid parameters through every kind of run: a finite answer or a typed error, within the work allowed.
#![no_main]

#[path = "../../crates/solver/tests/anything/mod.rs"]
mod anything;

use anything::{Anything, DRAWS};
use libfuzzer_sys::fuzz_target;

// Two bytes a number: finer than any threshold that a scene has. Missing bytes are the middle, the paper's value.
fuzz_target!(|bytes: &[u8]| {
    let mut draws = [0.5; DRAWS];
    for (draw, pair) in draws.iter_mut().zip(bytes.chunks_exact(2)) {
        *draw = f64::from(u16::from_le_bytes([pair[0], pair[1]])) / f64::from(u16::MAX);
    }
    Anything::new(&draws).check();
});
