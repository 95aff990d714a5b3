//! What a run is looked at with. Methods hand over their motion piece by piece; observers keep what was asked for.

use crate::flow::LANES;
pub use crate::peak::Peak;
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
}

/// A stretch of the motion known at its knots; what lies between them is computed for who asks.
pub trait Path<const N: usize> {
    /// Number of pieces, one less than there are knots, of which there are at most [`MOST_KNOTS`].
    fn pieces(&self) -> usize;
    /// Visits the states at the knots in their order.
    fn states(&self, visit: impl FnMut(&[f64; N]));
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

/// A quantity that depends on the force and the state.
pub trait Quantity<const N: usize> {
    /// Its value with its first two time derivatives. The value itself must depend on the state alone: between the ends of a
    /// [`Path`] it is asked for without the force.
    fn rates(&self, drive: Drive, y: &[f64; N]) -> [f64; 3];
    /// The same at moments of flight, side by side.
    #[inline(always)]
    fn rates_in_flight(&self, drive: &[f64x4; 2], y: &[f64x4; N]) -> [f64x4; 3] {
        let mut rates = [f64x4::ZERO; 3];
        for lane in 0..LANES {
            let at = self.rates(drive.map(|c| c.to_array()[lane]), &y.map(|c| c.to_array()[lane]));
            for (all, one) in rates.iter_mut().zip(at) {
                all.as_mut_array()[lane] = one;
            }
        }
        rates
    }
}

impl<F: Fn(Drive, &[f64; N]) -> [f64; 3], const N: usize> Quantity<N> for F {
    #[inline(always)]
    fn rates(&self, drive: Drive, y: &[f64; N]) -> [f64; 3] {
        self(drive, y)
    }
}
