//! A cache of what is computed of a piece for all its observers, which halve it at the same places.

use crate::motion::knot::Knot;
use retune_model::{Change, Growth, ORDERS};
use std::cell::RefCell;

/// Results for the piece that is observed: a moment inside it costs a step, a bound at most as much.
#[derive(Default)]
pub struct Shared {
    /// Moments by θ.
    pub moments: Cache<f64, Knot<4>>,
    /// Bounds of [`RegularisedContact::growth`](retune_model::RegularisedContact::growth), and those with the rates.
    pub growths: [Cache<IntervalKey, [Growth<ORDERS>; 2]>; 2],
    /// Bounds of [`RegularisedContact::change`](retune_model::RegularisedContact::change).
    pub changes: Cache<IntervalKey, Option<Change>>,
}

impl Shared {
    /// Clears the cache for the next piece.
    pub fn clear(&self) {
        self.moments.clear();
        self.growths.iter().for_each(Cache::clear);
        self.changes.clear();
    }
}

/// The cache key of bounds between two places of a piece: all that they depend on.
pub type IntervalKey = ([f64; 5], [[f64; 4]; 2]);

/// The cache key of two places `h` apart.
pub fn interval_key([from, to]: [&Knot<4>; 2], h: f64) -> IntervalKey {
    ([from.t, h, to.t, from.clock[0], to.clock[0]], [from.y, to.y])
}

/// A cache of a function's values by its arguments.
pub struct Cache<A, V>(RefCell<Vec<(A, V)>>);

impl<A, V> Default for Cache<A, V> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<A: PartialEq, V: Copy> Cache<A, V> {
    /// A search halves a piece some 64 times. Searching more entries would take as long as recomputing.
    const CAPACITY: usize = 128;

    /// The value for these arguments, computed if it is not cached.
    pub fn get_or_compute(&self, arguments: A, compute: impl FnOnce() -> V) -> V {
        let mut all = self.0.borrow_mut();
        if let Some((_, value)) = all.iter().find(|(of, _)| *of == arguments) {
            return *value;
        }
        let value = compute();
        if all.len() < Self::CAPACITY {
            all.push((arguments, value));
        }
        value
    }

    fn clear(&self) {
        self.0.borrow_mut().clear();
    }
}

/// The value for these arguments, from the cache if there is one.
#[inline]
pub fn cached<A: PartialEq, V: Copy>(
    cache: Option<&Cache<A, V>>,
    arguments: A,
    compute: impl FnOnce() -> V,
) -> V {
    match cache {
        Some(cache) => cache.get_or_compute(arguments, compute),
        None => compute(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// A value is computed once for its arguments, and again for others and in the next piece.
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
            assert!(shared.changes.get_or_compute(interval_key(ends, h), compute).is_none());
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
        // Values beyond the capacity are computed each time.
        let many = || (0..1000).for_each(|i| change([&begin, &end], 3.0 + f64::from(i)));
        many();
        let first = computed.get();
        many();
        assert_eq!(
            (first, computed.get()),
            (1004, 2004 - (Cache::<IntervalKey, Option<Change>>::CAPACITY as i32 - 1))
        );
    }
}
