//! A motion on a branch, with the direction of the branch and the test functions of bifurcations.

use super::forced::Forced;
use super::orbit::Orbit;
use super::shooting::{Linearised, Shooting, Solution};
use nalgebra::{Complex, DVector, Matrix6};

/// A motion on a branch, with the direction of the branch.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub solution: Solution,
    pub direction: DVector<f64>,
    pub orbit: Orbit,
    /// Test functions that change sign at a fold, a crossing of branches, a period doubling and a Neimark–Sacker bifurcation; exactly 0 at
    /// one that is a start or an end.
    pub tests: [f64; 4],
}

impl Node {
    pub(super) fn new(
        shooting: &Shooting<impl Forced>,
        solution: Solution,
        before: &DVector<f64>,
    ) -> Option<Self> {
        let (direction, crossing) = shooting.tangent(&solution.at, before)?;
        let orbit = Orbit::of(shooting, &solution).ok()?;
        let [doubling, circle] = on_circle(&orbit, &solution.at);
        let tests = [direction[direction.len() - 1], crossing, doubling, circle];
        Some(Self { solution, direction, orbit, tests })
    }

    /// The motion of half the periods with these states, repeated twice: two branches meet in it at a period doubling.
    pub(super) fn doubled(
        shooting: &Shooting<impl Forced>,
        half: &[[f64; 4]],
        value: f64,
        direction: DVector<f64>,
    ) -> Option<Self> {
        let x = shooting.unknowns(&half.repeat(2), value);
        let solution = Solution { at: shooting.linearised(&x).ok()?, x, iterations: 0 };
        let orbit = Orbit::of(shooting, &solution).ok()?;
        let [doubling, circle] = on_circle(&orbit, &solution.at);
        Some(Self { solution, direction, orbit, tests: [0.0, 0.0, doubling, circle] })
    }

    /// This motion with the branch's direction reversed.
    pub(super) fn reversed(self) -> Self {
        let [fold, crossing, doubling, circle] = self.tests;
        Self { direction: -self.direction, tests: [-fold, -crossing, doubling, circle], ..self }
    }

    /// This motion, begun `shift` segments earlier.
    pub(super) fn shifted_back(mut self, shooting: &Shooting<impl Forced>, shift: usize) -> Option<Self> {
        let on = shooting.segments - shift;
        self.solution.x = shooting.shifted(&self.solution.x, on);
        self.direction = shooting.shifted(&self.direction, on);
        self.orbit.states.rotate_right(shift);
        self.orbit.recompute_seen(shooting)?;
        Some(self)
    }

    /// Whether as many multipliers cross the unit circle on the way to another motion as events with these numbers of multipliers account
    /// for.
    pub(super) fn crossings_match(&self, next: &Self, events: impl Iterator<Item = usize>) -> bool {
        let outside =
            |node: &Self| node.orbit.multipliers.iter().filter(|multiplier| multiplier.norm() > 1.0).count();
        let (change, expected) = (outside(self).abs_diff(outside(next)), events.sum::<usize>());
        let at_bifurcation = [self, next].iter().any(|node| node.tests.contains(&0.0));
        at_bifurcation || change <= expected && (expected - change).is_multiple_of(2)
    }
}

/// Test functions that change sign where a multiplier is -1, and where the product of two is 1.
fn on_circle(orbit: &Orbit, at: &Linearised) -> [f64; 2] {
    let doubling: Complex<f64> = orbit.multipliers.iter().map(|multiplier| multiplier + 1.0).product();
    [doubling.re, (at.compound() - Matrix6::identity()).determinant()]
}

/// All pairs of multipliers.
pub(super) fn pairs(orbit: &Orbit) -> impl Iterator<Item = [Complex<f64>; 2]> {
    let all = orbit.multipliers;
    (0..4).flat_map(move |i| (0..i).map(move |j| [all[i], all[j]]))
}

/// The motion at a share of the way between two.
pub(super) fn between(shooting: &Shooting<impl Forced>, [now, next]: [&Node; 2], share: f64) -> Option<Node> {
    let way = &next.solution.x - &now.solution.x;
    let solution = shooting.correct(&(&now.solution.x + &way * share), &way)?;
    Node::new(shooting, solution, &now.direction)
}
