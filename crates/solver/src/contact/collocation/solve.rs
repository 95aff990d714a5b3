//! One contact by collocation: Newton's iteration for the depths at the nodes and the duration, and the error estimate.

use super::bends::Bends;
use super::disturbed::{UNDISTURBED, without_loss};
use super::lossy_rule::{Loss, LossyRule, LossyRules};
use super::motion::Collision;
use super::newton::Newton;
use super::nodes::{Nodes, at_nodes, dot, product};
use super::response::{Collisions, FREE};
use super::rule::{Rule, TAIL};
use super::undisturbed::{DURATION, clock, undisturbed_force};
use super::unit_law::UnitLaw;
use crate::linear::flow::{Expansion, Flow};
use crate::motion::knot::Knot;
use crate::motion::linearised::MOMENTS;
use crate::motion::polynomial::{BLOCKS, Polynomial};
use crate::observe::observer::Observer;
use std::sync::LazyLock;
use wide::f64x4;

/// The rules in use, from few nodes to many.
static FEW: LazyLock<Lossless<8, 2>> = LazyLock::new(lossless);
static SOME: LazyLock<Lossless<12, 3>> = LazyLock::new(lossless);
static MANY: LazyLock<Lossless<16, 4>> = LazyLock::new(lossless);

/// The rule for contacts in which the force bends so much that the others do not suffice.
static BENT: LazyLock<Lossless<24, 6>> = LazyLock::new(lossless);

/// A rule for contacts without loss, and their iteration.
pub(super) type Lossless<const N: usize, const M: usize> = (Rule<N, M>, Newton<N, M>);

pub(super) fn lossless<const N: usize, const M: usize>() -> Lossless<N, M> {
    let force = undisturbed_force();
    let (rule, integrals) = Rule::new(clock, &force, |u| force(u).powf(2.0 / 3.0));
    let (start, solve) = without_loss(&integrals);
    (rule, Newton::new(&start, 2, solve))
}

/// The greatest error of the end of an undisturbed collision, for each rule of 8, 12, … nodes, to first order in what a bend of the force at `b`
/// adds to its depth, for one that adds `(t - b)³` that is 1 at the end: shares of the duration and of the touch-down speed. For higher powers it is
/// at most `FLAT / N` of that. `exact_what_a_bend_costs_to_first_order` computes both from the linear theory for bends all over a contact. Depths at
/// the nodes are off by at most 2.2 times as much.
pub(super) const KINK: [f64; 5] = [5e-5, 1.15e-5, 4.4e-6, 1.9e-6, 1e-6];
pub(super) const FLAT: f64 = 1.6;

/// Factor on this error for a contact that is not undisturbed: a rule of thumb, whose failures the test
/// `reference_contacts_across_samples_agree_with_contacts_step_by_step` counts (`just lab test-bends`).
const DISTURBED: f64 = 2.0;

/// Limit on iterations: one that has not converged by then converges too slowly.
pub(super) const MAX_ITERATIONS: u32 = 16;

impl Collisions {
    /// Computes the contact that begins at `touch` and shows it to the observer, if it is nearly an undisturbed collision
    /// and over before `to`, up to which the force bends at `bends` alone. Returns the moment of lift-off and the number of evaluations of the
    /// force.
    #[inline(always)]
    pub fn collide(
        &self,
        flow: &Flow<4>,
        touch: Knot<4>,
        to: f64,
        bends: &Bends,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Option<(Knot<4>, u64)> {
        if self.equations.is_lossy() {
            let loss = self.loss.as_ref().filter(|_| !observer.follows_contacts())?;
            return self.collide_lossy(loss, flow, touch, to, bends, observer);
        }
        // At these tolerances common contacts pass the error estimate of the rule. Inside a contact Gauss's nodes gain nothing, but the
        // motion there is still accurate enough for the energy of the much heavier structure.
        if self.rtol >= 1e-7
            && let Some(end) = self.collide_with(&FEW, flow, &touch, to, bends, observer)
        {
            return Some(end);
        }
        if self.rtol >= 1e-9
            && let Some(end) = self.collide_with(&SOME, flow, &touch, to, bends, observer)
        {
            return Some(end);
        }
        let end = self.collide_with(&MANY, flow, &touch, to, bends, observer);
        if end.is_some() || bends.all().is_empty() {
            return end;
        }
        self.collide_with(&BENT, flow, &touch, to, bends, observer)
    }

    /// [`Self::collide`] by one rule.
    #[inline(always)]
    fn collide_with<const N: usize, const M: usize>(
        &self,
        rule: &LazyLock<Lossless<N, M>>,
        flow: &Flow<4>,
        touch: &Knot<4>,
        to: f64,
        bends: &Bends,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Option<(Knot<4>, u64)> {
        let rule = &**rule;
        self.solve(
            &rule.0,
            |workspace| self.iterate(rule, touch, to, workspace),
            flow,
            touch,
            bends,
            observer,
        )
    }

    /// [`Self::collide`] for a contact that loses energy.
    #[inline(never)]
    fn collide_lossy(
        &self,
        loss: &Loss,
        flow: &Flow<4>,
        touch: Knot<4>,
        to: f64,
        bends: &Bends,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Option<(Knot<4>, u64)> {
        let speed = self.side.sign() * (touch.y[3] - touch.y[1]);
        if speed.is_nan() || speed <= 0.0 {
            return None;
        }
        let (LossyRules { few, some, more, many, suffice }, law) = loss.rules(speed)?;
        let [few_suffice, some_suffice, more_suffice] = suffice.map(|least| self.rtol >= least);
        if few_suffice && let Some(end) = self.solve_lossy((few, &law), flow, &touch, to, bends, observer) {
            return Some(end);
        }
        if some_suffice && let Some(end) = self.solve_lossy((some, &law), flow, &touch, to, bends, observer) {
            return Some(end);
        }
        if more_suffice && let Some(end) = self.solve_lossy((more, &law), flow, &touch, to, bends, observer) {
            return Some(end);
        }
        self.solve_lossy((many, &law), flow, &touch, to, bends, observer)
    }

    /// [`Self::collide_lossy`] by one rule.
    #[inline(always)]
    fn solve_lossy<const N: usize, const M: usize>(
        &self,
        (of, law): (&LossyRule<N, M>, &UnitLaw),
        flow: &Flow<4>,
        touch: &Knot<4>,
        to: f64,
        bends: &Bends,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Option<(Knot<4>, u64)> {
        let iterate = |workspace: &mut Workspace<'_, M>| self.iterate_lossy(of, law, touch, to, workspace);
        self.solve(&of.rule, iterate, flow, touch, bends, observer)
    }

    /// The contact by one rule; `None` if it is not of the kind that the rule is for.
    #[inline(always)]
    fn solve<const N: usize, const M: usize>(
        &self,
        rule: &Rule<N, M>,
        iterate: impl FnOnce(&mut Workspace<'_, M>) -> Option<Solution<M>>,
        flow: &Flow<4>,
        touch: &Knot<4>,
        bends: &Bends,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Option<(Knot<4>, u64)> {
        let mut workspace = Workspace {
            free: flow.expand(touch.excitation, &touch.y),
            moments: rule.undisturbed,
            last: rule.undisturbed_last,
            bends,
            bend: flow.partner_response(),
        };
        let Solution { depth, terms, depths, duration, iterations } = iterate(&mut workspace)?;
        let mut collision = Collision {
            of: self,
            rule,
            flow,
            touch,
            free: &workspace.free,
            bends,
            free_terms: free_terms(terms),
            terms,
            moments: &workspace.moments,
            last: &workspace.last,
            scale: duration * depth * depth.sqrt(),
            duration,
            depth,
            roots: depths.map(|z| (z * depth).sqrt()),
            end: [0.0; 4],
        };
        collision.end = collision.lift_off();
        if self.equations.may_part() && !self.force_stays_compressive(touch, &collision.end, duration) {
            return None;
        }
        observer.path(&collision);
        let excitation = collision.excitation(duration);
        let end = Knot { t: touch.t + duration, excitation, y: collision.end, clock: [1.0, 0.0] };
        Some((end, u64::from(iterations) * N as u64))
    }

    /// Newton's iteration for a contact from the moments of the undisturbed force, in the workspace, to its own; `None` if it is not of the
    /// kind that the rule is for. It is compiled once for a rule, not once more for every observer.
    #[inline(never)]
    fn iterate<const N: usize, const M: usize>(
        &self,
        (rule, newton): &Lossless<N, M>,
        touch: &Knot<4>,
        to: f64,
        Workspace { free, moments, last, bends, bend }: &mut Workspace<'_, M>,
    ) -> Option<Solution<M>> {
        let speed = self.side.sign() * (touch.y[3] - touch.y[1]);
        let depth = self.equations.greatest_depth(speed).powi(2);
        let undisturbed = DURATION * depth / speed;
        if speed.is_nan() || speed <= 0.0 {
            return None;
        }
        let terms = self.longest.iter().position(|&longest| undisturbed < longest)?;
        // z_free / depth, without the constant term, which is zero.
        let [x1, _, x2, _] = free.0;
        let to_depth = self.side.sign() / depth;
        let approach = Polynomial::<FREE>(std::array::from_fn(|b| (x2.0[b] - x1.0[b]) * to_depth)).over_s();
        let bent = bends.contribution(relative_position(bend, to_depth));
        let (mut depths, mut stretch) = (rule.depths, 1.0);
        let mut amounts = UNDISTURBED;
        let (mut before, mut iterations): (f64, u32) = (1.0, 0);
        let force = loop {
            let duration = stretch * undisturbed;
            let (mut pushed, mut pushed_last) = ([f64x4::ZERO; M], 0.0);
            for k in (1..=terms).rev() {
                for i in 0..M {
                    pushed[i] = pushed[i] * duration + moments[k][i] * self.gains[k];
                }
                pushed_last = pushed_last * duration + self.gains[k] * last[k];
            }
            let scale = duration * duration * depth.sqrt();
            let times = rule.times.map(|time| time * duration);
            let mean_rate = at_nodes(&approach, free_terms(terms) - 1, &times);
            let mut without: Nodes<M> = std::array::from_fn(|i| mean_rate[i] * times[i]);
            bent.add_to_nodes(&mut without, &times, free_terms(terms));
            let free_last = approach.at(duration) * duration + bent.at(duration);
            let residual: Nodes<M> = std::array::from_fn(|i| depths[i] - without[i] + pushed[i] * scale);
            let (change, lengthening) = newton.change(amounts, &residual, scale * pushed_last - free_last);
            for i in 0..M {
                depths[i] -= change[i];
            }
            stretch -= lengthening;
            iterations += 1;
            let size = change_size(&change, lengthening);
            // Each iteration gains about as much as the last: an error of about `size² / before` is left.
            let settled = size * size <= 0.3 * self.rtol * before;
            if size.is_nan() || size >= 0.5 * before || iterations == MAX_ITERATIONS {
                return None;
            }
            if iterations == 1 {
                amounts = newton.amounts(&change, lengthening);
                let (bend, longer) = newton.second_order(amounts);
                for i in 0..M {
                    depths[i] += bend[i];
                }
                stretch += longer;
            }
            before = size;
            let force = depths.map(|depth| depth * depth.sqrt());
            for k in usize::from(!settled)..=terms {
                moments[k] = product(&rule.moments[k], &force);
                last[k] = dot(&rule.last[k], &force);
            }
            if settled {
                break force;
            }
        };
        let duration = stretch * undisturbed;
        let kink = KINK[N / 4 - 2] * bent.kink(duration, FLAT / N as f64);
        let error = estimated_error(rule, &force, TAIL[(N / 4 - 2).min(TAIL.len() - 1)], kink);
        let is_right = error <= self.rtol && touch.t + duration < to;
        is_right.then_some(Solution { depth, terms, depths, duration, iterations })
    }
}

/// The largest magnitude of a change at the nodes and of the duration.
#[inline(always)]
pub(super) fn change_size<const M: usize>(change: &Nodes<M>, lengthening: f64) -> f64 {
    let largest = change.iter().fold(f64x4::splat(lengthening).abs(), |size, c| size.max(c.abs()));
    largest.to_array().into_iter().fold(0.0, f64::max)
}

/// The estimated error of a contact with these forces at the nodes, and with bends that would cause the error `kink` in an undisturbed
/// collision.
#[inline(always)]
pub(super) fn estimated_error<const N: usize, const M: usize>(
    rule: &Rule<N, M>,
    force: &Nodes<M>,
    share: f64,
    kink: f64,
) -> f64 {
    let tail = (dot(&rule.tails[0], force).powi(2) + dot(&rule.tails[1], force).powi(2)).sqrt();
    DISTURBED * kink + share * tail * tail.sqrt().sqrt()
}

/// The response of the depth to a bend, `scale (x2 - x1)`.
pub(super) fn relative_position(bend: &Expansion<4>, scale: f64) -> Polynomial<BLOCKS> {
    let [x1, _, x2, _] = bend.0;
    Polynomial(std::array::from_fn(|b| (x2.0[b] - x1.0[b]) * scale))
}

/// The response of its rate, `scale (v2 - v1)`.
pub(super) fn relative_velocity(bend: &Expansion<4>, scale: f64) -> Polynomial<BLOCKS> {
    let [_, v1, _, v2] = bend.0;
    Polynomial(std::array::from_fn(|b| (v2.0[b] - v1.0[b]) * scale))
}

/// The motion without contact, and the moments of the force at the nodes and at lift-off.
pub(super) struct Workspace<'a, const M: usize> {
    pub free: Expansion<4, FREE>,
    pub moments: [Nodes<M>; MOMENTS],
    pub last: [f64; MOMENTS],
    /// Where the force bends, and the response to a bend of 1.
    pub bends: &'a Bends,
    pub bend: &'a Expansion<4>,
}

pub(super) struct Solution<const M: usize> {
    /// Greatest depth of the undisturbed collision, m.
    pub depth: f64,
    /// Terms of the response to the force that are needed.
    pub terms: usize,
    /// At the nodes, over `depth`.
    pub depths: Nodes<M>,
    /// s
    pub duration: f64,
    pub iterations: u32,
}

/// Terms of the motion without contact that are needed: their error is about the square of the response's.
pub(super) fn free_terms(terms: usize) -> usize {
    terms + 4
}
