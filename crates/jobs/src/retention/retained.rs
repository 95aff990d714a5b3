//! The results of `retention`, and the selection shown on its page.

use super::curves::Curve;
use super::force::Forced;
use super::trade::{Point, front};
use super::tuned::{Tuned, Tuning};
use crate::designs::Designs;
use retune_model::Parameter;
use retune_study::{SpringBounds, Study};

/// Dampers count as equal if E1max of all their tunings differs by at most this share.
pub(super) const EQUAL: f64 = 1e-3;

/// Dampers tuned for several stiffnesses of the structure, and the retention of each tuning.
#[derive(Debug)]
pub struct Retained {
    /// Each damper with its designs.
    pub dampers: Vec<Tuned>,
    /// How the bounds on k2 depend on k1 in re-tuning.
    pub bounds: SpringBounds,
    /// E1max along k1.
    pub curves: Vec<Curve>,
    /// E1max of the nominal designs under smaller forces.
    pub forced: Vec<Forced>,
    /// The kept designs, with their ranges.
    pub kept: Vec<Point>,
    /// The designs between the nominal ones and those with the widest ranges.
    pub points: Vec<Point>,
    /// All designs as a table.
    pub table: Designs,
}

impl Retained {
    pub(super) fn name(&self, damper: usize) -> &str {
        &self.dampers[damper].name
    }

    /// The study of the first damper, named in figures.
    pub(super) fn study(&self) -> Option<&Study> {
        self.dampers.first().map(Tuned::study)
    }

    pub(super) fn varies_mass(&self) -> bool {
        self.dampers.iter().any(|damper| damper.study().varied().contains(&Parameter::M2))
    }

    /// The designs of a damper that no other dominates, the least E1max first.
    pub(super) fn front(&self, damper: usize) -> Vec<&Point> {
        front(&self.points, damper)
    }

    /// Pairs of dampers with equal E1max for all tunings, the later one second.
    pub(super) fn same(&self) -> Vec<(usize, usize)> {
        let energies = |damper: usize| -> Vec<f64> {
            let rows = self.table.rows.iter().filter(|row| row.damper == self.name(damper));
            rows.filter(|row| Tuning::GIVEN.iter().all(|given| row.label != given.name()))
                .map(|row| row.e1_max)
                .collect()
        };
        let equal = |one: usize, other: usize| {
            let (one, other) = (energies(one), energies(other));
            one.len() == other.len() && one.iter().zip(&other).all(|(a, b)| (a / b - 1.0).abs() <= EQUAL)
        };
        let count = self.dampers.len();
        let later = |damper: usize| (damper + 1..count).find(|other| equal(damper, *other));
        (0..count).filter_map(|damper| Some((damper, later(damper)?))).collect()
    }

    /// The dampers shown: all but those equal to a later one.
    pub(super) fn shown(&self) -> Vec<usize> {
        let same = self.same();
        (0..self.dampers.len()).filter(|damper| same.iter().all(|(one, _)| one != damper)).collect()
    }

    /// Whether a kept design is shown: a given one may be in several studies and is shown with the first only.
    pub(super) fn is_new(&self, damper: usize, tuning: Tuning) -> bool {
        let at = self.dampers[damper].of(tuning);
        !Tuning::GIVEN.contains(&tuning)
            || self.dampers[..damper].iter().all(|earlier| earlier.of(tuning) != at)
    }

    pub(super) fn shown_kept(&self) -> Vec<&Point> {
        let shown = self.shown();
        let is_shown =
            |point: &&Point| shown.contains(&point.damper) && self.is_new(point.damper, point.tuning);
        self.kept.iter().filter(is_shown).collect()
    }
}
