//! The rate of a quantity in flight, bounded by the four numbers that a motion in contact consists of.

use crate::system::LinearSystem;

/// The rate at which a quantity changes in flight, as a polynomial in the numbers of `retune_model::Growth` with every coefficient by its
/// magnitude: `constant + (linear + square n) · n`.
///
/// It is `(linear + Σ weight (row · d) row) · (A d + b P cos ωt)`; terms that cancel, such as the two by which a spring exchanges work with
/// its energy, do not count.
#[derive(Clone, Copy, Debug)]
pub struct SlopeInFlight<const N: usize> {
    constant: f64,
    linear: [f64; N],
    /// The part of `linear` by the force.
    driven: [f64; N],
    square: [[f64; N]; N],
}

/// Weights of these numbers in a row of weights of the state: `x2 - D = x1 + sign (stretch)`, `v2 = v1 + sign w`. Their signs
/// are those of a wall in the positive direction.
fn by_number<const N: usize>(row: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| row[i] + row.get(i + 2).unwrap_or(&0.0))
}

impl<const N: usize> SlopeInFlight<N> {
    /// The rate of `linear · d + Σ weight/2 (row · d)²`.
    pub fn new<S: LinearSystem<N>>(system: &S, linear: &[f64; N], squares: &[(f64, [f64; N]); 2]) -> Self {
        let (of, force) = (system.linear(), system.amplitude());
        let dot = |a: &[f64; N], b: &[f64; N]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // row · A and row · b P.
        let rate_of = |row: &[f64; N]| {
            (by_number(&of.columns.map(|column| dot(row, &column))), dot(row, &of.input) * force)
        };
        let (rate_row, driven) = rate_of(linear);
        let (mut slope, mut square) = (
            Self {
                constant: driven.abs(),
                linear: rate_row.map(f64::abs),
                driven: [0.0; N],
                square: [[0.0; N]; N],
            },
            [[0.0; N]; N],
        );
        for (weight, row) in squares {
            let (numbers, (rate, driven)) = (by_number(row), rate_of(row));
            for i in 0..N {
                slope.linear[i] += (weight * numbers[i] * driven).abs();
                slope.driven[i] += (weight * numbers[i] * driven).abs();
                for j in 0..N {
                    square[i][j] += weight * numbers[i] * rate[j];
                }
            }
        }
        for i in 0..N {
            for j in 0..N {
                slope.square[i][j] = 0.5 * (square[i][j] + square[j][i]).abs();
            }
        }
        slope
    }

    /// A bound on the rate where the numbers have at most these magnitudes.
    pub fn bound(&self, most: &[f64; N]) -> f64 {
        let mut sum = self.constant;
        for i in 0..N {
            let by = (0..N).map(|j| self.square[i][j] * most[j]).sum::<f64>();
            sum += (self.linear[i] + by) * most[i];
        }
        sum
    }

    /// A bound on the change of the rate between two places at which the numbers are at most `most` and differ by at most `of`, and the
    /// force differs by at most a share `turn` of its bound.
    pub fn variation(&self, most: &[f64; N], of: &[f64; N], turn: f64) -> f64 {
        let mut sum = self.constant * turn;
        for i in 0..N {
            let by = (0..N).map(|j| 2.0 * self.square[i][j] * most[j]).sum::<f64>();
            sum += (self.linear[i] + by) * of[i] + self.driven[i] * turn * most[i];
        }
        sum
    }
}
