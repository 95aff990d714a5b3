//! Contacts that lose energy, close to an undisturbed collision: that of a law with the same restitution at every speed, or of one with a χ
//! close to that of the contact.
//!
//! The force `f = ζ^(3/2) φ` depends on the speed of indentation, too, so the unknowns are the forces at the nodes and the duration σ. With the
//! moments `m_k` of f the Volterra equation gives depth and speed at every node,
//!
//! ```text
//! ζ = ζ_free - Σ_k g_k T^(k+1) √Z m_k        ż/w = ż_free/w - (Z^(3/2)/w) Σ_k g_k T^k m_(k-1)
//! ```
//!
//! and the residuals are `f - ζ^(3/2) φ(ζ^(5/2)/2, ż/w)` and the depth at the end. The iteration is that of contacts without loss.

use super::bends::BendContribution;
use super::disturbed::UNDISTURBED;
use super::lossy_rule::LossyRule;
use super::newton::Extended;
use super::nodes::{Nodes, at_nodes, dot, product};
use super::response::{Collisions, FREE};
use super::rule::Rule;
use super::solve::{
    FLAT, MAX_ITERATIONS, Solution, Workspace, change_size, estimated_error, free_terms, relative_position,
    relative_velocity,
};
use super::unit_law::UnitLaw;
use crate::motion::knot::Knot;
use crate::motion::linearised::MOMENTS;
use crate::motion::polynomial::Polynomial;
use wide::f64x4;

/// A contact in the units of its undisturbed collision.
struct Contact<'a, const N: usize, const M: usize> {
    of: &'a Collisions,
    rule: &'a Rule<N, M>,
    terms: usize,
    /// Greatest depth without loss, m; touch-down speed, m/s; duration of the undisturbed collision, s.
    depth: f64,
    speed: f64,
    undisturbed: f64,
    /// Bounds on the terms of the response to a force of 1, over the first of them.
    weights: [f64; MOMENTS],
    /// `z_free / t` in Z, and `ż_free` in w.
    approach: Polynomial<FREE>,
    pace: Polynomial<FREE>,
    /// What bends of the force add to `z_free` and to `ż_free`, in the same units.
    bent: [BendContribution<'a>; 2],
}

/// The motion under forces at the nodes: depths and speeds there, and the depth at the end.
struct Motion<const M: usize> {
    depths: Nodes<M>,
    speeds: Nodes<M>,
    end: f64,
}

impl<const N: usize, const M: usize> Contact<'_, N, M> {
    /// Subtracts the moments of a change of the forces (of this size, in units of the greatest force), as far as they are significant.
    #[inline(always)]
    fn subtract_moments(
        &self,
        change: &Nodes<M>,
        size: f64,
        moments: &mut [Nodes<M>; MOMENTS],
        last: &mut [f64; MOMENTS],
    ) {
        let counts = |k: &usize| self.weights[*k] * size > 0.02 * self.of.rtol;
        let needed = (2..=self.terms).rev().find(counts).unwrap_or(1);
        for k in 0..=needed {
            let less = product(&self.rule.moments[k], change);
            for i in 0..M {
                moments[k][i] -= less[i];
            }
            last[k] -= dot(&self.rule.last[k], change);
        }
    }

    /// The motion under forces with these moments.
    #[inline(always)]
    fn motion(&self, stretch: f64, moments: &[Nodes<M>; MOMENTS], last: &[f64; MOMENTS]) -> Motion<M> {
        let Self { of, rule, terms, depth, speed, .. } = *self;
        let duration = stretch * self.undisturbed;
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
        let mut rate = at_nodes(&self.pace, free_terms(terms), &times);
        let mut without: Nodes<M> = std::array::from_fn(|i| mean_rate[i] * times[i]);
        let [deeper, faster] = &self.bent;
        deeper.add_to_nodes(&mut without, &times, free_terms(terms));
        faster.add_to_nodes(&mut rate, &times, free_terms(terms));
        Motion {
            depths: std::array::from_fn(|i| without[i] - pushed[i] * scale),
            speeds: std::array::from_fn(|i| rate[i] - slowed[i] * slowing),
            end: self.approach.at(duration) * duration + deeper.at(duration) - scale * pushed_last,
        }
    }
}

impl Collisions {
    /// The iteration as for contacts without loss, for those near the undisturbed collision of a rule with loss.
    #[inline(never)]
    pub(super) fn iterate_lossy<const N: usize, const M: usize>(
        &self,
        of: &LossyRule<N, M>,
        law: &UnitLaw,
        touch: &Knot<4>,
        to: f64,
        Workspace { free, moments, last, bends, bend }: &mut Workspace<'_, M>,
    ) -> Option<Solution<M>> {
        let rule = &of.rule;
        let speed = self.side.sign() * (touch.y[3] - touch.y[1]);
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
        let mut weights = [1.0; MOMENTS];
        let mut part = 2.0 / self.gains[1];
        for k in 2..MOMENTS {
            part *= undisturbed / (k + 1) as f64;
            weights[k] = part * self.gains[k].abs();
        }
        let to_depth = self.side.sign() / depth;
        let bent = [relative_position(bend, to_depth), relative_velocity(bend, self.side.sign() / speed)]
            .map(|one| bends.contribution(one));
        let contact =
            Contact { of: self, rule, terms, depth, speed, undisturbed, weights, approach, pace, bent };
        let mut unknowns: Extended<M> = (of.forces, 1.0);
        let mut amounts = UNDISTURBED;
        let (mut before, mut last_gain) = (1.0_f64, 0.0_f64);
        for iterations in 1..=MAX_ITERATIONS {
            let Motion { depths, speeds, end } = contact.motion(unknowns.1, moments, last);
            // At first the force is taken as linear: before the duration fits, depths near the end may be below zero.
            let residual: Nodes<M> = match iterations {
                1 => {
                    let offset = of.force_offset(law);
                    std::array::from_fn(|i| {
                        offset[i]
                            + of.slopes[0][i] * (rule.depths[i] - depths[i])
                            + of.slopes[1][i] * (of.speeds[i] - speeds[i])
                    })
                }
                _ => {
                    let force = of.at_nodes(law, &depths, &speeds);
                    std::array::from_fn(|i| unknowns.0[i] - force[i])
                }
            };
            let (mut change, mut lengthening) = of.newton.change(amounts, &residual, end);
            let size = change_size(&change, lengthening);
            if size.is_nan() || size >= 0.5 * before {
                return None;
            }
            if iterations == 1 {
                amounts = of.newton.amounts(&change, lengthening);
                let (bend, longer) = of.newton.second_order(amounts);
                for i in 0..M {
                    change[i] -= bend[i];
                }
                lengthening -= longer;
            }
            unknowns = (std::array::from_fn(|i| unknowns.0[i] - change[i]), unknowns.1 - lengthening);
            contact.subtract_moments(&change, size, moments, last);
            // Each step gains about as much as the last two, of which one may have gained more by chance; the first corrects what others cannot.
            let gain = size / before;
            let gains = if iterations > 2 { gain.max(last_gain) } else { gain };
            if size * gains <= 0.3 * self.rtol {
                let Motion { depths, .. } = contact.motion(unknowns.1, moments, last);
                let duration = unknowns.1 * undisturbed;
                let kink = of.kink * contact.bent[0].kink(duration, FLAT / N as f64);
                let error = estimated_error(rule, &unknowns.0, of.tail, kink);
                let is_right = error <= self.rtol && touch.t + duration < to;
                return is_right.then_some(Solution { depth, terms, depths, duration, iterations });
            }
            (before, last_gain) = (size, gain);
        }
        None
    }

    /// Whether the force pushes throughout a contact that loses energy by the law of Hunt and Crossley: the speed of indentation
    /// `w` falls by it, and rises by other forces at most as fast as in the bounds over the contact.
    pub(super) fn force_stays_compressive(&self, touch: &Knot<4>, end: &[f64; 4], duration: f64) -> bool {
        let touch = self.equations.regularise(&touch.y);
        let depth = self.equations.greatest_depth(touch[1]);
        let over = self.equations.over_contact(&touch, depth, duration, self.amplitude);
        let least = self.side.sign() * (end[3] - end[1]);
        over.is_some_and(|over| self.equations.push(least - over.beside[3] * duration) > 0.0)
    }
}
