//! The motions that a certificate knows of beside those from rest.

use crate::amount::{Amount, measured};
use retune_dynamics::periodic::Largest;
use retune_model::Measure;
use retune_study::{counted, rounded, short};
use serde::Serialize;

/// Every motion of the design that was found over the band, from rest and from other starts.
#[derive(Clone, Debug, Serialize)]
pub struct Motions {
    /// The band, rad/s, and the stiffness of the structure, N/m: that of the worst run.
    pub from: f64,
    pub to: f64,
    pub k1: f64,
    /// Frequencies at which runs were started, and starts at each beside that from rest.
    pub samples: usize,
    pub starts: usize,
    /// The share of the band over which a stable periodic motion is known.
    pub covered: f64,
    /// The largest value; null where nothing was found.
    pub largest: Option<Another>,
    /// The parts of the band without a known stable motion.
    pub irregular: Vec<Irregular>,
}

/// The motion with the largest value.
#[derive(Clone, Debug, Serialize)]
pub struct Another {
    #[serde(flatten)]
    pub value: Amount,
    pub omega: f64,
    /// Periods of the force after which it repeats; null where it does not.
    pub periods: Option<usize>,
    /// The walls that it strikes in turn: S the structure, O the obstacle.
    pub impacts: String,
    /// Whether a run from rest leads to it, or to its branch elsewhere in the band.
    pub from_rest: bool,
    /// The largest share of the starts at one frequency that end on it or on its branch.
    pub share: f64,
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

impl Another {
    pub fn new(quantity: Measure, found: &Largest) -> Self {
        Self {
            value: Amount::new(quantity, found.value),
            omega: found.at,
            periods: found.orbit.as_ref().map(|orbit| orbit.periods),
            impacts: found.orbit.as_ref().map(|orbit| orbit.seen.impacts.clone()).unwrap_or_default(),
            from_rest: found.from_rest,
            share: found.share,
        }
    }

    /// What it is and where.
    pub fn words(&self) -> String {
        let Self { value, omega, periods, impacts, .. } = self;
        let kind = periods.map_or_else(|| "irregular".to_owned(), |n| periodic(n, impacts));
        format!("{} at omega = {} rad/s ({kind})", measured(value.value, value.quantity), short(*omega))
    }

    /// How it is reached.
    pub fn reached(&self) -> String {
        let share = match 100.0 * self.share {
            0.0 => "no start that was made ends".to_owned(),
            share => format!("up to {} % of the starts end", rounded(share, 2)),
        };
        if self.from_rest {
            "runs from rest lead there".to_owned()
        } else {
            format!("{share} there, none from rest")
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
        format!("stable periodic ones are known over {covered} % of the band; {largest}{irregular}")
    }
}
