//! Gauss's rules, and the force of the undisturbed collision.

use super::DURATION;
use crate::dop853;
use nalgebra::{DMatrix, SymmetricEigen};

/// `τ` and `dτ/du` of the clock.
pub fn clock(u: f64) -> [f64; 2] {
    [u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)]
}

/// The force `ζ^(3/2)` of the undisturbed collision as a function of the clock, to rounding: `u³ (1 - u)³` times a polynomial
/// that meets it on 40 nodes.
pub fn undisturbed_force() -> impl Fn(f64) -> f64 {
    const NODES: usize = 40;
    let ends = |u: f64| (u * (1.0 - u)).powi(3);
    let (nodes, _) = gauss(NODES, 0);
    // In units of Z and Z/w the regularised collision is q' = w/2, w' = -(5/4) q⁴, t' = q (see `retune_model::Compression`).
    let slope = |&[q, w, _]: &[f64; 3]| [0.5 * w, -1.25 * q.powi(4), q];
    let advance = |y: &[f64; 3], h: f64| dop853::step(slope, y, &slope(y), h).y;
    let mut y = [0.0, 1.0, 0.0];
    // It is the same backwards: what leaves is the mirror image of what came.
    let mut values: Vec<f64> = nodes[..NODES / 2]
        .iter()
        .map(|&u| {
            let time = DURATION * clock(u)[0];
            // Newton's iteration for the end of the last of some short steps; time grows at the rate q.
            while time - y[2] > 0.05 * y[0].max(0.05) {
                y = advance(&y, 0.04);
            }
            let mut h = 0.0;
            let mut at = y;
            for _ in 0..50 {
                let correction = (time - at[2]) / at[0].max(1e-3);
                h += correction;
                at = advance(&y, h);
                if correction.abs() < 1e-16 {
                    break;
                }
            }
            y = at;
            y[0].powi(3) / ends(u)
        })
        .collect();
    values.extend(values.clone().into_iter().rev());
    let weights: Vec<f64> = (0..NODES)
        .map(|j| (0..NODES).filter(|&i| i != j).map(|i| 0.25 / (nodes[j] - nodes[i])).product())
        .collect();
    move |u| {
        let (mut above, mut below) = (0.0, 0.0);
        for ((node, weight), value) in nodes.iter().zip(&weights).zip(&values) {
            if u == *node {
                return ends(u) * value;
            }
            above += weight / (u - node) * value;
            below += weight / (u - node);
        }
        ends(u) * above / below
    }
}

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
