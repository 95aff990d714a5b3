//! Where the energy of a motion goes: into the dashpot of the structure, that of the damper, and impacts.

use crate::contact::collocation::quadrature::gauss;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::observe::observer::{Impact, Observer, Part, Path};
use retune_model::{Bare, Coupled};

/// Nodes of Gauss's rule on a segment. In a step of the exact flow, and of a contact, the fastest motion turns by at most 1.25 and 1.5 rad, over which
/// the rule is exact to rounding; in one of a held contact by 3, over which it is to 1e-10.
const NODES: usize = 8;

/// The same in a piece of a contact that was computed at once, where each is reached by steps of its own: the motion turns by 0.3 rad there, at most by
/// half a radian where little accuracy is asked for, and the rule is exact to 1e-12.
const IN_PIECES: usize = 5;

/// The energy that a motion loses, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// In the dashpot c1 of the structure.
    pub structure: f64,
    /// In the dashpot c2 of the damper.
    pub damper: f64,
    /// In impacts.
    pub impacts: f64,
}

impl Losses {
    /// All of it, J.
    pub fn total(&self) -> f64 {
        self.structure + self.damper + self.impacts
    }
}

/// A system that loses energy.
pub(crate) trait Loses<const N: usize> {
    /// The power, W, that goes into the structure's dashpot, into the damper's, and into a contact.
    fn powers(&self, knot: &Knot<N>) -> [f64; 3];
    /// What an impact takes of the energy, J.
    fn taken(&self, impact: &Impact<N>) -> f64;
}

impl Loses<2> for Bare {
    fn powers(&self, knot: &Knot<2>) -> [f64; 3] {
        [self.dashpot_loss(knot.excitation, knot.y[1]), 0.0, 0.0]
    }
    /// Nothing strikes it.
    fn taken(&self, _impact: &Impact<2>) -> f64 {
        0.0
    }
}

impl Loses<4> for Coupled {
    fn powers(&self, knot: &Knot<4>) -> [f64; 3] {
        // A wall that would pull is left behind, still indented: what it holds is lost, too.
        let contact = self.contact_loss(&knot.y);
        [self.bare().dashpot_loss(knot.excitation, knot.y[1]), self.damper_loss(&knot.y), contact]
    }
    fn taken(&self, impact: &Impact<4>) -> f64 {
        self.kinetic_energy(&impact.before.y) - self.kinetic_energy(&impact.after.y)
    }
}

/// Adds up what a motion loses.
pub(crate) struct Lost<'a, S> {
    system: &'a S,
    /// Nodes on [0, 1] with their weights, for a segment and for a piece of a contact.
    rule: Vec<(f64, f64)>,
    in_pieces: Vec<(f64, f64)>,
    lost: [f64; 3],
}

impl<'a, S> Lost<'a, S> {
    /// Of a system; nothing yet.
    pub fn new(system: &'a S) -> Self {
        let [rule, in_pieces] = [NODES, IN_PIECES].map(|count| {
            let (nodes, weights) = gauss(count, 0);
            nodes.into_iter().zip(weights).collect()
        });
        Self { system, rule, in_pieces, lost: [0.0; 3] }
    }

    fn add(&mut self, more: [f64; 3]) {
        self.lost.iter_mut().zip(more).for_each(|(lost, more)| *lost += more);
    }

    /// What has been lost, J.
    pub fn all(&self) -> Losses {
        let [structure, damper, impacts] = self.lost;
        Losses { structure, damper, impacts }
    }
}

/// What a segment loses, J, by a rule.
fn lost_in<S: Loses<N>, const N: usize>(
    system: &S,
    rule: &[(f64, f64)],
    segment: &dyn Segment<N>,
) -> [f64; 3] {
    let mut lost = [0.0; 3];
    for (node, weight) in rule {
        let knot = segment.at(node * segment.length());
        let time = weight * segment.length() * knot.clock[0];
        lost.iter_mut().zip(system.powers(&knot)).for_each(|(lost, power)| *lost += power * time);
    }
    lost
}

impl<S: Loses<N>, const N: usize> Observer<N> for Lost<'_, S> {
    fn segment(&mut self, segment: &dyn Segment<N>) {
        self.add(lost_in(self.system, &self.rule, segment));
    }
    fn path(&mut self, path: &dyn Path<N>) {
        for piece in 0..path.pieces() {
            path.show(piece, &mut |part| {
                if let Part::Segment(segment) = part {
                    self.add(lost_in(self.system, &self.in_pieces, segment));
                }
            });
        }
    }
    fn impact(&mut self, impact: &Impact<N>) {
        self.lost[2] += self.system.taken(impact);
    }
}
