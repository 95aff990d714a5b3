//! What a reader must know before using the answer, on screen and on its page: each flag says what is so, where, and what to do about it.

use super::notes::{Goal, Met};
use super::{FailureNote, Optimum, stop_words};
use crate::tune::report::numbers::{amount, four};
use retune_optim::{Limit, Stop};
use retune_study::{counted, joined};

pub struct Flag {
    /// Its name: the page marks it so, and tests look for it.
    pub name: &'static str,
    pub words: String,
    /// What to do about it in the study, before another search.
    pub change: Option<String>,
}

impl Flag {
    fn new(name: &'static str, words: String) -> Self {
        Self { name, words, change: None }
    }

    fn with(self, change: impl Into<String>) -> Self {
        Self { change: Some(change.into()), ..self }
    }
}

impl Optimum {
    /// The flags of a result, the gravest first.
    pub(crate) fn flags(&self) -> Vec<Flag> {
        let missed = self.certificate.missed_peak().map(|words| {
            Flag::new("missed-peak", format!("{words}.")).with("more samples in optimize.objective.omega")
        });
        let all = [
            broken(self),
            missed,
            near_a_limit(self),
            on_bound(self),
            edge(self),
            stopped(self),
            irregular(self),
            not_predictable(self),
            unsettled(self),
            failed(self),
        ];
        all.into_iter().flatten().collect()
    }
}

fn broken(optimum: &Optimum) -> Option<Flag> {
    let note = optimum.limits.as_ref().filter(|note| !note.feasible)?;
    let broken = note.reached.iter().filter_map(|&(limit, reached)| {
        let allowed = note.allowed.get(limit).filter(|allowed| reached > *allowed)?;
        let over = four(100.0 * (reached / allowed - 1.0));
        let unit = limit.unit();
        Some((limit, format!("{limit} {} of {} {unit}, over by {over} %", four(reached), four(allowed))))
    });
    let (names, words): (Vec<Limit>, Vec<String>) = broken.unzip();
    let none = if note.proven {
        "No design within the bounds keeps the limits".to_owned()
    } else {
        format!("None found that keeps the limits in {}", counted(note.evaluations, "evaluation"))
    };
    let broken = words.join("; ");
    let words = format!("{none}; this one comes nearest. Broken: {broken}. Do not build it as it is.");
    let change = format!("a larger limit of {}, or wider bounds", joined(&names, ", "));
    Some(Flag::new("limits-broken", words).with(change))
}

fn near_a_limit(optimum: &Optimum) -> Option<Flag> {
    let near = optimum.certificate.measured.limits.as_ref()?.broken_near()?;
    let words = format!("The design keeps the limits, but designs near it do not: {near}.");
    let kept = optimum.limits.as_ref().is_some_and(|note| note.feasible);
    kept.then(|| Flag::new("near-a-limit", words).with("a limit with some margin"))
}

fn on_bound(optimum: &Optimum) -> Option<Flag> {
    let met = &optimum.on_bound;
    let words = |Met { variable, bound }: &Met| match bound {
        0.0 => format!("{variable} on 0, the least that is possible"),
        _ => format!("{variable} on {} {}; a wider bound may give less", four(*bound), variable.unit()),
    };
    let words: Vec<String> = met.iter().map(words).collect();
    let wider: Vec<_> = met.iter().filter(|met| met.bound != 0.0).map(|met| met.variable).collect();
    let wider = joined(&wider, ", ");
    let change = (!wider.is_empty()).then(|| format!("a wider bound of {wider}, if it can be built"));
    let words = format!("The optimum lies on a bound: {}.", words.join("; "));
    (!met.is_empty()).then(|| Flag { change, ..Flag::new("on-bound", words) })
}

/// The best point of the grid is at the first or last value of an axis that could be longer.
fn edge(optimum: &Optimum) -> Option<Flag> {
    let names = joined(&optimum.on_edge, ", ");
    let words = format!(
        "The best point of the grid lies at its edge in {names}: there may be better designs beyond it."
    );
    let flag = || Flag::new("grid-edge", words).with(format!("a grid that reaches farther in {names}"));
    (!names.is_empty()).then(flag)
}

fn stopped(optimum: &Optimum) -> Option<Flag> {
    let stop = optimum.refine.runs[optimum.refine.winner - 1].stop;
    let limit = match stop {
        Stop::Converged => return None,
        Stop::MaxIter => "a larger MaxIter",
        Stop::MaxFunEvals => "a larger MaxFunEvals",
        Stop::Interrupted => "nothing",
    };
    let words = format!("The refinement that found the design has not converged: it {}.", stop_words(stop));
    Some(Flag::new("not-converged", words).with(format!("{limit} in optimize.refine")))
}

fn irregular(optimum: &Optimum) -> Option<Flag> {
    let (motion, name) = (&optimum.certificate.measured.motion, optimum.value.quantity.name());
    let words = format!(
        "The motion at the worst frequency is irregular ({}): designs that are practically equal can differ much in {name}.",
        motion.regime
    );
    let change = "a statistic over small errors as the objective (optimize.objective.ensemble)";
    motion.irregular.then(|| Flag::new("irregular", words).with(change))
}

fn not_predictable(optimum: &Optimum) -> Option<Flag> {
    let (judged, quantity) = (&optimum.certificate.judged, optimum.value.quantity);
    let words = format!(
        "{} of the worst run is not predictable: equally good ways to compute it differ by up to {}.",
        quantity.name(),
        amount(judged.error_bar, quantity)
    );
    (!judged.predictable).then(|| Flag::new("not-predictable", words))
}

fn unsettled(optimum: &Optimum) -> Option<Flag> {
    let Goal { unsettled, runs, .. } = optimum.objective.as_ref()?;
    let (unsettled, runs) = (unsettled.filter(|count| *count > 0)?, counted((*runs)?, "run"));
    let words = format!(
        "{unsettled} of {runs} of this design had not settled at the end of the run; their value is that of the window."
    );
    Some(Flag::new("unsettled", words).with("a larger T in window"))
}

fn failed(optimum: &Optimum) -> Option<Flag> {
    let FailureNote { count, example } = &optimum.failures;
    let example = example.iter().map(|example| format!(", for instance {example}")).collect::<String>();
    let words = format!("{} could not be computed{example}.", counted(*count, "design"));
    (*count > 0).then(|| Flag::new("failures", words))
}
