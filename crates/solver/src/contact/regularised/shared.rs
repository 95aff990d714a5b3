//! What is computed of a piece once for all its observers, which halve it at the same places.

use crate::motion::knot::Knot;
use retune_model::{Change, Growth, ORDERS};
use std::cell::RefCell;

/// What has been computed of the piece that is observed: a moment inside it costs a step, a bound as much or a part of it.
#[derive(Default)]
pub struct Shared {
    /// Moments by θ.
    pub moments: Kept<f64, Knot<4>>,
    /// Bounds of [`RegularisedContact::growth`](retune_model::RegularisedContact::growth), and those with the rates.
    pub growths: [Kept<Between, [Growth<ORDERS>; 2]>; 2],
    /// Those of [`RegularisedContact::change`](retune_model::RegularisedContact::change).
    pub changes: Kept<Between, Option<Change>>,
}

impl Shared {
    /// Begins a piece.
    pub fn clear(&self) {
        self.moments.clear();
        self.growths.iter().for_each(Kept::clear);
        self.changes.clear();
    }
}

/// All that bounds between two places of a piece depend on.
pub type Between = ([f64; 5], [[f64; 4]; 2]);

/// The same of two places `h` apart.
pub fn between([from, to]: [&Knot<4>; 2], h: f64) -> Between {
    ([from.t, h, to.t, from.clock[0], to.clock[0]], [from.y, to.y])
}

/// Values of a function by its arguments.
pub struct Kept<A, V>(RefCell<Vec<(A, V)>>);

impl<A, V> Default for Kept<A, V> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<A: PartialEq, V: Copy> Kept<A, V> {
    /// A search halves a piece some 64 times. To look through more would take as long as to compute anew.
    const MOST: usize = 128;

    /// The value for these arguments, which is computed if it is not there.
    pub fn of(&self, arguments: A, compute: impl FnOnce() -> V) -> V {
        let mut all = self.0.borrow_mut();
        if let Some((_, value)) = all.iter().find(|(of, _)| *of == arguments) {
            return *value;
        }
        let value = compute();
        if all.len() < Self::MOST {
            all.push((arguments, value));
        }
        value
    }

    fn clear(&self) {
        self.0.borrow_mut().clear();
    }
}

/// The value for these arguments, from what is kept, if anything is.
#[inline]
pub fn once<A: PartialEq, V: Copy>(
    kept: Option<&Kept<A, V>>,
    arguments: A,
    compute: impl FnOnce() -> V,
) -> V {
    match kept {
        Some(kept) => kept.of(arguments, compute),
        None => compute(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// What is kept is a function's value: computed once for its arguments, anew for others and in the next piece.
    #[test]
    fn contract_a_bound_is_computed_once_for_all_observers_of_a_piece() {
        let (shared, computed) = (Shared::default(), Cell::new(0));
        let at =
            |t: f64, x1: f64| Knot { t, excitation: [0.0; 2], y: [x1, 0.0, 0.0, 0.0], clock: [1.0, 0.0] };
        let change = |ends: [&Knot<4>; 2], h: f64| {
            let compute = || {
                computed.set(computed.get() + 1);
                None
            };
            assert!(shared.changes.of(between(ends, h), compute).is_none());
        };
        let (begin, end, another) = (at(1.0, 0.1), at(2.0, 0.2), at(2.0, 0.3));
        for _ in 0..3 {
            change([&begin, &end], 1.0);
        }
        assert_eq!(computed.get(), 1);
        change([&begin, &end], 2.0);
        change([&begin, &another], 1.0);
        assert_eq!(computed.get(), 3);
        shared.clear();
        change([&begin, &end], 1.0);
        assert_eq!(computed.get(), 4);
        // Those beyond the room for them are computed each time.
        let many = || (0..1000).for_each(|i| change([&begin, &end], 3.0 + f64::from(i)));
        many();
        let first = computed.get();
        many();
        assert_eq!(
            (first, computed.get()),
            (1004, 2004 - (Kept::<Between, Option<Change>>::MOST as i32 - 1))
        );
    }
}
