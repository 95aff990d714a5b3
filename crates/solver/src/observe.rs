//! What a run is looked at with. Methods hand over their motion piece by piece; observers keep what was asked for.

pub use crate::peak::Peak;
pub use crate::quantity::{BareEnergy, DamperEnergy, Form, PrimaryEnergy, Quantity, RelativePosition};
use crate::steps::Steps;
use retune_model::{Drive, Side};
use wide::f64x4;

/// A moment of the motion.
#[derive(Clone, Copy, Debug)]
pub struct Knot<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// `[P cos ωt, P sin ωt]`, N.
    pub drive: Drive,
    /// State.
    pub y: [f64; N],
    /// `[dt/dθ, d²t/dθ²]`: how time runs in the coordinate in which the piece is smooth. `[1, 0]` where that is time itself.
    pub clock: [f64; 2],
}

impl<const N: usize> Knot<N> {
    /// A quantity with its first two time derivatives at this moment, of flight or not.
    #[inline(always)]
    pub fn rates(&self, quantity: &impl Quantity<N>, in_flight: bool) -> [f64; 3] {
        if in_flight {
            let (drive, y) = (self.drive.map(f64x4::splat), self.y.map(f64x4::splat));
            quantity.rates_in_flight(&drive, &y).map(|lanes| lanes.to_array()[0])
        } else {
            quantity.rates(self.drive, &self.y)
        }
    }
}

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

/// A stretch of the motion known at its knots; what lies between them is computed for who asks.
pub trait Path<const N: usize> {
    /// Number of pieces, one less than there are knots, of which there are at most [`MOST_KNOTS`].
    fn pieces(&self) -> usize;
    /// Visits the times (s, since the first) and states at the knots in their order.
    fn states(&self, visit: impl FnMut(f64, &[f64; N]));
    /// A bound on the second time derivative of a quantity; infinite where none is known.
    fn second_derivative(&self, form: &Form<N>) -> f64;
    /// Shows the piece that follows a knot.
    fn show(&self, piece: usize, observer: &mut impl Observer<N>);
}

/// Most knots of a [`Path`].
pub const MOST_KNOTS: usize = 18;

/// Follows a run.
pub trait Observer<const N: usize> {
    /// A piece of the motion has been computed.
    fn segment(&mut self, segment: &impl Segment<N>);
    /// Many pieces at once. To look at them one by one is always right.
    fn path(&mut self, path: &impl Path<N>)
    where
        Self: Sized,
    {
        for piece in 0..path.pieces() {
            path.show(piece, self);
        }
    }
    /// Some whole steps of an exact flow at once. To look at them one by one is always right.
    fn steps(&mut self, steps: &Steps<'_, N>)
    where
        Self: Sized,
    {
        for number in 0..steps.count() {
            self.segment(&steps.step(number));
        }
    }
    /// The damper has touched a wall.
    fn touch_down(&mut self, _t: f64, _side: Side) {}
    /// Nothing that can still happen will change what is kept: the run may end here.
    fn satisfied(&self) -> bool {
        false
    }
}

/// Sees nothing: for the transient before a window.
pub struct Unobserved;

impl<const N: usize> Observer<N> for Unobserved {
    fn segment(&mut self, _segment: &impl Segment<N>) {}
    fn path(&mut self, _path: &impl Path<N>) {}
    fn steps(&mut self, _steps: &Steps<'_, N>) {}
}
