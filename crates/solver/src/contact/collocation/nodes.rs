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

/// `Σ_j columns[j] vector[j]`, each of its numbers in two chains of dependent operations. Eight nodes at a time, whose sums stay in registers however
/// it is compiled, and the last four of an odd M.
#[inline(always)]
pub fn product<const N: usize, const M: usize>(columns: &[Nodes<M>; N], vector: &Nodes<M>) -> Nodes<M> {
    let numbers: &[f64] = bytemuck::cast_slice(vector);
    let ((first, second), (one, two)) = (columns.split_at(N / 2), numbers.split_at(N / 2));
    let mut all = [f64x4::ZERO; M];
    for i in 0..M / 2 {
        let (mut sum, mut other) = (f64x8::ZERO, f64x8::ZERO);
        for j in 0..N / 2 {
            sum += eight(&first[j], i) * one[j];
            other += eight(&second[j], i) * two[j];
        }
        [all[2 * i], all[2 * i + 1]] = halves(sum + other);
    }
    if M % 2 == 1 {
        let (mut sum, mut other) = (f64x4::ZERO, f64x4::ZERO);
        for j in 0..N / 2 {
            sum += first[j][M - 1] * one[j];
            other += second[j][M - 1] * two[j];
        }
        all[M - 1] = sum + other;
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
