//! The undisturbed collision of two free bodies by the law of Hunt and Crossley.

/// `χ = λ v` of an undisturbed collision with the restitution `e` in (0, 1] at the touch-down speed v.
///
/// The collision obeys `χ (1 + e) = ln((1 + χ) / (1 - χ e))`. With `a = χ (1 + e) / 2` that is
/// `(1 - e) / (1 + e) = coth a - 1/a`, Langevin's function.
pub(super) fn chi(e: f64) -> f64 {
    let ratio = (1.0 - e) / (1.0 + e);
    // A close guess (A. Cohen, Rheologica Acta 30 (1991) 270); where coth a is 1 to rounding, the root itself.
    let mut a = ratio * (3.0 - ratio * ratio) / (1.0 - ratio * ratio);
    if e < 0.025 {
        a = 0.5 * (1.0 + e) / e;
    } else if e < 1.0 {
        for _ in 0..8 {
            let value = langevin(a);
            a -= (value - ratio) / (1.0 - value * value - 2.0 * value / a);
        }
    }
    2.0 * a / (1.0 + e)
}

/// `coth a - 1/a` for `a >= 0`; where the difference would lose digits, its continued fraction `a / (3 + a² / (5 + a² / (7 + …)))`.
pub(super) fn langevin(a: f64) -> f64 {
    if a > 1.0 {
        return 1.0 / a.tanh() - 1.0 / a;
    }
    a / (1..=10).rev().fold(23.0, |rest, k| f64::from(2 * k + 1) + a * a / rest)
}
