//! What kind of motion a record shows, from distances of states, impact counts and the largest exponent; never from looks.
//!
//! 1. *Periodic*, `nT, m, k`: states n periods apart agree over the whole settled stretch, n the least such number; m and k are
//!    the impacts on the structure and on the obstacle in n periods. Neighbours must not part.
//! 2. Otherwise the exponent decides: above [`FLOOR`] *chaotic*, within it *amplitude-modulated* (quasi-periodic), below it
//!    *settling* (the record is too short: a long transient or a period above [`LONGEST`]).
//! 3. A chaotic motion is *intermittent* where nearly periodic (laminar) phases alternate with bursts.
//! 4. A regular motion was reached through *transient chaos* where neighbours parted, on average and by much, before it.

use crate::lyapunov::Exponent;
use crate::record::{Record, distance};
use serde::Serialize;

/// Longest period that is looked for, in periods of the force.
pub const LONGEST: usize = 64;
/// Distance of states, as a share of the motion's size, below which they are the same.
pub const SAME: f64 = 1e-6;
/// As [`SAME`] where the distances still fall: a motion that is coming to rest on its period.
const NEARING: f64 = 1e-3;
/// An exponent within this of zero cannot be told from zero, 1/s.
pub const FLOOR: f64 = 0.01;
/// Distance, as a share of the motion's size, within which a phase is laminar.
const LAMINAR: f64 = 0.05;
/// Longest period of a laminar phase, in periods of the force.
const LAMINAR_PERIOD: usize = 12;
/// Shares of time in laminar phases between which a chaotic motion is intermittent.
const INTERMITTENT: [f64; 2] = [0.2, 0.98];
/// A transient is chaotic only if it parted neighbours by at least this factor.
const PARTED: f64 = 1e3;

/// The kinds of settled motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Repeats after a whole number of periods of the force.
    Periodic,
    /// Quasi-periodic: never repeats, neighbours neither part nor meet.
    AmplitudeModulated,
    /// Neighbours part exponentially.
    Chaotic,
    /// Chaotic, with long nearly periodic phases between bursts.
    Intermittent,
    /// Neighbours meet, but no period was seen: a longer record is needed.
    Settling,
}

/// Chaos that ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Transient {
    /// When it ended, s from the start.
    pub until: f64,
    /// Its finite-time exponent.
    pub exponent: Exponent,
}

/// A motion's regime and what it rests on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Regime {
    /// The kind of the settled motion.
    pub kind: Kind,
    /// n of `nT, m, k`: periods of the force after which the motion repeats.
    pub period: Option<usize>,
    /// m and k: impacts on the structure and on the obstacle in a period of the motion; where it has none, of the force.
    pub impacts: [f64; 2],
    /// Largest exponent of the settled motion, 1/s.
    pub exponent: Exponent,
    /// The chaos it went through, if any.
    pub transient: Option<Transient>,
    /// Share of settled time in laminar phases.
    pub laminar: f64,
    /// Probability, by the evidence above, that the kind is right: 0.5 is a toss-up.
    pub confidence: f64,
}

impl Regime {
    /// `nT, m, k` or the kind in a word or two.
    pub fn label(&self) -> String {
        let end = match (self.kind, self.period) {
            (Kind::Periodic, Some(n)) => {
                let n = if n == 1 { String::new() } else { n.to_string() };
                format!("{n}T, {:.0}, {:.0}", self.impacts[0], self.impacts[1])
            }
            (kind, _) => kind.words().to_owned(),
        };
        if self.transient.is_some() { format!("transient chaos, then {end}") } else { end }
    }
}

impl Kind {
    /// The kind in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Periodic => "periodic",
            Self::AmplitudeModulated => "amplitude-modulated",
            Self::Chaotic => "chaotic",
            Self::Intermittent => "intermittent",
            Self::Settling => "still settling",
        }
    }
}

/// The regime of a record.
pub fn classify(record: &Record) -> Regime {
    let from = record.settle.min(record.samples.len());
    let settled = &record.samples[from..];
    let size = record.scale();
    let exponent = record.exponent();
    let found = repeats(settled, size).filter(|_| exponent.value < FLOOR);
    let laminar = laminar_share(settled, size);
    let kind = match found {
        Some(_) => Kind::Periodic,
        None if exponent.value > FLOOR && intermittent(&laminar) => Kind::Intermittent,
        None if exponent.value > FLOOR => Kind::Chaotic,
        None if exponent.value >= -FLOOR => Kind::AmplitudeModulated,
        None => Kind::Settling,
    };
    let transient = match kind {
        Kind::Periodic => found.and_then(|(n, _)| transient_chaos(record, n, size)),
        _ => None,
    };
    let period = found.map(|(n, _)| n);
    Regime {
        kind,
        period,
        impacts: mean_impacts(&record.impacts[from..], period.unwrap_or(1), period.is_some()),
        exponent,
        transient,
        laminar: laminar.share,
        confidence: confidence(kind, exponent, found.map(|(_, gap)| gap), transient.as_ref(), laminar.share),
    }
}

/// The least n for which states n periods apart agree, with the largest distance seen as a share of the motion's size.
fn repeats(samples: &[[f64; 4]], size: f64) -> Option<(usize, f64)> {
    let worst = |part: &[[f64; 4]], n: usize| {
        part.iter().zip(&part[n..]).map(|(a, b)| distance(a, b)).fold(0.0, f64::max) / size
    };
    let longest = LONGEST.min(samples.len() / 3);
    let periods = || 1..=longest;
    periods().find_map(|n| Some((n, worst(samples, n))).filter(|(_, gap)| *gap < SAME)).or_else(|| {
        periods().find_map(|n| {
            let (first, last) = samples.split_at(samples.len() / 2);
            let (before, after) = (worst(first, n), worst(last, n));
            Some((n, after)).filter(|_| after < NEARING && after < 0.2 * before)
        })
    })
}

/// Impacts in `n` periods: over the last n where the motion repeats, the mean where it does not.
fn mean_impacts(impacts: &[[u64; 2]], n: usize, repeats: bool) -> [f64; 2] {
    let sum = |part: &[[u64; 2]], side: usize| part.iter().map(|count| count[side]).sum::<u64>() as f64;
    if repeats {
        // Whole cycles: an impact that happens at a crest of the force may be counted a period early or late.
        let cycles = impacts.len() / n;
        let part = &impacts[impacts.len() - cycles * n..];
        [0, 1].map(|side| (sum(part, side) / cycles.max(1) as f64).round())
    } else {
        [0, 1].map(|side| sum(impacts, side) / impacts.len().max(1) as f64)
    }
}

struct Laminar {
    share: f64,
    phases: usize,
}

/// Phases in which states n periods apart stay close for at least ten periods and three times n, for any one n.
fn laminar_share(samples: &[[f64; 4]], size: f64) -> Laminar {
    let mut laminar = vec![false; samples.len()];
    for n in 1..=LAMINAR_PERIOD.min(samples.len() / 3) {
        let least = (3 * n).max(10);
        let mut begin = 0;
        for i in 0..=samples.len() - n {
            let close = i < samples.len() - n && distance(&samples[i], &samples[i + n]) < LAMINAR * size;
            if close {
                continue;
            }
            if i - begin >= least {
                laminar[begin..i].fill(true);
            }
            begin = i + 1;
        }
    }
    let count = laminar.iter().filter(|&&is| is).count();
    let phases = laminar.windows(2).filter(|pair| !pair[0] && pair[1]).count();
    Laminar { share: count as f64 / samples.len().max(1) as f64, phases }
}

fn intermittent(laminar: &Laminar) -> bool {
    laminar.share > INTERMITTENT[0] && laminar.share < INTERMITTENT[1] && laminar.phases >= 2
}

/// The stretch before the motion came within a hundredth of its size of its period, if neighbours parted in it.
fn transient_chaos(record: &Record, n: usize, size: f64) -> Option<Transient> {
    let samples = &record.samples;
    let far = |i: &usize| distance(&samples[*i], &samples[*i + n]) > 1e-2 * size;
    let end = (0..samples.len() - n).rev().find(far)? + 1;
    let growth = &record.growth[..end];
    // The last contraction on to the period belongs to the period, not to the chaos before it: take the stretch up to where the
    // neighbours were farthest apart.
    let mut sum = 0.0;
    let (mut most, mut at) = (0.0, 0);
    for (i, rate) in growth.iter().enumerate() {
        sum += rate;
        if sum > most {
            (most, at) = (sum, i + 1);
        }
    }
    let exponent = Exponent::of(&growth[..at], record.period);
    let real = most > PARTED.ln() && exponent.value > FLOOR && exponent.margin(0.0) > 2.0;
    real.then_some(Transient { until: end as f64 * record.period, exponent })
}

/// The logistic curve that stays within 0.01 of the normal distribution.
fn normal(margin: f64) -> f64 {
    1.0 / (1.0 + (-1.702 * margin).exp())
}

fn confidence(
    kind: Kind,
    exponent: Exponent,
    gap: Option<f64>,
    transient: Option<&Transient>,
    laminar: f64,
) -> f64 {
    let sign = |threshold: f64| normal(exponent.margin(threshold));
    match kind {
        Kind::Periodic => {
            let closes = if gap.is_some_and(|gap| gap < SAME) { 1.0 } else { 0.8 };
            let chaos = transient.map_or(1.0, |chaos| normal(chaos.exponent.margin(FLOOR)));
            (1.0 - sign(FLOOR)) * closes * chaos
        }
        Kind::AmplitudeModulated => sign(-FLOOR) - sign(FLOOR),
        Kind::Chaotic => sign(FLOOR),
        Kind::Intermittent => {
            let [low, high] = INTERMITTENT;
            let inside = (laminar - low).min(high - laminar) / (0.5 * (high - low));
            sign(FLOOR) * (0.5 + 0.5 * inside.clamp(0.0, 1.0))
        }
        Kind::Settling => 1.0 - sign(-FLOOR),
    }
}
