//! Contacts with the same restitution at every speed, close to the undisturbed collision of that law.
//!
//! The force `f = ζ^(3/2) φ` depends on the speed of indentation, too, so the unknowns are the forces at the nodes and the duration σ. With the
//! moments `m_k` of f the Volterra equation gives depth and speed at every node,
//!
//! ```text
//! ζ = ζ_free - Σ_k g_k T^(k+1) √Z m_k        ż/w = ż_free/w - (Z^(3/2)/w) Σ_k g_k T^k m_(k-1)
//! ```
//!
//! and the residuals are `f - ζ^(3/2) φ(ζ^(5/2)/2, ż/w)` and the depth at the end. Newton's iteration with the inverse Jacobian of the
//! undisturbed collision is hastened by Broyden's updates (C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations, SIAM 1995,
//! section 7.3).

use super::lossy_rule::{LossyRule, M, N, Unknowns, inner};
use super::nodes::{Nodes, at_nodes, dot, product};
use super::response::{Collisions, FREE};
use super::rule::Rule;
use super::solve::{Found, MAX_ITERATIONS, Pushed, TAIL, error, free_terms, size};
use crate::motion::knot::Knot;
use crate::motion::linearised::MOMENTS;
use crate::motion::polynomial::Polynomial;
use retune_model::Restoring;
use wide::f64x4;

/// A contact in the units of its undisturbed collision.
struct Contact<'a> {
    of: &'a Collisions,
    rule: &'a Rule<N, M>,
    terms: usize,
    /// Greatest depth without loss, m; touch-down speed, m/s; duration of the undisturbed collision, s.
    depth: f64,
    speed: f64,
    undisturbed: f64,
    /// `z_free / t` in Z, and `ż_free` in w.
    approach: Polynomial<FREE>,
    pace: Polynomial<FREE>,
}

/// The motion under forces at the nodes: depths and speeds there, and the depth at the end.
struct Motion {
    depths: Nodes<M>,
    speeds: Nodes<M>,
    end: f64,
}

impl Contact<'_> {
    /// The motion under these forces, whose moments are left at the nodes and at the end.
    fn motion(
        &self,
        (forces, stretch): &Unknowns,
        moments: &mut [Nodes<M>; MOMENTS],
        last: &mut [f64; MOMENTS],
    ) -> Motion {
        let Self { of, rule, terms, depth, speed, .. } = *self;
        let duration = stretch * self.undisturbed;
        for k in 0..=terms {
            moments[k] = product(&rule.moments[k], forces);
            last[k] = dot(&rule.last[k], forces);
        }
        let (mut pushed, mut slowed, mut pushed_last) = ([f64x4::ZERO; M], [f64x4::ZERO; M], 0.0);
        for k in (1..=terms).rev() {
            for i in 0..M {
                pushed[i] = pushed[i] * duration + moments[k][i] * of.gains[k];
                slowed[i] = slowed[i] * duration + moments[k - 1][i] * of.gains[k];
            }
            pushed_last = pushed_last * duration + of.gains[k] * last[k];
        }
        let scale = duration * duration * depth.sqrt();
        let slowing = duration * depth * depth.sqrt() / speed;
        let times = rule.times.map(|time| time * duration);
        let mean_rate = at_nodes(&self.approach, free_terms(terms) - 1, &times);
        let rate = at_nodes(&self.pace, free_terms(terms), &times);
        Motion {
            depths: std::array::from_fn(|i| mean_rate[i] * times[i] - pushed[i] * scale),
            speeds: std::array::from_fn(|i| rate[i] - slowed[i] * slowing),
            end: self.approach.at(duration) * duration - scale * pushed_last,
        }
    }
}

/// Broyden's steps, each with the square of its length.
struct Broyden(Vec<(Unknowns, f64)>);

impl Broyden {
    /// The next step, from that by the inverse Jacobian at the beginning.
    fn step(&mut self, plain: Unknowns) -> Unknowns {
        let mut step = plain;
        for pair in self.0.windows(2) {
            let share = inner(&pair[0].0, &step) / pair[0].1;
            let (forces, stretch) = pair[1].0;
            step = (std::array::from_fn(|i| step.0[i] + forces[i] * share), step.1 + stretch * share);
        }
        if let Some((before, square)) = self.0.last() {
            let share = 1.0 / (1.0 - inner(before, &step) / square);
            step = (step.0.map(|step| step * share), step.1 * share);
        }
        self.0.push((step, inner(&step, &step)));
        step
    }
}

impl Collisions {
    /// As the iteration of contacts without loss, for those near the undisturbed collision of `rule`.
    #[inline(never)]
    pub(super) fn iterate_lossy(
        &self,
        of: &LossyRule,
        touch: &Knot<4>,
        to: f64,
        Pushed { free, moments, last }: &mut Pushed<M>,
    ) -> Option<Found<M>> {
        let LossyRule { rule, law, .. } = of;
        let speed = self.side.sign() * (touch.y[3] - touch.y[1]);
        if speed.is_nan() || speed <= 0.0 {
            return None;
        }
        let depth = self.equations.greatest_depth(speed).powi(2);
        let undisturbed = of.duration * depth / speed;
        let terms = self.longest.iter().position(|&longest| undisturbed < longest)?;
        let [x1, v1, x2, v2] = free.0;
        let between = |a: Polynomial<FREE>, b: Polynomial<FREE>, size: f64| {
            Polynomial::<FREE>(std::array::from_fn(|block| {
                (b.0[block] - a.0[block]) * (self.side.sign() / size)
            }))
        };
        let (approach, pace) = (between(x1, x2, depth).over_s(), between(v1, v2, speed));
        let contact = Contact { of: self, rule, terms, depth, speed, undisturbed, approach, pace };
        let mut unknowns: Unknowns = (of.forces, 1.0);
        let mut broyden = Broyden(Vec::with_capacity(MAX_ITERATIONS as usize));
        let mut before = 1.0_f64;
        for iterations in 1..=MAX_ITERATIONS {
            let Motion { depths, speeds, end } = contact.motion(&unknowns, moments, last);
            // At first the force is taken as linear: before the duration fits, depths near the end may be below zero.
            let residual: Nodes<M> = std::array::from_fn(|i| match iterations {
                1 => {
                    of.slopes[0][i] * (rule.depths[i] - depths[i])
                        + of.slopes[1][i] * (of.speeds[i] - speeds[i])
                }
                _ => unknowns.0[i] - force(law, depths[i], speeds[i]),
            });
            let (change, lengthening) = broyden.step(of.change(&(residual, end)));
            let size = size(&change, lengthening);
            if size.is_nan() || size >= 0.5 * before {
                return None;
            }
            unknowns = (std::array::from_fn(|i| unknowns.0[i] + change[i]), unknowns.1 + lengthening);
            // Each step gains at least as much as the last.
            if size * size <= 0.3 * self.rtol * before {
                let Motion { depths, .. } = contact.motion(&unknowns, moments, last);
                let duration = unknowns.1 * undisturbed;
                // The forces of both kinds of collision are alike: so are their errors, as the tests show.
                let error = error(rule, &unknowns.0, TAIL[2]);
                let is_right = error <= self.rtol && touch.t + duration < to;
                return is_right.then_some(Found { depth, terms, depths, duration, iterations });
            }
            before = size;
        }
        None
    }
}

/// `ζ^(3/2) φ`.
#[inline(always)]
fn force(law: &Restoring, depths: f64x4, speeds: f64x4) -> f64x4 {
    let (depths, speeds) = (depths.to_array(), speeds.to_array());
    f64x4::new(std::array::from_fn(|lane| {
        let (z, root) = (depths[lane], depths[lane].sqrt());
        z * root * law.push(0.5 * z * z * root, speeds[lane])
    }))
}
