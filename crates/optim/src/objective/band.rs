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
    /// Number of evenly spaced frequencies that are evaluated first, both ends included, at least 2.
    pub samples: usize,
}

impl Band {
    /// Sample number `i`, rad/s.
    pub fn at(&self, i: usize) -> f64 {
        let last = self.samples.saturating_sub(1).max(1);
        if i == last { self.to } else { self.from + (self.to - self.from) * (i as f64 / last as f64) }
    }
}

/// Most evaluations in the search of one peak. A smooth one needs four or five.
const REFINEMENTS: usize = 11;
/// A search ends after the first number of evaluations if its best is below the largest sample by more than the second, a share.
const FEW: usize = 2;
const HOPELESS: f64 = 0.4;
/// A search ends once the predicted gain of its parabola is below this share.
const GAIN: f64 = 1e-13;

/// Some quantities at a frequency; cutoffs apply to the first.
#[derive(Clone, Copy)]
struct Sample<const N: usize> {
    frequency: f64,
    values: [f64; N],
}

/// The largest of `value(omega)` over `band`: of the samples, and of a search between the neighbours of every sample that is not
/// below them, which ends early if it stays well below the largest sample. Samples and searches are shared among the threads of the current
/// rayon pool; the result is the same at any number of them. It is a lower bound: a peak that shows in no sample is missed. Samples are
/// taken in groups, each spread over the band; once one of a group is above `cutoff`, the largest sample so far is returned.
///
/// # Errors
/// The first failure in the order of the frequencies, samples before searches, of the groups that were taken.
pub fn worst_over<E: Send + Sync>(
    band: &Band,
    value: impl Fn(f64) -> Result<f64, E> + Sync,
    cutoff: f64,
) -> Result<Worst, E> {
    let [worst] = all_worst_over(band, &|omega| value(omega).map(|value| [value]), cutoff, [None], true)?;
    Ok(worst)
}

/// [`worst_over`] for several quantities at once; `cutoff` is for the first.
///
/// Each quantity has its own peaks. Without a limit in `limits` all of them are searched; otherwise those that would exceed the limit
/// and all samples if they rose four times as far above their sample as the parabola through it and its neighbours.
///
/// Without `peaks` only the samples are evaluated.
///
/// # Errors
/// As [`worst_over`].
pub fn all_worst_over<E: Send + Sync, const N: usize>(
    band: &Band,
    values: &(dyn Fn(f64) -> Result<[f64; N], E> + Sync),
    cutoff: f64,
    limits: [Option<f64>; N],
    peaks: bool,
) -> Result<[Worst; N], E> {
    let sample_at = |frequency: f64| values(frequency).map(|values| Sample { frequency, values });
    let count = band.samples.max(2);
    let order = if cutoff.is_finite() { likely_first(band) } else { (0..count).collect() };
    let sample = |&i: &usize| (i, sample_at(band.at(i)));
    let above =
        |(_, sample): &(usize, Result<Sample<N>, E>)| !sample.as_ref().is_ok_and(|s| s.values[0] <= cutoff);
    let ends = |taken: &[(usize, Result<Sample<N>, E>)]| taken.iter().any(above);
    let mut samples = if cutoff.is_finite() {
        in_groups(count, TOGETHER, &|place, _| sample(&order[place]), &ends)
    } else {
        order.par_iter().map(sample).collect()
    };
    samples.sort_by_key(|(i, _)| *i);
    let samples = samples.into_iter().map(|(_, sample)| sample).collect::<Result<Vec<Sample<N>>, E>>()?;
    let worst = samples[1..].iter().fold(worst_of(&samples[0]), |all, sample| larger(all, worst_of(sample)));
    if worst[0].value > cutoff || !peaks {
        return Ok(worst);
    }
    let last = samples.len() - 1;
    let around = |i: usize| [samples[i.max(1) - 1], samples[i], samples[last.min(i + 1)]];
    let worth_a_search = |&(quantity, i): &(usize, usize)| {
        let [before, value, after] = around(i).map(|sample| sample.values[quantity]);
        let is_peak = (i == 0 || value > before) && (i == last || value >= after);
        let most = value + 0.5 * (2.0 * value - before - after);
        is_peak && limits[quantity].is_none_or(|limit| most > limit.max(worst[quantity].value))
    };
    let places = (0..N).flat_map(|quantity| (0..=last).map(move |i| (quantity, i)));
    let peaks: Vec<(usize, usize)> = places.filter(worth_a_search).collect();
    let promising = |Worst { value, .. }: Worst| value - HOPELESS * value.abs();
    let refine = |&(quantity, i): &(usize, usize)| {
        local_maximum(&sample_at, around(i), quantity, promising(worst[quantity]), cutoff)
    };
    let refined: Vec<Result<[Worst; N], E>> = peaks.par_iter().map(refine).collect();
    refined.into_iter().try_fold(worst, |all, more| Ok(larger(all, more?)))
}

/// The samples of a band in an order that is likely to reach one above a cutoff soon: about eight of them, evenly spaced, from the middle
/// outwards, as a structure has its largest values near its resonance; then those between in the same way.
fn likely_first(band: &Band) -> Vec<usize> {
    let count = band.samples.max(2);
    let strides = count.div_ceil(TOGETHER);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&i| ((i + strides - count / 2 % strides) % strides, (2 * i + 1).abs_diff(count)));
    order
}

fn worst_of<const N: usize>(&Sample { frequency, values }: &Sample<N>) -> [Worst; N] {
    values.map(|value| Worst { frequency, value })
}

/// The larger of each quantity; on a tie `a`.
fn larger<const N: usize>(a: [Worst; N], b: [Worst; N]) -> [Worst; N] {
    std::array::from_fn(|q| if b[q].value > a[q].value { b[q] } else { a[q] })
}

/// A local maximum of a quantity between two points, given one between them that is not below either, and the largest values of the other
/// quantities on the way: parabolic steps from three known points, with golden sections where these fail (R. P. Brent, Algorithms for
/// Minimization without Derivatives, 1973, chapter 5). It ends early below `promising` or once the predicted gain is negligible.
fn local_maximum<E, const N: usize>(
    sample_at: &dyn Fn(f64) -> Result<Sample<N>, E>,
    around: [Sample<N>; 3],
    quantity: usize,
    promising: f64,
    cutoff: f64,
) -> Result<[Worst; N], E> {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let [left, best, right] = around.map(|sample| worst_of(&sample)[quantity]);
    let mut seen = worst_of(&around[1]);
    let (mut a, mut b) = (left.frequency, right.frequency);
    // `x` the best, `w` the second, `v` the third; `step` and `earlier` are the last two steps.
    let (mut x, (mut w, mut v)) =
        (best, if left.value > right.value { (left, right) } else { (right, left) });
    let (mut step, mut earlier) = (b - a, b - a);
    for count in 0..REFINEMENTS {
        let (middle, tolerance) = (0.5 * (a + b), 1e-8 * x.frequency.abs());
        let is_at_its_place = (x.frequency - middle).abs() + 0.5 * (b - a) <= 2.0 * tolerance;
        if is_at_its_place || count >= FEW && x.value < promising {
            break;
        }
        let (to_w, to_v) = (x.frequency - w.frequency, x.frequency - v.frequency);
        let (r, q) = (to_w * (x.value - v.value), to_v * (x.value - w.value));
        let parabola = 0.5 * (to_v * q - to_w * r) / (r - q);
        let inside = x.frequency + parabola > a && x.frequency + parabola < b;
        if inside && parabola.abs() < 0.5 * earlier.abs() {
            let bend = (r - q) / (to_w * to_v * (to_v - to_w));
            if count > 0 && bend.abs() * parabola.powi(2) < GAIN * x.value.abs() {
                break;
            }
            (earlier, step) = (step, parabola);
        } else {
            earlier = if x.frequency < middle { b - x.frequency } else { a - x.frequency };
            step = GOLDEN * earlier;
        }
        let step_taken = if step.abs() < tolerance { tolerance.copysign(step) } else { step };
        let frequency = (x.frequency + step_taken).clamp(a, b);
        let all = worst_of(&sample_at(frequency)?);
        let tried = all[quantity];
        seen = larger(seen, all);
        if all[0].value > cutoff {
            return Ok(seen);
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
    seen[quantity] = x;
    Ok(seen)
}
