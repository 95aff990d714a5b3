//! What happens to a motion: impacts, ends of contacts, crests of the force.

use crate::Failure;
use crate::equations::Mode;
use crate::number::FREE;
use retune_model::Side;

/// What happens to a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The force is at a crest, the damper in flight.
    Crest,
    /// The damper touches a wall.
    Touch(Side),
    /// The damper leaves a wall.
    Leave(Side),
    /// The force of a contact that loses energy ends before the contact does: no motion that is proven comes to it.
    Pull,
}

impl Event {
    /// The coordinate that has a fixed value there: the distance of the damper, the phase, or the speed.
    pub fn fixed(self) -> usize {
        match self {
            Self::Crest => 4,
            Self::Touch(_) | Self::Leave(_) => 0,
            Self::Pull => 1,
        }
    }

    /// The coordinates that have not, of an event that ends a segment.
    pub fn free(self) -> [usize; FREE] {
        if self == Self::Crest { [0, 1, 2, 3] } else { [1, 2, 3, 4] }
    }

    /// Whether motions come to it from below.
    pub fn is_rising(self) -> bool {
        matches!(self, Self::Crest | Self::Touch(Side::Obstacle))
    }

    /// What the damper does after it.
    pub fn mode_after(self) -> Mode {
        if let Self::Touch(side) = self { Mode::Contact(side) } else { Mode::Flight }
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Crest => "crest of the force",
            Self::Touch(Side::Primary) => "touches the structure",
            Self::Touch(Side::Obstacle) => "touches the obstacle",
            Self::Leave(Side::Primary) => "leaves the structure",
            Self::Leave(Side::Obstacle) => "leaves the obstacle",
            Self::Pull => "end of the force of a contact",
        }
    }

    /// That motions may come to it, or not.
    pub fn doubt(self) -> Failure {
        if self == Self::Pull { Failure::Pulls } else { Failure::Graze(self) }
    }
}
