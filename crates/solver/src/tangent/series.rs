//! Taylor series of a motion and of its changes.

use retune_model::Excitation;

/// A state and the force, or their derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub y: [f64; 4],
    pub force: Excitation,
}

impl Moment {
    pub(super) fn times(self, share: f64) -> Self {
        Self { y: self.y.map(|v| v * share), force: self.force.map(|v| v * share) }
    }
}

/// Terms of a series over the brief contact that is computed at once: `0.3¹³/13! = 3e-17`.
pub(super) const BRIEF: usize = 13;

/// A Taylor series of a motion or of its change, to as many terms as count.
#[derive(Clone, Copy)]
pub(super) struct Series {
    terms: [Moment; BRIEF],
    count: usize,
}

impl Series {
    /// The series that begins so, each further term by its number and the one before it.
    pub(super) fn new(from: Moment, count: usize, rate: impl Fn(usize, &Moment) -> Moment) -> Self {
        let mut terms = [from; BRIEF];
        for k in 1..count {
            terms[k] = rate(k, &terms[k - 1]).times(1.0 / k as f64);
        }
        Self { terms, count }
    }

    /// Its terms.
    pub(super) fn terms(&self) -> &[Moment] {
        &self.terms[..self.count]
    }

    /// The rate of the state after `t` seconds.
    pub(super) fn rate(&self, t: f64) -> [f64; 4] {
        let terms = self.terms().iter().enumerate().skip(1).rev();
        terms.fold([0.0; 4], |sum, (k, term)| std::array::from_fn(|i| sum[i] * t + k as f64 * term.y[i]))
    }

    /// The force.
    pub(super) fn force(&self, t: f64) -> Excitation {
        self.terms().iter().rev().fold([0.0; 2], |sum, term| [0, 1].map(|i| sum[i] * t + term.force[i]))
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn sum(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| a[i] + b[i])
}
