//! Decides whether two stretches of motion belong to one motion or to two, in order to count coexisting motions.
//!
//! A motion is represented by the set of its stroboscopic states, in the coordinates of [`crate::record::coordinates`]. The
//! *separation* of two sets is the mean distance from a state of one to the nearest state of the other, the larger of the two
//! directions (an averaged Hausdorff distance). Order and phase do not matter: a period-3 motion shifted by one period is the same
//! motion.

use crate::record::{distance, size};
use crate::regime::ARRIVED;

/// Motions nearer than this share of their size are one motion: the limit at which a transient has ended
/// ([`crate::regime::ARRIVED`]).
pub const APART: f64 = ARRIVED;
/// ... and so are those whose separation is less than this many times the separation of the two halves of either stretch: a chaotic
/// motion never repeats exactly, and a motion that still drifts has not reached its attractor. The halves of a stretch are sparser
/// than the stretches, so halves of one motion lie further apart than whole stretches of it; a factor 2 covers the drift, and 3
/// leaves a margin for scatter. In doubt the two stretches count as one motion.
pub const BEYOND: f64 = 3.0;

/// Whether two stretches of stroboscopic states (√J), each of two states or more, belong to different motions.
pub fn distinct(a: &[[f64; 4]], b: &[[f64; 4]]) -> bool {
    let within = drift(a).max(drift(b));
    separation(a, b) > (APART * size(a).max(size(b))).max(BEYOND * within)
}

/// For each stretch, the index of the first stretch with the same motion: `[0, 0, 2]` are two motions.
pub fn motions(stretches: &[&[[f64; 4]]]) -> Vec<usize> {
    let mut first: Vec<usize> = Vec::with_capacity(stretches.len());
    for (i, stretch) in stretches.iter().enumerate() {
        let same = (0..i).find(|&j| first[j] == j && !distinct(stretches[j], stretch));
        first.push(same.unwrap_or(i));
    }
    first
}

/// The larger of the mean distances from one set to the other, √J.
pub fn separation(a: &[[f64; 4]], b: &[[f64; 4]]) -> f64 {
    let to = |from: &[[f64; 4]], set: &[[f64; 4]]| {
        let nearest = |y: &[f64; 4]| set.iter().map(|z| distance(y, z)).fold(f64::INFINITY, f64::min);
        from.iter().map(nearest).sum::<f64>() / from.len().max(1) as f64
    };
    to(a, b).max(to(b, a))
}

/// Separation of the two halves of a stretch.
fn drift(stretch: &[[f64; 4]]) -> f64 {
    let (before, after) = stretch.split_at(stretch.len() / 2);
    separation(before, after)
}
