//! A smooth piece of the motion.

use super::form::Form;
use super::knot::Knot;

/// A piece of the motion on which it is smooth in its own coordinate `θ`, from 0 to `length`.
pub trait Segment<const N: usize> {
    /// First and last moment.
    fn ends(&self) -> [&Knot<N>; 2];
    /// Length in `θ`.
    fn length(&self) -> f64;
    /// The moment at `θ`.
    fn at(&self, theta: f64) -> Knot<N>;
    /// The moment at time `t` (s) inside the piece.
    fn at_time(&self, t: f64) -> Knot<N>;
    /// Whether no wall pushes in it, not even where rounding has left an end of it inside one.
    fn in_flight(&self) -> bool {
        false
    }
    /// How far a quantity may leave the quintic that meets its value, slope and curvature (with respect to `θ`) at two places `h`
    /// apart: `h⁶/46080` times a bound on its sixth derivative between them; a `sharp` bound may cost more. Infinite where they are
    /// too far apart to say; `None` for a motion that is not known well enough to say.
    fn quintic_error(&self, _form: &Form<N>, _ends: [&Knot<N>; 2], _h: f64, _sharp: bool) -> Option<f64> {
        None
    }
}
