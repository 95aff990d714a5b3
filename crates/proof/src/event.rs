//! What happens to a motion: impacts, ends of contacts, crests of the force.

use crate::number::SPEED;
use retune_model::Side;
use std::fmt;

/// What happens to a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The force is at a crest, the damper in flight.
    Crest,
    /// The damper touches a wall.
    Touch(Side),
    /// The damper leaves a wall.
    Leave(Side),
}

impl Event {
    /// The coordinate that has a fixed value there: the phase, or the distance of the damper.
    pub fn fixed(self) -> usize {
        if self == Self::Crest { 4 } else { 0 }
    }

    /// The coordinates that have not.
    pub fn free(self) -> impl Iterator<Item = usize> + Clone {
        (0..SPEED).filter(move |&i| i != self.fixed())
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Crest => "reach a crest of the force in flight",
            Self::Touch(Side::Primary) => "touch the structure",
            Self::Touch(Side::Obstacle) => "touch the obstacle",
            Self::Leave(Side::Primary) => "leave the structure",
            Self::Leave(Side::Obstacle) => "leave the obstacle",
        })
    }
}
