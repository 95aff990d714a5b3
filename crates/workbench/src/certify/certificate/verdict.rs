//! The verdict of a certificate, and its rule.

use super::measured::{Measured, Neighbourhood, Sensitivity};
use retune_study::short;
use serde::Serialize;

/// Largest error bar of a predictable E1max, as a share of it.
const PREDICTABLE: f64 = 1e-3;
/// Width of the neighbours' E1max, as a share of that of the design, above which it is wide; an error bar as wide counts as much.
const WIDE: f64 = 0.05;
/// Growth of E1max within 1 % of any one parameter above which an optimum is sensitive.
const SENSITIVE: f64 = 0.1;

/// A verdict. A design that breaks its limits has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Small errors change little.
    Robust,
    /// Small errors change E1max little, but break a limit.
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
            Self::Edge => "edge",
            Self::Sensitive => "sensitive",
            Self::SingleChaoticRealisation => "single chaotic realisation",
        }
    }
}

/// Whether an error bar makes E1max of a run predictable, both in J.
pub fn is_predictable(error_bar: f64, e1_max: f64) -> bool {
    error_bar <= PREDICTABLE * e1_max
}

/// The verdict on a design whose E1max is `e1_max` ± `error_bar`, J; none where it breaks a limit. With its words.
pub fn judge(
    e1_max: f64,
    error_bar: f64,
    predictable: bool,
    measured: &Measured,
) -> (Option<Verdict>, String) {
    let limits = measured.limits.as_ref();
    if let Some(broken) = limits.and_then(|limits| limits.broken()) {
        return (None, format!("no verdict, for the design breaks {broken}"));
    }
    let (verdict, words) = judge_energy(e1_max, error_bar, predictable, measured);
    match (verdict, limits.and_then(|limits| limits.broken_near())) {
        (_, None) => (Some(verdict), words),
        (Verdict::Robust, Some(near)) => {
            (Some(Verdict::Edge), format!("on the edge of a limit: {near}; E1max alone is {words}"))
        }
        (_, Some(near)) => (Some(verdict), format!("{words}; and on the edge of a limit: {near}")),
    }
}

/// The verdict on E1max, whatever the limits.
fn judge_energy(e1_max: f64, error_bar: f64, predictable: bool, measured: &Measured) -> (Verdict, String) {
    let Measured { neighbourhood, motion, sensitivity, .. } = measured;
    let Neighbourhood { low, high, errors, .. } = neighbourhood;
    // Not a number is no evidence of anything small.
    let small = |value: f64| value <= WIDE * e1_max;
    let narrow = small(neighbourhood.width()) && small(error_bar);
    let near = format!("designs within {} % of it have {}", 100.0 * errors, between(*low, *high));
    if !narrow && (motion.irregular || !predictable) {
        let width = short(neighbourhood.width().max(error_bar));
        return (
            Verdict::SingleChaoticRealisation,
            format!("a single chaotic realisation of a distribution of width {width} J: {near}"),
        );
    }
    if !narrow {
        return (Verdict::Sensitive, format!("sensitive: {near}"));
    }
    // The parameter whose error of 1 % raises E1max most.
    let worst = sensitivity.iter().max_by(|a, b| a.worst.total_cmp(&b.worst));
    let said = worst.map_or(String::new(), |Sensitivity { parameter, worst, worst_at_percent, .. }| {
        let gives =
            if worst.is_finite() { format!("gives {} J", short(*worst)) } else { NO_VALUE.to_owned() };
        format!("{parameter} off by {worst_at_percent:+} % {gives}")
    });
    match worst {
        Some(worst) if worst.worst.is_infinite() => (Verdict::Sensitive, format!("sensitive: {said}")),
        Some(worst) if worst.worst > (1.0 + SENSITIVE) * e1_max => {
            (Verdict::Sensitive, format!("sensitive: {said}, {} times as much", short(worst.worst / e1_max)))
        }
        _ => (Verdict::Robust, format!("robust: at worst {said}")),
    }
}

/// What is said of a design that cannot be computed.
const NO_VALUE: &str = "has no value";
/// What stands in the place of its energy.
pub(super) const NO_ENERGY: &str = "no value";

/// A range of E1max in words; one that is infinite is of designs that cannot be computed.
pub(super) fn between(low: f64, high: f64) -> String {
    match [low, high].map(f64::is_finite) {
        [true, true] => format!("{} to {} J", short(low), short(high)),
        [true, false] => format!("{} J or more, and some of them no value", short(low)),
        _ => NO_ENERGY.to_owned(),
    }
}

/// The rule in words; `limits` says whether the study has limits.
pub fn rule(limits: bool) -> String {
    let edge = if limits {
        "; edge: as robust, but a neighbour, 1 % of one parameter, or a sample more of the band breaks a limit; no verdict: the \
         design itself breaks one"
    } else {
        ""
    };
    format!(
        "wide: the error bar, or the width of the middle 90 % of the neighbours, is above {} % of E1max; single chaotic realisation: wide, and the \
         motion of the worst run is irregular (chaotic, through a chaotic transient, or without a period) or not predictable; sensitive: \
         wide, or 1 % of one parameter raises E1max by more than {} %; robust: none of these{edge}. predictable: the error bar is at \
         most {} % of the worst run's E1max",
        100.0 * WIDE,
        100.0 * SENSITIVE,
        100.0 * PREDICTABLE
    )
}
