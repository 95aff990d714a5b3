//! The objectives of `tests/reference/fminsearch_scipy.py`, the same operations in the same order.

pub type Objective = fn(&[f64]) -> f64;

/// Name, objective and start.
pub const PROBLEMS: [(&str, Objective, &[f64]); 4] = [
    ("quadratic", quadratic, &[1.0, 1.0, 1.0, 0.0]),
    ("rosenbrock", rosenbrock, &[-1.2, 1.0]),
    ("terraces", terraces, &[3.0, -1.0, 0.5]),
    ("tmd", tmd, &[600.0, 262.0]),
];

/// 4-D bowl with coupled coordinates, around (3, −1, 0.5, 2).
pub fn quadratic(x: &[f64]) -> f64 {
    let (a, b, c, d) = (x[0] - 3.0, x[1] + 1.0, x[2] - 0.5, x[3] - 2.0);
    a * a + 10.0 * b * b + 5.0 * c * c + 2.0 * d * d + a * b + c * d
}

pub fn rosenbrock(x: &[f64]) -> f64 {
    let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
    a * a + 100.0 * b * b
}

/// 3-D, flat steps around (2, 2, −2): causes ties, failed contractions and shrinks.
pub fn terraces(x: &[f64]) -> f64 {
    let (a, b, c) = ((x[0] - x[1]).abs(), (x[1] + x[2]).abs(), (x[0] - 2.0).abs());
    (64.0 * (a + b + c)).trunc()
}

/// Largest E₁ of the steady motion of a main structure with a linear damper, J; `x` = (k₂ N/m, c₂ N·s/m).
/// X₁ = P b / (a b − s²) with a = k₁ + k₂ − m₁ω² + iω(c₁ + c₂), b = k₂ − m₂ω² + iωc₂, s = k₂ + iωc₂.
#[expect(clippy::approx_constant, reason = "the forcing is at 6.28 rad/s, not at 2π")]
pub fn tmd(x: &[f64]) -> f64 {
    let (m1, c1, k1, m2, force, w) = (1000.0, 452.0, 3.95e4_f64, 60.0, 800.0, 6.28);
    let (k2, c2) = (x[0], x[1]);
    let (a_re, a_im) = (k1 + k2 - m1 * w * w, w * (c1 + c2));
    let (b_re, b_im) = (k2 - m2 * w * w, w * c2);
    let (s_re, s_im) = (k2, w * c2);
    let d_re = (a_re * b_re - a_im * b_im) - (s_re * s_re - s_im * s_im);
    let d_im = (a_re * b_im + a_im * b_re) - 2.0 * s_re * s_im;
    let amplitude_squared = force * force * (b_re * b_re + b_im * b_im) / (d_re * d_re + d_im * d_im);
    0.5 * amplitude_squared * k1.max(m1 * w * w)
}
