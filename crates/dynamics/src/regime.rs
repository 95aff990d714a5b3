//! Classifies the motion of a record from distances of states, impact counts and the largest Lyapunov exponent. (Whether a run may stop
//! since its motion repeats is another question: `retune-solver` proves it, see its `Settle`.)
//!
//! 1. *Periodic*, `nT, m, k`: states n periods apart agree over the whole settled stretch, n the least such number; m and k are
//!    the impacts on the structure and on the obstacle in n periods. Neighbouring motions must not diverge.
//! 2. Otherwise the exponent decides: above [`FLOOR`] *chaotic*, within it *amplitude-modulated* (quasi-periodic), below it
//!    *settling* (the record is too short: a long transient, or a period above [`LONGEST`]).
//! 3. A chaotic motion is *intermittent* if it is nearly periodic (laminar) most of the time, in phases interrupted again and
//!    again by bursts (Y. Pomeau and P. Manneville, Commun. Math. Phys. 74, 1980).
//! 4. A periodic motion was reached through *transient chaos* if neighbours diverged before it, on average and by a large factor
//!    (C. Grebogi, E. Ott and J. A. Yorke, Physica D 7, 1983).

use crate::lyapunov::Exponent;
use crate::record::{Record, distance};
use serde::Serialize;

/// Longest period that is detected, in periods of the force: the default stretch of 500 contains it seven times.
pub const LONGEST: usize = 64;
/// Distance, as a share of the motion's size, below which two states are the same: far above the error of a run (rtol 1e-11),
/// far below any visible difference.
pub const SAME: f64 = 1e-6;
/// As [`SAME`] where the distances fall to less than [`FALLING`] of themselves from one half of the stretch to the other: a motion
/// that still converges to its periodic orbit. A thousandth of the motion's size is below any visible difference.
pub const NEARING: f64 = 1e-3;
/// See [`NEARING`]. Neighbours that converge at the rate [`FLOOR`] come nearer by a factor exp(2.5), about 12, in half the default
/// stretch; a fifth leaves a margin for the end of a faster approach.
pub const FALLING: f64 = 0.2;
/// An exponent within this of zero cannot be distinguished from zero, 1/s: if the exponent is zero, neighbours may diverge in
/// proportion to time, which over the default 500 periods of about 1 s gives an apparent exponent of ln(500)/500 s = 0.012 /s.
pub const FLOOR: f64 = 0.01;
/// Distance, as a share of the motion's size, within which a phase is laminar. States of a chaotic motion differ by about the
/// motion's size, those of a laminar phase by a few per cent per period of the motion: the limit lies between.
pub const LAMINAR: f64 = 0.05;
/// Longest period of a laminar phase, in periods of the force: twice the longest that Figure 4 of the paper labels.
pub const LAMINAR_PERIOD: usize = 12;
/// Shortest laminar phase, in periods of the force (it also lasts three of its own periods): a chaotic motion comes within
/// [`LAMINAR`] of itself by chance one time in twenty or less, and ten times in a row practically never.
pub const LAMINAR_PHASE: usize = 10;
/// Share of time in laminar phases above which a chaotic motion can be intermittent.
pub const MOSTLY: f64 = 0.5;
/// Distance from the periodic orbit, as a share of the motion's size, at which a transient ends.
pub const ARRIVED: f64 = 0.01;
/// A transient is chaotic only if neighbours diverged by at least this factor. On the way to a periodic orbit they diverge for a
/// while without chaos too: by up to 2e4 among the motions of Figure 4 from rest (2T, 1, 0 at k1 = 3.95e4 N/m, omega = 5.958
/// rad/s).
pub const PARTED: f64 = 1e5;

/// Number of standard errors by which the exponent of a chaotic transient must exceed zero: a probability of 98 %.
pub const MARGIN: f64 = 2.0;

/// The kinds of settled motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Repeats after a whole number of periods of the force.
    Periodic,
    /// Quasi-periodic: never repeats; neighbours neither diverge nor converge.
    AmplitudeModulated,
    /// Neighbours diverge exponentially.
    Chaotic,
    /// Chaotic, with long nearly periodic phases between bursts.
    Intermittent,
    /// Neighbours converge, but no period was found: a longer record is needed.
    Settling,
}

/// Transient chaos.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Transient {
    /// When it ended, s from the start.
    pub until: f64,
    /// Its finite-time exponent.
    pub exponent: Exponent,
}

/// The regime of a motion and the quantities it follows from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Regime {
    /// The kind of the settled motion.
    pub kind: Kind,
    /// n of `nT, m, k`: periods of the force after which the motion repeats.
    pub period: Option<usize>,
    /// m and k: impacts on the structure and on the obstacle per period of the motion or, if it has none, of the force.
    pub impacts: [f64; 2],
    /// Largest exponent of the settled motion, 1/s.
    pub exponent: Exponent,
    /// The transient chaos before it, if any.
    pub transient: Option<Transient>,
    /// Share of settled time in laminar phases.
    pub laminar: f64,
    /// Bursts that ended a laminar phase in the settled stretch.
    pub bursts: usize,
    /// Estimated probability that the kind is right; 0.5 is undecided.
    pub confidence: f64,
}

impl Regime {
    /// `nT, m, k`, or the name of the kind.
    pub fn label(&self) -> String {
        let end = match (self.kind, self.period) {
            (Kind::Periodic, Some(n)) => periodic_label(n, self.impacts),
            (kind, _) => kind.words().to_owned(),
        };
        if self.transient.is_some() { format!("transient chaos, then {end}") } else { end }
    }

    /// The motion in words that need no legend: "repeats every 2 periods of the force, with 1 impact on the structure and 3 on the
    /// obstacle".
    pub fn sentence(&self) -> String {
        let end = match (self.kind, self.period) {
            (Kind::Periodic, Some(n)) => {
                let periods = if n == 1 { "period".to_owned() } else { format!("{n} periods") };
                let impacts = match self.impacts.map(f64::round) {
                    [0.0, 0.0] => "touching no wall".to_owned(),
                    [on_structure, on_obstacle] => {
                        let noun = if on_structure == 1.0 { "impact" } else { "impacts" };
                        format!(
                            "with {on_structure} {noun} on the structure and {on_obstacle} on the obstacle"
                        )
                    }
                };
                format!("repeats every {periods} of the force, {impacts}")
            }
            (Kind::Chaotic, _) => "is irregular: chaotic".to_owned(),
            (Kind::Intermittent, _) => "is irregular: regular stretches between bursts".to_owned(),
            (Kind::AmplitudeModulated, _) => "never quite repeats: its amplitude is modulated".to_owned(),
            _ => "has not settled".to_owned(),
        };
        if self.transient.is_some() { format!("is irregular at first, then {end}") } else { end }
    }
}

/// The paper's `nT, m, k`: a motion of `n` periods of the force with `m` impacts on the structure and `k` on the obstacle.
pub fn periodic_label(n: usize, [structure, obstacle]: [f64; 2]) -> String {
    let n = if n == 1 { String::new() } else { n.to_string() };
    format!("{n}T, {structure:.0}, {obstacle:.0}")
}

impl Kind {
    /// The name of the kind.
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

/// Classifies a record.
pub fn classify(record: &Record) -> Regime {
    let from = record.settle.min(record.samples.len());
    let settled = &record.samples[from..];
    let size = record.scale();
    let exponent = record.exponent();
    let found = repeats(settled, size).filter(|_| exponent.value < FLOOR);
    let laminar = laminar_share(settled, size);
    let kind = match found {
        Some(_) => Kind::Periodic,
        None if exponent.value > FLOOR && laminar.intermittency() > 0.5 => Kind::Intermittent,
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
        bursts: laminar.bursts,
        confidence: confidence(kind, exponent, found.map(|(_, gap)| gap), transient.as_ref(), &laminar),
    }
}

/// The smallest n for which states n periods apart agree, with the largest distance found, as a share of the motion's size.
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
            Some((n, after)).filter(|_| after < NEARING && after < FALLING * before)
        })
    })
}

/// Impacts in `n` periods: those of the last n if the motion repeats, else the mean.
fn mean_impacts(impacts: &[[u64; 2]], n: usize, repeats: bool) -> [f64; 2] {
    let sum = |part: &[[u64; 2]], side: usize| part.iter().map(|count| count[side]).sum::<u64>() as f64;
    if repeats {
        // Whole cycles: an impact at a crest of the force may be counted one period early or late.
        let cycles = impacts.len() / n;
        let part = &impacts[impacts.len() - cycles * n..];
        [0, 1].map(|side| (sum(part, side) / cycles.max(1) as f64).round())
    } else {
        [0, 1].map(|side| sum(impacts, side) / impacts.len().max(1) as f64)
    }
}

/// Laminar phases of a settled motion.
struct Laminar {
    share: f64,
    bursts: usize,
    /// Number of independent samples behind the share.
    draws: f64,
}

impl Laminar {
    /// Probability that laminar phases and bursts keep alternating and that laminar phases fill most of the time: that the bursts
    /// are not chance (if one were expected in the whole stretch, their number would be Poisson-distributed with mean 1),
    /// and that the share is above [`MOSTLY`] (each laminar phase, and each [`LAMINAR_PHASE`] periods without one, is one sample).
    fn intermittency(&self) -> f64 {
        let mut term = (-1.0_f64).exp();
        let mut fewer = 0.0;
        for burst in 0..self.bursts.min(20) {
            fewer += term;
            term /= (burst + 1) as f64;
        }
        let error = (MOSTLY * (1.0 - MOSTLY) / self.draws).sqrt();
        fewer * normal((self.share - MOSTLY) / error)
    }
}

/// Phases in which states n periods apart stay close for at least [`LAMINAR_PHASE`] periods and three times n, for any one n.
fn laminar_share(samples: &[[f64; 4]], size: f64) -> Laminar {
    let mut laminar = vec![false; samples.len()];
    for n in 1..=LAMINAR_PERIOD.min(samples.len() / 3) {
        let least = (3 * n).max(LAMINAR_PHASE);
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
    let bursts = laminar.windows(2).filter(|pair| pair[0] && !pair[1]).count();
    let draws = 1.0 + bursts as f64 + ((laminar.len() - count) / LAMINAR_PHASE) as f64;
    Laminar { share: count as f64 / samples.len().max(1) as f64, bursts, draws }
}

/// The stretch before the motion came within [`ARRIVED`] of its periodic orbit, if neighbours diverged in it.
fn transient_chaos(record: &Record, n: usize, size: f64) -> Option<Transient> {
    let samples = &record.samples;
    let far = |i: &usize| distance(&samples[*i], &samples[*i + n]) > ARRIVED * size;
    let end = (0..samples.len() - n).rev().find(far)? + 1;
    let growth = &record.growth[..end];
    // The final contraction on to the periodic orbit is not part of the chaos before it: take the stretch up to where the
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
    let real = most > PARTED.ln() && exponent.value > FLOOR && exponent.margin(0.0) > MARGIN;
    real.then_some(Transient { until: end as f64 * record.period, exponent })
}

/// Logistic approximation of the cumulative normal distribution, within 0.01.
fn normal(margin: f64) -> f64 {
    1.0 / (1.0 + (-1.702 * margin).exp())
}

fn confidence(
    kind: Kind,
    exponent: Exponent,
    gap: Option<f64>,
    transient: Option<&Transient>,
    laminar: &Laminar,
) -> f64 {
    let sign = |threshold: f64| normal(exponent.margin(threshold));
    match kind {
        Kind::Periodic => {
            // A motion that still converges may converge to an orbit of a multiple of this period.
            let closes = if gap.is_some_and(|gap| gap < SAME) { 1.0 } else { 0.8 };
            let chaos = transient.map_or(1.0, |chaos| normal(chaos.exponent.margin(FLOOR)));
            (1.0 - sign(FLOOR)) * closes * chaos
        }
        Kind::AmplitudeModulated => sign(-FLOOR) - sign(FLOOR),
        Kind::Chaotic => sign(FLOOR) * (1.0 - laminar.intermittency()),
        Kind::Intermittent => sign(FLOOR) * laminar.intermittency(),
        Kind::Settling => 1.0 - sign(-FLOOR),
    }
}
