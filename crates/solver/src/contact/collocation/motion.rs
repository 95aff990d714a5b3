//! The motion during a contact that was computed at once.

use super::bends::Bends;
use super::nodes::{Nodes, at_nodes, dot, node};
use super::response::{Collisions, FREE};
use super::rule::Rule;
use crate::contact::regularised::piece::{Piece, TIME, at_elapsed, knot};
use crate::linear::flow::{Expansion, Flow};
use crate::motion::form::Form;
use crate::motion::knot::Knot;
use crate::motion::lanes::each;
use crate::motion::linearised::{LinearContact, MOMENTS};
use crate::observe::observer::{Part, Path};
use nalgebra::DMatrix;
use retune_model::{Excitation, Growth, OverContact, RegularisedContact, RegularisedState};
use wide::f64x4;

/// A contact from touch-down to lift-off.
pub(super) struct Collision<'a, const N: usize, const M: usize> {
    pub(super) of: &'a Collisions,
    pub(super) rule: &'a Rule<N, M>,
    pub(super) flow: &'a Flow<4>,
    pub(super) touch: &'a Knot<4>,
    /// The motion without contact, and the terms of it and of the response to the force that are needed.
    pub(super) free: &'a Expansion<4, FREE>,
    pub(super) bends: &'a Bends,
    pub(super) free_terms: usize,
    pub(super) terms: usize,
    /// Moments of the force at the nodes and at lift-off, and the factor to impulses (N·s, over `K`).
    pub(super) moments: &'a [Nodes<M>; MOMENTS],
    pub(super) last: &'a [f64; MOMENTS],
    pub(super) scale: f64,
    pub(super) duration: f64,
    /// Greatest depth of the undisturbed collision, m.
    pub(super) depth: f64,
    /// `q = √z` at the nodes.
    pub(super) roots: Nodes<M>,
    /// `[x1, v1, x2, v2]` at lift-off.
    pub(super) end: [f64; 4],
}

impl<const N: usize, const M: usize> Collision<'_, N, M> {
    /// The state at lift-off, from the free motion and the moments of the force.
    #[inline(always)]
    pub(super) fn lift_off(&self) -> [f64; 4] {
        let (mut end, mut power) = (self.free.at(self.duration), self.scale);
        self.bends.add_to_state(&mut end, self.flow.partner_response(), self.duration);
        for (moment, kick) in self.last.iter().zip(&self.of.kicks).take(self.terms + 1) {
            for c in 0..4 {
                end[c] += kick[c] * power * moment;
            }
            power *= self.duration;
        }
        end[2] = end[0] + self.of.wall;
        end
    }

    /// A component of the state at the nodes.
    #[inline(always)]
    fn component(&self, c: usize) -> Nodes<M> {
        let times = self.rule.times.map(|time| time * self.duration);
        let mut nodes = at_nodes(&self.free.0[c], self.free_terms, &times);
        self.bends.contribution(self.flow.partner_response().0[c]).add_to_nodes(
            &mut nodes,
            &times,
            self.free_terms,
        );
        let mut power = self.scale;
        for (moment, kick) in self.moments.iter().zip(&self.of.kicks).take(self.terms + 1) {
            for i in 0..M {
                nodes[i] += moment[i] * (kick[c] * power);
            }
            power *= self.duration;
        }
        nodes
    }

    /// The force and its partner `elapsed` seconds after touch-down.
    #[inline(always)]
    pub(super) fn excitation(&self, elapsed: f64) -> Excitation {
        let pair = self.flow.excitation_after(self.touch.excitation, elapsed);
        self.bends.bent_excitation(pair, self.flow.linear().frequency, elapsed)
    }

    /// The state at one node, equal to [`Self::component`] to the last bit.
    fn state(&self, i: usize) -> [f64; 4] {
        let time = node(&self.rule.times, i) * self.duration;
        let first_terms = |blocks: &[f64x4], s: f64| {
            let mut value = 0.0;
            for block in blocks.iter().take(self.free_terms.div_ceil(4)).rev() {
                for coefficient in block.to_array().into_iter().rev() {
                    value = value * s + coefficient;
                }
            }
            value
        };
        each(|c| {
            let mut value = first_terms(&self.free.0[c].0, time);
            for &[bent, jump] in self.bends.all() {
                value += first_terms(&self.flow.partner_response().0[c].0, (time - bent).max(0.0)) * jump;
            }
            let mut power = self.scale;
            for (moment, kick) in self.moments.iter().zip(&self.of.kicks).take(self.terms + 1) {
                value += node(moment, i) * (kick[c] * power);
                power *= self.duration;
            }
            value
        })
    }

    /// `θ = ∫ dt / √z` at a knot.
    fn theta(&self, slope: &Nodes<M>, knot: usize) -> f64 {
        match knot {
            0 => 0.0,
            inner if inner <= N => {
                let columns = self.rule.running.iter().enumerate();
                columns.map(|(j, column)| node(column, inner - 1) * node(slope, j)).sum()
            }
            _ => dot(&self.rule.whole, slope),
        }
    }

    /// `τ` of a knot: touch-down, the nodes, lift-off.
    fn time(&self, knot: usize) -> f64 {
        match knot {
            0 => 0.0,
            inner if inner <= N => node(&self.rule.times, inner - 1),
            _ => 1.0,
        }
    }

    /// Bounds on the motion over the whole contact.
    #[inline(always)]
    fn bounds_over_contact(&self) -> Option<OverContact> {
        let Collisions { equations, amplitude, .. } = self.of;
        let touch = equations.regularise(&self.touch.y);
        equations.over_contact(&touch, self.depth.sqrt(), self.duration, *amplitude)
    }

    fn growth(&self) -> Option<Growth<3>> {
        self.bounds_over_contact().map(|over| self.of.equations.growth_over_contact(&over))
    }

    fn knot(&self, knot: usize) -> Knot<4> {
        let elapsed = self.time(knot) * self.duration;
        let (y, root) = match knot {
            0 => (self.touch.y, 0.0),
            inner if inner <= N => (self.state(inner - 1), node(&self.roots, inner - 1)),
            _ => (self.end, 0.0),
        };
        Knot {
            t: self.touch.t + elapsed,
            excitation: self.excitation(elapsed),
            y,
            clock: [root, 0.5 * self.of.side.sign() * (y[3] - y[1])],
        }
    }
}

impl<const N: usize, const M: usize> Collision<'_, N, M> {
    /// The integrals of `z^1.5 dz/dt` at the nodes and at lift-off.
    fn drags(&self, powers: &[f64; MOMENTS]) -> Vec<[f64; MOMENTS]> {
        let drag = |j: usize| {
            let (y, root) = (self.state(j), node(&self.roots, j));
            root.powi(3) * self.of.side.sign() * (y[3] - y[1])
        };
        let drag: [f64; N] = std::array::from_fn(drag);
        let mut all = vec![[0.0; MOMENTS]; N + 1];
        for k in 0..=self.terms {
            for (j, drag) in drag.iter().enumerate() {
                for (i, integrals) in all.iter_mut().enumerate() {
                    let moment =
                        if i < N { node(&self.rule.moments[k][j], i) } else { node(&self.rule.last[k], j) };
                    integrals[k] += powers[k] * moment * drag;
                }
            }
        }
        all
    }
}

impl<const N: usize, const M: usize> Collision<'_, N, M> {
    /// A piece from a state, with the derivative there, over a length in θ.
    fn piece<'a>(
        &self,
        equations: &'a RegularisedContact,
        (from, slope): (&'a RegularisedState, &'a RegularisedState),
        length: f64,
        ends: [Knot<4>; 2],
    ) -> Piece<'a> {
        Piece {
            equations,
            touch_down: ends[0].t,
            from,
            slope,
            length,
            // Nodes are about as far apart as the steps that `rtol` asks for, and farther near the ends. Where energy is lost a contact has
            // more of them: one step is enough except at the tightest tolerances.
            steps: if self.of.loss.is_some() && self.of.rtol >= 1e-11 { 1 } else { 2 },
            ends,
            energy: f64::INFINITY,
            bounds: Default::default(),
            shared: None,
        }
    }
}

impl<const N: usize, const M: usize> Path<4> for Collision<'_, N, M> {
    fn pieces(&self) -> usize {
        N + 1
    }

    #[inline(always)]
    fn states(&self, visit: &mut dyn FnMut(f64, &[f64; 4])) {
        visit(0.0, &self.touch.y);
        // Written out, so that the compiler drops the components that a visitor does not use.
        let [x1, v1] = [self.component(0), self.component(1)];
        let [x2, v2] = [self.component(2), self.component(3)];
        for i in 0..N {
            let state = [node(&x1, i), node(&v1, i), node(&x2, i), node(&v2, i)];
            visit(self.duration * node(&self.rule.times, i), &state);
        }
        visit(self.duration, &self.end);
    }

    fn ends(&self) -> [&[f64; 4]; 2] {
        [&self.touch.y, &self.end]
    }

    #[inline(always)]
    fn rise(&self, form: &Form<4>) -> f64 {
        let (kick, hertz_rate) = (&self.of.kicks[0], self.of.equations.hertz_rate());
        self.bounds_over_contact().map_or(f64::INFINITY, |over| form.rise_in_contact(kick, hertz_rate, &over))
    }

    fn second_derivative(&self, form: &Form<4>) -> f64 {
        // 2! of a Taylor coefficient
        self.growth().map_or(f64::INFINITY, |growth| 2.0 * form.in_contact::<3>(&growth, &[[0.0; 3]; 4], 2))
    }

    fn first_derivative(&self, form: &Form<4>) -> f64 {
        self.growth().map_or(f64::INFINITY, |growth| {
            let rates = growth.map(|[_, first, second]| [first, 2.0 * second, 0.0]);
            form.in_contact::<3>(&growth, &rates, 1)
        })
    }

    /// The segment between two knots is integrated from the first of them, and cut where the force bends.
    fn show(&self, piece: usize, visit: &mut dyn FnMut(Part<'_, 4>)) {
        let [mut begin, end] = [self.knot(piece), self.knot(piece + 1)];
        let [mut now, last] = [piece, piece + 1].map(|knot| self.time(knot) * self.duration);
        let mut from = self.of.equations.regularise(&begin.y);
        from[0] = begin.clock[0];
        let mut equations = self.of.equations.clone();
        let slope: Nodes<M> = std::array::from_fn(|i| self.rule.rates[i] / self.roots[i]);
        let mut length = self.duration * (self.theta(&slope, piece + 1) - self.theta(&slope, piece));
        for &[time, jump] in self.bends.all() {
            if time < now || time >= last {
                continue;
            }
            equations.set_excitation(0.0, begin.excitation);
            let derivative = equations.derivative(&from);
            let whole = self.piece(&equations, (&from, &derivative), length, [begin, end]);
            let (theta, mut bent) = at_elapsed(|theta| whole.advance(theta), length, time - now);
            let mut at = knot(&equations, begin.t, &bent);
            if theta > 0.0 {
                let before = self.piece(&equations, (&from, &derivative), theta, [begin, at]);
                visit(Part::Segment(&before));
            }
            visit(Part::Discontinuity);
            at.excitation[1] += jump;
            bent[TIME] = 0.0;
            (begin, now, from, length) = (at, time, bent, length - theta);
        }
        equations.set_excitation(0.0, begin.excitation);
        let derivative = equations.derivative(&from);
        let mut rest = self.piece(&equations, (&from, &derivative), length, [begin, end]);
        // On the clock of lossy contacts, which suits their force, the integral of 1/√z has fewer digits: an error of 1e-11 was seen.
        if self.of.loss.is_some() && self.of.rtol < 1e-10 {
            rest.meet_end();
        }
        visit(Part::Segment(&rest));
    }

    fn linearised(&self, loss: bool) -> LinearContact {
        let (rule, of, terms) = (self.rule, self.of, self.terms + 1);
        let powers: [f64; MOMENTS] = std::array::from_fn(|k| self.duration.powi(k as i32 + 1));
        let force = self.depth * self.depth.sqrt();
        let mut reductions = DMatrix::zeros(N + 1, N);
        let (mut last, mut added) = ([f64x4::ZERO; M], [[f64x4::ZERO; M]; 4]);
        for k in 0..terms {
            for i in 0..M {
                last[i] += rule.last[k][i] * (powers[k] * of.gains[k]);
                for c in 0..4 {
                    added[c][i] += rule.last[k][i] * (powers[k] * of.kicks[k][c]);
                }
            }
        }
        for j in 0..N {
            let mut sum = [f64x4::ZERO; M];
            for k in 0..terms {
                for i in 0..M {
                    sum[i] += rule.moments[k][j][i] * (powers[k] * of.gains[k]);
                }
            }
            let column = (0..N).map(|i| node(&sum, i)).chain([node(&last, j)]);
            reductions.column_mut(j).iter_mut().zip(column).for_each(|(to, from)| *to = from);
        }
        let moment = |k: usize, i: usize| if i < N { node(&self.moments[k], i) } else { self.last[k] };
        let drags = if loss { self.drags(&powers) } else { Vec::new() };
        LinearContact {
            side: of.side,
            touch: *self.touch,
            end: self.end,
            duration: self.duration,
            times: (0..=N).map(|i| if i < N { node(&rule.times, i) } else { 1.0 }).collect(),
            roots: (0..N).map(|j| node(&self.roots, j)).collect(),
            terms,
            impulses: (0..=N).map(|i| std::array::from_fn(|k| powers[k] * force * moment(k, i))).collect(),
            drags,
            kicks: of.kicks,
            gains: of.gains,
            reductions,
            additions: (0..N).map(|j| added.each_ref().map(|added| node(added, j))).collect(),
        }
    }
}
