//! The flow over pieces of a record whose samples are not equidistant: each has its own duration.

use super::flow::{Expansion, Flow, FourPieces, Stride};
use crate::motion::lanes::LANES;
use crate::motion::polynomial::BLOCKS;
use wide::f64x4;

/// Limit on terms of a series, without the first.
const MOST: usize = 4 * BLOCKS - 1;

/// Limit on the first term that is left out, relative to the first of its series: its value over a whole step, `2 · 1.25¹⁸/20!`.
const LEFT_OUT: f64 = 5e-17;

/// The series of a flow, term by term: `Φ(h) - 1` and `Ψ(h)` of four lengths at once.
pub struct Uneven<const N: usize> {
    /// The contribution of each term but the first to each component, for each component of the state or of the force.
    free: [[[f64; N]; MOST]; N],
    forced: [[[f64; N]; MOST]; 2],
}

impl<const N: usize> Uneven<N> {
    pub fn of(flow: &Flow<N>) -> Self {
        let (free, forced) = flow.series();
        let terms =
            |of: &Expansion<N>| std::array::from_fn(|k| std::array::from_fn(|i| of.0[i].coefficient(k + 1)));
        Self { free: free.each_ref().map(terms), forced: forced.each_ref().map(terms) }
    }

    /// The pieces between five samples at these times (s) and with these forces (N), from the state `y` on; `None` if one takes longer than
    /// a step of the flow.
    #[inline(always)]
    pub fn four(
        &self,
        flow: &Flow<N>,
        &[t0, t1, t2, t3, t4]: &[f64; LANES + 1],
        &[f0, f1, f2, f3, f4]: &[f64; LANES + 1],
        y: &[f64; N],
    ) -> Option<FourPieces<N>> {
        let linear = flow.linear();
        let times = f64x4::from([t1, t2, t3, t4]);
        let lengths = times - f64x4::from([t0, t1, t2, t3]);
        let longest = lengths.to_array().into_iter().fold(0.0, f64::max);
        if longest > flow.step() {
            return None;
        }
        let count = terms(longest * linear.rate);
        let sum = |series: &[[f64; N]; MOST]| {
            series[..count].iter().rev().fold([f64x4::ZERO; N], |mut sum, term| {
                for i in 0..N {
                    sum[i] = (sum[i] + term[i]) * lengths;
                }
                sum
            })
        };
        let (f, g) = (f64x4::from([f0, f1, f2, f3]), f64x4::from([f1, f2, f3, f4]));
        let partner = (f - g) / (lengths * linear.frequency);
        let [value, slope] = self.forced.each_ref().map(sum);
        let forced: [_; N] = std::array::from_fn(|i| (value[i] * f + slope[i] * partner).to_array());
        let free = self.free.each_ref().map(|series| sum(series).map(f64x4::to_array));
        let (mut now, mut ends) = (*y, [f64x4::ZERO; N]);
        for lane in 0..LANES {
            let mut next = now;
            for i in 0..N {
                next[i] += forced[i][lane];
                for j in 0..N {
                    next[i] += free[j][i][lane] * (now[j] - linear.origin[j]);
                }
                ends[i].as_mut_array()[lane] = next[i];
            }
            now = next;
        }
        let ends = Stride { excitation: [g, partner], y: ends };
        Some(FourPieces { lengths, times, begin: [f, partner], ends })
    }
}

/// Number of terms of a series over `x`, the duration times the flow's fastest rate. The series of a force begins with `h`, that of its
/// partner with `h²/2`: relative to that, the term of order m is at most `2 x^(m-2)/m!`.
fn terms(x: f64) -> usize {
    let (mut order, mut next) = (2, x / 3.0);
    while next > LEFT_OUT && order < MOST {
        order += 1;
        next *= x / (order + 1) as f64;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::LinearSystem;
    use retune_model::{Coupled, Of, Samples};
    use retune_testkit::histories::record;
    use retune_testkit::scenes::{LOSSY, Numbers, SSVI, Spread, TMD};

    /// Against all terms of the series from one sample to the next: from pieces of a millionth of a step to whole ones.
    #[test]
    fn exact_four_pieces_at_once_are_four_steps_of_their_lengths() {
        let mut spread = Spread::new(3);
        let stiff = Numbers { k2: 1e6, c2: 1e4, ..TMD };
        for numbers in [SSVI, TMD, LOSSY, stiff] {
            let samples = Samples::every(0.0, 0.5, vec![1.0, 2.0]).expect("a record");
            let scene = numbers.under(record(Of::Force, samples));
            let system = Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"));
            let flow = Flow::<4>::new(system.linear(), f64::INFINITY);
            let uneven = Uneven::of(&flow);
            for size in [1.0, 0.3, 0.1, 1e-2, 1e-4, 1e-6] {
                let mut times = [0.0; LANES + 1];
                for i in 0..LANES {
                    times[i + 1] = times[i] + flow.step() * size * (0.7 + 0.29 * spread.signed());
                }
                let forces = std::array::from_fn(|_| 100.0 * spread.signed());
                let mut y = system.start().map(|at| at + 0.05 * spread.signed());
                let found = uneven.four(&flow, &times, &forces, &y).expect("no longer than a step");
                for lane in 0..LANES {
                    let h = times[lane + 1] - times[lane];
                    let partner = (forces[lane] - forces[lane + 1]) / (h * flow.linear().frequency);
                    y = flow.expand::<BLOCKS>([forces[lane], partner], &y).at(h);
                    // Displacements count as the velocities that they become.
                    let rates = [flow.linear().rate, 1.0, flow.linear().rate, 1.0];
                    let largest = (0..4).fold(0.0_f64, |most, i| most.max((rates[i] * y[i]).abs()));
                    for i in 0..4 {
                        let off = rates[i] * (found.ends.y[i].to_array()[lane] - y[i]).abs();
                        assert!(
                            off <= 2e-15 * largest,
                            "{size} {lane} {i}: {off:e} of {largest} {numbers:?}"
                        );
                    }
                }
            }
            let long = [0.0, 1.0, 2.0, 3.01, 4.0].map(|t| t * flow.step());
            assert!(uneven.four(&flow, &long, &[1.0; LANES + 1], &[0.0; 4]).is_none());
        }
    }

    /// As many terms as over a whole step where a piece takes one, and none that could be missed.
    #[test]
    fn exact_no_term_that_counts_is_left_out() {
        assert_eq!(terms(1.25), MOST);
        for x in [1e-9, 1e-3, 0.03, 0.2, 0.7, 1.2] {
            let next = (3..=terms(x) + 1).fold(1.0, |term, order| term * x / order as f64);
            assert!(next <= LEFT_OUT, "{x}: {next:e}");
        }
    }
}
