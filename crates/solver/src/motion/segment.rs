//! A smooth segment of the motion.

use super::form::Form;
use super::knot::{Jet, Knot};

/// A segment of the motion, smooth in its own coordinate `θ`, which runs from 0 to `length`.
pub trait Segment<const N: usize> {
    /// First and last moment.
    fn ends(&self) -> [&Knot<N>; 2];
    /// Length in `θ`.
    fn length(&self) -> f64;
    /// The moment at `θ`.
    fn at(&self, theta: f64) -> Knot<N>;
    /// The moment at time `t` (s) inside the segment.
    fn at_time(&self, t: f64) -> Knot<N>;
    /// Whether it is free of contact forces, even where rounding has left one of its ends inside a wall.
    fn in_flight(&self) -> bool {
        false
    }
    /// The derivatives of the motion at a moment of it, where they are known better than from the equations of the whole system: a fast
    /// part that has decayed leaves a rounding error, which these would mistake for motion.
    fn jet(&self, _at: &Knot<N>) -> Option<Jet<N>> {
        None
    }
    /// The cost of an evaluation in it, relative to the usual one.
    fn cost(&self) -> u64 {
        1
    }
    /// A bound on the energy norm of the motion in it (√J), where one is known.
    fn energy(&self) -> f64 {
        f64::INFINITY
    }
    /// A bound on the deviation of a quantity from the quintic that meets its value, slope and curvature (with respect to `θ`) at two
    /// places `h` apart: `h⁶/46080` times a bound on its sixth derivative between them; a `sharp` bound may cost more. Infinite where they
    /// are too far apart for a bound; `None` for a motion without a known bound.
    fn quintic_error(&self, _form: &Form<N>, _ends: [&Knot<N>; 2], _h: f64, _sharp: bool) -> Option<f64> {
        None
    }
    /// How far a quantity may rise between two places `h` apart above the larger of its values there, given its slopes (with respect to
    /// `θ`) at both: a coarse bound that also holds where [`Self::quintic_error`] is infinite. Infinite for a motion without such a bound.
    fn rise(&self, _form: &Form<N>, _ends: [&Knot<N>; 2], _slopes: [f64; 2], _h: f64) -> f64 {
        f64::INFINITY
    }
}
