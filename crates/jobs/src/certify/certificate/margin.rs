//! How far the force and the parameters may be off before a motion with 5 % more is there.

use super::motions::periodic;
use crate::amount::{Amount, measured};
use retune_study::{rounded, short};
use serde::Serialize;

/// A motion with 5 % more than runs from rest, where it begins.
#[derive(Clone, Debug, Serialize)]
pub struct Other {
    #[serde(flatten)]
    pub value: Amount,
    pub omega: f64,
    pub k1: f64,
    /// `[x1, v1, x2, v2]` of it at a crest of the force.
    pub state: [f64; 4],
    /// Periods of the force after which it repeats; null where it does not.
    pub periods: Option<usize>,
    /// The walls that it strikes in turn: S the structure, O the obstacle.
    pub impacts: String,
}

/// The margins of a design. Forces are multiples of its own.
#[derive(Clone, Debug, Serialize)]
pub struct Margin {
    /// The least margin of the force of a robust design.
    pub needed_force: f64,
    /// The forces at which motions were looked for, beside its own.
    pub forces: Vec<f64>,
    /// The force up to which none was found.
    pub safe_to: f64,
    /// The motion that begins there; null where none was found up to the largest of the forces.
    pub other: Option<Other>,
    /// The least relative error of a parameter of a robust design, %.
    pub needed_percent: f64,
    /// The parameters whose errors of that size bring such a motion, of those that were found at more force.
    pub parameters: Vec<Error>,
}

/// The least error of a parameter that brings another motion.
#[derive(Clone, Debug, Serialize)]
pub struct Error {
    pub parameter: &'static str,
    pub percent: f64,
    #[serde(flatten)]
    pub other: Other,
}

impl Other {
    pub fn words(&self) -> String {
        let Self { value, omega, k1, periods, impacts, .. } = self;
        let kind = periods.map_or_else(|| "irregular".to_owned(), |n| periodic(n, impacts));
        let (omega, k1) = (short(*omega), short(*k1));
        format!("{} at omega = {omega} rad/s, k1 = {k1} N/m ({kind})", measured(value.value, value.quantity))
    }
}

impl Margin {
    /// Whether it is less than a robust design has.
    pub fn is_short(&self) -> bool {
        self.safe_to < self.needed_force || !self.parameters.is_empty()
    }

    pub fn words(&self) -> String {
        let safe = percent_down(self.safe_to);
        let Some(other) = &self.other else {
            return format!("safe to {safe} P, where none with 5 % more is found");
        };
        let mut words = format!("safe to {safe} P; from there on a motion has {}", other.words());
        for Error { parameter, percent, other } in &self.parameters {
            words += &format!("; {parameter} off by {} % brings {}", rounded(*percent, 2), other.words());
        }
        words
    }
}

/// A multiple to four decimals, rounded down: less is safe, too.
fn percent_down(multiple: f64) -> String {
    short((1e4 * multiple).floor() / 1e4)
}
