//! Observers of events alone.

use super::observer::Observer;
use retune_model::Side;

/// Touch-downs on each wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TouchDowns(pub [u64; 2]);

impl<const N: usize> Observer<N> for TouchDowns {
    fn watches_motion(&self) -> bool {
        false
    }
    fn touch_down(&mut self, _t: f64, side: Side) {
        self.0[side as usize] += 1;
    }
}

/// Times (s) and walls of all touch-downs, in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchDownTimes(pub Vec<(f64, Side)>);

impl<const N: usize> Observer<N> for TouchDownTimes {
    fn watches_motion(&self) -> bool {
        false
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        self.0.push((t, side));
    }
}
