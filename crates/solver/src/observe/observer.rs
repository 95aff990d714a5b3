//! Observers: a method passes on its motion segment by segment, and each observer keeps its own result.

use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::form::Form;
use crate::motion::knot::Knot;
use crate::motion::linearised::LinearContact;
use crate::motion::segment::Segment;
use retune_model::Side;

/// A stretch of the motion known at its knots; the segments between them are computed only on request.
pub trait Path<const N: usize> {
    /// Number of segments, one less than there are knots, of which there are at most [`MOST_KNOTS`].
    fn pieces(&self) -> usize;
    /// Visits the times (s, since the first) and states at the knots in their order.
    fn states(&self, visit: &mut dyn FnMut(f64, &[f64; N]));
    /// The states at both ends.
    fn ends(&self) -> [&[f64; N]; 2];
    /// A bound on how far a quantity that depends on the state alone exceeds the larger of its values at both ends; infinite where none is
    /// known.
    fn rise(&self, form: &Form<N>) -> f64;
    /// A bound on the second time derivative of a quantity that depends on the state alone; infinite where none is known.
    fn second_derivative(&self, form: &Form<N>) -> f64;
    /// A bound on the first time derivative of a quantity; infinite where none is known.
    fn first_derivative(&self, form: &Form<N>) -> f64;
    /// Visits the motion from a knot to the next one.
    fn show(&self, piece: usize, visit: &mut dyn FnMut(Part<'_, N>));
    /// The contact linearised for small changes, with the effect of a small loss if requested.
    fn linearised(&self, loss: bool) -> LinearContact;
}

/// A part of a [`Path`], as observers see it.
pub enum Part<'a, const N: usize> {
    /// A segment of the motion.
    Segment(&'a dyn Segment<N>),
    /// The slope of the force jumps: see [`Observer::discontinuity`].
    Discontinuity,
}

/// Limit on knots of a [`Path`].
pub const MOST_KNOTS: usize = 26;

/// An impact with a rigid wall: the state jumps.
#[derive(Clone, Copy, Debug)]
pub struct Impact<const N: usize> {
    /// The wall.
    pub side: Side,
    /// The moment before it.
    pub before: Knot<N>,
    /// The moment after it, at the same time.
    pub after: Knot<N>,
    /// Whether the wall holds the damper from now on.
    pub caught: bool,
    /// Whether the damper only grazes the wall: it touches it without a speed, and is not pressed on it.
    pub grazes: bool,
}

/// Observes a run. Pairs of observers (nested to any depth), arrays and `Option`s of observers are observers, too.
pub trait Observer<const N: usize> {
    /// Whether it observes the motion. An observer of events alone sets this to `false`, and no segment is computed for it.
    fn watches_motion(&self) -> bool {
        true
    }
    /// A segment of the motion has been computed.
    fn segment(&mut self, _segment: &dyn Segment<N>) {}
    /// Several segments at once. To process them one by one is always correct.
    #[inline(always)]
    fn path(&mut self, path: &dyn Path<N>) {
        if self.watches_motion() {
            for piece in 0..path.pieces() {
                path.show(piece, &mut |part| self.see(part));
            }
        }
    }
    /// A part of a path.
    fn see(&mut self, part: Part<'_, N>) {
        match part {
            Part::Segment(segment) => self.segment(segment),
            Part::Discontinuity => self.discontinuity(),
        }
    }
    /// Several whole steps of an exact flow at once. To process them one by one is always correct.
    #[inline(always)]
    fn steps(&mut self, steps: &Steps<'_, N>) {
        if self.watches_motion() {
            for number in 0..steps.count() {
                self.segment(&steps.step(number));
            }
        }
    }
    /// Whether these pieces of a record provably do not affect its result: they are then not passed on.
    #[inline(always)]
    fn skips(&self, _block: &Block<N>) -> bool {
        !self.watches_motion()
    }
    /// The damper has touched a wall at time `t` (s).
    fn touch_down(&mut self, _t: f64, _side: Side) {}
    /// The damper has struck a rigid wall: between two segments the state jumps.
    fn impact(&mut self, _impact: &Impact<N>) {}
    /// Whether it needs every piece of a contact: contacts in steps are then integrated by DOP853, a contact that loses energy is never
    /// collocated, and no contact leaves out the fast part of a strong dashpot.
    fn follows_contacts(&self) -> bool {
        false
    }
    /// The force or its slope jumps between two segments, or a fast part of the motion is left out from here on: rates before and after
    /// differ.
    fn discontinuity(&mut self) {}
    /// Whether the run may stop here. It stops as soon as one of several observers says so.
    fn satisfied(&self) -> bool {
        false
    }
    /// Its work so far, in units of some 10 ns of a current processor.
    fn search_work(&self) -> u64 {
        0
    }
}

/// An observer that ignores the motion: for the transient before a window.
pub struct Unobserved;

impl<const N: usize> Observer<N> for Unobserved {
    fn watches_motion(&self) -> bool {
        false
    }
}

impl<const N: usize, A: Observer<N>, B: Observer<N>> Observer<N> for (A, B) {
    fn watches_motion(&self) -> bool {
        self.0.watches_motion() || self.1.watches_motion()
    }
    #[inline(always)]
    fn segment(&mut self, segment: &dyn Segment<N>) {
        self.0.segment(segment);
        self.1.segment(segment);
    }
    #[inline(always)]
    fn path(&mut self, path: &dyn Path<N>) {
        self.0.path(path);
        self.1.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, N>) {
        self.0.steps(steps);
        self.1.steps(steps);
    }
    fn skips(&self, block: &Block<N>) -> bool {
        self.0.skips(block) && self.1.skips(block)
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        self.0.touch_down(t, side);
        self.1.touch_down(t, side);
    }
    fn impact(&mut self, impact: &Impact<N>) {
        self.0.impact(impact);
        self.1.impact(impact);
    }
    fn follows_contacts(&self) -> bool {
        self.0.follows_contacts() || self.1.follows_contacts()
    }
    fn discontinuity(&mut self) {
        self.0.discontinuity();
        self.1.discontinuity();
    }
    fn satisfied(&self) -> bool {
        self.0.satisfied() || self.1.satisfied()
    }
    fn search_work(&self) -> u64 {
        self.0.search_work() + self.1.search_work()
    }
}

impl<const N: usize, O: Observer<N> + ?Sized> Observer<N> for &mut O {
    fn watches_motion(&self) -> bool {
        (**self).watches_motion()
    }
    #[inline(always)]
    fn segment(&mut self, segment: &dyn Segment<N>) {
        (**self).segment(segment);
    }
    #[inline(always)]
    fn path(&mut self, path: &dyn Path<N>) {
        (**self).path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, N>) {
        (**self).steps(steps);
    }
    fn skips(&self, block: &Block<N>) -> bool {
        (**self).skips(block)
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        (**self).touch_down(t, side);
    }
    fn impact(&mut self, impact: &Impact<N>) {
        (**self).impact(impact);
    }
    fn follows_contacts(&self) -> bool {
        (**self).follows_contacts()
    }
    fn discontinuity(&mut self) {
        (**self).discontinuity();
    }
    fn satisfied(&self) -> bool {
        (**self).satisfied()
    }
    fn search_work(&self) -> u64 {
        (**self).search_work()
    }
}

/// Implements [`Observer`] for a container by forwarding every call to each observer in it.
macro_rules! for_each_in {
    ($container:ty $(, const $count:ident)?) => {
        impl<const N: usize, O: Observer<N>, $(const $count: usize)?> Observer<N> for $container {
            fn watches_motion(&self) -> bool {
                self.iter().any(|observer| observer.watches_motion())
            }
            fn segment(&mut self, segment: &dyn Segment<N>) {
                self.iter_mut().for_each(|observer| observer.segment(segment));
            }
            fn path(&mut self, path: &dyn Path<N>) {
                self.iter_mut().for_each(|observer| observer.path(path));
            }
            fn steps(&mut self, steps: &Steps<'_, N>) {
                self.iter_mut().for_each(|observer| observer.steps(steps));
            }
            fn skips(&self, block: &Block<N>) -> bool {
                self.iter().all(|observer| observer.skips(block))
            }
            fn touch_down(&mut self, t: f64, side: Side) {
                self.iter_mut().for_each(|observer| observer.touch_down(t, side));
            }
            fn impact(&mut self, impact: &Impact<N>) {
                self.iter_mut().for_each(|observer| observer.impact(impact));
            }
            fn follows_contacts(&self) -> bool {
                self.iter().any(|observer| observer.follows_contacts())
            }
            fn discontinuity(&mut self) {
                self.iter_mut().for_each(Observer::discontinuity);
            }
            fn satisfied(&self) -> bool {
                self.iter().any(|observer| observer.satisfied())
            }
            fn search_work(&self) -> u64 {
                self.iter().map(Observer::search_work).sum()
            }
        }
    };
}

for_each_in!([O; K], const K);
for_each_in!(Option<O>);
