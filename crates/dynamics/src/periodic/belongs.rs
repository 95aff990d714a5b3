//! Which branch a motion lies on.

use super::branches::Branches;
use super::orbit::Orbit;
use super::settle::{SAME, is_same};
use super::shooting::{Shooting, Solution};
use super::trace::trace;
use nalgebra::DVector;
use std::ops::Range;

/// A branch farther than this from a motion is not tried, in units of the motion's size.
const FAR: f64 = 0.3;
/// If Newton's iteration fails for a branch nearer than this, the motion is continued to the adjacent points of the branch: beside a
/// grazing at a nearly hard wall the iteration converges only from very near.
const CLOSE: f64 = 1e-2;
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Branches {
    /// The number of the branch that a motion lies on; none if it is on none.
    pub fn holds(&self, shooting: &Shooting, motion: &Solution) -> Option<usize> {
        self.holds_among(shooting, motion, 0..self.branches.len())
    }

    /// [`Self::holds`] among some branches.
    pub(super) fn holds_among(
        &self,
        shooting: &Shooting,
        motion: &Solution,
        numbers: Range<usize>,
    ) -> Option<usize> {
        let value = shooting.value(&motion.x);
        let is_here = |(_, pair, guess): &(usize, &[Orbit], DVector<f64>)| {
            let gap = shooting.nearest(guess, &motion.x).1;
            gap < FAR
                && (shooting.correct_at_value(guess).is_some_and(|found| is_same(shooting, &found, motion))
                    || gap < CLOSE && leads_to(shooting, motion, pair))
        };
        self.near(shooting, value, numbers).find(is_here).map(|(number, ..)| number)
    }

    /// The motions on all branches of as many periods at a value.
    pub(super) fn at(&self, shooting: &Shooting, value: f64) -> Vec<Solution> {
        self.near(shooting, value, 0..self.branches.len())
            .filter_map(|(.., guess)| shooting.correct_at_value(&guess))
            .collect()
    }

    /// Where branches of as many periods pass a value: the branch's number, the points on either side, and the unknowns interpolated
    /// between them.
    fn near<'a>(
        &'a self,
        shooting: &'a Shooting,
        value: f64,
        numbers: Range<usize>,
    ) -> impl Iterator<Item = (usize, &'a [Orbit], DVector<f64>)> + 'a {
        let branches = numbers.map(|number| (number, &self.branches[number]));
        // At an end of the range a value may be off by the rounding of its unknown.
        let off = move |orbit: &Orbit| {
            let off = orbit.value - value;
            if off.abs() <= ROUNDING * value.abs() { 0.0 } else { off }
        };
        branches.filter(|(_, branch)| branch.shooting.periods == shooting.periods).flat_map(
            move |(number, branch)| {
                let around = move |pair: &&[Orbit]| off(&pair[0]) * off(&pair[1]) <= 0.0;
                branch.points.windows(2).filter(around).map(move |pair| {
                    let [a, b] = [pair[0].value, pair[1].value];
                    let share = if a == b { 0.0 } else { (value - a) / (b - a) };
                    let [x, y] = [&pair[0], &pair[1]].map(|orbit| shooting.unknowns(&orbit.states, value));
                    (number, pair, &x + (y - &x) * share)
                })
            },
        )
    }
}

/// Whether the branch through a motion leads to one of the two points of `pair`, one on either side of it.
fn leads_to(shooting: &Shooting, motion: &Solution, pair: &[Orbit]) -> bool {
    let [a, b] = [pair[0].value, pair[1].value];
    let Some(branch) = trace(shooting, motion, [a.min(b), a.max(b)], &|| true) else { return false };
    let ends = [branch.points.first(), branch.points.last()].into_iter().flatten();
    let unknowns = |orbit: &Orbit| shooting.unknowns(&orbit.states, orbit.value);
    let is_met = |end: &Orbit| {
        pair.iter().any(|orbit| {
            orbit.value == end.value && shooting.nearest(&unknowns(orbit), &unknowns(end)).1 < SAME
        })
    };
    ends.into_iter().any(is_met)
}
