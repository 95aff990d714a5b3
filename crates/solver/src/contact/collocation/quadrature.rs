//! Gauss's rules and Legendre's polynomials.

use nalgebra::{DMatrix, SymmetricEigen};

/// Gauss's rule for the weight `(4u (1 - u))^power` on `[0, 1]` (weights for `power` 0 only), by the eigenvalues of the
/// recurrence of Gegenbauer's polynomials (G. H. Golub & J. H. Welsch, Mathematics of Computation 23, 1969).
pub fn gauss(count: usize, power: u32) -> (Vec<f64>, Vec<f64>) {
    let beta = |n: f64| {
        let a = f64::from(power);
        (n * (n + 2.0 * a) / ((2.0 * n + 2.0 * a - 1.0) * (2.0 * n + 2.0 * a + 1.0))).sqrt()
    };
    let recurrence =
        DMatrix::from_fn(count, count, |i, j| if i.abs_diff(j) == 1 { beta(i.max(j) as f64) } else { 0.0 });
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(recurrence);

    let mut rule: Vec<_> =
        eigenvalues.iter().zip(eigenvectors.row(0).iter()).map(|(x, v)| (0.5 * (1.0 + x), v * v)).collect();
    rule.sort_by(|a, b| a.0.total_cmp(&b.0));
    rule.into_iter().unzip()
}

/// Legendre's polynomial of a degree.
pub fn legendre(degree: usize, x: f64) -> f64 {
    let (mut before, mut now) = (0.0, 1.0);
    for n in 0..degree {
        let n = n as f64;
        (before, now) = (now, ((2.0 * n + 1.0) * x * now - n * before) / (n + 1.0));
    }
    now
}
