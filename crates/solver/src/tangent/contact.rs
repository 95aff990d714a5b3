//! Derivatives through a contact that is followed step by step: an integral equation for the change of the indentation, solved at the nodes of a rule.
//!
//! With `r = x2 - x1`, the slope `κ` of the contact force and `f` what a parameter adds to the accelerations, the variational equations are
//! `δ' = A δ + κ δr (e1/m1 - e2/m2) + f`, the linear part `A` that of flight and `e1`, `e2` unit speeds of the two bodies. The effect of
//! each by `A` alone until the end of the stretch is exact, so `δr` at the nodes solves as many linear equations as there are nodes. In a
//! contact with loss the force changes with `δr'`, too; there `κ δr` as a whole, the change of the force, is the unknown.

use super::flight::Flight;
use super::series::sum;
use crate::contact::collocation::quadrature::gauss;
use crate::motion::segment::Segment;
use nalgebra::{DMatrix, DVector};
use retune_model::{Coupled, Excitation, Parameter, Side};
use std::sync::LazyLock;

/// Carries derivatives by the first state and by parameters over a stretch of a contact.
pub(super) fn carry(
    system: &Coupled,
    flight: &Flight,
    nodes: &Nodes,
    parameters: &[Parameter],
    force_by: impl Fn(usize, f64) -> Excitation,
    by_state: &mut [[f64; 4]; 4],
    by: &mut [[f64; 4]],
) {
    let (n, Gauss { running, whole, .. }) = (NODE_COUNT, &*GAUSS);
    let [m1, m2] = system.masses();
    let seconds = nodes.span[1] - nodes.span[0];
    let side = side(system, nodes);
    let rate = |i: usize| side.sign() * (nodes.states[i][3] - nodes.states[i][1]);
    let slopes = |i: usize| system.contact_slopes(side, nodes.roots[i], rate(i));
    let lossy = system.is_lossy();
    // The row of the unknown, and the force per unit of it.
    let unknown = |i: usize| {
        let [slope, drag] = slopes(i);
        if lossy { [-slope, -drag, slope, drag] } else { [-1.0, 0.0, 1.0, 0.0] }
    };
    let slope = |i: usize| if lossy { 1.0 } else { slopes(i)[0] };
    // The states at the end from unit speeds at each node, and the row that gives `δr` at each node from the state at the end, both by `A`
    // alone.
    let mut kicks = [[[0.0; 4]; 2]; NODE_COUNT];
    let mut rows = [[0.0; 4]; NODE_COUNT];
    for i in 0..n {
        let remaining = seconds - nodes.times[i];
        kicks[i] = [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]].map(|kick| flight.decay(remaining, kick));
        rows[i] = flight.row_decay(-remaining, unknown(i));
    }
    let mut gains = [0, 1].map(|_| [[0.0; NODE_COUNT]; NODE_COUNT]);
    for i in 0..n {
        for j in 0..n {
            let weight = running[i][j] * nodes.rates[j];
            for body in 0..2 {
                let along: f64 = rows[i].iter().zip(&kicks[j][body]).map(|(a, b)| a * b).sum();
                gains[body][i][j] = weight * along;
            }
        }
    }
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let gain = gains[0][i][j] / m1 - gains[1][i][j] / m2;
        f64::from(u8::from(i == j)) - slope(j) * gain
    });
    let solver = matrix.lu();
    let carry_column = |column: &mut [f64; 4], added: &[[f64; 2]; NODE_COUNT]| {
        let free = flight.decay(seconds, *column);
        let mut right = DVector::from_fn(n, |i, _| {
            let free_part: f64 = rows[i].iter().zip(&free).map(|(a, b)| a * b).sum();
            free_part
                + (0..n).map(|j| gains[0][i][j] * added[j][0] + gains[1][i][j] * added[j][1]).sum::<f64>()
        });
        // The matrix is the identity plus a small Volterra kernel: it can be inverted.
        solver.solve_mut(&mut right);
        *column = free;
        for j in 0..n {
            let weight = whole[j] * nodes.rates[j];
            let push = slope(j) * right[j];
            let [a1, a2] = [added[j][0] + push / m1, added[j][1] - push / m2];
            let [first, second] = kicks[j];
            *column = sum(*column, std::array::from_fn(|i| weight * (first[i] * a1 + second[i] * a2)));
        }
    };
    by_state.iter_mut().for_each(|column| carry_column(column, &[[0.0; 2]; NODE_COUNT]));
    for (number, (column, &parameter)) in by.iter_mut().zip(parameters).enumerate() {
        let mut added = [[0.0; 2]; NODE_COUNT];
        for (j, added) in added.iter_mut().enumerate() {
            let contact = system.contact_force_by(parameter, side, nodes.roots[j], rate(j));
            let [a1, a2] = system.acceleration_by(parameter, &nodes.states[j], contact);
            *added = [a1 + force_by(number, nodes.times[j])[0] / m1, a2];
        }
        carry_column(column, &added);
    }
}

/// The wall of a contact.
fn side(system: &Coupled, nodes: &Nodes) -> Side {
    let [near, far] = system.indentation(&nodes.states[NODE_COUNT / 2]);
    if near > far { Side::Primary } else { Side::Obstacle }
}

/// A stretch of a contact at the nodes of Gauss's rule in its own coordinate.
pub(super) struct Nodes {
    /// When it begins and ends, s.
    pub span: [f64; 2],
    /// The state at its end.
    pub end: [f64; 4],
    /// The times of the nodes since the beginning, s.
    times: [f64; NODE_COUNT],
    /// Factors from integrals of the rule to integrals over time, s.
    rates: [f64; NODE_COUNT],
    /// `√z` of the indentation, √m.
    roots: [f64; NODE_COUNT],
    states: [[f64; 4]; NODE_COUNT],
}

/// Nodes of a piece of a contact that is followed step by step: Gauss's rule on 8 is of order 16, the steps themselves are of order 8.
const NODE_COUNT: usize = 8;

/// Nodes of Gauss's rule on `[0, 1]`, the integrals to each of them, and over all.
struct Gauss {
    nodes: [f64; NODE_COUNT],
    running: [[f64; NODE_COUNT]; NODE_COUNT],
    whole: [f64; NODE_COUNT],
}

static GAUSS: LazyLock<Gauss> = LazyLock::new(|| {
    let (at, weights) = gauss(NODE_COUNT, 0);
    let nodes: [f64; NODE_COUNT] = std::array::from_fn(|i| at[i]);
    let cardinal = |j: usize, u: f64| {
        let factor = |i: usize| if i == j { 1.0 } else { (u - nodes[i]) / (nodes[j] - nodes[i]) };
        (0..NODE_COUNT).map(factor).product::<f64>()
    };
    let (mut running, mut whole) = ([[0.0; NODE_COUNT]; NODE_COUNT], [0.0; NODE_COUNT]);
    for j in 0..NODE_COUNT {
        whole[j] = weights[j];
        for i in 0..NODE_COUNT {
            let inner = at.iter().zip(&weights);
            running[i][j] = inner.map(|(x, weight)| nodes[i] * weight * cardinal(j, nodes[i] * x)).sum();
        }
    }
    Gauss { nodes, running, whole }
});

/// A piece of a contact that is followed step by step, at the nodes of Gauss's rule in its own coordinate.
pub(super) fn nodes(piece: &dyn Segment<4>) -> Nodes {
    let [start, end] = piece.ends();
    let Gauss { nodes, .. } = &*GAUSS;
    let (mut times, mut rates) = ([0.0; NODE_COUNT], [0.0; NODE_COUNT]);
    let (mut roots, mut states) = ([0.0; NODE_COUNT], [[0.0; 4]; NODE_COUNT]);
    for (i, node) in nodes.iter().enumerate() {
        let knot = piece.at(piece.length() * node);
        times[i] = knot.t - start.t;
        rates[i] = piece.length() * knot.clock[0];
        roots[i] = knot.clock[0];
        states[i] = knot.y;
    }
    Nodes { span: [start.t, end.t], end: end.y, times, rates, roots, states }
}
