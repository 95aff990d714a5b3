//! A step of a general method as observers see it: its dense output.

use super::step::POWERS;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::system::System;

/// A step and its interpolant, `y(t + s h) = y + h Σ p_j s^(j+1)`.
pub struct Piece<'a, S, const N: usize> {
    pub system: &'a S,
    pub ends: [Knot<N>; 2],
    /// Length, s.
    pub h: f64,
    pub dense: [[f64; N]; POWERS],
}

impl<S: System<N>, const N: usize> Segment<N> for Piece<'_, S, N> {
    fn ends(&self) -> [&Knot<N>; 2] {
        [&self.ends[0], &self.ends[1]]
    }
    fn length(&self) -> f64 {
        self.h
    }
    fn at(&self, theta: f64) -> Knot<N> {
        let (from, s) = (&self.ends[0], theta / self.h);
        let y = std::array::from_fn(|i| {
            from.y[i] + theta * self.dense.iter().rev().fold(0.0, |sum, p| sum * s + p[i])
        });
        let t = from.t + theta;
        Knot { t, excitation: self.system.excitation(t), y, clock: [1.0, 0.0] }
    }
    fn at_time(&self, t: f64) -> Knot<N> {
        Knot { t, ..self.at(t - self.ends[0].t) }
    }
}
