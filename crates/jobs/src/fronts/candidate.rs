//! A design of `fronts`, evaluated on the samples of the study of fronts, and its comparison with others.

use crate::certify::Verdict;
use crate::columns;
use crate::needs::Largest;
use retune_model::{Design, Measure, Parameter};
use retune_report::cells;
use retune_report::table::Cell;
use retune_study::Sweep;
use std::cmp::Ordering;
use std::fmt::Display;

/// E1max that differs by less than this share is the same.
pub const SAME: f64 = 0.01;

/// The verdict of a design that a descent found, until it is judged.
pub(super) const CONTINUED: &str = "not certified";

/// A damper under a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Under {
    pub damper: usize,
    pub sweep: Sweep,
    /// The bound, in the unit of the sweep.
    pub bound: f64,
}

impl Under {
    /// Its name in the journal.
    pub(super) fn name(&self) -> String {
        format!("{} {} {}", self.damper, self.sweep.name(), self.bound)
    }
}

/// A bound in words: `k2 at most 400 N/m`.
pub(super) fn at_most(sweep: Sweep, bound: impl Display) -> String {
    format!("{} at most {bound} {}", sweep.name(), sweep.unit())
}

/// A design, evaluated on the samples of the study of fronts.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub damper: usize,
    pub at: Design,
    /// The worst E1max over the band, J.
    pub e1_max: f64,
    /// The same on the samples of the second evaluation, J, if there was one.
    pub checked: Option<f64>,
    /// The largest stroke (spring deflection |x2 - x1 - D|) in any run, m.
    pub stroke: f64,
    /// The largest contact force in any run, N.
    pub force: f64,
    pub verdict: &'static str,
    /// The reason for it, if it has a certificate.
    pub reason: String,
    /// What it needs and what the structure does, if it has a certificate.
    pub needs: Option<Largest>,
}

impl Candidate {
    /// By how much it is beyond a bound, as a share of it.
    pub fn excess(&self, Under { sweep, bound, .. }: Under) -> f64 {
        (self.reached(sweep) / bound - 1.0).max(0.0)
    }

    /// Whether it is of the damper and keeps the bound.
    pub fn keeps(&self, under: Under) -> bool {
        self.damper == under.damper && self.excess(under) == 0.0
    }

    /// The value of a bounded quantity, in its unit.
    pub fn reached(&self, sweep: Sweep) -> f64 {
        match sweep {
            Sweep::K2 => self.at.get(Parameter::K2),
            Sweep::Stroke => self.stroke,
            Sweep::ContactForce => self.force,
        }
    }

    /// The worst E1max over the band on the finest samples that it was looked at on, J.
    pub fn known(&self) -> f64 {
        self.checked.unwrap_or(self.e1_max)
    }

    /// Whether E1max rises on more samples by more than what is the same.
    pub fn rises(&self) -> bool {
        self.checked.is_some_and(|checked| checked > (1.0 + SAME) * self.e1_max)
    }

    /// Whether its certificate says that other starts than rest lead to much more.
    pub fn is_unsafe(&self) -> bool {
        self.verdict == Verdict::FromRest.name()
    }

    /// Whether it is of the same damper and each parameter is within a twentieth, or a centimetre.
    pub fn is_nearly(&self, other: &Self) -> bool {
        let near = |parameter: Parameter| {
            let [a, b] = [self, other].map(|design| design.at.get(parameter));
            // A gap is left out where there is no wall, anything else where it is that of the study.
            let same = if parameter.is_gap() { a.is_nan() && b.is_nan() } else { a.is_nan() || b.is_nan() };
            same || (a - b).abs() <= (0.05 * a.abs().max(b.abs())).max(0.01)
        };
        self.damper == other.damper && Parameter::VARIED.into_iter().all(near)
    }

    /// Whether it dominates `other`: is as good in E1max, stroke, force and k2, and better in one of them.
    pub fn dominates(&self, other: &Self) -> bool {
        let all = |design: &Self| [design.e1_max, design.stroke, design.force, design.at.get(Parameter::K2)];
        let pairs = || all(self).into_iter().zip(all(other));
        pairs().all(|(own, other)| own <= other) && pairs().any(|(own, other)| own < other)
    }

    /// The names of its columns in a table with these parameters.
    pub fn names(parameters: &[Parameter]) -> Vec<&'static str> {
        let reached = [Measure::Stroke, Measure::ContactForce].map(Measure::name);
        [&["E1max", "E1max_check"], &*columns::symbols(parameters), &reached].concat()
    }

    /// Its cells there.
    pub fn cells(&self, parameters: &[Parameter]) -> Vec<Cell> {
        let design = columns::cells_of(&self.at, parameters);
        [cells![self.e1_max, self.checked], design, cells![self.stroke, self.force]].concat()
    }
}

/// The design that keeps a bound first, then that which is beyond it by less.
pub fn by_excess(a: &Candidate, b: &Candidate, under: Under) -> Ordering {
    a.excess(under).total_cmp(&b.excess(under)).then(a.known().total_cmp(&b.known()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_report::table::line;

    #[test]
    fn regress_gaps_of_a_damper_without_walls_are_empty_fields() {
        let value = |parameter| match parameter {
            Parameter::K2 => 215.0,
            Parameter::C2 => 35.0,
            _ => f64::NAN,
        };
        let (at, verdict, reason) = (Design::new(value).expect("a design"), "steady", String::new());
        let (damper, checked, needs) = (0, None, None);
        let [e1_max, stroke, force] = [600.0, 0.5, 0.0];
        let design = Candidate { damper, at, e1_max, checked, stroke, force, verdict, reason, needs };
        assert_eq!(line(&design.cells(&Parameter::PAPER)), "600,,215,35,,,0.5,0\n");
    }
}
