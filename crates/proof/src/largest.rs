//! The largest values of a motion over its whole period.

use crate::Interval;
use crate::equations::{Equations, Mode, product};
use crate::number::State;
use crate::range::Range;
use crate::segment::Passage;
use crate::step::Piece;
use retune_model::Measure;
use serde::{Serialize, Serializer};

/// The series of a quantity from that of a motion; none where the mode has no such quantity.
type Quantity<'a> = &'a dyn Fn(Mode, &[State]) -> Option<Vec<Interval>>;

/// Largest values.
#[derive(Clone, Copy, Debug)]
pub struct Largest {
    /// E1max, J.
    pub energy: Interval,
    /// Largest stretch of the damper's spring, m.
    pub stroke: Interval,
    /// Largest contact force, N.
    pub contact_force: Interval,
}

impl Largest {
    /// Each with its quantity.
    pub fn all(&self) -> [(Measure, Interval); 3] {
        [
            (Measure::Energy, self.energy),
            (Measure::Stroke, self.stroke),
            (Measure::ContactForce, self.contact_force),
        ]
    }
}

impl Serialize for Largest {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.all().map(|(measure, value)| (measure.name(), value)))
    }
}

/// The largest values over all segments of a motion.
pub fn largest(equations: &Equations, passages: &[Passage]) -> Largest {
    let over = |of: Quantity<'_>| {
        let mut most = Interval::ZERO;
        for passage in passages {
            over_passage(passage, of, &mut most);
        }
        most
    };
    let [stretch, compression] = [1.0, -1.0].map(|sign| {
        over(&|mode, motion| {
            let sign = Interval::point(sign);
            Some(stretch(equations, mode, motion).into_iter().map(|c| sign * c).collect())
        })
    });
    Largest {
        energy: over(&|_, motion| Some(energy(equations, motion))),
        stroke: stretch.max(compression),
        contact_force: over(&|mode, motion| force(equations, mode, motion)),
    }
}

/// Raises the largest value so far to that over a segment. Quantities that a mode does not have are zero in it.
fn over_passage(passage: &Passage, of: Quantity<'_>, most: &mut Interval) {
    for (k, piece) in passage.pieces.iter().enumerate() {
        let Piece { mode, h, .. } = *piece;
        let is_last = k + 1 == passage.pieces.len();
        if of(mode, &piece.at_start).is_none() {
            return;
        }
        let series = piece.series_of(|motion| of(mode, motion).unwrap_or_default());
        // The segment may end before the last piece does; it may also end after it.
        let sure = if is_last { h + passage.delay.lo().min(0.0) } else { h };
        Range::new(series, h).raise(most, sure.next_down());
        if is_last && let Some(&[value]) = of(mode, &[passage.near]).as_deref() {
            *most = most.max(Interval::new(most.lo(), value.hi().max(most.lo())));
        }
    }
}

fn square(motion: &[State], k: usize, i: usize) -> Interval {
    product(k, Interval::ZERO, |n| motion[n][i], |n| motion[n][i])
}

/// `E1 = (m1 v1² + k1 x1²)/2`.
fn energy(equations: &Equations, motion: &[State]) -> Vec<Interval> {
    let half = Interval::point(0.5);
    let at = |k: usize| half * (equations.m1 * square(motion, k, 3) + equations.k1 * square(motion, k, 2));
    (0..motion.len()).map(at).collect()
}

/// `r - D`; in a contact `r` is the wall's position and `z = q²` beyond it.
fn stretch(equations: &Equations, mode: Mode, motion: &[State]) -> Vec<Interval> {
    let mut series: Vec<Interval> = match mode {
        Mode::Flight => motion.iter().map(|c| c[0]).collect(),
        Mode::Contact(side) => {
            let sign = Interval::point(side.sign());
            (0..motion.len()).map(|k| sign * square(motion, k, 0)).collect()
        }
    };
    let from = match mode {
        Mode::Flight => Interval::ZERO,
        Mode::Contact(side) => equations.wall(side).unwrap_or(Interval::ENTIRE),
    };
    series[0] = series[0] + from - equations.rest;
    series
}

/// `K q³`; none in flight.
fn force(equations: &Equations, mode: Mode, motion: &[State]) -> Option<Vec<Interval>> {
    let Mode::Contact(side) = mode else { return None };
    let squares: Vec<Interval> = (0..motion.len()).map(|k| square(motion, k, 0)).collect();
    let cube = |k: usize| product(k, Interval::ZERO, |n| squares[n], |n| motion[n][0]);
    Some((0..motion.len()).map(|k| equations.hertz[side as usize] * cube(k)).collect())
}
