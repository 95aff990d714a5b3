//! Longer steps where one part of the motion is much faster than all others and decays, such as that of a strong dashpot.
//!
//! With `v` and `w` the right and left eigenvectors of the fast rate `λ < 0`, scaled to `w · v = 1`, a deviation is `d = s + a v` with
//! `a = w · d`, and `a' = λ a + β f` with `β = w · b`. Once its own transient is below rounding, `a` follows the force,
//!
//! `a = α₁ f + α₂ g`, `α₁ = -β λ / (λ² + ω²)`, `α₂ = β ω / (λ² + ω²)`, with the partner `g` of the force (`f' = -ω g`, `g' = ω f`).
//!
//! From then on `d' = A (1 - v wᵀ) d + (b - β v + ω α₂ v) f - ω α₁ v g`: the exact motion, by equations with the slow rates alone. So the
//! cost of a flight follows its motion, not the fastest rate of the system.

use super::flow::{Flow, mat_vec};
use crate::motion::knot::Knot;
use crate::system::Linear;

/// Steps of the whole flow that a step of the reduced one must replace to be worthwhile.
const WORTH: f64 = 16.0;

/// Iterations of the power method: each adds the digits of the ratio of the rates, which is [`WORTH`] or more.
const ITERATIONS: usize = 20;

/// Largest ratio of the last term of a step's series to the largest term.
const CONVERGED: f64 = 1e-15;

/// Transient of the fast part that may be left out, relative to the magnitudes of the terms of the state.
const GONE: f64 = 8.0 * f64::EPSILON;

/// Limit on what rounding in the fast rate may add to the slow ones over a run. The fast rate leaves its rounding error in the slow
/// equations: at 4e-9 of this measure E1max is off by 6e-12 (`exact_a_strong_dashpot_in_long_steps`).
const ROUNDING: f64 = 1e-8;

/// The flow without a fast part.
pub struct Reduced<const N: usize> {
    pub flow: Flow<N>,
    /// `v`.
    fast: [f64; N],
    /// `w`.
    row: [f64; N],
    /// `α₁` and `α₂`.
    alpha: [f64; 2],
}

impl<const N: usize> Reduced<N> {
    /// The reduction of a whole flow, in steps of at most `longest` seconds; `None` where no part is fast enough, or where the force is not
    /// harmonic.
    pub fn of(whole: &Flow<N>, longest: f64) -> Option<Self> {
        let linear = *whole.linear();
        // Reduced steps are limited by ω, too.
        if linear.returns == 0.0 || linear.rate < WORTH * linear.frequency || longest < WORTH * whole.step() {
            return None;
        }
        let transposed = std::array::from_fn(|i| std::array::from_fn(|j| linear.columns[j][i]));
        let fast = dominant(&linear.columns)?;
        let row = dominant(&transposed)?;
        let scale = dot(&row, &fast);
        let row = row.map(|w| w / scale);
        let moved = mat_vec(&linear.columns, &fast);
        let rate = dot(&row, &moved);
        let omega = linear.frequency;
        let exact = -rate * longest * f64::EPSILON <= ROUNDING;
        if rate.is_nan() || rate >= 0.0 || !exact || row.iter().any(|w| !w.is_finite()) {
            return None;
        }
        let beta = dot(&row, &linear.input);
        let turned = beta / (rate * rate + omega * omega);
        let alpha = [-turned * rate, turned * omega];
        let follow = fast.map(|v| -v * omega * alpha[0]);
        let mut slow = Linear { partner: Some(follow), ..linear };
        for (column, w) in slow.columns.iter_mut().zip(row) {
            for i in 0..N {
                column[i] -= moved[i] * w;
            }
        }
        for i in 0..N {
            slow.input[i] += fast[i] * (omega * alpha[1] - beta);
        }
        slow.rate = omega.max(growth(&slow.columns));
        // The largest rate does not bound how terms of different units grow at first: the last term of the series does.
        for _ in 0..4 {
            let flow = Flow::new(slow, longest);
            if flow.step() < WORTH * whole.step() {
                return None;
            }
            if flow.last_term() <= CONVERGED {
                return Some(Self { flow, fast, row, alpha });
            }
            slow.rate *= 1.5;
        }
        None
    }

    /// The state at a moment without the fast part's transient, if that is below the rounding of the state.
    pub fn without_transient(&self, now: &Knot<N>) -> Option<[f64; N]> {
        let [f, g] = now.excitation;
        let origin = self.flow.linear().origin;
        let deviation: [f64; N] = std::array::from_fn(|i| now.y[i] - origin[i]);
        let forced = self.alpha[0] * f + self.alpha[1] * g;
        let transient = dot(&self.row, &deviation) - forced;
        let size: f64 =
            self.row.iter().zip(&now.y).zip(&origin).map(|((w, y), y0)| w.abs() * (y.abs() + y0.abs())).sum();
        (transient.abs() <= GONE * (size + forced.abs()))
            .then(|| std::array::from_fn(|i| now.y[i] - transient * self.fast[i]))
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The eigenvector of the largest rate, by the power method: its largest component is 1. `None` where no rate dominates.
fn dominant<const N: usize>(columns: &[[f64; N]; N]) -> Option<[f64; N]> {
    let mut vector: [f64; N] = std::array::from_fn(|i| 1.0 + i as f64 / 7.0);
    let mut moved = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let next = mat_vec(columns, &vector);
        let largest = next.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        let next = next.map(|component| component / largest);
        moved = next.iter().zip(vector).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        vector = next;
    }
    (moved <= 1e-14).then_some(vector)
}

/// The largest rate of a matrix, 1/s, too small by at most 9 %: `‖A¹⁶‖^(1/16)` by the largest element.
fn growth<const N: usize>(columns: &[[f64; N]; N]) -> f64 {
    let (mut power, mut logarithm) = (*columns, 0.0);
    for doubling in 0..=4 {
        if doubling > 0 {
            power = power.map(|column| mat_vec(&power, &column));
            logarithm *= 2.0;
        }
        let size = power.iter().flatten().map(|a| a.abs()).fold(0.0, f64::max);
        if size == 0.0 {
            return 0.0;
        }
        power = power.map(|column| column.map(|a| a / size));
        logarithm += size.ln();
    }
    (logarithm / 16.0).exp()
}
