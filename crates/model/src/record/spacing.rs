//! Whether times are equidistant.

/// Relative tolerance for the distances of equidistant samples: room for times rounded to decimals.
const EVEN: f64 = 1e-9;

/// Tests one by one whether times are equidistant, so that a file of such samples is read without storing their times.
#[derive(Clone, Copy, Debug)]
pub struct Spacing {
    count: usize,
    first: f64,
    last: f64,
    /// The distances that fit all times so far.
    range: [f64; 2],
}

impl Default for Spacing {
    fn default() -> Self {
        Self { count: 0, first: 0.0, last: f64::NEG_INFINITY, range: [0.0, f64::INFINITY] }
    }
}

impl Spacing {
    /// Adds the next time, s. Returns whether some distance still fits all, each to [`EVEN`] of it and to the rounding of the time.
    pub fn push(&mut self, t: f64) -> bool {
        if self.count == 0 {
            self.first = t;
        }
        let (i, since, rounding) = (self.count as f64, t - self.first, f64::EPSILON * t);
        let [least, most] = self.range;
        self.range = [
            least.max((since - rounding) / (i + EVEN)),
            if i > 0.0 { most.min((since + rounding) / (i - EVEN)) } else { most },
        ];
        let is_later = t > self.last && t.is_finite() && self.first >= 0.0;
        (self.count, self.last) = (self.count + 1, t);
        is_later && self.range[0] <= self.range[1]
    }

    /// The first time and the distance, s, of all times, if [`Self::push`] was true of each.
    pub fn even(&self) -> Option<[f64; 2]> {
        let step = (self.last - self.first) / (self.count as f64 - 1.0);
        let fits = self.count > 1 && self.range[0] <= step && step <= self.range[1];
        fits.then_some([self.first, step])
    }
}
