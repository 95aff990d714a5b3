//! What a reader must know before using the answer: each flag says what is so, where, and what to do about it.

use super::findings::Findings;
use super::numbers::{amount, four};
use crate::tune::optimum::notes::Goal;
use crate::tune::optimum::stop_words;
use retune_optim::{Limit, Stop};
use retune_study::{counted, joined};

pub struct Flag {
    /// Its name: the page marks it so, and tests look for it.
    pub name: &'static str,
    pub words: String,
    /// What to do about it in the study, before another search.
    pub change: Option<String>,
}

/// The flags of a result, the gravest first.
pub fn flags(findings: &Findings) -> Vec<Flag> {
    let flag = |name, words| Flag { name, words, change: None };
    let all = [
        broken(findings),
        findings.optimum.certificate.missed_peak().map(|words| Flag {
            name: "missed-peak",
            words: format!("{words}."),
            change: Some("more samples in optimize.objective.omega".to_owned()),
        }),
        near_a_limit(findings),
        on_bound(findings),
        edge(findings),
        stopped(findings),
        findings.measured().motion.irregular.then(|| irregular(findings)),
        (!findings.optimum.certificate.judged.predictable).then(|| {
            flag(
                "not-predictable",
                format!(
                    "{} of the worst run is not predictable: equally good ways to compute it differ by up to {}.",
                    findings.quantity().name(),
                    amount(findings.optimum.certificate.judged.error_bar, findings.quantity())
                ),
            )
        }),
        unsettled(findings).map(|words| Flag {
            name: "unsettled",
            words,
            change: Some("a larger T in window".to_owned()),
        }),
        failed(findings).map(|words| flag("failures", words)),
    ];
    all.into_iter().flatten().collect()
}

fn broken(findings: &Findings) -> Option<Flag> {
    let note = findings.optimum.limits.as_ref().filter(|note| !note.feasible)?;
    let broken: Vec<(Limit, String)> = note
        .reached
        .iter()
        .filter_map(|&(limit, reached)| {
            let allowed = note.allowed.get(limit)?;
            let over = four(100.0 * (reached / allowed - 1.0));
            let words =
                format!("{limit} {} of {} {}, over by {over} %", four(reached), four(allowed), limit.unit());
            (reached > allowed).then_some((limit, words))
        })
        .collect();
    let (names, words): (Vec<Limit>, Vec<String>) = broken.into_iter().unzip();
    Some(Flag {
        name: "limits-broken",
        words: format!(
            "{}; this one comes nearest. Broken: {}. Do not build it as it is.",
            if note.proven {
                "No design within the bounds keeps the limits".to_owned()
            } else {
                format!("None found that keeps the limits in {}", counted(note.evaluations, "evaluation"))
            },
            words.join("; ")
        ),
        change: Some(format!("a larger limit of {}, or wider bounds", joined(&names, ", "))),
    })
}

fn near_a_limit(findings: &Findings) -> Option<Flag> {
    let near = findings.measured().limits.as_ref()?.broken_near()?;
    let kept = findings.optimum.limits.as_ref().is_some_and(|note| note.feasible);
    kept.then(|| Flag {
        name: "near-a-limit",
        words: format!("The design keeps the limits, but designs near it do not: {near}."),
        change: Some("a limit with some margin".to_owned()),
    })
}

fn on_bound(findings: &Findings) -> Option<Flag> {
    let met = &findings.optimum.on_bound;
    let words: Vec<String> = met
        .iter()
        .map(|met| match met.bound {
            0.0 => format!("{} on 0, the least that is possible", met.variable),
            bound => format!(
                "{} on {} {}; a wider bound may give less",
                met.variable,
                four(bound),
                met.variable.unit()
            ),
        })
        .collect();
    let wider: Vec<_> = met.iter().filter(|met| met.bound != 0.0).map(|met| met.variable).collect();
    (!met.is_empty()).then(|| Flag {
        name: "on-bound",
        words: format!("The optimum lies on a bound: {}.", words.join("; ")),
        change: (!wider.is_empty())
            .then(|| format!("a wider bound of {}, if it can be built", joined(&wider, ", "))),
    })
}

/// The best point of the grid is at the first or last value of an axis that could be longer.
fn edge(findings: &Findings) -> Option<Flag> {
    let on_edge = &findings.optimum.on_edge;
    (!on_edge.is_empty()).then(|| {
        let names = joined(on_edge, ", ");
        Flag {
            name: "grid-edge",
            words: format!(
                "The best point of the grid lies at its edge in {names}: there may be better designs beyond it."
            ),
            change: Some(format!("a grid that reaches farther in {names}")),
        }
    })
}

fn stopped(findings: &Findings) -> Option<Flag> {
    let stop = findings.refined.best().minimum.stop;
    let limit = match stop {
        Stop::Converged => return None,
        Stop::MaxIter => "a larger MaxIter",
        Stop::MaxFunEvals => "a larger MaxFunEvals",
        Stop::Interrupted => "nothing",
    };
    Some(Flag {
        name: "not-converged",
        words: format!("The refinement that found the design has not converged: it {}.", stop_words(stop)),
        change: Some(format!("{limit} in optimize.refine")),
    })
}

fn irregular(findings: &Findings) -> Flag {
    let motion = &findings.measured().motion;
    Flag {
        name: "irregular",
        words: format!(
            "The motion at the worst frequency is irregular ({}): designs that are practically equal can differ much in {}.",
            motion.regime,
            findings.quantity().name()
        ),
        change: Some(
            "a statistic over small errors as the objective (optimize.objective.ensemble)".to_owned(),
        ),
    }
}

fn unsettled(findings: &Findings) -> Option<String> {
    let Goal { unsettled, runs, .. } = findings.optimum.objective.as_ref()?;
    let (unsettled, runs) = (unsettled.filter(|count| *count > 0)?, (*runs)?);
    Some(format!(
        "{unsettled} of {} of this design had not settled at the end of the run; their value is that of the window.",
        counted(runs, "run")
    ))
}

fn failed(findings: &Findings) -> Option<String> {
    let failures = &findings.optimum.failures;
    let example =
        failures.example.as_ref().map(|example| format!(", for instance {example}")).unwrap_or_default();
    (failures.count > 0)
        .then(|| format!("{} could not be computed{example}.", counted(failures.count, "design")))
}
