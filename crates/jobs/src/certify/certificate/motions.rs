//! The motions of a certificate other than those from rest.

use crate::amount::{Amount, measured};
use retune_dynamics::periodic::{Largest, Share};
use retune_model::{Measure, Parameter};
use retune_study::{counted, rounded, short};
use serde::Serialize;

/// The share of starts ending on a motion, and the probability of missing it, for which the width of a missed motion is reported.
pub const SHARE: f64 = 0.3;
pub const MISSED: f64 = 0.01;

/// All motions of the design found over the band, from rest and from other starts.
#[derive(Clone, Debug, Serialize)]
pub struct Motions {
    /// The band, rad/s, and the stiffness of the structure, N/m, with the highest ratio of the largest value to that of the runs from rest.
    pub from: f64,
    pub to: f64,
    pub k1: f64,
    /// All stiffnesses at which motions were searched for.
    pub k1_of: Vec<f64>,
    /// Whether the objective has an ensemble, whose members were not run from other starts.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub members_not_looked_at: bool,
    /// Frequencies at which runs were started from rest, and other starts over the band.
    pub samples: usize,
    pub starts: usize,
    /// A motion on which 30 % of the starts end is missed with a probability below 1 % if it is wider than this, rad/s.
    pub width_missed: f64,
    /// The value of the runs from rest, for comparison.
    #[serde(skip)]
    pub from_rest: f64,
    /// The share of the band over which a stable periodic motion is known.
    pub covered: f64,
    /// The largest value; null where nothing was found.
    pub largest: Option<Other>,
    /// The parts of the band without a known stable motion.
    pub irregular: Vec<Irregular>,
}

/// A motion with a large value.
#[derive(Clone, Debug, Serialize)]
pub struct Other {
    #[serde(flatten)]
    pub value: Amount,
    pub omega: f64,
    /// The stiffness, N/m, where it differs from motion to motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k1: Option<f64>,
    /// Its state `[x1, v1, x2, v2]` at a crest of the force, to reproduce it.
    pub state: [f64; 4],
    /// Periods of the force after which it repeats; null where it does not.
    pub periods: Option<usize>,
    /// The walls that it strikes in turn: S the structure, O the obstacle.
    pub impacts: String,
    /// None where no starts were counted.
    #[serde(flatten)]
    pub reached: Option<Reached>,
}

#[derive(Clone, Copy, Debug, Serialize)]
pub struct Reached {
    /// Whether a run from rest leads to it, or to its branch elsewhere in the band.
    pub from_rest: bool,
    /// Number of starts that end on it or on its branch, of those in the range where it is stable.
    pub ends: usize,
    pub starts: usize,
}

/// A part of the band without a known stable motion.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Irregular {
    pub from: f64,
    pub to: f64,
    /// The largest value of the runs there.
    #[serde(flatten)]
    pub value: Amount,
}

/// A periodic motion in words, with the walls that it strikes in turn: "2 periods, impacts OSS".
pub fn periodic(periods: usize, impacts: &str) -> String {
    let impacts = if impacts.is_empty() { "no impact".to_owned() } else { format!("impacts {impacts}") };
    format!("{}, {impacts}", counted(periods as u64, "period"))
}

impl Other {
    pub fn new(quantity: Measure, found: &Largest) -> Self {
        let Share { ends, starts, .. } = found.share;
        Self {
            value: Amount::new(quantity, found.value),
            omega: found.at,
            k1: None,
            state: found.start,
            periods: found.orbit.as_ref().map(|orbit| orbit.periods),
            impacts: found.orbit.as_ref().map(|orbit| orbit.seen.impacts.clone()).unwrap_or_default(),
            reached: Some(Reached { from_rest: found.from_rest, ends, starts }),
        }
    }

    pub fn words(&self) -> String {
        let Self { value, omega, k1, periods, impacts, .. } = self;
        let kind = periods.map_or_else(|| "irregular".to_owned(), |n| periodic(n, impacts));
        let k1 = k1.map_or_else(String::new, |k1| format!(", k1 = {} N/m", short(k1)));
        format!("{} at omega = {} rad/s{k1} ({kind})", measured(value.value, value.quantity), short(*omega))
    }

    /// The command that reproduces it, with a study or results that hold the design.
    pub fn reproduce(&self, k1: f64) -> String {
        let Self { omega, state, .. } = self;
        let state = state.map(short).join(",");
        format!("`retune simulate STUDY --set omega={omega} --set k1={k1} --from {state}` runs it again")
    }

    pub fn is_from_rest(&self) -> bool {
        self.reached.is_some_and(|reached| reached.from_rest)
    }

    pub fn reached(&self) -> String {
        match self.reached {
            Some(Reached { from_rest: false, ends, starts }) => {
                let stable = if self.periods.is_some() { " where it is stable" } else { "" };
                format!("{ends} of {starts} starts{stable} end there, none from rest")
            }
            _ => "runs from rest lead there".to_owned(),
        }
    }
}

impl Motions {
    /// A line of the certificate.
    pub fn words(&self) -> String {
        let largest = self
            .largest
            .as_ref()
            .map_or("none found".to_owned(), |one| format!("the largest {}; {}", one.words(), one.reached()));
        let irregular = match self.irregular.as_slice() {
            [] => String::new(),
            parts => {
                let part = |part: &Irregular| format!("{} to {}", rounded(part.from, 4), rounded(part.to, 4));
                let all: Vec<String> = parts.iter().map(part).collect();
                format!("; irregular at {} rad/s", all.join(", "))
            }
        };
        let covered = rounded(100.0 * self.covered, 3);
        let Self { from, to, k1_of, samples, starts, .. } = self;
        let k1: Vec<String> = k1_of.iter().map(|k1| short(*k1)).collect();
        let over = if from == to {
            format!("at {} rad/s", short(*from))
        } else {
            format!("and {samples} from rest over {} to {} rad/s", short(*from), short(*to))
        };
        let k1 = k1.join(", ");
        format!(
            "by {starts} starts {over}, k1 = {k1} N/m: stable periodic ones are known over {covered} % of the band; {largest}{irregular}{}",
            self.members_words()
        )
    }

    /// A note that the members of an ensemble were not run from other starts.
    pub fn members_words(&self) -> &'static str {
        if self.members_not_looked_at {
            "; members of the ensemble not looked at from other starts"
        } else {
            ""
        }
    }

    pub fn missed(&self) -> String {
        if self.from == self.to {
            return format!("{} starts at one frequency", self.starts);
        }
        let ([share, missed], width) = ([SHARE, MISSED].map(|of| 100.0 * of), rounded(self.width_missed, 2));
        let starts = self.starts;
        format!(
            "a motion on which {share} % of the starts end is missed by {starts} starts with a probability below {missed} % if it is wider than {width} rad/s"
        )
    }

    /// The ratio of the largest value to that of the runs from rest.
    pub fn ratio(&self) -> f64 {
        self.largest.as_ref().map_or(0.0, |one| one.value.value / self.from_rest)
    }
}

/// The margins of a design. Forces are multiples of the design's force.
#[derive(Clone, Debug, Serialize)]
pub struct Margin {
    /// The force margin required of a robust design.
    pub needed_force: f64,
    /// The forces at which motions were searched for, besides the design's force.
    pub forces: Vec<f64>,
    /// The largest force at which no such motion was found.
    pub safe_to: f64,
    /// The motion that begins there; null where none was found up to the largest of the forces.
    pub other: Option<Other>,
    /// The parameter error that a robust design must tolerate, %.
    pub needed_percent: f64,
    /// The parameter that the forces are multiples of; none for a forcing given in time.
    #[serde(skip)]
    pub amplitude: Option<Parameter>,
    /// The parameters for which an error of that size brings a motion that was found at more force.
    pub parameters: Vec<ParameterError>,
}

/// The least error of a parameter that brings another motion.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterError {
    pub parameter: &'static str,
    pub percent: f64,
    #[serde(flatten)]
    pub other: Other,
}

impl Margin {
    /// Whether it is less than a robust design needs.
    pub fn is_short(&self) -> bool {
        self.safe_to < self.needed_force || !self.parameters.is_empty()
    }

    pub fn words(&self) -> String {
        let safe = match self.amplitude.filter(|amplitude| *amplitude != Parameter::P) {
            None => format!("{} P", percent_down(self.safe_to)),
            Some(other) => {
                format!("{} times the {}", percent_down(self.safe_to), other.symbol().replace('_', " "))
            }
        };
        let Some(other) = &self.other else {
            return format!("safe to {safe}, where none with 5 % more is found");
        };
        let mut words = format!("safe to {safe}; from there on a motion has {}", other.words());
        for ParameterError { parameter, percent, other } in &self.parameters {
            words += &format!("; {parameter} off by {} % brings {}", rounded(*percent, 2), other.words());
        }
        words
    }
}

/// A multiple to four decimals, rounded down to the safe side.
fn percent_down(multiple: f64) -> String {
    short((1e4 * multiple).floor() / 1e4)
}
