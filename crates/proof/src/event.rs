//! What happens to a motion: impacts, ends of contacts, crests of the force.

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

    /// Whether both are at one wall.
    pub fn is_beside(self, other: Self) -> bool {
        matches!((self, other), (Self::Touch(a), Self::Leave(b)) | (Self::Leave(a), Self::Touch(b)) if a == b)
    }

    /// What a motion does there, in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Crest => "reaches a crest of the force in flight",
            Self::Touch(Side::Primary) => "touches the structure",
            Self::Touch(Side::Obstacle) => "touches the obstacle",
            Self::Leave(Side::Primary) => "leaves the structure",
            Self::Leave(Side::Obstacle) => "leaves the obstacle",
            Self::Pull => "loses the force of a contact",
        }
    }
}
