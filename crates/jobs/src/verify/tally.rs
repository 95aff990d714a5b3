//! Differences between numbers, counted.

/// The differences between the numbers of a file and those computed again.
#[derive(Default)]
pub struct Tally {
    pub differ: usize,
    pub most: f64,
}

impl Tally {
    /// Compares two numbers; two that are not finite are the same: no value.
    pub fn see(&mut self, said: f64, found: f64) {
        let none = |value: f64| !value.is_finite();
        if said.to_bits() != found.to_bits() && !(none(said) && none(found)) {
            let difference = (said - found).abs() / said.abs().max(found.abs());
            self.differs(if difference.is_finite() { difference } else { f64::INFINITY });
        }
    }

    pub fn differs(&mut self, by: f64) {
        self.differ += 1;
        self.most = self.most.max(by);
    }
}
