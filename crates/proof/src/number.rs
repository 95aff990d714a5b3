//! The numbers in which the equations of motion are evaluated: intervals or functions of a parameter, alone or with their derivatives by
//! the coordinates of a state; matrices of these, with a frame of nearly orthogonal directions and its inverse, and an approximate inverse
//! of the derivatives by all unknowns.

use crate::{Interval, Number, Taylor};
use nalgebra::{DMatrix, SMatrix};
use std::array;
use std::ops::{Add, Mul, Neg};

/// Coordinates of a state: four of the motion, the phase of the force, and the speed of a contact that loses energy.
pub const STATE: usize = 6;
/// The index of that speed.
pub const SPEED: usize = 5;
/// Coordinates that are free on a section.
pub const FREE: usize = 4;

/// Intervals, one for each coordinate.
pub type State = [Interval; STATE];
/// Functions of the parameter of a family, one for each coordinate.
pub type Family = [Taylor; STATE];

/// The largest width.
pub fn width(boxes: &[Interval]) -> f64 {
    boxes.iter().map(|x| x.width()).fold(0.0, f64::max)
}

/// A quantity with its derivatives by the coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<T> {
    /// The quantity.
    pub value: T,
    /// Its derivatives.
    pub by: [T; STATE],
}

impl<T: Number> Gradient<T> {
    /// The coordinates of a state as quantities: the derivative of each by itself is one.
    pub fn coordinates(state: &[T; STATE]) -> [Self; STATE] {
        let entry = |is_diagonal: bool| T::constant(if is_diagonal { Interval::ONE } else { Interval::ZERO });
        array::from_fn(|i| Self { value: state[i], by: array::from_fn(|j| entry(i == j)) })
    }

    /// A value that does not depend on the state.
    fn of_value(value: T) -> Self {
        Self { value, by: [T::constant(Interval::ZERO); STATE] }
    }
}

impl<T: Number> Add for Gradient<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, by: plus(&self.by, &other.by) }
    }
}

impl<T: Number> Neg for Gradient<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, by: self.by.map(|by| -by) }
    }
}

impl<T: Number> Mul for Gradient<T> {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
    fn mul(self, other: Self) -> Self {
        let by = |j: usize| self.by[j] * other.value + self.value * other.by[j];
        Self { value: self.value * other.value, by: array::from_fn(by) }
    }
}

impl<T: Number> Number for Gradient<T> {
    fn constant(value: Interval) -> Self {
        Self::of_value(T::constant(value))
    }

    fn of(function: Taylor) -> Self {
        Self::of_value(T::of(function))
    }

    fn times(self, factor: Interval) -> Self {
        Self { value: self.value.times(factor), by: self.by.map(|by| by.times(factor)) }
    }

    fn cos_sin(self) -> [Self; 2] {
        let [cos, sin] = self.value.cos_sin();
        let of = |value, slope| Self { value, by: self.by.map(|by| slope * by) };
        [of(cos, -sin), of(sin, cos)]
    }

    fn reciprocal(self) -> Self {
        let value = self.value.reciprocal();
        let slope = -(value * value);
        Self { value, by: self.by.map(|by| slope * by) }
    }
}

/// A matrix in intervals, `[row][column]`, or in functions of a family's parameter.
pub type Matrix<T = Interval, const N: usize = STATE> = [[T; N]; N];

/// A matrix over the free coordinates, for each value of a family's parameter.
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

/// The matrix with these entries.
pub fn matrix<T, const N: usize>(entry: impl Fn(usize, usize) -> T) -> Matrix<T, N> {
    array::from_fn(|i| array::from_fn(|j| entry(i, j)))
}

/// The sum of two vectors.
pub fn plus<T: Number>(a: &[T; STATE], b: &[T; STATE]) -> [T; STATE] {
    array::from_fn(|i| a[i] + b[i])
}

/// Coordinates of a box in directions that turn with the flow, against the wrapping effect (R. Lohner, 1987).
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

/// Newton iterations for an inverse: each doubles the order.
const ITERATIONS: usize = 3;

/// A matrix of any size, of functions of a family's parameter: its rows.
pub type Rows = Vec<Vec<Taylor>>;

/// Polynomials near the inverse of a matrix, from the inverse at the middle by Newton's iteration `A + A (1 - M A)` (G. Schulz, 1933); none
/// for a singular one.
pub fn inverse(matrix: &Rows) -> Option<Rows> {
    let n = matrix.len();
    let first = DMatrix::from_fn(n, n, |i, j| matrix[i][j].mid()).try_inverse()?;
    let mut a: Rows = (0..n).map(|i| (0..n).map(|j| Taylor::point(first[(i, j)])).collect()).collect();
    if matrix.iter().flatten().all(|entry| entry.is_constant()) {
        return Some(a);
    }
    for _ in 0..ITERATIONS {
        let change = product(&a, &off(matrix, &a));
        for (a, change) in a.iter_mut().flatten().zip(change.into_iter().flatten()) {
            *a = (*a + change).polynomial();
        }
    }
    Some(a)
}

/// A matrix times a vector.
pub fn applied(a: &Rows, vector: &[Taylor]) -> Vec<Taylor> {
    let row = |row: &Vec<Taylor>| row.iter().zip(vector).fold(Taylor::ZERO, |sum, (a, x)| sum + *a * *x);
    a.iter().map(row).collect()
}

/// `1 - A B`.
pub fn off(a: &Rows, b: &Rows) -> Rows {
    let mut all = product(a, b);
    for (i, row) in all.iter_mut().enumerate() {
        row.iter_mut().for_each(|x| *x = -*x);
        row[i] = row[i] + Taylor::point(1.0);
    }
    all
}

fn product(a: &Rows, b: &Rows) -> Rows {
    let row = |row: &Vec<Taylor>| {
        let mut all = vec![Taylor::ZERO; b.len()];
        for (a, b) in row.iter().zip(b).filter(|(a, _)| **a != Taylor::ZERO) {
            all.iter_mut().zip(b).for_each(|(sum, b)| *sum = *sum + *a * *b);
        }
        all
    };
    a.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The coordinates of a sum of directions contain its weights, although the directions are some degrees off orthogonal.
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
