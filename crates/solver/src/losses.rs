//! The energy that a motion loses in the dashpot of the structure, in that of the damper, and in impacts.

use crate::contact::collocation::quadrature::gauss;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::observe::observer::{Impact, Observer, Part, Path};
use retune_model::{Bare, Coupled};

/// Nodes of Gauss's rule on a segment. The phase of the fastest motion advances by at most 1.25 rad in a step of the exact flow and 1.5 rad
/// in one of a contact, over which the rule is exact to rounding; in a step of a held contact by 3 rad, over which it is exact to 1e-10.
const NODES: usize = 8;

/// Nodes in a piece of a contact that was computed at once, where each takes separate steps: the phase advances by 0.3 rad there, at most
/// by half a radian at loose tolerances, and the rule is exact to 1e-12.
const PIECE_NODES: usize = 5;

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
    /// The total, J.
    pub fn total(&self) -> f64 {
        self.structure + self.damper + self.impacts
    }
}

/// A system that loses energy.
pub(crate) trait Dissipative<const N: usize> {
    /// The power, W, dissipated in the structure's dashpot, in the damper's, and in a contact.
    fn dissipated_powers(&self, knot: &Knot<N>) -> [f64; 3];
    /// The energy lost in an impact, J.
    fn impact_loss(&self, impact: &Impact<N>) -> f64;
}

impl Dissipative<2> for Bare {
    fn dissipated_powers(&self, knot: &Knot<2>) -> [f64; 3] {
        [self.dashpot_loss(knot.excitation, knot.y[1]), 0.0, 0.0]
    }
    fn impact_loss(&self, _impact: &Impact<2>) -> f64 {
        0.0
    }
}

impl Dissipative<4> for Coupled {
    fn dissipated_powers(&self, knot: &Knot<4>) -> [f64; 3] {
        // A damper leaves a wall that would pull while it is still indented: the energy stored there is lost, too.
        let contact = self.contact_loss(&knot.y);
        [self.bare().dashpot_loss(knot.excitation, knot.y[1]), self.damper_loss(&knot.y), contact]
    }
    fn impact_loss(&self, impact: &Impact<4>) -> f64 {
        self.kinetic_energy(&impact.before.y) - self.kinetic_energy(&impact.after.y)
    }
}

/// Accumulates the energy that a motion loses.
pub(crate) struct LossObserver<'a, S> {
    system: &'a S,
    /// Nodes on [0, 1] with their weights, for a segment and for a piece of a contact.
    rule: Vec<(f64, f64)>,
    piece_rule: Vec<(f64, f64)>,
    lost: [f64; 3],
}

impl<'a, S> LossObserver<'a, S> {
    pub fn new(system: &'a S) -> Self {
        let [rule, piece_rule] = [NODES, PIECE_NODES].map(|count| {
            let (nodes, weights) = gauss(count, 0);
            nodes.into_iter().zip(weights).collect()
        });
        Self { system, rule, piece_rule, lost: [0.0; 3] }
    }

    fn add(&mut self, more: [f64; 3]) {
        self.lost.iter_mut().zip(more).for_each(|(lost, more)| *lost += more);
    }

    /// The energy lost so far, J.
    pub fn losses(&self) -> Losses {
        let [structure, damper, impacts] = self.lost;
        Losses { structure, damper, impacts }
    }
}

/// The energy lost in a segment, J, by a quadrature rule.
fn segment_losses<S: Dissipative<N>, const N: usize>(
    system: &S,
    rule: &[(f64, f64)],
    segment: &dyn Segment<N>,
) -> [f64; 3] {
    let mut lost = [0.0; 3];
    for (node, weight) in rule {
        let knot = segment.at(node * segment.length());
        let time = weight * segment.length() * knot.clock[0];
        lost.iter_mut().zip(system.dissipated_powers(&knot)).for_each(|(lost, power)| *lost += power * time);
    }
    lost
}

impl<S: Dissipative<N>, const N: usize> Observer<N> for LossObserver<'_, S> {
    fn segment(&mut self, segment: &dyn Segment<N>) {
        self.add(segment_losses(self.system, &self.rule, segment));
    }
    fn path(&mut self, path: &dyn Path<N>) {
        for piece in 0..path.pieces() {
            path.show(piece, &mut |part| {
                if let Part::Segment(segment) = part {
                    self.add(segment_losses(self.system, &self.piece_rule, segment));
                }
            });
        }
    }
    fn impact(&mut self, impact: &Impact<N>) {
        self.lost[2] += self.system.impact_loss(impact);
    }
}
