//! Polynomials of few terms.

use std::ops::{Add, Mul};

/// A number, or several side by side.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self> + Add<f64, Output = Self>
{
}

impl<T> Number for T where
    T: Copy + Add<Output = T> + Mul<Output = T> + Mul<f64, Output = T> + Add<f64, Output = T>
{
}

/// Terms of a [`polynomial`].
pub(crate) const TERMS: usize = 8;

/// `Σ c_k t^k` by Estrin's scheme: pairs, then pairs of pairs, so that chains of dependent operations are short.
#[inline(always)]
pub(crate) fn polynomial<T: Number>(c: &[f64; TERMS], t: T) -> T {
    let t2 = t * t;
    let pair = |k: usize| t * c[k + 1] + c[k];
    (pair(0) + pair(2) * t2) + (pair(4) + pair(6) * t2) * (t2 * t2)
}
