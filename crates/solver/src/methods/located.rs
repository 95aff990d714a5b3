//! Touch-downs and lift-offs inside a step of a general method.

use super::step::{Attempt, OneStep};
use crate::error::SolverError;
use crate::linear::gap::{PrecisionLost, first_contact};
use crate::motion::knot::Knot;
use crate::motion::polynomial::Polynomial;
use crate::response::Work;
use crate::system::System;
use retune_model::Side;

/// A step that ends no later than at a touch-down or lift-off, its length (s), and at which wall.
pub type Located<const N: usize> = Result<(f64, Attempt<N>, Option<Side>), SolverError>;

/// The start of a step.
pub struct Start<'a, S, const N: usize> {
    /// The system.
    pub system: &'a S,
    /// The moment.
    pub now: &'a Knot<N>,
    /// `f` there.
    pub slope: &'a [f64; N],
    /// The wall in contact, if any.
    pub contact: Option<Side>,
    /// Whether the damper has just touched or left a wall, so that a gap is zero by definition rather than by arithmetic.
    pub leaving: bool,
}

impl<S: System<N>, const N: usize> Start<'_, S, N> {
    /// Shortens a step to the first touch-down or lift-off in it, if there is one.
    ///
    /// The dense output gives the wall and an approximate time (double crossings inside the step included); a secant iteration on the
    /// length of the step, which is recomputed each time, gives the exact one.
    pub fn located<M: OneStep<N>>(&self, h: f64, attempt: Attempt<N>, work: &mut Work) -> Located<N> {
        let mut first: Option<(f64, Side)> = None;
        for side in Side::BOTH {
            let has_wall = self.system.indentation(&self.now.y)[side as usize] != f64::NEG_INFINITY;
            if has_wall && self.contact.is_none_or(|touching| touching == side) {
                let found = first_contact(self.open_polynomial(side, h, &attempt), 1.0);
                let found = found.map_err(|PrecisionLost| SolverError::NonFinite { t: self.now.t })?;
                first = found.into_iter().map(|s| (s, side)).chain(first).min_by(|a, b| a.0.total_cmp(&b.0));
            }
        }
        let Some((s, side)) = first else { return Ok((h, attempt, None)) };
        let (system, sign) = (self.system, self.open_sign(side));
        let opening = |y: &[f64; N]| sign * system.indentation(y)[side as usize];
        let Knot { t, y, .. } = *self.now;
        // Both brackets of the secant: the first guess, and its neighbour.
        let shortest = 16.0 * f64::EPSILON * t.max(h);
        let mut length = (s * h).max(shortest);
        let mut best: Option<(f64, Attempt<N>)> = None;
        let mut previous: Option<(f64, f64)> = None;
        for _ in 0..8 {
            work.evaluations += M::EVALUATIONS;
            let Some(shorter) = M::attempt(self.system, t, &y, self.slope, length) else { break };
            let value = opening(&shorter.y);
            let slope = match previous {
                Some((at, old)) if at != length => (value - old) / (length - at),
                _ => {
                    // Relative speed of the walls from the step's own end slopes.
                    let ahead: [f64; N] = std::array::from_fn(|i| shorter.y[i] + 1e-6 * h * shorter.slope[i]);
                    (opening(&ahead) - value) / (1e-6 * h)
                }
            };
            previous = Some((length, value));
            best = Some((length, shorter));
            let next = length - value / slope;
            if !(next > 0.0 && next <= h) || (next - length).abs() <= 4.0 * f64::EPSILON * t.max(h) {
                break;
            }
            length = next;
        }
        // None where the equations of an implicit step have no solution, which takes numbers that are not finite.
        let (length, shorter) = best.ok_or(SolverError::NonFinite { t })?;
        Ok((length, shorter, Some(side)))
    }

    /// `+1` where a contact ends when the indentation falls through zero, `-1` where one begins when it rises.
    fn open_sign(&self, side: Side) -> f64 {
        if self.contact == Some(side) { 1.0 } else { -1.0 }
    }

    /// The quantity whose zero ends the present phase, as a polynomial over the step: the gap in flight, the indentation in contact.
    fn open_polynomial(&self, side: Side, h: f64, attempt: &Attempt<N>) -> Polynomial<2> {
        let (i, sign) = (side as usize, self.open_sign(side));
        let z = |y: &[f64; N]| sign * self.system.indentation(y)[i];
        let origin = z(&[0.0; N]);
        let mut p = [0.0; 8];
        p[0] = z(&self.now.y).max(0.0);
        if self.leaving && p[0].abs() < 1e-9 {
            p[0] = 0.0;
        }
        for (c, dense) in p[1..].iter_mut().zip(&attempt.dense) {
            *c = h * (z(dense) - origin); // the indentation is affine in the state
        }
        Polynomial::new(&p)
    }
}
