//! How the force of a contact moves the linear system: `A^k b` and `g_k`, and for how long few terms suffice.

use super::lossy_rule::Loss;
use super::undisturbed::DURATION;
use crate::linear::flow::Flow;
use crate::motion::knot::Knot;
use crate::motion::linearised::MOMENTS;
use crate::system::LinearSystem;
use retune_model::{Coupled, RegularisedContact, Side};

/// The data of all contacts with one wall.
pub struct Collisions {
    pub equations: RegularisedContact,
    /// Their loss.
    pub loss: Option<Loss>,
    pub side: Side,
    /// Position of that wall relative to the structure, m.
    pub wall: f64,
    /// `A^k b`.
    pub kicks: [[f64; 4]; MOMENTS],
    /// `g_k`.
    pub gains: [f64; MOMENTS],
    /// Longest contact (s) for which the terms up to the k-th are exact.
    pub longest: [f64; MOMENTS],
    /// Error allowed, relative to the touch-down speed.
    pub rtol: f64,
    /// P, N.
    pub amplitude: f64,
}

/// The duration of any collision relative to the undisturbed one is expected to be less: later bends of the force are ignored.
const LONGEST: f64 = 2.0;

/// Blocks of four terms of the free motion's Taylor series, and the largest `rate t` for which they are exact:
/// `0.3¹² / 12! = 1e-15`.
pub const FREE: usize = 3;
const BRIEF: f64 = 0.3;

impl Collisions {
    /// The latest end (s) of a contact that begins at `touch`, if it is nearly an undisturbed collision.
    pub fn latest_end(&self, touch: &Knot<4>) -> f64 {
        let speed = self.side.sign() * (touch.y[3] - touch.y[1]);
        touch.t + LONGEST * DURATION * self.equations.greatest_depth(speed).powi(2) / speed
    }

    /// Prepares for contacts with `side`, each to be computed with an error of `rtol` relative to its touch-down speed.
    pub fn new(system: &Coupled, side: Side, flow: &Flow<4>, rtol: f64) -> Self {
        let (columns, sign) = (flow.linear().columns, side.sign());
        let mut kicks = [[0.0; 4]; MOMENTS];
        kicks[0] = system.derivative_under([0.0; 2], &system.rest(), -sign * system.hertz(side));
        for k in 1..MOMENTS {
            let mut next = [0.0; 4];
            for (column, weight) in columns.iter().zip(kicks[k - 1]) {
                for i in 0..4 {
                    next[i] += column[i] * weight;
                }
            }
            kicks[k] = next;
        }
        let gains = kicks.map(|kick| -sign * (kick[2] - kick[0]));
        // The terms left out, relative to the first: `2 g_k t^(k-1) / (k + 1)! g_1` (the double integral of a constant is t²/2).
        let limit = |k: usize| {
            let factorial = (1..=k + 1).product::<usize>() as f64;
            (0.1 * rtol * gains[1] * factorial / (2.0 * gains[k].abs())).powf(1.0 / (k - 1) as f64)
        };
        let brief = BRIEF / flow.linear().rate;
        let mut longest = [0.0; MOMENTS];
        let mut least = brief;
        for terms in (2..MOMENTS - 1).rev() {
            least = least.min(limit(terms + 1));
            longest[terms] = least;
        }
        let equations = system.regularised_contact(side);
        let amplitude = system.amplitude();
        let loss = Loss::of(&equations);
        Self { equations, loss, side, wall: system.wall(side), kicks, gains, longest, rtol, amplitude }
    }
}
