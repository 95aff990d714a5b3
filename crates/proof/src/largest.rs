//! The largest values of a motion over its whole period.

use crate::equations::{Mode, Push, product};
use crate::number::STATE;
use crate::range::Range;
use crate::segment::Passage;
use crate::step::Quantity;
use crate::{Equations, Interval, Number};
use retune_model::Measure;
use serde::Serialize;

/// Largest values.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Largest {
    /// E1max, J.
    #[serde(rename = "E1max")]
    pub energy: Interval,
    /// Largest stretch of the damper's spring, m.
    pub stroke: Interval,
    /// Largest contact force, N.
    pub contact_force: Interval,
}

impl Largest {
    /// Each value with its measure.
    pub fn all(&self) -> [(Measure, Interval); 3] {
        [
            (Measure::Energy, self.energy),
            (Measure::Stroke, self.stroke),
            (Measure::ContactForce, self.contact_force),
        ]
    }
}

/// The largest values over all segments of a motion.
pub fn largest(equations: &Equations, passages: &[Passage]) -> Largest {
    let over = |of: Of| over(passages, &(equations, of));
    Largest {
        energy: over(Of::Energy),
        stroke: over(Of::Stretch(1.0)).max(over(Of::Stretch(-1.0))),
        contact_force: over(Of::Force),
    }
}

/// The largest value of a non-negative quantity.
fn over(passages: &[Passage], value: &(&Equations, Of)) -> Interval {
    let mut most = Interval::ZERO;
    for Passage { pieces, near, delay, .. } in passages {
        for (k, piece) in pieces.iter().enumerate() {
            let is_last = k + 1 == pieces.len();
            // The segment may end before the last piece does; it may also end after it.
            let sure = if is_last { (Interval::ONE + *delay).lo().min(1.0) } else { 1.0 };
            Range::new(piece.series_of(value)).raise(&mut most, sure);
            if is_last && let Some(&value) = value.series(piece.mode, &[*near]).first() {
                most = most.max(Interval::new(most.lo(), value.hull().hi().max(most.lo())));
            }
        }
    }
    most
}

/// The quantity that is maximised.
#[derive(Clone, Copy, Debug)]
enum Of {
    Energy,
    /// The stretch of the spring, times a sign.
    Stretch(f64),
    Force,
}

impl Quantity for (&Equations, Of) {
    fn series<T: Number>(&self, mode: Mode, motion: &[[T; STATE]]) -> Vec<T> {
        let (equations, of) = self;
        let square = |k: usize, i: usize| product(k, |n| motion[n][i], |n| motion[n][i]);
        match (of, mode) {
            // (m1 v1² + k1 x1²)/2.
            (Of::Energy, _) => {
                let [m, _, k] = equations.primary.map(|x| Interval::point(0.5) * x);
                (0..motion.len()).map(|n| square(n, 3).times(m) + square(n, 2).times(k)).collect()
            }
            // r - D; in a contact r is the wall's position and z = q² beyond it.
            (Of::Stretch(sign), _) => {
                let (mut series, from): (Vec<T>, _) = match mode {
                    Mode::Flight => (motion.iter().map(|c| c[0]).collect(), Interval::ZERO),
                    Mode::Contact(side) => {
                        let sign = Interval::point(side.sign());
                        let depth = (0..motion.len()).map(|k| square(k, 0).times(sign)).collect();
                        (depth, equations.walls[side as usize])
                    }
                };
                series[0] = series[0] + T::constant(from - equations.rest);
                series.into_iter().map(|c| c.times(Interval::point(*sign))).collect()
            }
            // K q³ times the factor of a loss.
            (Of::Force, Mode::Contact(side)) => {
                let mut push = Push::new(equations, side);
                (0..motion.len()).for_each(|_| push.extend(motion));
                push.force
            }
            // None.
            (Of::Force, Mode::Flight) => vec![T::constant(Interval::ZERO); motion.len()],
        }
    }
}
