//! A design of `fronts`, evaluated on the samples of its plan, and its comparison with others.

use crate::certify::Verdict;
use crate::columns;
use crate::needs::Largest;
use retune_model::{Design, Measure, Parameter};
use retune_report::cells;
use retune_report::table::Cell;
use retune_study::Sweep;
use std::cmp::Ordering;
use std::fmt::Display;

/// Values of E1max that differ by less than this share count as equal.
pub const SAME: f64 = 0.01;

/// The verdict of a design until it is certified.
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

/// A design, evaluated on the samples of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub damper: usize,
    pub at: Design,
    /// The worst E1max over the band, J.
    pub e1_max: f64,
    /// The worst E1max on the finest samples, J, if it was evaluated on them.
    pub checked: Option<f64>,
    /// The largest stroke (spring deflection |x2 - x1 - D|) in any run, m.
    pub stroke: f64,
    /// The largest contact force in any run, N.
    pub force: f64,
    pub verdict: &'static str,
    /// The reason for it, if it has a certificate.
    pub reason: String,
    /// Its largest values and those of the structure, if it has a certificate.
    pub needs: Option<Largest>,
}

impl Candidate {
    /// The excess over a bound, as a share of it; 0 if it keeps the bound.
    pub fn excess(&self, Under { sweep, bound, .. }: Under) -> f64 {
        (self.reached(sweep) / bound - 1.0).max(0.0)
    }

    /// Whether it belongs to the damper and keeps the bound.
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

    /// The worst E1max over the band on the finest samples evaluated, J.
    pub fn known(&self) -> f64 {
        self.checked.unwrap_or(self.e1_max)
    }

    /// Whether E1max on the finest samples is larger by more than [`SAME`].
    pub fn rises(&self) -> bool {
        self.checked.is_some_and(|checked| checked > (1.0 + SAME) * self.e1_max)
    }

    /// Whether, by its certificate, starts other than rest lead to much larger values.
    pub fn is_unsafe(&self) -> bool {
        self.verdict == Verdict::FromRest.name()
    }

    /// Whether it belongs to the same damper and each parameter differs by at most 5 %; a gap, which may be zero, by 5 % of the largest gap.
    pub fn is_nearly(&self, other: &Self) -> bool {
        let gaps = [self, other].map(|design| [Parameter::D, Parameter::C].map(|gap| design.at.get(gap)));
        let largest_gap = gaps.as_flattened().iter().copied().fold(0.0, f64::max);
        let near = |parameter: Parameter| {
            let [a, b] = [self, other].map(|design| design.at.get(parameter));
            // A gap is NaN where there is no wall, any other parameter where it is the study's.
            let same = if parameter.is_gap() { a.is_nan() && b.is_nan() } else { a.is_nan() || b.is_nan() };
            let size = if parameter.is_gap() { largest_gap } else { a.abs().max(b.abs()) };
            same || (a - b).abs() <= 0.05 * size
        };
        self.damper == other.damper && Parameter::VARIED.into_iter().all(near)
    }

    /// Whether it dominates `other`: no worse in E1max, stroke, force and k2, and better in one of them.
    pub fn dominates(&self, other: &Self) -> bool {
        let all = |design: &Self| [design.known(), design.stroke, design.force, design.at.get(Parameter::K2)];
        let pairs = || all(self).into_iter().zip(all(other));
        pairs().all(|(own, other)| own <= other) && pairs().any(|(own, other)| own < other)
    }

    /// The names of its columns in a table with these parameters.
    pub fn names(parameters: &[Parameter]) -> Vec<&'static str> {
        let reached = [Measure::Stroke, Measure::ContactForce].map(Measure::name);
        [&["E1max", "E1max_check"], &*columns::symbols(parameters), &reached].concat()
    }

    /// Its cells in such a table.
    pub fn cells(&self, parameters: &[Parameter]) -> Vec<Cell> {
        let design = columns::cells_of(&self.at, parameters);
        [cells![self.e1_max, self.checked], design, cells![self.stroke, self.force]].concat()
    }
}

/// Orders designs by their excess over a bound, then by E1max.
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
