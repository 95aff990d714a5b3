//! Why something was not proven.

use crate::{Event, Interval};
use serde::{Serialize, Serializer};

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
    /// A motion may have more energy than it is to have: bounds on it, and what it is to have at most.
    #[error("the motion may have an E1max of {bound} J, and at most {1} J are to be proven", bound = .0.hi())]
    Above(Interval, f64),
    /// No motion to prove anything of.
    #[error("none found: the run settles on no periodic motion")]
    NoGuess,
}

impl Failure {
    /// That motions may come to an event, or not.
    pub(crate) fn open(event: Event) -> Self {
        if event == Event::Pull { Self::Pulls } else { Self::Graze(event) }
    }
}

impl Serialize for Failure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
