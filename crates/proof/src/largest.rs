//! The largest values of a motion over its whole period.

use crate::Interval;
use crate::equations::{Equations, Mode, Push, product};
use crate::number::{Number, STATE};
use crate::range::Range;
use crate::segment::Passage;
use crate::step::Quantity;
use retune_model::Measure;
use serde::{Serialize, Serializer};

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
    let over = |of: Of| {
        let mut most = Interval::ZERO;
        for passage in passages {
            over_passage(passage, &Value { equations, of }, &mut most);
        }
        most
    };
    Largest {
        energy: over(Of::Energy),
        stroke: over(Of::Stretch(1.0)).max(over(Of::Stretch(-1.0))),
        contact_force: over(Of::Force),
    }
}

/// Raises the largest value so far to that over a segment. Quantities that a mode does not have are zero in it.
fn over_passage(passage: &Passage, value: &Value<'_>, most: &mut Interval) {
    for (k, piece) in passage.pieces.iter().enumerate() {
        if value.of == Of::Force && piece.mode == Mode::Flight {
            return;
        }
        let is_last = k + 1 == passage.pieces.len();
        // The segment may end before the last piece does; it may also end after it.
        let sure = if is_last { (Interval::ONE + passage.delay).lo().min(1.0) } else { 1.0 };
        Range::new(piece.series_of(value)).raise(most, sure);
        if is_last && let Some(&value) = value.series(piece.mode, &[passage.near]).first() {
            *most = most.max(Interval::new(most.lo(), value.hull().hi().max(most.lo())));
        }
    }
}

/// What is largest.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Energy,
    /// Times a sign.
    Stretch(f64),
    Force,
}

/// A quantity of a scene.
struct Value<'a> {
    equations: &'a Equations,
    of: Of,
}

impl Quantity for Value<'_> {
    fn series<T: Number>(&self, mode: Mode, motion: &[[T; STATE]]) -> Vec<T> {
        match self.of {
            Of::Energy => energy(self.equations, motion),
            Of::Stretch(sign) => {
                let stretch = stretch(self.equations, mode, motion);
                stretch.into_iter().map(|c| c.times(Interval::point(sign))).collect()
            }
            Of::Force => force(self.equations, mode, motion),
        }
    }
}

fn square<T: Number>(motion: &[[T; STATE]], k: usize, i: usize) -> T {
    product(k, |n| motion[n][i], |n| motion[n][i])
}

/// `E1 = (m1 v1² + k1 x1²)/2`.
fn energy<T: Number>(equations: &Equations, motion: &[[T; STATE]]) -> Vec<T> {
    let half = Interval::point(0.5);
    let at = |k: usize| {
        square(motion, k, 3).times(half * equations.m1) + square(motion, k, 2).times(half * equations.k1)
    };
    (0..motion.len()).map(at).collect()
}

/// `r - D`; in a contact `r` is the wall's position and `z = q²` beyond it.
fn stretch<T: Number>(equations: &Equations, mode: Mode, motion: &[[T; STATE]]) -> Vec<T> {
    let (mut series, from): (Vec<T>, _) = match mode {
        Mode::Flight => (motion.iter().map(|c| c[0]).collect(), Interval::ZERO),
        Mode::Contact(side) => {
            let sign = Interval::point(side.sign());
            let depth = (0..motion.len()).map(|k| square(motion, k, 0).times(sign)).collect();
            (depth, equations.walls[side as usize])
        }
    };
    series[0] = series[0] + T::constant(from - equations.rest);
    series
}

/// `K q³` times the factor of a loss; zero in flight.
fn force<T: Number>(equations: &Equations, mode: Mode, motion: &[[T; STATE]]) -> Vec<T> {
    let Mode::Contact(side) = mode else { return vec![T::constant(Interval::ZERO); motion.len()] };
    let mut force = Push::new(equations, side);
    (0..motion.len()).for_each(|_| force.extend(motion));
    force.force
}
