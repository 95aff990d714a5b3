//! The verdict of a certificate, and its rule.

use super::measured::{FINER, Measured, Neighbourhood, Sensitivity};
use crate::amount::{Amount, measured};
use retune_model::Measure;
use retune_study::{Margins, short};
use serde::Serialize;

/// Largest error bar of a predictable value, as a share of it.
const PREDICTABLE: f64 = 1e-3;
/// Width of the neighbours' values, or size of the error bar, as a share of the design's value, above which it counts as wide.
const WIDE: f64 = 0.05;
/// Growth within 1 % of any one parameter above which an optimum is sensitive.
const SENSITIVE: f64 = 0.1;

/// A verdict. A design that breaks its limits has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Small errors change little.
    Robust,
    /// Small errors change little, but other starts, or frequencies between the samples, lead to much more.
    #[serde(rename = "from rest only")]
    FromRest,
    /// Small errors change the value little, but break a limit, or bring a motion with much more from other starts.
    Edge,
    /// Small errors change much, in a regular way or at an edge.
    Sensitive,
    /// The motion is irregular, and the value one of many that practically equal designs have.
    #[serde(rename = "single chaotic realisation")]
    SingleChaoticRealisation,
}

impl Verdict {
    /// Its word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Robust => "robust",
            Self::FromRest => "from rest only",
            Self::Edge => "edge",
            Self::Sensitive => "sensitive",
            Self::SingleChaoticRealisation => "single chaotic realisation",
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Largest difference of a run of the convergence study that could be finished to the worst run, in the unit of the value: how far the
    /// methods agree.
    pub error_bar: f64,
    pub predictable: bool,
    /// null where the design breaks a limit.
    pub verdict: Option<Verdict>,
    pub words: String,
}

impl Measured {
    /// The verdict on a design with this value.
    pub fn judged(&self, value: Amount) -> Judged {
        let finished = self.convergence.iter().filter(|run| run.is_finished());
        let error_bar = finished.map(|run| run.error(&self.worst_run)).fold(0.0, f64::max);
        let predictable = is_predictable(error_bar, self.worst_run.value.value);
        let (verdict, words) = judge(value, error_bar, predictable, self);
        Judged { error_bar, predictable, verdict, words }
    }
}

/// Whether an error bar makes the value of a run predictable, both in one unit.
fn is_predictable(error_bar: f64, value: f64) -> bool {
    error_bar <= PREDICTABLE * value
}

/// The verdict on a design with this value ± `error_bar`, and its words; no verdict where it breaks a limit.
fn judge(value: Amount, error_bar: f64, predictable: bool, measured: &Measured) -> (Option<Verdict>, String) {
    let limits = measured.limits.as_ref();
    if let Some(broken) = limits.and_then(|limits| limits.broken()) {
        return (None, format!("no verdict, for the design breaks {broken}"));
    }
    let (verdict, words) = judge_value(value, error_bar, predictable, measured);
    match (verdict, limits.and_then(|limits| limits.broken_near())) {
        (_, None) => (Some(verdict), words),
        (Verdict::Robust, Some(near)) => (
            Some(Verdict::Edge),
            format!("on the edge of a limit: {near}; {} alone is {words}", value.quantity.name()),
        ),
        (_, Some(near)) => (Some(verdict), format!("{words}; and on the edge of a limit: {near}")),
    }
}

/// A finding against a robust verdict.
struct Finding {
    verdict: Verdict,
    /// The words if it is the first finding.
    alone: String,
    /// The words if it follows others.
    beside: String,
}

/// The verdict on the value, whatever the limits: that of the gravest finding, with words on all findings.
fn judge_value(own: Amount, error_bar: f64, predictable: bool, all: &Measured) -> (Verdict, String) {
    let Amount { quantity, value, .. } = own;
    let worst = all.sensitivity.iter().max_by(|a, b| a.worst.total_cmp(&b.worst));
    let worst_case = worst.map_or(String::new(), |worst| off_by(worst, quantity));
    let findings = [
        wide_finding(own, error_bar, predictable, all),
        worst.and_then(|worst| sensitive_finding(value, worst, &worst_case)),
        finer_finding(own, all),
        motion_finding(all, &worst_case),
        margin_finding(all, &worst_case),
    ];
    let mut findings = findings.into_iter().flatten();
    let Some(Finding { verdict, alone, .. }) = findings.next() else {
        return (Verdict::Robust, robust_words(all, &worst_case));
    };
    let words = findings.fold(alone, |words, Finding { beside, .. }| format!("{words}; {beside}"));
    (verdict, words)
}

/// Whether a difference is small compared with the design's value; NaN is not small.
fn small(difference: f64, value: f64) -> bool {
    difference <= WIDE * value
}

/// The values of the design's neighbours in words.
fn near(Neighbourhood { low, high, errors, .. }: &Neighbourhood, quantity: Measure) -> String {
    format!("designs within {} % of it have {}", 100.0 * errors, between(*low, *high, quantity))
}

/// The effect of an error of one parameter, in words.
fn off_by(Sensitivity { parameter, worst, worst_at_percent, .. }: &Sensitivity, quantity: Measure) -> String {
    let gives =
        if worst.is_finite() { format!("gives {}", measured(*worst, quantity)) } else { NO_VALUE.to_owned() };
    format!("{parameter} off by {worst_at_percent:+} % {gives}")
}

/// Finds neighbours or methods whose values lie far apart.
fn wide_finding(own: Amount, error_bar: f64, predictable: bool, all: &Measured) -> Option<Finding> {
    let Amount { quantity, value, .. } = own;
    let width = all.neighbourhood.width();
    if small(width, value) && small(error_bar, value) {
        return None;
    }
    let near = near(&all.neighbourhood, quantity);
    let (verdict, alone) = if all.has_walls && (all.motion.irregular || !predictable) {
        let width = measured(width.max(error_bar), quantity);
        (
            Verdict::SingleChaoticRealisation,
            format!("a single chaotic realisation of a distribution of width {width}: {near}"),
        )
    } else if !predictable {
        let apart = measured(error_bar, quantity);
        (Verdict::Sensitive, format!("sensitive: methods and tolerances differ by {apart}; {near}"))
    } else {
        (Verdict::Sensitive, format!("sensitive: {near}"))
    };
    Some(Finding { verdict, alone, beside: near })
}

/// Finds a parameter whose error of 1 % raises the value much or makes it impossible to compute.
fn sensitive_finding(
    value: f64,
    Sensitivity { worst, .. }: &Sensitivity,
    worst_case: &str,
) -> Option<Finding> {
    let beside = if worst.is_infinite() {
        worst_case.to_owned()
    } else if *worst > (1.0 + SENSITIVE) * value {
        format!("{worst_case}, {} times as much", short(worst / value))
    } else {
        return None;
    };
    Some(Finding { verdict: Verdict::Sensitive, alone: format!("sensitive: {beside}"), beside })
}

/// Finds a peak that the samples of the study miss.
fn finer_finding(own: Amount, all: &Measured) -> Option<Finding> {
    let Amount { quantity, value, .. } = own;
    let finer = all.finer.filter(|finer| !small(finer - value, value))?;
    let finer = or_none(finer, quantity);
    let near = near(&all.neighbourhood, quantity);
    Some(Finding {
        verdict: Verdict::FromRest,
        alone: format!("robust on the samples of the study only: {FINER} times as many have {finer}; {near}"),
        beside: format!("{FINER} times as many samples have {finer}"),
    })
}

/// Finds another motion with a larger value at the design's force.
fn motion_finding(all: &Measured, worst_case: &str) -> Option<Finding> {
    let motions = all.motions.as_ref()?;
    let other = motions.largest.as_ref().filter(|_| motions.ratio() > 1.0 + WIDE)?;
    let motion = other.words();
    let (alone, beside) = if other.is_from_rest() {
        let beside = format!("runs from rest between its samples, or longer ones, lead to {motion}");
        (format!("robust on the runs of the study only: {worst_case}; but {beside}"), beside)
    } else {
        let beside = format!("a motion has {motion}; {}", other.reached());
        (format!("robust from rest only: {worst_case}; but {beside}"), beside)
    };
    Some(Finding { verdict: Verdict::FromRest, alone, beside })
}

/// Finds another motion with a larger value at a slightly larger force, or with a small error of a parameter.
fn margin_finding(all: &Measured, worst_case: &str) -> Option<Finding> {
    let margin = all.margin.as_ref().filter(|margin| margin.is_short())?;
    let beside = margin.words();
    Some(Finding {
        verdict: Verdict::Edge,
        alone: format!("on the edge of another motion: {beside}; from rest, {worst_case}"),
        beside,
    })
}

/// The words for a design without any finding.
fn robust_words(all: &Measured, worst_case: &str) -> String {
    let Some(motions) = &all.motions else {
        return format!("robust: at worst {worst_case}; other starts not looked at");
    };
    let margin = all.margin.as_ref().map_or(String::new(), |margin| format!("; {}", margin.words()));
    let (starts, members) = (motions.starts, motions.members_words());
    format!("robust: at worst {worst_case}; none of {starts} starts leads to 5 % more{margin}{members}")
}

/// The predicate for a design that cannot be computed.
const NO_VALUE: &str = "has no value";
/// The text in place of its value.
pub(super) const NONE: &str = "no value";

/// A value in words; not finite means that the design cannot be computed.
pub fn or_none(value: f64, quantity: Measure) -> String {
    if value.is_finite() { measured(value, quantity) } else { NONE.to_owned() }
}

/// A range of values in words; an infinite end means that some designs cannot be computed.
pub(super) fn between(low: f64, high: f64, quantity: Measure) -> String {
    match [low, high].map(f64::is_finite) {
        [true, true] => format!("{} to {}", short(low), measured(high, quantity)),
        [true, false] => format!("{} or more, and some of them no value", measured(low, quantity)),
        _ => NONE.to_owned(),
    }
}

/// The rule in words; `limits` tells whether the study has limits, `walls` whether the damper has walls, without which no motion is
/// chaotic.
pub fn rule(quantity: Measure, (limits, walls): (bool, bool), Margins { force, errors }: Margins) -> String {
    let name = quantity.name();
    let chaotic = if walls {
        "single chaotic realisation: wide, and the motion of the worst run is irregular (chaotic, through a chaotic transient, or without a period) or not \
         predictable; "
    } else {
        ""
    };
    let limits = if limits {
        ", or a neighbour, 1 % of one parameter, or a sample more of the band breaks a limit; no verdict: the design itself breaks one"
    } else {
        ""
    };
    let edge = format!(
        "edge: as robust, but a motion with {} % more is there for {} % more force or with an error of {} % of one parameter{limits}",
        100.0 * WIDE,
        100.0 * force,
        100.0 * errors
    );
    format!(
        "wide: the difference of methods, or the width of the middle 90 % of the neighbours, is above {} % of {name}; {chaotic}sensitive: \
         wide, or 1 % of one parameter raises {name} by more than {} %; from rest only: none of these, but a motion from \
         another start or between the samples has {} % more; {edge}; robust: none of these. predictable: methods differ by at \
         most {} % of the worst run's {name}",
        100.0 * WIDE,
        100.0 * SENSITIVE,
        100.0 * WIDE,
        100.0 * PREDICTABLE
    )
}
