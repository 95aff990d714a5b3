//! How far a quantity leaves the quintic that meets it at two places of a flight, beside the bounds on it.

use crate::problems::{quintic, rates};
use retune_solver::observe::{DamperEnergy, Observer, PrimaryEnergy, Quantity, RelativePosition, Segment};
use retune_solver::{Hybrid, Motion, Phase};
use retune_testkit::scenes::{Numbers, SSVI, TWO_SIDED};

/// Looks at every piece of flight, and keeps the largest share of its sharp bound that an error reaches.
struct Errors<Q> {
    quantity: Q,
    reached: f64,
    pieces: u32,
}

impl<Q: Quantity<4>> Observer<4> for Errors<Q> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        // The bounds in contacts are tested beside their definition (`retune_model::RegularisedContact::growth`).
        if !segment.in_flight() {
            return;
        }
        for share in [1.0, 0.5, 0.125] {
            let h = share * segment.length();
            let (from, to) = (*segment.ends()[0], segment.at(h));
            let bound = |h: f64, sharp: bool| {
                segment.quintic_error(self.quantity.form(), [&from, &to], h, sharp).expect("known")
            };
            // A stretch half as long has a 64th.
            for sharp in [false, true] {
                let (whole, half) = (bound(h, sharp), bound(0.5 * h, sharp));
                assert!((64.0 * half - whole).abs() <= 1e-12 * whole, "{whole} {half}");
            }
            let (a, b) = (rates(&self.quantity, &from, true), rates(&self.quantity, &to, true));
            let size =
                a.iter().zip(&b).zip([1.0, h, h * h]).map(|((a, b), h)| (a.abs() + b.abs()) * h).sum::<f64>();
            let rounding = 1e-12 * (size + self.quantity.form().size(&from.y));
            for s in [0.3, 0.5, 0.7] {
                let value = rates(&self.quantity, &segment.at(s * h), true)[0];
                let error = ((value - quintic(h, a, b, s)).abs() - rounding).max(0.0);
                for sharp in [false, true] {
                    let bound = bound(h, sharp);
                    assert!(error <= bound * (1.0 + 1e-9), "{h} {s} {sharp}: {error} {bound}");
                    if sharp && bound > 0.0 {
                        self.reached = self.reached.max(error / bound);
                    }
                }
            }
        }
        self.pieces += 1;
    }
}

#[test]
fn invariant_no_quantity_leaves_its_quintic_by_more_than_its_bound() {
    let stiff = Numbers { k1: 6e4, k2: 2500.0, c2: 20.0, omega: 7.6, ..SSVI };
    for numbers in [SSVI, TWO_SIDED, stiff] {
        let system = numbers.coupled();
        fn check<Q: Quantity<4>>(numbers: &Numbers, quantity: Q) {
            let system = numbers.coupled();
            let mut errors = Errors { quantity, reached: 0.0, pieces: 0 };
            let mut hybrid = Hybrid::new(&system, 1e-9, 20.0, 1_000_000);
            let rest = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
            hybrid.propagate(rest, 20.0, &mut errors).expect("a run");
            assert!(errors.pieces > 100, "{}", errors.pieces);
            assert!(errors.reached > 0.5, "a bound that is never nearly reached: {}", errors.reached);
        }
        check(&numbers, PrimaryEnergy::new(&system));
        check(&numbers, DamperEnergy::new(&system));
        check(&numbers, RelativePosition::new(&system, -1.0));
    }
}
