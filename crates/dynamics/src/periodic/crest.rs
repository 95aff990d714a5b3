//! The largest value of a quantity on branches that are followed for it alone: by searches, which ask for it at one design after another.

use super::look::Reached;
use super::orbit::Orbit;
use super::seen::Seen;
use super::shooting::{Shooting, Solution};
use super::trace::{Branch, trace_while};
use std::cell::Cell;

/// Motions that are looked at for the largest value have this share of the largest that is known.
pub(super) const COUNTS: f64 = 0.8;
/// A crest ends where the quantity is below this share of its largest value.
const DOWN: f64 = 0.995;

/// The part of the branch of a motion that leads up to the largest value of a quantity among stable motions, and a little beyond.
pub(super) fn crest(
    shooting: &Shooting,
    seed: &Solution,
    range: [f64; 2],
    quantity: fn(&Seen) -> f64,
) -> Option<Branch> {
    let most = Cell::new(0.0);
    let goes_on = |orbit: &Orbit| {
        let value = quantity(&orbit.seen);
        most.set(f64::max(most.get(), value));
        orbit.is_stable() && value >= DOWN * most.get()
    };
    trace_while(shooting, seed, range, &goes_on)
}

/// Keeps of samples in a row those at which runs reach as much as at both beside them; gives the largest value of all.
pub(super) fn keep_crests(seen: &mut Vec<Reached>, quantity: fn(&Seen) -> f64) -> f64 {
    let reached: Vec<f64> = seen.iter().map(|seen| seen.most(quantity)).collect();
    let at = |i: usize| reached.get(i).copied().unwrap_or(0.0);
    let mut places = 0..;
    seen.retain(|_| places.next().is_some_and(|i| at(i) >= at(i.wrapping_sub(1)) && at(i) >= at(i + 1)));
    reached.iter().copied().fold(0.0, f64::max)
}
