//! What happens to a motion: impacts, ends of contacts, crests of the force; and why something was not proven.

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

/// Why something was not proven: it may be true all the same.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The proof does not cover such scenes.
    #[error(
        "{0}: nothing is proven of such scenes; give damping, a periodic forcing, and Hertz's surfaces or no walls"
    )]
    Scene(&'static str),
    /// A motion comes to a wall, or to the end of a contact, so slowly that it may as well not come there.
    #[error("cannot be proven here: the motion grazes, that is, it is open whether it {}", .0.name())]
    Graze(Event),
    /// A contact may lose so much that its force ends before it.
    #[error(
        "cannot be proven here: the force of a contact may end, at 1 + lambda dz/dt = 0, before the contact does"
    )]
    Pulls,
    /// No box was found that the motions stay in during a step of this length, from a box of this width.
    #[error(
        "cannot be proven here: no step of {0:e} s (in a contact s/√m) from a box of the width {1:e} could be enclosed"
    )]
    Step(f64, f64),
    /// A segment does not end within so many steps.
    #[error("cannot be proven here: no next impact, end of a contact or crest of the force within {0} steps")]
    Endless(usize),
    /// The guess does not repeat after so many periods of the force: so far it is off.
    #[error(
        "the guess is refused: after {0} periods of the force it is {1:e} (m, m/s or rad) from where it began, and Newton's iteration does not close that"
    )]
    Guess(usize, f64),
    /// The sequence of events of a guess changed while it was improved.
    #[error("cannot be proven here: the sequence of impacts is another one from one iteration to the next")]
    Sequence,
    /// Krawczyk's operator maps no box into itself: the width of the last box, and of what became of it.
    #[error(
        "cannot be proven here: Krawczyk's operator maps no box about the motion into itself; the last one was {0:e} wide (m, m/s or rad) and became {1:e} wide"
    )]
    Krawczyk(f64, f64),
    /// A motion that is to be stable was not proven to be.
    #[error("the motion is not proven to be stable")]
    NotStable,
}

impl Failure {
    /// That motions may come to an event, or not.
    pub(crate) fn open(event: Event) -> Self {
        if event == Event::Pull { Self::Pulls } else { Self::Graze(event) }
    }
}
