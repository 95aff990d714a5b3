//! The pieces of an equidistant record as steps of the flow.

use super::flow::{BentStride, Flow, Stride};
use super::steps::StepClock;
use crate::motion::lanes::LANES;
use retune_model::EvenForce;
use wide::f64x4;

/// The samples of a record, if a flow may take its steps from one to the next: no step of its own is shorter.
pub fn in_steps(force: Option<EvenForce>, step: f64) -> Option<EvenForce> {
    force.filter(|force| force.even[1] == step)
}

/// From sample `i` on the next four pieces that end by the time `to`, as steps from a moment.
#[inline(always)]
pub fn forces(force: &EvenForce, i: usize, to: f64) -> Option<[f64; LANES + 1]> {
    force.forces(i).filter(|_| force.time(i + LANES) <= to)
}

/// The clock of a record at sample `i`.
pub fn clock(force: &EvenForce, i: usize) -> StepClock {
    let [first, step] = force.even;
    let mut clock = StepClock::new(first, step);
    clock.count(i);
    clock
}

/// Strides in a [`Block`].
const STRIDES: usize = 4;

/// Pieces in a [`Block`].
pub const PIECES: usize = STRIDES * LANES;

/// Many pieces of a record in a row, of which nothing is computed but the states at their ends: most of a flight is far from every wall and from
/// every record, which values at the samples and a bound on second derivatives between them prove.
pub struct Block<const N: usize> {
    /// The first moment: time, s; the force and its partner, and the state.
    pub t: f64,
    pub force: [f64; 2],
    pub from: [f64; N],
    /// The moments at which the pieces end.
    pub ends: [Stride<N>; STRIDES],
    /// The time at which the last one ends, s.
    pub end: f64,
    /// Length of a piece, s.
    pub length: f64,
    /// A bound on the energy norm of the motion, √J.
    pub energy: f64,
}

impl<const N: usize> Block<N> {
    /// The pieces from sample `i` on, if they end by the time `to`; `energy` bounds the energy norm in them.
    #[inline(always)]
    pub fn new(
        flow: &Flow<N>,
        force: &EvenForce,
        i: usize,
        to: f64,
        from: &[f64; N],
        energy: f64,
    ) -> Option<Self> {
        let end = force.time(i + PIECES);
        let all = force.forces::<{ PIECES + 1 }>(i).filter(|_| end <= to)?;
        let mut y = *from;
        let ends = std::array::from_fn(|number| {
            let forces = std::array::from_fn(|k| all[number * LANES + k]);
            let BentStride { stride, .. } = flow.bent_stride(&forces, &y);
            y = stride.y.map(|component| component.to_array()[LANES - 1]);
            stride
        });
        Some(Self {
            t: force.time(i),
            force: [all[0], 0.0],
            from: *from,
            ends,
            end,
            length: flow.step(),
            energy,
        })
    }

    /// The state at its end.
    pub fn last(&self) -> [f64; N] {
        self.ends[STRIDES - 1].y.map(|component| component.to_array()[LANES - 1])
    }

    /// Bounds on a number in it, of which these are the values at moments side by side, and a bound on its second derivative within a piece: a
    /// line between two values leaves it by at most an eighth of that times `h²`.
    #[inline(always)]
    pub fn range(&self, value: impl Fn(&[f64x4; 2], &[f64x4; N]) -> f64x4, second: f64) -> [f64; 2] {
        let first = value(&self.force.map(f64x4::splat), &self.from.map(f64x4::splat));
        let (mut least, mut most) = (first, first);
        for Stride { excitation, y } in &self.ends {
            let value = value(excitation, y);
            (least, most) = (least.fast_min(value), most.fast_max(value));
        }
        let off = 0.125 * self.length * self.length * second;
        let least = least.to_array().into_iter().fold(f64::INFINITY, f64::min);
        let most = most.to_array().into_iter().fold(f64::NEG_INFINITY, f64::max);
        [least - off, most + off]
    }
}
