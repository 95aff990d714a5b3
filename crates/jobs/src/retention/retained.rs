//! The results of `retention`.

use super::curves::Curve;
use super::force::Forced;
use super::range::Threshold;
use super::trade::Point;
use super::tuned::{Tuned, Tuning};
use crate::designs::Designs;
use retune_study::SpringBounds;

/// Dampers tuned for several stiffnesses of the structure, and how long each tuning lasts.
#[derive(Debug)]
pub struct Retained {
    /// Each damper with its designs.
    pub dampers: Vec<Tuned>,
    /// What became of the bounds on k2 where a damper was tuned anew.
    pub bounds: SpringBounds,
    /// E1max along k1.
    pub curves: Vec<Curve>,
    /// For each damper, what counts as half of the work.
    pub thresholds: Vec<Threshold>,
    /// E1max of the nominal designs under smaller forces.
    pub forced: Vec<Forced>,
    /// The designs that are kept, by the name of their tuning, with their ranges.
    pub kept: Vec<(&'static str, Point)>,
    /// The designs between the nominal ones and those with the widest ranges.
    pub points: Vec<Point>,
    /// All designs as a table.
    pub table: Designs,
}

impl Retained {
    /// Whether the design of a tuning is not that of an earlier damper: the paper's may stand in several studies.
    pub(super) fn is_new(&self, damper: usize, tuning: Tuning) -> bool {
        let at = self.dampers[damper].of(tuning);
        tuning != Tuning::Paper || self.dampers[..damper].iter().all(|earlier| earlier.of(tuning) != at)
    }
}
