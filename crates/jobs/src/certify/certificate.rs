//! The contents of a certificate.

mod limits;
pub(super) mod measured;
mod motions;
mod text;
pub(super) mod verdict;

pub use limits::{Kept, Near};
pub use measured::{FINER, Measured, Motion, Neighbourhood, Run, Sensitivity, WorstRun};
pub use motions::{Irregular, MISSED, Margin, Motions, Other, ParameterError, SHARE, periodic};
pub use verdict::{Judged, Verdict};

use super::records::Records;
use super::walls::Walls;

use crate::Error;
use crate::amount::Amount;
use crate::summary::{MadeBy, TunedDamper};
use retune_model::Damper;
use retune_optim::Evaluation;
use retune_study::Study;
use serde::Serialize;

/// Share of the value that the samples of a study may miss without a warning.
const MISSED_PEAK: f64 = 0.01;

/// A certificate. SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    #[serde(flatten)]
    pub(crate) made_by: MadeBy,
    pub(crate) design: TunedDamper,
    #[serde(flatten)]
    pub(crate) value: Amount,
    #[serde(flatten)]
    pub(crate) judged: Judged,
    pub(crate) rule: String,
    /// The value with other walls, where the damper touches its walls; the verdict does not depend on it.
    #[serde(flatten)]
    pub(crate) walls: Option<Walls>,
    /// The value under other records, where the study has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) records: Option<Records>,
    #[serde(flatten)]
    pub(crate) measured: Measured,
}

/// The short form in `optimum.json`.
#[derive(Debug, Serialize)]
pub struct Short<'a> {
    verdict: Option<Verdict>,
    words: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    contacts: Option<&'a str>,
    error_bar: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    missed_peak: Option<String>,
    predictable: bool,
    regime: &'a str,
    exponent: f64,
}

impl Certificate {
    pub(super) fn new(study: &Study, damper: &Damper, own: &Evaluation, measured: Measured) -> Self {
        let value = Amount::new(study.quantity(), own.value);
        Self {
            made_by: MadeBy::new(study),
            design: TunedDamper::of(damper, study.varied()),
            value,
            judged: measured.judged(value),
            rule: verdict::rule(
                value.quantity,
                (measured.limits.is_some(), measured.has_walls),
                study.certificate,
            ),
            walls: None,
            records: None,
            measured,
        }
    }

    /// Whether the motion with the largest value that was found strikes a wall.
    pub(super) fn strikes(&self) -> bool {
        let largest = self.measured.motions.as_ref().and_then(|motions| motions.largest.as_ref());
        largest.is_some_and(|largest| !largest.impacts.is_empty())
    }

    /// The verdict in a word.
    pub fn verdict(&self) -> &'static str {
        self.judged.verdict.map_or("none", Verdict::name)
    }

    /// The reason for the verdict, in words.
    pub fn reason(&self) -> &str {
        &self.judged.words
    }

    /// How closely the methods that could finish the worst run agree, and which could not, in words.
    fn compared(&self) -> String {
        let (finished, not): (Vec<&Run>, Vec<&Run>) =
            self.measured.convergence.iter().partition(|run| run.is_finished());
        let mut not: Vec<&str> = not.iter().map(|run| run.method.name()).collect();
        not.dedup();
        let not =
            if not.is_empty() { String::new() } else { format!("; {} could not finish", not.join(" and ")) };
        let (error_bar, unit) = (self.judged.error_bar, self.value.quantity.unit());
        format!("{} methods and tolerances differ by {error_bar:.1e} {unit}{not}", finished.len())
    }

    /// The largest force at which no other motion has 5 % more, as a multiple of the design's force; infinite without a margin.
    pub(crate) fn safe_to(&self) -> f64 {
        self.measured.margin.as_ref().map_or(f64::INFINITY, |margin| margin.safe_to)
    }

    /// Whether no design can have a better verdict or a larger margin.
    pub(crate) fn is_safest(&self) -> bool {
        let clear = self.measured.margin.as_ref().is_none_or(|margin| margin.other.is_none());
        self.judged.verdict == Some(Verdict::Robust) && clear
    }

    /// Whether it has all measurements: that of [`judge`](crate::certify::judge) lacks motions from other starts where they cannot change
    /// the verdict.
    pub(crate) fn is_whole(&self) -> bool {
        matches!(self.judged.verdict, Some(Verdict::Robust | Verdict::FromRest | Verdict::Edge))
    }

    /// Refuses a design that breaks the limits of its study, for which there is no verdict, by [`Error::Infeasible`].
    pub fn check_limits(&self) -> Result<(), Error> {
        match self.judged.verdict {
            Some(_) => Ok(()),
            None => {
                let (name, words) = (self.made_by.study().to_owned(), self.reason().to_owned());
                Err(Error::Infeasible { name, words })
            }
        }
    }

    /// The peak that the samples of the study miss, in words, if it is more than 1 % higher.
    pub(crate) fn missed_peak(&self) -> Option<String> {
        let finer = self.measured.finer.filter(|finer| *finer > (1.0 + MISSED_PEAK) * self.value.value)?;
        let quantity = self.value.quantity;
        let name = quantity.name();
        let finer = verdict::or_none(finer, quantity);
        Some(format!(
            "{name} of this design is more between the samples of the study: {FINER} times as many have {finer}"
        ))
    }

    pub(crate) fn short(&self) -> Short<'_> {
        let Judged { error_bar, predictable, verdict, words } = &self.judged;
        Short {
            verdict: *verdict,
            words,
            contacts: self.walls.as_ref().map(Walls::words),
            error_bar: *error_bar,
            missed_peak: self.missed_peak(),
            predictable: *predictable,
            regime: &self.measured.motion.regime,
            exponent: self.measured.motion.exponent,
        }
    }
}
