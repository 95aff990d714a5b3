//! Matrices of as many rows as a state has, in intervals, and a frame of nearly orthogonal directions with its inverse.

use crate::number::{FREE, Number, STATE, State};
use crate::{Interval, Taylor};
use nalgebra::SMatrix;
use std::array;

/// A matrix in intervals, `[row][column]`, or in functions of a family's parameter.
pub type Matrix<T = Interval, const N: usize = STATE> = [[T; N]; N];

/// One of the free coordinates, for each value of a family's parameter.
pub type Block = Matrix<Taylor, FREE>;

/// The identity.
pub fn identity<T: Number>() -> Matrix<T> {
    matrix(|i, j| T::constant(if i == j { Interval::ONE } else { Interval::ZERO }))
}

/// A matrix times a vector.
pub fn times_vector(a: &Matrix, x: &State) -> State {
    array::from_fn(|i| (0..STATE).fold(Interval::ZERO, |sum, j| sum + a[i][j] * x[j]))
}

/// A matrix times a matrix.
pub fn times<T: Number, const N: usize>(a: &Matrix<T, N>, b: &Matrix<T, N>) -> Matrix<T, N> {
    let entry =
        |i: usize, j: usize| (0..N).fold(T::constant(Interval::ZERO), |sum, k| sum + a[i][k] * b[k][j]);
    matrix(entry)
}

/// A matrix by its entries.
pub fn matrix<T, const N: usize>(entry: impl Fn(usize, usize) -> T) -> Matrix<T, N> {
    array::from_fn(|i| array::from_fn(|j| entry(i, j)))
}

/// Sums of the coordinates.
pub fn plus<T: Number>(a: &[T; STATE], b: &[T; STATE]) -> [T; STATE] {
    array::from_fn(|i| a[i] + b[i])
}

/// Coordinates of a box in directions that turn with the flow, so that boxes do not grow by being wrapped in boxes (R. Lohner, 1987).
///
/// The directions are the columns of `S⁻¹ Q` with a nearly orthogonal `Q` and a diagonal `S` of powers of two, exact as factors.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    q: SMatrix<f64, STATE, STATE>,
    scales: [f64; STATE],
}

impl Frame {
    /// The directions of the coordinates.
    pub fn identity() -> Self {
        Self { q: SMatrix::identity(), scales: [1.0; STATE] }
    }

    /// Directions near the columns of a matrix, the one with the largest column times `weights` first, orthogonal once scaled.
    pub fn along(columns: &Matrix, weights: &[f64; STATE], scales: [f64; STATE]) -> Self {
        let all = SMatrix::<f64, STATE, STATE>::from_fn(|i, j| scales[i] * columns[i][j].mid() * weights[j]);
        let mut order: [usize; STATE] = array::from_fn(|j| j);
        order.sort_by(|a, b| all.column(*b).norm().total_cmp(&all.column(*a).norm()));
        let sorted = SMatrix::<f64, STATE, STATE>::from_fn(|i, j| all[(i, order[j])]);
        Self { q: sorted.qr().q(), scales }
    }

    /// Its directions as the columns of a matrix.
    pub fn matrix(&self) -> Matrix {
        matrix(|i, j| Interval::point(self.q[(i, j)]) / Interval::point(self.scales[i]))
    }

    /// The coordinates of all vectors of a box along the directions; none if these are not nearly orthogonal.
    ///
    /// With `Qᵀ Q = I + Δ` and `δ = ‖Δ‖∞ < 1` the inverse of `Q` is `(I + Δ)⁻¹ Qᵀ`, and `(I + Δ)⁻¹ b` differs from `b` by at most `δ/(1 - δ) ‖b‖∞`.
    pub fn coordinates(&self, x: &State) -> Option<State> {
        let q: Matrix = matrix(|i, j| Interval::point(self.q[(i, j)]));
        let transposed = matrix(|i, j| q[j][i]);
        let (one, square) = (identity(), times(&transposed, &q));
        let row = |i: usize| (0..STATE).fold(Interval::ZERO, |sum, j| sum + (square[i][j] - one[i][j]).abs());
        let delta = (0..STATE).map(|i| row(i).hi()).fold(0.0, f64::max);
        if delta >= 0.5 || delta.is_nan() {
            return None;
        }
        let scaled = array::from_fn(|i| Interval::point(self.scales[i]) * x[i]);
        let b = times_vector(&transposed, &scaled);
        let size = Interval::point(b.iter().map(|b| b.magnitude()).fold(0.0, f64::max));
        let delta = Interval::point(delta);
        let off = Interval::around_zero((delta / (Interval::ONE - delta) * size).hi());
        Some(b.map(|b| b + off))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The weights of a sum of directions are in its coordinates along them, though these are at angles of some degrees off.
    #[test]
    fn exact_coordinates_along_directions_that_are_not_orthogonal() {
        let off = |i: usize, j: usize| 0.004 * ((i + 2 * j) % 5) as f64;
        let q = SMatrix::from_fn(|i, j| if i == j { 1.0 } else { off(i, j) });
        let frame = Frame { q, scales: [1.0, 2.0, 0.5, 4.0, 1.0, 8.0] };
        let weights = [1.0, -2.0, 3.0, 0.5, -1.0, 2.0];
        let sum = times_vector(&frame.matrix(), &weights.map(Interval::point));
        let found = frame.coordinates(&sum).expect("nearly orthogonal");
        for (x, weight) in found.into_iter().zip(weights) {
            assert!(x.contains(weight) && x.width() < 2.0, "{weight}: {x}");
        }
        assert_eq!(Frame { q: q.map(|x| 1.5 * x), ..frame }.coordinates(&sum), None);
    }
}
