//! The largest value of a function over a band of frequencies, by samples and a search about each of their maxima.

use crate::chunks::{TOGETHER, in_groups};
use rayon::prelude::*;
use retune_model::Worst;

/// A band of angular frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Lowest, above 0, rad/s.
    pub from: f64,
    /// Highest, above the lowest, rad/s.
    pub to: f64,
    /// How many evenly spaced frequencies are looked at first, both ends included, at least 2.
    pub samples: usize,
}

impl Band {
    /// Sample number `i`, rad/s.
    pub fn at(&self, i: usize) -> f64 {
        let last = self.samples.saturating_sub(1).max(1);
        if i == last { self.to } else { self.from + (self.to - self.from) * (i as f64 / last as f64) }
    }
}

/// Most evaluations that one maximum of the samples is refined by. A smooth peak needs about eight.
const REFINEMENTS: usize = 12;

/// The largest of `value(omega)` over `band`: of the samples, and of a search between the neighbours of every sample that is
/// not below them. Samples and searches are shared among the threads of the current rayon pool; the result is the same at any
/// number of them. It is a lower bound: a peak that shows at no sample is missed. Samples are taken in groups, each spread over the
/// band; once one of a group is above `cutoff`, the largest sample so far is the answer.
///
/// # Errors
/// The first failure in the order of the frequencies, samples before searches, of the groups that were taken.
pub fn worst_over<E: Send + Sync>(
    band: &Band,
    value: impl Fn(f64) -> Result<f64, E> + Sync,
    cutoff: f64,
) -> Result<Worst, E> {
    let count = band.samples.max(2);
    let groups = count.div_ceil(TOGETHER);
    // Group g has the samples g, g + groups, g + 2 groups, …
    let order: Vec<usize> = (0..groups).flat_map(|g| (g..count).step_by(groups)).collect();
    let sample = |&i: &usize| (i, value(band.at(i)).map(|value| Worst { frequency: band.at(i), value }));
    let above = |(_, sample): &(usize, Result<Worst, E>)| !sample.as_ref().is_ok_and(|s| s.value <= cutoff);
    let ends = |taken: &[(usize, Result<Worst, E>)]| taken.iter().any(above);
    let together = if cutoff.is_finite() { TOGETHER } else { count };
    let mut samples = in_groups(count, together, |place, _| sample(&order[place]), ends);
    samples.sort_by_key(|(i, _)| *i);
    let samples = samples.into_iter().map(|(_, sample)| sample).collect::<Result<Vec<Worst>, E>>()?;
    let largest =
        |all: &[Worst], first| all.iter().fold(first, |a: Worst, b| if b.value > a.value { *b } else { a });
    let worst = largest(&samples, samples[0]);
    if worst.value > cutoff {
        return Ok(worst);
    }
    let last = samples.len() - 1;
    let is_peak = |&i: &usize| {
        let value = samples[i].value;
        (i == 0 || value > samples[i - 1].value) && (i == last || value >= samples[i + 1].value)
    };
    let peaks: Vec<usize> = (0..=last).filter(is_peak).collect();
    let refine = |&i: &usize| {
        local_maximum(&value, [samples[i.max(1) - 1], samples[i], samples[last.min(i + 1)]], cutoff)
    };
    let refined: Vec<Result<Worst, E>> = peaks.par_iter().map(refine).collect();
    Ok(largest(&refined.into_iter().collect::<Result<Vec<Worst>, E>>()?, worst))
}

/// A local maximum between two places, from one between them that is not below either: parabolas, and golden sections where
/// they do not serve (R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapter 5), from three known points.
fn local_maximum<E>(
    value: &impl Fn(f64) -> Result<f64, E>,
    [left, best, right]: [Worst; 3],
    cutoff: f64,
) -> Result<Worst, E> {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let (mut a, mut b) = (left.frequency, right.frequency);
    // `x` the best, `w` the second, `v` the third; `step` and `earlier` are the last two steps.
    let (mut x, (mut w, mut v)) =
        (best, if left.value > right.value { (left, right) } else { (right, left) });
    let (mut step, mut earlier) = (b - a, b - a);
    for _ in 0..REFINEMENTS {
        let (middle, tolerance) = (0.5 * (a + b), 1e-8 * x.frequency.abs());
        if (x.frequency - middle).abs() + 0.5 * (b - a) <= 2.0 * tolerance {
            break;
        }
        let (to_w, to_v) = (x.frequency - w.frequency, x.frequency - v.frequency);
        let (r, q) = (to_w * (x.value - v.value), to_v * (x.value - w.value));
        let parabola = 0.5 * (to_v * q - to_w * r) / (r - q);
        let inside = x.frequency + parabola > a && x.frequency + parabola < b;
        if inside && parabola.abs() < 0.5 * earlier.abs() {
            (earlier, step) = (step, parabola);
        } else {
            earlier = if x.frequency < middle { b - x.frequency } else { a - x.frequency };
            step = GOLDEN * earlier;
        }
        let step_taken = if step.abs() < tolerance { tolerance.copysign(step) } else { step };
        let frequency = (x.frequency + step_taken).clamp(a, b);
        let tried = Worst { frequency, value: value(frequency)? };
        if tried.value > cutoff {
            return Ok(tried);
        }
        if tried.value >= x.value {
            if frequency < x.frequency {
                b = x.frequency
            } else {
                a = x.frequency
            }
            (v, w, x) = (w, x, tried);
        } else {
            if frequency < x.frequency {
                a = frequency
            } else {
                b = frequency
            }
            if tried.value >= w.value || w.frequency == x.frequency {
                (v, w) = (w, tried);
            } else if tried.value >= v.value || v.frequency == x.frequency || v.frequency == w.frequency {
                v = tried;
            }
        }
    }
    Ok(x)
}
