//! The search of the peaks of a band between its samples, beside many more samples.

use retune_testkit::hunt::peaks::peaks;

#[test]
fn reference_peaks_beside_fine_samples() {
    peaks(20).passes();
}
