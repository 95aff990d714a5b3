//! Where the force bends during a contact: at the samples of a record.
//!
//! Without contact, a jump `g` of the force's partner (see `retune_model::Excitation`) at the time `b` adds `g r(t - b)` to the motion from
//! then on, with the response `r` to a partner of 1, whose depth begins like `(t - b)³`, or later where the base moves. So the motion
//! without contact is still exact. The force of the contact is no polynomial there, but nearly one: the resulting error follows from
//! [`BendContribution::kink`] (see `solve::KINK`).

use super::nodes::{Nodes, at_nodes};
use crate::linear::flow::Expansion;
use crate::motion::polynomial::{BLOCKS, Polynomial};
use retune_model::Excitation;
use wide::f64x4;

/// Limit on bends in a contact that is computed at once.
const MOST: usize = 24;

/// The times of the bends, s since touch-down, and the jumps of the force's partner there, N.
pub struct Bends {
    all: [[f64; 2]; MOST],
    count: usize,
}

impl Bends {
    pub const NONE: Self = Self { all: [[0.0; 2]; MOST], count: 0 };

    /// Adds a bend later than all others; `false` if there are too many.
    pub fn push(&mut self, time: f64, jump: f64) -> bool {
        let Some(place) = self.all.get_mut(self.count) else { return false };
        *place = [time, jump];
        self.count += 1;
        true
    }

    /// Times and jumps, in their order.
    #[inline(always)]
    pub fn all(&self) -> &[[f64; 2]] {
        &self.all[..self.count]
    }

    /// The force and its partner `elapsed` seconds after touch-down (at a bend, just before it), from those of a force that does not bend;
    /// `omega` as in `f' = -ω s`.
    pub fn bent_excitation(&self, mut pair: Excitation, omega: f64, elapsed: f64) -> Excitation {
        for &[time, jump] in self.all() {
            let since = elapsed - time;
            if since > 0.0 {
                pair[0] -= omega * since * jump;
                pair[1] += jump;
            }
        }
        pair
    }

    /// The contribution of the bends to a quantity whose response to a jump of 1 is `one`.
    pub fn contribution(&self, one: Polynomial<BLOCKS>) -> BendContribution<'_> {
        BendContribution { bends: self, one }
    }

    pub fn add_to_state(&self, state: &mut [f64; 4], response: &Expansion<4>, elapsed: f64) {
        for (state, one) in state.iter_mut().zip(&response.0) {
            *state += self.contribution(*one).at(elapsed);
        }
    }
}

/// The contribution of bends to a quantity of the motion.
pub struct BendContribution<'a> {
    bends: &'a Bends,
    one: Polynomial<BLOCKS>,
}

impl BendContribution<'_> {
    /// Adds it to the values at these times, s since touch-down, with this many terms of the response.
    #[inline(always)]
    pub fn add_to_nodes<const M: usize>(&self, nodes: &mut Nodes<M>, times: &Nodes<M>, terms: usize) {
        for &[time, jump] in self.bends.all() {
            let since = times.map(|t| (t - time).fast_max(f64x4::ZERO));
            let response = at_nodes(&self.one, terms, &since);
            for i in 0..M {
                nodes[i] += response[i] * jump;
            }
        }
    }

    #[inline(always)]
    pub fn at(&self, elapsed: f64) -> f64 {
        let all = self.bends.all().iter();
        all.map(|&[time, jump]| jump * self.one.at((elapsed - time).max(0.0))).sum()
    }

    /// A bound on the cubes `(t - b)³` that the bends in a contact of `duration` seconds add by its end, with a share of all higher powers.
    pub fn kink(&self, duration: f64, share: f64) -> f64 {
        let cube = self.one.coefficient(3).abs() * duration.powi(3);
        let all = Polynomial(self.one.0.map(|block| block.abs())).at(duration);
        let within = self.bends.all().iter().filter(|[time, _]| *time < duration);
        within.map(|[_, jump]| jump.abs() * (cube + share * (all - cube))).sum()
    }
}
