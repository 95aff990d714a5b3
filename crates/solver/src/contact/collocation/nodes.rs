//! Numbers at the nodes of a rule, four side by side; in products eight, where the processor can. Their tables begin at a line of its cache, since
//! eight numbers that cross one are read twice.

use crate::motion::polynomial::Polynomial;
use wide::{f64x4, f64x8};

/// A number for each of `4 M` nodes.
pub type Nodes<const M: usize> = [f64x4; M];

/// The nodes side by side, of which there are `N = 4 M`.
pub fn packed<const N: usize, const M: usize>(numbers: &[f64; N]) -> Nodes<M> {
    std::array::from_fn(|block| f64x4::new(std::array::from_fn(|lane| numbers[4 * block + lane])))
}

/// The number for node `i`.
#[inline(always)]
pub fn node<const M: usize>(nodes: &Nodes<M>, i: usize) -> f64 {
    nodes[i / 4].to_array()[i % 4]
}

/// The first terms of a polynomial, in whole blocks of four, at every node.
#[inline(always)]
pub fn at_nodes<const B: usize, const M: usize>(
    polynomial: &Polynomial<B>,
    terms: usize,
    times: &Nodes<M>,
) -> Nodes<M> {
    let mut sum = [f64x4::ZERO; M];
    for block in polynomial.0.iter().take(terms.div_ceil(4)).rev() {
        for coefficient in block.to_array().into_iter().rev() {
            for i in 0..M {
                sum[i] = sum[i] * times[i] + coefficient;
            }
        }
    }
    sum
}

/// `Σ_j columns[j] vector[j]`, in two chains of dependent operations.
#[inline(always)]
pub fn product<const N: usize, const M: usize>(columns: &[Nodes<M>; N], vector: &Nodes<M>) -> Nodes<M> {
    let mut numbers = [0.0; N];
    for (four, lanes) in numbers.as_chunks_mut().0.iter_mut().zip(vector) {
        *four = lanes.to_array();
    }
    // Eight nodes side by side, and the last four of an odd M. Each node's sum is the same, bit by bit.
    let (mut sum, mut other) = ([f64x8::ZERO; M], [f64x8::ZERO; M]);
    let (mut sum_last, mut other_last) = (f64x4::ZERO, f64x4::ZERO);
    for j in 0..N / 2 {
        let (column, beyond) = (&columns[j], &columns[N / 2 + j]);
        for i in 0..M / 2 {
            sum[i] += eight(column, i) * numbers[j];
            other[i] += eight(beyond, i) * numbers[N / 2 + j];
        }
        if M % 2 == 1 {
            sum_last += column[M - 1] * numbers[j];
            other_last += beyond[M - 1] * numbers[N / 2 + j];
        }
    }
    let mut all = [sum_last + other_last; M];
    for i in 0..M / 2 {
        let [low, high] = halves(sum[i] + other[i]);
        all[2 * i] = low;
        all[2 * i + 1] = high;
    }
    all
}

#[inline(always)]
fn eight<const M: usize>(nodes: &Nodes<M>, i: usize) -> f64x8 {
    bytemuck::cast([nodes[2 * i], nodes[2 * i + 1]])
}

#[inline(always)]
fn halves(nodes: f64x8) -> [f64x4; 2] {
    bytemuck::cast(nodes)
}

/// `Σ a b`, in four chains.
#[inline(always)]
pub fn dot<const M: usize>(a: &Nodes<M>, b: &Nodes<M>) -> f64 {
    let sum = a.iter().zip(b).fold(f64x4::ZERO, |sum, (a, b)| sum + *a * *b);
    let [first, second, third, fourth] = sum.to_array();
    (first + third) + (second + fourth)
}
