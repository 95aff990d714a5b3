//! A motion on a branch, with the direction of the branch and what changes sign at bifurcations.

use super::forced::Forced;
use super::orbit::Orbit;
use super::shooting::{Shooting, Solution};
use nalgebra::{Complex, DVector};

/// A motion on a branch, with the direction of the branch.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub solution: Solution,
    pub direction: DVector<f64>,
    pub orbit: Orbit,
    pub tests: [f64; 3],
}

impl Node {
    pub(super) fn new(
        shooting: &Shooting<impl Forced>,
        solution: Solution,
        before: &DVector<f64>,
    ) -> Option<Self> {
        let direction = shooting.tangent(&solution.at, before)?;
        let orbit = Orbit::of(shooting, &solution).ok()?;
        let tests = tests(&orbit, &direction);
        Some(Self { solution, direction, orbit, tests })
    }
}

/// What changes sign at a fold, a period doubling and a Neimark–Sacker bifurcation.
pub(super) fn tests(orbit: &Orbit, direction: &DVector<f64>) -> [f64; 3] {
    let one = Complex::new(1.0, 0.0);
    let all = &orbit.multipliers;
    let doubling: Complex<f64> = all.iter().map(|multiplier| multiplier + one).product();
    let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
    let circle: Complex<f64> = pairs.map(|(i, j)| all[i] * all[j] - one).product();
    [direction[direction.len() - 1], doubling.re, circle.re]
}

/// The motion at a share of the way between two.
pub(super) fn between(shooting: &Shooting<impl Forced>, [now, next]: [&Node; 2], share: f64) -> Option<Node> {
    let way = &next.solution.x - &now.solution.x;
    let solution = shooting.correct(&(&now.solution.x + &way * share), &way)?;
    Node::new(shooting, solution, &now.direction)
}
