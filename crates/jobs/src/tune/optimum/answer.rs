//! The answer of a search in words: what to build, what it does, how sure that is, and what to do next. Lines fit 80 columns.

use super::notes::LimitNote;
use super::{DescentNote, Optimum, PassedOver, RunNote, Valley, stop_words};
use crate::amount::Amount;
use crate::certify::Verdict;
use crate::needs::Needs;
use crate::summary::as_much;
use retune_model::Parameter;
use retune_study::{counted, frequency, rounded, short};
use std::path::Path;

/// Width of the terminal that lines are wrapped for.
const COLUMNS: usize = 80;
/// A no-break space.
const HELD: &str = "\u{a0}";
/// A no-break hyphen.
const HYPHEN: &str = "\u{2011}";

impl Optimum {
    /// The last lines on screen.
    pub fn report(&self) -> String {
        let mut lines = vec![String::new()];
        let mut say = |words: String| lines.push(wrapped(&words, "  "));
        say(self.headline());
        let flags = self.flags().into_iter().map(|flag| flag.words.trim_end_matches('.').to_owned());
        let warnings = flags.chain(self.needs.iter().flat_map(Needs::warnings));
        warnings.for_each(|words| say(format!("  note: {words}")));
        say(format!("  {}", self.compared()));
        let values = self.damper.words(|variable| self.digits(variable)).replace(", ", ",");
        say(format!("  build    {}", values.replace(' ', HELD).replace(',', ", ")));
        let flat: Vec<String> = self.valleys.iter().filter_map(Valley::words).collect();
        if !flat.is_empty() {
            say(format!("  flat     {} (the others held): at most 0.1 % more", flat.join("; ")));
        }
        for (name, words) in self.needs.iter().flat_map(|needs| needs.lines(&self.of)) {
            say(format!("  {name:<9}{words}"));
        }
        say(format!("  motion   {}", self.certificate.measured.motion.sentence));
        say(format!("  verdict  {}", self.certificate.verdict_words()));
        self.limits.iter().filter_map(LimitNote::kept).for_each(|kept| say(format!("  {kept}")));
        let notes = self.of.transient().map(|words| format!("note: {words}"));
        notes
            .into_iter()
            .chain(self.passed_over.iter().map(PassedOver::words))
            .for_each(|note| say(format!("  {note}")));
        say(format!("  from     {}", self.made_by));
        lines.join("\n")
    }

    /// How the search went, for the log.
    pub fn search(&self) -> String {
        let winner = self.refine.winner;
        let RunNote { iterations, func_count, stop, descent, .. } = &self.refine.runs[winner - 1];
        let begun = match self.beyond {
            None => format!("start {winner} of {}", self.starts),
            Some(from) => format!("from {from}"),
        };
        let simplex = format!(
            "fminsearch, {begun}: {} after {}, {}; TolX {:e} is {}",
            stop_words(*stop),
            counted(*iterations, "iteration"),
            counted(*func_count, "evaluation"),
            self.refine.tol_x,
            self.refine.tol_x_mode,
        );
        let begun = self.beyond.filter(|_| *iterations == 0).map_or(simplex, str::to_owned);
        let descent = descent.map_or_else(String::new, |DescentNote { from, evaluations }| {
            let from = if from.value.is_nan() { "outside the limits".to_owned() } else { from.words() };
            format!("; then a descent by derivatives from {from}, {}", counted(evaluations, "evaluation"))
        });
        let mut lines = vec![format!("\n{begun}{descent}")];
        lines.extend(self.global.as_ref().map(super::Basins::report));
        lines.join("\n")
    }

    /// What to do next with the results in `out`.
    pub fn next(&self, out: &Path) -> String {
        let single =
            self.simulation.omega() > 0.0 && self.objective.as_ref().is_none_or(|goal| goal.band().is_none());
        if self.certificate.judged.verdict == Some(Verdict::SingleChaoticRealisation) && single {
            return "next: give the study a band (`optimize.objective.omega`, docs/tuning.md): at this\n  \
                    frequency alone the value is one of many that practically equal designs have"
                .to_owned();
        }
        let (out, omega) = (out.display(), rounded(self.simulation.omega(), 6));
        // Another motion may coexist with that from rest only where the damper strikes.
        let others = if self.simulation.has_impacts() && self.simulation.omega() > 0.0 {
            format!("next: see what it does from other starts than rest with\n  `retune branches {out}`\n")
        } else {
            String::new()
        };
        let (at, set) = if self.simulation.omega() > 0.0 {
            (" at the worst frequency", format!(" --set omega={omega}"))
        } else {
            ("", String::new())
        };
        format!(
            "{others}next: record the motion{at} with\n  `retune simulate {out}{set} --trajectory motion.csv`"
        )
    }

    /// The significant digits of a parameter; four if it was not varied.
    fn digits(&self, variable: Parameter) -> usize {
        self.valleys.iter().find(|valley| valley.variable == variable).map_or(4, Valley::digits)
    }

    fn headline(&self) -> String {
        let at = match self.objective.as_ref().filter(|goal| goal.band().is_some()) {
            Some(goal) => {
                let e = goal.worst_restitution.map_or(String::new(), |e| format!(" and restitution {e}"));
                format!(", worst at omega = {}{e}", frequency(goal.worst_omega))
            }
            None if self.simulation.omega() == 0.0 => String::new(),
            None => format!(" at omega = {}", frequency(self.simulation.omega())),
        };
        let sum = if self.of.objective().sum.is_empty() { "" } else { "weighted sum of " };
        format!("{}: {sum}{} {}{at}", self.damper_type, self.value.quantity.name(), self.value.words())
    }

    /// The value without a damper and with the study's damper, in words.
    fn compared(&self) -> String {
        let times = |other: Amount| match other.value.is_finite() {
            true if self.value.value == 0.0 => other.words(),
            true => format!("{} ({})", other.words(), as_much(other.value / self.value.value)),
            false => "without bound".to_owned(),
        };
        let study = if self.study.value.is_nan() {
            format!("no value with {}", self.baseline)
        } else {
            format!("{} with {}", times(self.study), self.baseline)
        };
        // Without a damper there is no stroke.
        if self.value.quantity.is_of_damper() {
            return format!("instead  {study}");
        }
        format!("instead  {} without a damper, {study}", times(self.none))
    }
}

/// Wraps paragraphs to at most [`COLUMNS`] columns; the first may be indented.
fn wrapped(text: &str, indent: &str) -> String {
    let indentation = &text[..text.len() - text.trim_start().len()];
    let further = format!("{indentation}{indent}       ");
    // The name of a file stays whole.
    let held = |word: &str| if word.contains('/') { word.replace('-', HYPHEN) } else { word.to_owned() };
    let paragraph = |(i, text): (usize, &str)| {
        let first = if i == 0 { indentation } else { &further };
        let options = textwrap::Options::new(COLUMNS).initial_indent(first).subsequent_indent(&further);
        let words: Vec<String> = text.split(' ').map(held).collect();
        textwrap::fill(&words.join(" "), options).replace(HELD, " ").replace(HYPHEN, "-")
    };
    text.trim_start().lines().enumerate().map(paragraph).collect::<Vec<_>>().join("\n")
}

impl LimitNote {
    /// How close the values are to the limits; none if a limit is broken.
    fn kept(&self) -> Option<String> {
        let Self { allowed, feasible, active, evaluations, infeasible, .. } = self;
        let words = self.reached.iter().filter_map(|(limit, reached)| {
            let note = if active.contains(limit) { ", active" } else { "" };
            Some(format!(
                "{limit} {} of {} {}{note}",
                short(*reached),
                short(allowed.get(*limit)?),
                limit.unit()
            ))
        });
        let (words, evaluations) =
            (words.collect::<Vec<_>>().join("; "), counted(*evaluations, "evaluation"));
        feasible.then(|| format!("limits kept: {words}; {infeasible} of {evaluations} broke one"))
    }
}
