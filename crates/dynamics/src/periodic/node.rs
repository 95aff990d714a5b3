//! A motion on a branch, with the direction of the branch and what changes sign at bifurcations.

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
    /// What changes sign at a fold, at a crossing of branches, at a period doubling and at a Neimark–Sacker bifurcation; exactly 0 at one that is a
    /// start or an end.
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

    /// The motion of half the periods that begins with these states, taken twice: at a period doubling two branches meet in it.
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

    /// The same motion, from which the branch goes to the other side.
    pub(super) fn turned(self) -> Self {
        let [fold, crossing, doubling, circle] = self.tests;
        Self { direction: -self.direction, tests: [-fold, -crossing, doubling, circle], ..self }
    }

    /// The same motion from the segment on that is so many before its first.
    pub(super) fn moved_back(mut self, shooting: &Shooting<impl Forced>, shift: usize) -> Option<Self> {
        let on = shooting.segments - shift;
        self.solution.x = shooting.moved_on(&self.solution.x, on);
        self.direction = shooting.moved_on(&self.direction, on);
        self.orbit.states.rotate_right(shift);
        self.orbit.seen_anew(shooting)?;
        Some(self)
    }

    /// Whether multipliers leave or enter the unit circle on the way to another motion by as many as events with these numbers of multipliers tell.
    pub(super) fn is_told(&self, next: &Self, events: impl Iterator<Item = usize>) -> bool {
        let outside =
            |node: &Self| node.orbit.multipliers.iter().filter(|multiplier| multiplier.norm() > 1.0).count();
        let (change, told) = (outside(self).abs_diff(outside(next)), events.sum::<usize>());
        let at_bifurcation = [self, next].iter().any(|node| node.tests.contains(&0.0));
        at_bifurcation || change <= told && (told - change).is_multiple_of(2)
    }
}

/// What changes sign where a multiplier is -1, and where the product of two is 1.
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
