//! Polynomials of few terms.

/// Terms of a [`polynomial`].
pub(crate) const TERMS: usize = 8;

/// `Σ c_k t^k` by Estrin's scheme: pairs, then pairs of pairs, so that chains of dependent operations are short.
#[inline(always)]
pub(crate) fn polynomial(c: &[f64; TERMS], t: f64) -> f64 {
    let t2 = t * t;
    let pair = |k: usize| c[k] + c[k + 1] * t;
    (pair(0) + pair(2) * t2) + (pair(4) + pair(6) * t2) * (t2 * t2)
}
