//! The contents of a certificate.

mod limits;
mod margin;
mod measured;
mod motions;
mod records;
mod text;
mod verdict;
mod walls;

pub use limits::{Kept, Near};
pub use margin::{Error as ParameterError, Margin, Other};
pub use measured::{FINER, Measured, Motion, Neighbourhood, Run, Sensitivity, WorstRun};
pub use motions::{Another, Irregular, MISSED, Motions, SHARE, periodic};
pub use records::{Records, UnderRecord};
pub use verdict::{Judged, Verdict};
pub use walls::{AtRestitution, AtStiffness, Found, Walls};

use crate::Error;
use crate::amount::Amount;
use crate::summary::{MadeBy, TunedDamper};
use retune_model::Damper;
use retune_optim::Evaluation;
use retune_study::Study;
use serde::Serialize;

/// What the samples of a study may miss without a word, as a share of the value.
const MISSED_PEAK: f64 = 0.01;

/// A certificate. SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    #[serde(flatten)]
    pub(crate) made_by: MadeBy,
    pub(crate) design: TunedDamper,
    /// The objective's value.
    #[serde(flatten)]
    pub(crate) value: Amount,
    /// Largest difference of a run of the convergence study that could be finished to the worst run, in the unit of the value: how far the methods agree.
    pub(crate) error_bar: f64,
    pub(crate) predictable: bool,
    /// null where the design breaks a limit.
    pub(crate) verdict: Option<Verdict>,
    /// The verdict in words.
    pub(crate) words: String,
    /// The rule that the verdict follows.
    pub(crate) rule: String,
    /// The value between other walls, where the damper touches its own; beside the verdict, which does not depend on it.
    #[serde(flatten)]
    pub(crate) walls: Option<Walls>,
    /// The value under other records, where the study has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) records: Option<Records>,
    /// The limits at the design and near it, where the study has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) limits: Option<Kept>,
    /// The run with the largest value that the value is made of.
    pub(crate) worst_run: WorstRun,
    pub(crate) convergence: Vec<Run>,
    /// The objective with four times the samples of its bands, where it has bands that are sampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) finer: Option<f64>,
    pub(crate) motion: Motion,
    /// Every motion that was found, from rest and from other starts, where the damper can strike and the force has a period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) motions: Option<Motions>,
    /// How far the force and the parameters may be off before another motion has 5 % more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) margin: Option<Margin>,
    pub(crate) sensitivity: Vec<Sensitivity>,
    pub(crate) neighbourhood: Neighbourhood,
}

/// The short form that `optimum.json` has.
#[derive(Clone, Debug, Serialize)]
pub struct Short {
    verdict: Option<Verdict>,
    words: String,
    /// What other walls make of the value, in words, where the damper touches its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    contacts: Option<String>,
    error_bar: f64,
    /// What the comparison of methods came to.
    #[serde(skip)]
    compared: String,
    /// What the samples of the study miss, in words, where it is more than 1 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) missed_peak: Option<String>,
    predictable: bool,
    regime: String,
    exponent: f64,
    /// The motion of the worst run in words.
    #[serde(skip)]
    sentence: String,
}

impl Short {
    /// The verdict in words, with the error bar; on a line of its own what other walls do.
    pub fn verdict_words(&self) -> String {
        let contacts = self.contacts.as_ref().map_or(String::new(), |words| format!("\nContacts: {words}"));
        format!("{} ({}){contacts}", self.words, self.compared)
    }

    /// The reason for the verdict, in words.
    pub fn reason(&self) -> &str {
        &self.words
    }

    /// Whether the value is one of many that practically equal designs have.
    pub fn is_chaotic(&self) -> bool {
        self.verdict == Some(Verdict::SingleChaoticRealisation)
    }

    /// The motion of the worst run in words.
    pub fn motion_words(&self) -> &str {
        &self.sentence
    }

    /// The verdict in a word.
    pub fn verdict(&self) -> &'static str {
        self.verdict.map_or("none", Verdict::name)
    }

    /// Refuses a design that breaks the limits of its `study`, for which there is no verdict.
    ///
    /// # Errors
    /// [`Error::Infeasible`].
    pub(crate) fn check_limits(&self, study: &str) -> Result<(), Error> {
        match self.verdict {
            Some(_) => Ok(()),
            None => Err(Error::Infeasible { name: study.to_owned(), words: self.words.clone() }),
        }
    }
}

impl Certificate {
    pub(super) fn new(study: &Study, damper: &Damper, own: &Evaluation, measured: Measured) -> Self {
        let value = Amount::new(study.quantity(), own.value);
        let Judged { error_bar, predictable, verdict, words } = measured.judged(value);
        let Measured {
            worst_run,
            convergence,
            finer,
            motion,
            motions,
            margin,
            sensitivity,
            neighbourhood,
            limits,
        } = measured;
        Self {
            made_by: MadeBy::new(study),
            design: TunedDamper::of(damper, study.varied()),
            value,
            error_bar,
            predictable,
            verdict,
            words,
            rule: verdict::rule(value.quantity, limits.is_some(), study.certificate),
            walls: None,
            records: None,
            limits,
            worst_run,
            convergence,
            finer,
            motion,
            motions,
            margin,
            sensitivity,
            neighbourhood,
        }
    }

    /// With the value between other walls.
    pub(super) fn with_walls(self, walls: Option<Walls>) -> Self {
        Self { walls, ..self }
    }

    /// With the value under other records.
    pub(super) fn with_records(self, records: Option<Records>) -> Self {
        Self { records, ..self }
    }

    /// Whether the motion with the largest value that was found strikes a wall.
    pub(super) fn strikes(&self) -> bool {
        let largest = self.motions.as_ref().and_then(|motions| motions.largest.as_ref());
        largest.is_some_and(|largest| !largest.impacts.is_empty())
    }

    /// How far the methods that could finish the worst run agree, and which could not.
    fn compared(&self) -> String {
        let (finished, not): (Vec<&Run>, Vec<&Run>) =
            self.convergence.iter().partition(|run| run.is_finished());
        let mut not: Vec<&str> = not.iter().map(|run| run.method.name()).collect();
        not.dedup();
        let not =
            if not.is_empty() { String::new() } else { format!("; {} could not finish", not.join(" and ")) };
        let unit = self.value.quantity.unit();
        format!("{} methods and tolerances differ by {:.1e} {unit}{not}", finished.len(), self.error_bar)
    }

    /// The force up to which no other motion has 5 % more, as a multiple of its own; infinite where there is no such motion to look for.
    pub(crate) fn safe_to(&self) -> f64 {
        self.margin.as_ref().map_or(f64::INFINITY, |margin| margin.safe_to)
    }

    /// Whether no verdict is better and no margin larger.
    pub(crate) fn is_safest(&self) -> bool {
        let clear = self.margin.as_ref().is_none_or(|margin| margin.other.is_none());
        self.verdict == Some(Verdict::Robust) && clear
    }

    /// Whether it has all measurements. One of [`judge`](crate::certify::judge) lacks the motions from other starts where the verdict was
    /// decided without.
    pub(crate) fn is_whole(&self) -> bool {
        matches!(self.verdict, Some(Verdict::Robust | Verdict::FromRest | Verdict::Edge))
    }

    /// Refuses a design that breaks the limits of its study.
    ///
    /// # Errors
    /// [`Error::Infeasible`].
    pub fn check_limits(&self) -> Result<(), Error> {
        self.short().check_limits(self.made_by.study())
    }

    /// What the samples of the study miss, in words, where it is more than 1 %.
    pub(crate) fn missed_peak(&self) -> Option<String> {
        let finer = self.finer.filter(|finer| *finer > (1.0 + MISSED_PEAK) * self.value.value)?;
        let quantity = self.value.quantity;
        let name = quantity.name();
        let finer = verdict::or_none(finer, quantity);
        Some(format!(
            "{name} of this design is more between the samples of the study: {FINER} times as many have {finer}"
        ))
    }

    /// The reason for the verdict, in words.
    pub fn reason(&self) -> &str {
        &self.words
    }

    /// The short form.
    pub fn short(&self) -> Short {
        let Self { verdict, words, error_bar, predictable, motion, .. } = self.clone();
        let compared = self.compared();
        let Motion { regime, exponent, sentence, .. } = motion;
        Short {
            verdict,
            words,
            contacts: self.walls.as_ref().map(|walls| walls.words().to_owned()),
            error_bar,
            compared,
            missed_peak: self.missed_peak(),
            predictable,
            regime,
            exponent,
            sentence,
        }
    }
}
