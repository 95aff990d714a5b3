//! Problems with known answers, and the tools that give the answers, for the tests of this crate.

pub mod linear;
pub mod smooth;
pub mod trees;

use retune_model::Side;
use retune_solver::observe::{Knot, Observer, Quantity, Segment};

/// Looks at every moment that a method hands over, and at two between, and counts touch-downs.
pub struct Watch<F> {
    look: F,
    pub touches: [u64; 2],
}

impl<F: FnMut(&Knot<4>)> Watch<F> {
    pub fn new(look: F) -> Self {
        Self { look, touches: [0; 2] }
    }
}

impl<F: FnMut(&Knot<4>)> Observer<4> for Watch<F> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [a, b] = segment.ends();
        (self.look)(a);
        (self.look)(&segment.at(0.3 * segment.length()));
        (self.look)(&segment.at_time(a.t + 0.7 * (b.t - a.t)));
        (self.look)(b);
    }
    fn touch_down(&mut self, _t: f64, side: Side) {
        self.touches[side as usize] += 1;
    }
}

/// Asserts that two numbers differ by at most `tolerance` times `size`.
#[track_caller]
pub fn assert_close(found: f64, expected: f64, size: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= tolerance * size, "{what}: {found} {expected}, error {:e}", error / size);
}

/// Asserts that two states agree to `tolerance`, positions against `x` (m), velocities against `v` (m/s).
#[track_caller]
pub fn assert_states(found: [f64; 4], expected: [f64; 4], [x, v]: [f64; 2], tolerance: f64, what: &str) {
    for (i, size) in [x, v, x, v].into_iter().enumerate() {
        assert_close(found[i], expected[i], size, tolerance, &format!("{what}, component {i}"));
    }
}

/// Value, slope and curvature with respect to `θ`.
pub fn rates(quantity: &impl Quantity<4>, knot: &Knot<4>, in_flight: bool) -> [f64; 3] {
    let [value, slope, curvature] = knot.rates(quantity, in_flight);
    let [rate, bend] = knot.clock;
    [value, slope * rate, curvature * rate * rate + slope * bend]
}

/// The quintic through value, slope and curvature at the ends of a stretch of length `h`, at a share `s` of it.
pub fn quintic(h: f64, a: [f64; 3], b: [f64; 3], s: f64) -> f64 {
    let c = [
        a[0],
        a[0] + h * a[1] / 5.0,
        a[0] + 2.0 * h * a[1] / 5.0 + h * h * a[2] / 20.0,
        b[0] - 2.0 * h * b[1] / 5.0 + h * h * b[2] / 20.0,
        b[0] - h * b[1] / 5.0,
        b[0],
    ];
    let binomial = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    (0..6).map(|i| binomial[i] * c[i] * s.powi(i as i32) * (1.0 - s).powi(5 - i as i32)).sum()
}
