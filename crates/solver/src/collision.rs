//! A whole contact at once: a collocation of the contact force on the few nodes of a [`Rule`].
//!
//! Between the bodies acts `F = K f`, `f = z^(3/2)`; everything else is linear. So the motion is the free one, which the contact
//! would interrupt, and what the force adds to it. With `A` the linear part and `b` what a unit of `f` adds to `y'`,
//!
//! ```text
//! y(t) = y_free(t) + Σ_k A^k b ∫₀^t (t - s)^k / k! f(s) ds
//! z(t) = z_free(t) - Σ_k g_k  ∫₀^t (t - s)^k / k! f(s) ds,      g_0 = 0, g_1 = κ
//! ```
//!
//! The second line is a Volterra equation for `z` alone. A contact is short beside the linear motion, so a few terms are
//! exact; and it is nearly the undisturbed Hertz collision, so Newton's iteration needs no inverse Jacobians but those computed
//! once for all (see `rule::newton`). A contact that is not of this kind is declined, and integrated step by step (see
//! `contact`).

use crate::contact::Piece;
use crate::flow::{Expansion, Flow};
use crate::observe::{Knot, Observer, Path};
use crate::rule::{DURATION, MOMENTS, Rule, dot, each, product};
use retune_model::{Compression, Coupled, Side};
use std::sync::LazyLock;

/// The rules in use, from few nodes to many.
static RULES: LazyLock<(Rule<8>, Rule<12>, Rule<16>)> =
    LazyLock::new(|| (Rule::new(), Rule::new(), Rule::new()));

/// How contacts with one wall begin and how their force moves the system.
pub struct Collisions {
    equations: Compression,
    side: Side,
    wall: f64,
    /// `A^k b`.
    kicks: [[f64; 4]; MOMENTS],
    /// `g_k`.
    gains: [f64; MOMENTS],
    /// Longest contact (s) for which the terms up to the k-th are exact.
    longest: [f64; MOMENTS],
    rtol: f64,
}

/// A contact from touch-down to lift-off.
struct Collision<'a, const N: usize> {
    of: &'a Collisions,
    rule: &'static Rule<N>,
    flow: &'a Flow<4>,
    touch: Knot<4>,
    duration: f64,
    /// `q = √z` at the nodes.
    roots: [f64; N],
    /// `[x1, v1, x2, v2]` at the nodes, and at lift-off.
    nodes: [[f64; N]; 4],
    end: [f64; 4],
    /// Turns that the iteration took.
    turns: u32,
}

/// Most terms of the free motion's Taylor series, and the largest `rate t` for which they are exact: `0.3¹² / 12! = 1e-15`.
const FREE: usize = 12; // even
const BRIEF: f64 = 0.3;

/// The error of the end of a contact over `tail^1.25`, for each rule, where the tail of its force's expansion is the root of the
/// sum of squares of the two highest coefficients. Calibrated on contacts drawn at random; the test
/// `reference_contacts_at_once_agree_with_contacts_step_by_step` holds what follows from it.
const TAIL: [f64; 3] = [1.8e-3, 3.5e-4, 2.9e-4];

/// Most turns of the iteration; one that has not converged by then gains too little a turn.
const TURNS: u32 = 16;

impl Collisions {
    /// Prepares for contacts with `side`, each to be computed with an error of `rtol` relative to its touch-down speed.
    pub fn new(system: &Coupled, side: Side, flow: &Flow<4>, rtol: f64) -> Self {
        let (columns, sign) = (flow.linear().columns, side.sign());
        let mut kicks = [[0.0; 4]; MOMENTS];
        kicks[0] = system.derivative_under([0.0; 2], &system.rest(), -sign * system.hertz(side));
        for k in 1..MOMENTS {
            let mut next = [0.0; 4];
            for (column, weight) in columns.iter().zip(kicks[k - 1]) {
                for i in 0..4 {
                    next[i] += column[i] * weight;
                }
            }
            kicks[k] = next;
        }
        let gains = kicks.map(|kick| -sign * (kick[2] - kick[0]));
        // The terms left out, relative to the first: `2 g_k t^(k-1) / (k + 1)! g_1` (the double integral of a constant is t²/2).
        let limit = |k: usize| {
            let factorial = (1..=k + 1).product::<usize>() as f64;
            (0.1 * rtol * gains[1] * factorial / (2.0 * gains[k].abs())).powf(1.0 / (k - 1) as f64)
        };
        let brief = BRIEF / flow.linear().rate;
        let longest = std::array::from_fn(|terms| {
            if (2..MOMENTS - 1).contains(&terms) {
                (terms + 1..MOMENTS).map(limit).fold(brief, f64::min)
            } else {
                0.0
            }
        });
        let equations = system.compression(side);
        Self { equations, side, wall: system.wall(side), kicks, gains, longest, rtol }
    }

    /// Computes the contact that begins at `touch` and shows it to the observer, if it is nearly an undisturbed collision
    /// and over before `to`. Returns time and state of lift-off and the number of evaluations of the force.
    #[inline(always)]
    pub fn collide(
        &self,
        flow: &Flow<4>,
        touch: Knot<4>,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Option<(f64, [f64; 4], u64)> {
        let (few, some, many) = &*RULES;
        // From these tolerances on, common contacts pass the test of the rule, and their insides, for which quadrature by Gauss gains
        // nothing, are accurate enough for the energy of the much heavier structure.
        if self.rtol >= 1e-7
            && let Some(collision) = self.solve(few, flow, touch, to)
        {
            return Some(collision.finish(observer));
        }
        if self.rtol >= 1e-9
            && let Some(collision) = self.solve(some, flow, touch, to)
        {
            return Some(collision.finish(observer));
        }
        self.solve(many, flow, touch, to).map(|collision| collision.finish(observer))
    }

    /// The contact by one rule; `None` if it is not of the kind that the rule is for.
    #[inline(always)]
    fn solve<'a, const N: usize>(
        &'a self,
        rule: &'static Rule<N>,
        flow: &'a Flow<4>,
        touch: Knot<4>,
        to: f64,
    ) -> Option<Collision<'a, N>> {
        let speed = self.side.sign() * (touch.y[3] - touch.y[1]);
        let depth = self.equations.greatest_depth(speed).powi(2);
        let undisturbed = DURATION * depth / speed;
        if speed.is_nan() || speed <= 0.0 {
            return None;
        }
        let terms = self.longest.iter().position(|&longest| undisturbed < longest)?;
        let free_terms = terms + 4; // their error is about the square of the response's
        let free = flow.expand::<FREE>(touch.drive, &touch.y);
        let (x1, x2) = (free.component(0), free.component(2));
        // z_free / depth, without the constant term, which is zero.
        let mut approach = [0.0; FREE - 1];
        for k in 1..FREE {
            approach[k - 1] = self.side.sign() / depth * (x2[k] - x1[k]);
        }
        let (mut depths, mut stretch) = (rule.depths, 1.0);
        let (mut moments, mut last) = (rule.undisturbed, rule.undisturbed_last);
        let mut shares = [0.0; 2];
        let (mut before, mut turns) = (1.0, 0);
        let force = loop {
            let duration = stretch * undisturbed;
            let (mut pushed, mut pushed_last) = ([0.0; N], 0.0);
            for k in (1..=terms).rev() {
                for i in 0..N {
                    pushed[i] = pushed[i] * duration + self.gains[k] * moments[k][i];
                }
                pushed_last = pushed_last * duration + self.gains[k] * last[k];
            }
            let scale = duration * duration * depth.sqrt();
            let times = each::<N>(|i| rule.times[i] * duration);
            let (mut free, mut free_last) = ([0.0; N], 0.0);
            for a in approach[..free_terms - 1].iter().rev() {
                for i in 0..N {
                    free[i] = (free[i] + a) * times[i];
                }
                free_last = (free_last + a) * duration;
            }
            let residual = each(|i| depths[i] - free[i] + scale * pushed[i]);
            let (change, lengthening) =
                rule.newton.change(shares, &residual, scale * pushed_last - free_last);
            for i in 0..N {
                depths[i] -= change[i];
            }
            stretch -= lengthening;
            turns += 1;
            let size = change.iter().fold(lengthening.abs(), |size, c| size.max(c.abs()));
            // Each turn gains about as much as the last: what is left is some `size² / before`.
            let settled = size * size <= 0.3 * self.rtol * before;
            if size.is_nan() || size >= 0.5 * before || turns == TURNS {
                return None;
            }
            if turns == 1 {
                shares = rule.newton.shares(&change, lengthening);
            }
            before = size;
            let force = each::<N>(|i| depths[i] * depths[i].sqrt());
            for k in usize::from(!settled)..=terms {
                moments[k] = product(&rule.moments[k], &force);
                last[k] = dot(&rule.last[k], &force);
            }
            if settled {
                break force;
            }
        };
        let tail = (dot(&rule.tails[0], &force).powi(2) + dot(&rule.tails[1], &force).powi(2)).sqrt();
        let duration = stretch * undisturbed;
        let error = TAIL[N / 4 - 2] * tail * tail.sqrt().sqrt();
        if error.is_nan() || error > self.rtol || touch.t + duration >= to {
            return None;
        }
        let (nodes, mut end) =
            self.states(rule, &free, [terms, free_terms], (depth, duration), (&moments, &last));
        end[2] = end[0] + self.wall;
        let roots = each(|i| (depth * depths[i]).sqrt());
        Some(Collision { of: self, rule, flow, touch, duration, roots, nodes, end, turns })
    }

    /// The states `[x1, v1, x2, v2]` at the nodes and at the end, from the free motion and the moments of the force.
    #[inline(always)]
    fn states<const N: usize>(
        &self,
        rule: &Rule<N>,
        free: &Expansion<4, FREE>,
        [terms, free_terms]: [usize; 2],
        (depth, duration): (f64, f64),
        (moments, last): (&[[f64; N]; MOMENTS], &[f64; MOMENTS]),
    ) -> ([[f64; N]; 4], [f64; 4]) {
        let times = each::<N>(|i| rule.times[i] * duration);
        let (mut nodes, mut end) = ([[0.0; N]; 4], free.at(duration));
        for c in 0..4 {
            for coefficient in free.component(c)[..free_terms].iter().rev() {
                for i in 0..N {
                    nodes[c][i] = nodes[c][i] * times[i] + coefficient;
                }
            }
            let mut power = duration * depth * depth.sqrt();
            for k in 0..=terms {
                let kick = self.kicks[k][c] * power;
                for i in 0..N {
                    nodes[c][i] += kick * moments[k][i];
                }
                end[c] += kick * last[k];
                power *= duration;
            }
        }
        (nodes, end)
    }
}

impl<const N: usize> Collision<'_, N> {
    /// Shows the motion to an observer. Returns time and state of lift-off and the number of evaluations of the force.
    #[inline(always)]
    fn finish(&self, observer: &mut impl Observer<4>) -> (f64, [f64; 4], u64) {
        observer.path(self);
        (self.touch.t + self.duration, self.end, u64::from(self.turns) * N as u64)
    }

    /// `τ` of a knot: touch-down, the nodes, lift-off.
    fn time(&self, knot: usize) -> f64 {
        match knot {
            0 => 0.0,
            node if node <= N => self.rule.times[node - 1],
            _ => 1.0,
        }
    }

    fn knot(&self, knot: usize) -> Knot<4> {
        let elapsed = self.time(knot) * self.duration;
        let (y, root) = match knot {
            0 => (self.touch.y, 0.0),
            node if node <= N => (self.nodes.map(|component| component[node - 1]), self.roots[node - 1]),
            _ => (self.end, 0.0),
        };
        Knot {
            t: self.touch.t + elapsed,
            drive: self.flow.drive_after(self.touch.drive, elapsed),
            y,
            clock: [root, 0.5 * self.of.side.sign() * (y[3] - y[1])],
        }
    }
}

impl<const N: usize> Path<4> for Collision<'_, N> {
    fn pieces(&self) -> usize {
        N + 1
    }

    #[inline(always)]
    fn states(&self, mut visit: impl FnMut(&[f64; 4])) {
        visit(&self.touch.y);
        for i in 0..N {
            visit(&[self.nodes[0][i], self.nodes[1][i], self.nodes[2][i], self.nodes[3][i]]);
        }
        visit(&self.end);
    }

    /// A piece between two knots is followed by steps from the first of them.
    fn show(&self, piece: usize, observer: &mut impl Observer<4>) {
        let ends = [self.knot(piece), self.knot(piece + 1)];
        let mut from = self.of.equations.compress(&ends[0].y);
        from[0] = ends[0].clock[0];
        let mut equations = self.of.equations;
        equations.set_drive(0.0, ends[0].drive);
        // θ = ∫ dt / √z
        let slope: [f64; N] = std::array::from_fn(|i| self.rule.rates[i] / self.roots[i]);
        let theta = |knot: usize| match knot {
            0 => 0.0,
            node if node <= N => (0..N).map(|j| self.rule.running[j][node - 1] * slope[j]).sum(),
            _ => dot(&self.rule.whole, &slope),
        };
        let length = self.duration * (theta(piece + 1) - theta(piece));
        let derivative = equations.derivative(&from);
        observer.segment(&Piece {
            equations: &equations,
            touch_down: ends[0].t,
            from: &from,
            slope: &derivative,
            length,
            steps: 2, // nodes are about as far apart as the steps that `rtol` asks for, and farther near the ends
            ends,
        });
    }
}

#[cfg(test)]
mod tests;
