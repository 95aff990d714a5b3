//! Events of a motion: impacts, ends of contacts, crests of the force; and the reasons why a proof fails.

use crate::number::FREE;
use retune_model::Side;
use serde::Serialize;
use std::fmt;

/// An event of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The force is at a crest, the damper in flight.
    Crest,
    /// The damper touches a wall.
    Touch(Side),
    /// The damper leaves a wall.
    Leave(Side),
    /// The force of a contact that loses energy ends before the contact does. No proven motion reaches it.
    Pull,
}

impl Event {
    /// The index of the coordinate that is fixed there: the distance of the damper, the phase, or the speed.
    pub fn fixed(self) -> usize {
        match self {
            Self::Crest => 4,
            Self::Touch(_) | Self::Leave(_) => 0,
            Self::Pull => 1,
        }
    }

    /// The indices of the free coordinates, of an event that ends a segment.
    pub fn free(self) -> [usize; FREE] {
        if self == Self::Crest { [0, 1, 2, 3] } else { [1, 2, 3, 4] }
    }

    /// Whether motions reach it from below.
    pub fn is_rising(self) -> bool {
        matches!(self, Self::Crest | Self::Touch(Side::Obstacle))
    }

    /// Whether they are the touch and the leave of one wall.
    pub fn is_beside(self, other: Self) -> bool {
        matches!((self, other), (Self::Touch(a), Self::Leave(b)) | (Self::Leave(a), Self::Touch(b)) if a == b)
    }

    /// Its name: what a motion does there, in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Crest => "reaches a crest of the force in flight",
            Self::Touch(Side::Primary) => "touches the structure",
            Self::Touch(Side::Obstacle) => "touches the obstacle",
            Self::Leave(Side::Primary) => "leaves the structure",
            Self::Leave(Side::Obstacle) => "leaves the obstacle",
            Self::Pull => "loses the force of a contact before its end, at 1 + lambda dz/dt = 0",
        }
    }
}

/// A multiplier computed in doubles at the middles of the derivatives, not proven; without the sign of its imaginary part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Multiplier {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
    /// The largest width of the derivatives of the segments.
    pub derivatives: f64,
}

impl fmt::Display for Multiplier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { re, im, derivatives } = self;
        let pair = if *im == 0.0 { String::new() } else { format!(" ± {im:.6}i") };
        write!(f, "the largest multiplier is about {re:.6}{pair}, by derivatives {derivatives:.1e} wide")
    }
}

/// Why a proof failed, in which step, and at which width there (in m, m/s or rad): the statement may still be true.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The proof does not cover such scenes.
    #[error(
        "{0}: nothing is proven of such scenes; give damping, a periodic forcing, and Hertz's surfaces or no walls"
    )]
    Scene(&'static str),
    /// No closed form: without force the system may not come to rest.
    #[error("in closed form: no dashpot is proven to bring the system to rest")]
    Undamped,
    /// A motion reaches a wall, the end of a contact, or that of its force so slowly that it may also miss it, from a box of this width.
    #[error("at an event: a graze: it is open whether the motion {name}; its box is {1:.1e} wide", name = .0.name())]
    Graze(Event, f64),
    /// No enclosure was found for a step of this length, from a box of this width.
    #[error("in a step of {0:.1e} s (in a contact s/√m): no enclosure is found; its box is {1:.1e} wide")]
    Step(f64, f64),
    /// A segment does not end within this number of steps; its box then has this width.
    #[error("in a segment: no impact, lift-off or crest within {0} steps; its box is {1:.1e} wide")]
    Endless(usize, f64),
    /// The guess does not repeat after this number of periods of the force; the second number is its gap.
    #[error("the guess is refused; after {0} period{s} of the force it is {1:.1e} (m, m/s or rad) off", s = if *_0 == 1 { "" } else { "s" })]
    Guess(usize, f64),
    /// The sequence of events changed with a Newton change of this size.
    #[error("by Newton's iteration: the sequence of impacts becomes another one by a change of {0:.1e}")]
    Sequence(f64),
    /// Krawczyk's operator maps no box into itself: the widths of the last box and of its image.
    #[error("by Krawczyk's operator: no box is mapped into itself; one {0:.1e} wide becomes {1:.1e} wide")]
    Krawczyk(f64, f64),
    /// A motion required to be stable was not proven to be.
    #[error("the motion is not proven to be stable: {0}")]
    NotStable(Multiplier),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_failure_says_its_step_and_the_width_there() {
        let w = 1.5e-9;
        let multiplier = Multiplier { re: -0.99, im: 0.0, derivatives: w };
        for (failure, step) in [
            (Failure::Graze(Event::Touch(Side::Primary), w), "at an event"),
            (Failure::Step(1e-3, w), "in a step"),
            (Failure::Endless(9, w), "in a segment"),
            (Failure::Guess(2, w), "the guess is refused"),
            (Failure::Sequence(w), "by Newton's iteration"),
            (Failure::Krawczyk(w, 2.0), "by Krawczyk's operator"),
            (Failure::NotStable(multiplier), "the motion is not proven to be stable"),
        ] {
            let words = failure.to_string();
            assert!(words.starts_with(step) && words.contains("1.5e-9"), "{words}");
        }
    }
}
