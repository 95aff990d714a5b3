//! Minimises the largest of several smooth functions, by their derivatives.
//!
//! The worst over a band is the largest of its peaks, and each peak is a smooth function of the design where motions are regular. At the
//! optimum several are equally high: a kink, towards which a simplex collapses early. Here each step minimises the largest of all
//! linearised peaks, a linear program, within a trust region (K. Madsen, An algorithm for minimax solution of overdetermined systems of
//! non-linear equations, IMA J. Appl. Math. 16, 1975, its first stage). Linear programs are solved by the crate `microlp`.

use crate::search::space::Space;
use microlp::{ComparisonOp, OptimizationDirection, Problem};

/// One of the functions, at a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Whether it is a limit, kept where the value is at most zero, instead of one of the functions whose largest is minimised.
    pub is_limit: bool,
    /// Its value.
    pub value: f64,
    /// Its derivatives by the parameters, in their own units.
    pub slope: Vec<f64>,
}

/// Initial half side of the trust region, in coordinates of [`Space`].
const FIRST: f64 = 0.03;
/// Most steps that are tried with one weight.
const STEPS: usize = 60;
/// A step whose predicted gain is due to curvature alone has a region of about the root of that gain; in a region below this share of
/// the root of the required gain no step can bring it.
const SMALL: f64 = 0.01;
/// A step is accepted if it brings the first share of the predicted gain, and the region grows if it brings the second.
const ACCEPTED: f64 = 0.1;
const GOOD: f64 = 0.7;

/// Initial penalty of a limit that is broken by its whole size, as a share of the worst. A descent that ends outside limits continues with
/// ten times the weight, up to the largest: near the tightest feasible limit, keeping it may need any weight.
const WEIGHT: f64 = 20.0;
const MOST_WEIGHT: f64 = 2e6;
/// Steps aim this far inside limits, as shares of them, so that rounding does not break them.
const INSIDE: f64 = 1e-6;

/// The merit of a design: the largest of the functions, and the relative violation of the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Height {
    /// The largest of the functions; infinite where the design has no value.
    pub worst: f64,
    /// Violation of the limits, 0 where they are kept.
    pub violation: f64,
}

impl Height {
    /// Whether it is better: with less violation, or with equal violation and a lower worst.
    pub fn is_below(&self, other: &Self) -> bool {
        self.violation < other.violation || self.violation == other.violation && self.worst < other.worst
    }

    /// The penalised value that steps minimise, as a share of `of`.
    fn merit(&self, of: f64, weight: f64) -> f64 {
        self.worst / of + weight * self.violation
    }
}

/// Descends from `start` in a box, and returns the best design on the way: the lowest of those with the least violation.
///
/// `evaluate(parameters, cutoff)` may stop as soon as the worst is above the cutoff; besides the height it returns what `pieces` needs to
/// find the functions of that design. Only steps that gain are accepted, so wrong derivatives cost only time. The search ends where the
/// predicted gain of a step is below the share `gain` of the worst, or where the trust region is too small for such a gain.
pub fn minimax<T>(
    evaluate: impl Fn(&[f64], f64) -> (Height, T),
    pieces: impl Fn(&[f64], &T) -> Vec<Piece>,
    space: &Space,
    start: &[f64],
    gain: f64,
) -> (Vec<f64>, Height) {
    let (mut height, seen) = evaluate(start, f64::INFINITY);
    let mut best = (start.to_vec(), height);
    if !height.worst.is_finite() || height.worst <= 0.0 {
        return best;
    }
    let (mut x, mut here) = (start.to_vec(), pieces(start, &seen));
    let (mut radius, mut tried, mut weight) = (FIRST, 0, WEIGHT);
    while let Some((to, predicted)) = step(&here, height.worst, space, &x, radius, weight) {
        // The error of the linear functions within the region is of the order of its square.
        if predicted < gain || radius < SMALL * gain.sqrt() || tried == STEPS {
            if height.violation == 0.0 || weight >= MOST_WEIGHT {
                break;
            }
            (radius, tried, weight) = (FIRST, 0, 10.0 * weight);
            continue;
        }
        tried += 1;
        let cutoff = if here.iter().any(|piece| piece.is_limit) { f64::INFINITY } else { height.worst };
        let (found, seen) = evaluate(&to, cutoff);
        let ratio = (height.merit(height.worst, weight) - found.merit(height.worst, weight)) / predicted;
        if found.is_below(&best.1) {
            best = (to.clone(), found);
        }
        if ratio > ACCEPTED {
            here = pieces(&to, &seen);
            (x, height) = (to, found);
        }
        radius *= if ratio > GOOD {
            2.0
        } else if ratio > ACCEPTED {
            1.0
        } else {
            0.25
        };
    }
    best
}

/// The optimal step for the linearised functions, and its predicted gain in merit; none without usable functions.
fn step(
    pieces: &[Piece],
    worst: f64,
    space: &Space,
    x: &[f64],
    radius: f64,
    weight: f64,
) -> Option<(Vec<f64>, f64)> {
    let (u, slopes) = (space.coordinates(x), space.slopes(x));
    let mut program = Problem::new(OptimizationDirection::Minimize);
    let most = program.add_var(1.0, (0.0, f64::INFINITY));
    let broken = program.add_var(weight, (0.0, f64::INFINITY));
    let moves: Vec<_> =
        u.iter().map(|&u| program.add_var(0.0, ((-u).max(-radius), (1.0 - u).min(radius)))).collect();
    let (mut highest, mut most_broken) = (0.0_f64, 0.0_f64);
    for piece in pieces.iter().filter(|piece| piece.slope.iter().all(|slope| slope.is_finite())) {
        // Shares of the worst, so that all rows are of one size.
        let scale = if piece.is_limit { 1.0 } else { worst };
        let (value, slack) = (piece.value / scale, if piece.is_limit { broken } else { most });
        let value = if piece.is_limit { value + INSIDE } else { value };
        let reached = if piece.is_limit { &mut most_broken } else { &mut highest };
        *reached = reached.max(value);
        let along = piece.slope.iter().zip(&slopes).map(|(by_value, slope)| by_value * slope / scale);
        let row: Vec<_> = moves.iter().copied().zip(along).chain([(slack, -1.0)]).collect();
        program.add_constraint(row, ComparisonOp::Le, -value);
    }
    let found = program.solve().ok()?.into_solution().ok()?;
    let to: Vec<f64> = u.iter().zip(&moves).map(|(u, &along)| u + found.var_value(along)).collect();
    (highest > 0.0).then(|| (space.point(&to), highest + weight * most_broken - found.objective()))
}
