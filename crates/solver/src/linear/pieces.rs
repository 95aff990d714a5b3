//! The pieces of a record as steps of the flow.

use super::flow::{Flow, FourPieces, Stride};
use super::uneven::Uneven;
use crate::motion::lanes::LANES;
use retune_model::SampledForce;
use wide::f64x4;

/// The longest step of a flow under a force with samples, if it may otherwise take steps of at most `longest` seconds.
pub fn longest_step(force: Option<SampledForce>, longest: f64) -> f64 {
    force.and_then(|force| force.even()).map_or(longest, |[_, step]| longest.min(step))
}

/// The samples of a record, between which a flow takes its steps.
pub struct Pieces<const N: usize> {
    force: SampledForce,
    lengths: Lengths<N>,
}

/// The durations of the pieces.
enum Lengths<const N: usize> {
    /// Each is a step of the flow; the first begins at this time, s.
    Step(f64),
    /// Any duration up to a step of the flow.
    Any(Box<Uneven<N>>),
}

impl<const N: usize> Pieces<N> {
    /// The pieces of a sampled force. `None` where equidistant samples are farther apart than a step of the flow.
    pub fn of(force: Option<SampledForce>, flow: &Flow<N>) -> Option<Self> {
        let force = force?;
        let lengths = match force.even() {
            Some([first, step]) => (flow.step() == step).then_some(Lengths::Step(first))?,
            None => Lengths::Any(Box::new(Uneven::of(flow))),
        };
        Some(Self { force, lengths })
    }

    /// The sample at exactly this time, s.
    pub fn at(&self, t: f64) -> Option<usize> {
        self.force.at(t)
    }

    /// The next four pieces from sample `i` and the state `y` there, if they end by the time `to` (s) and none is longer than a step of the
    /// flow.
    #[inline(always)]
    pub fn four(&self, flow: &Flow<N>, i: usize, to: f64, y: &[f64; N]) -> Option<FourPieces<N>> {
        match &self.lengths {
            Lengths::Step(first) => {
                let time = |count: usize| first + (i + count) as f64 * flow.step();
                let forces = self.force.forces(i).filter(|_| time(LANES) <= to)?;
                let (begin, ends) = flow.sampled_stride(&forces, y);
                let times = f64x4::from([time(1), time(2), time(3), time(4)]);
                Some(FourPieces { lengths: flow.step().into(), times, begin, ends })
            }
            Lengths::Any(uneven) => {
                let times = self.force.times(i).filter(|times| times[LANES] <= to)?;
                uneven.four(flow, &times, &self.force.forces(i)?, y)
            }
        }
    }
}

/// Strides in a [`Block`].
const STRIDES: usize = 4;

/// Pieces in a [`Block`].
pub const PIECES: usize = STRIDES * LANES;

/// A block of consecutive pieces of an equidistant record, of which only the states at their ends are computed: most of a flight is far
/// from every wall and from every running maximum, as values at the samples and a bound on second derivatives between them prove.
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
    /// The pieces from sample `i` on, if they are equidistant and end by the time `to`; `energy` bounds the energy norm in them.
    #[inline(always)]
    pub fn new(
        flow: &Flow<N>,
        pieces: &Pieces<N>,
        i: usize,
        to: f64,
        from: &[f64; N],
        energy: f64,
    ) -> Option<Self> {
        let Lengths::Step(first) = pieces.lengths else { return None };
        let time = |i: usize| first + i as f64 * flow.step();
        let end = time(i + PIECES);
        let all = pieces.force.forces::<{ PIECES + 1 }>(i).filter(|_| end <= to)?;
        let mut y = *from;
        let ends = std::array::from_fn(|number| {
            let forces = std::array::from_fn(|k| all[number * LANES + k]);
            let (_, stride) = flow.sampled_stride(&forces, &y);
            y = stride.y.map(|component| component.to_array()[LANES - 1]);
            stride
        });
        let (t, length) = (time(i), flow.step());
        Some(Self { t, force: [all[0], 0.0], from: *from, ends, end, length, energy })
    }

    /// The state at its end.
    pub fn last(&self) -> [f64; N] {
        self.ends[STRIDES - 1].y.map(|component| component.to_array()[LANES - 1])
    }

    /// A lower and an upper bound on a quantity in the block, from `value` at moments side by side and a bound on its second derivative
    /// within a piece: the chord between two values deviates from it by at most an eighth of that bound times `h²`.
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
