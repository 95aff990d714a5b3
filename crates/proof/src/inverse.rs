//! An approximate inverse of a matrix of functions of a family's parameter.

use crate::Taylor;
use nalgebra::DMatrix;

/// Newton's iterations: each doubles the order.
const ITERATIONS: usize = 3;

/// Polynomials.
#[derive(Clone, Debug)]
pub struct Inverse(Vec<Vec<Taylor>>);

impl Inverse {
    /// Near the inverse of a matrix, by that at the middle and Newton's iteration `A + A (1 - M A)` (G. Schulz, 1933); none of a singular one.
    pub fn of(matrix: &[Vec<Taylor>]) -> Option<Self> {
        let n = matrix.len();
        let first = DMatrix::from_fn(n, n, |i, j| matrix[i][j].mid()).try_inverse()?;
        let mut a: Vec<Vec<Taylor>> =
            (0..n).map(|i| (0..n).map(|j| Taylor::point(first[(i, j)])).collect()).collect();
        if matrix.iter().flatten().all(|entry| entry.is_constant()) {
            return Some(Self(a));
        }
        for _ in 0..ITERATIONS {
            let change = product(&a, &off(matrix, &a));
            for (a, change) in a.iter_mut().flatten().zip(change.into_iter().flatten()) {
                *a = (*a + change).polynomial();
            }
        }
        Some(Self(a))
    }

    /// It times a vector.
    pub fn times(&self, vector: &[Taylor]) -> Vec<Taylor> {
        let row = |row: &Vec<Taylor>| row.iter().zip(vector).fold(Taylor::ZERO, |sum, (a, x)| sum + *a * *x);
        self.0.iter().map(row).collect()
    }

    /// `1 - A M`.
    pub fn off(&self, matrix: &[Vec<Taylor>]) -> Vec<Vec<Taylor>> {
        off(&self.0, matrix)
    }
}

/// `1 - A B`.
fn off(a: &[Vec<Taylor>], b: &[Vec<Taylor>]) -> Vec<Vec<Taylor>> {
    let mut all = product(a, b);
    for (i, row) in all.iter_mut().enumerate() {
        row.iter_mut().for_each(|x| *x = -*x);
        row[i] = row[i] + Taylor::point(1.0);
    }
    all
}

fn product(a: &[Vec<Taylor>], b: &[Vec<Taylor>]) -> Vec<Vec<Taylor>> {
    let row = |row: &Vec<Taylor>| {
        let mut all = vec![Taylor::ZERO; b.len()];
        for (a, b) in row.iter().zip(b).filter(|(a, _)| **a != Taylor::ZERO) {
            all.iter_mut().zip(b).for_each(|(sum, b)| *sum = *sum + *a * *b);
        }
        all
    };
    a.iter().map(row).collect()
}
