//! The worst over a band against a search that shares nothing with it.

use retune_testkit::hunt::bands::{bands, largest_difference};
use retune_testkit::scenes::{Numbers, TMD};

#[test]
fn reference_no_damper_is_worse_than_its_worst() {
    bands(600).passes();
}

/// Was too low 11 times: the peak is narrow, and the band ends on the natural frequency of the damper.
#[test]
fn reference_a_band_that_ends_on_a_narrow_peak() {
    let numbers = Numbers { c1: 1.4869, k1: 66386.418, m2: 126.0215, k2: 14.2199, c2: 0.0, ..TMD };
    for to in [0.3359123, 0.335_912_3 * (1.0 + 1e-9), 0.336] {
        let off = largest_difference(&numbers, [0.1, to]);
        assert!(off < 1e-9, "{to}: {off:e}");
    }
}
