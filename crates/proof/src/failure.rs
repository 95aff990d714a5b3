//! Why something was not proven.

use crate::event::Event;
use serde::{Serialize, Serializer};

/// Why something was not proven: it may be true all the same.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The proof does not cover such scenes.
    #[error(
        "{0}: nothing is proven of such scenes; give a damper, a periodic forcing, and Hertz's surfaces or no walls"
    )]
    Scene(&'static str),
    /// A motion comes to a wall, or to the end of a contact, so slowly that it may as well not come there.
    #[error("cannot be proven here: the motion grazes, that is, it may or may not {}", may(.0))]
    Graze(Event),
    /// A contact may lose so much that its force ends before it.
    #[error(
        "cannot be proven here: the force of a contact may end, at 1 + lambda dz/dt = 0, before the contact does"
    )]
    Pulls,
    /// No box was found that the motions stay in during a step.
    #[error(
        "cannot be proven here: no step of {least:e} s (in a contact s/√m) from a box of the width {width:e} could be enclosed"
    )]
    Step {
        /// The length of the step.
        least: f64,
        /// The largest width of the box.
        width: f64,
    },
    /// A segment does not end.
    #[error(
        "cannot be proven here: no next impact, end of a contact or crest of the force within {steps} steps"
    )]
    Endless {
        /// How many.
        steps: usize,
    },
    /// The guess does not repeat.
    #[error(
        "the guess is refused: after {periods} periods of the force it is {gap:e} (m, m/s or rad) from where it began, and Newton's iteration does not close that"
    )]
    Guess {
        /// Periods of the force.
        periods: usize,
        /// How far it is off.
        gap: f64,
    },
    /// The sequence of events of a guess changed while it was improved.
    #[error("cannot be proven here: the sequence of impacts is another one from one iteration to the next")]
    Sequence,
    /// Krawczyk's operator maps no box into itself.
    #[error(
        "cannot be proven here: Krawczyk's operator maps no box about the motion into itself; the last one was {width:e} wide (m, m/s or rad) and became {image:e} wide"
    )]
    Krawczyk {
        /// The width of the last box tried.
        width: f64,
        /// The width of what became of it.
        image: f64,
    },
    /// A motion that is to be stable was not proven to be.
    #[error("the motion is not proven to be stable")]
    NotStable,
    /// A motion may have more energy than it is to have.
    #[error("the motion may have an E1max of {bound} J, and at most {most} J are to be proven")]
    Above {
        /// What it has at least.
        least: f64,
        /// What it has at most.
        bound: f64,
        /// What it is to have at most.
        most: f64,
    },
    /// No motion to prove anything of.
    #[error("none found: the run settles on no periodic motion")]
    NoGuess,
}

/// What a motion that grazes may do.
fn may(event: &Event) -> String {
    match event.name().split_once(' ') {
        Some(("touches", wall)) => format!("touch {wall}"),
        Some(("leaves", wall)) => format!("leave {wall}"),
        _ => format!("reach a {} in flight", event.name()),
    }
}

impl Serialize for Failure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
