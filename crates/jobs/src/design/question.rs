//! The question that `design` answers, in words.

use super::requirements::{Driving, Requirements, Wish};
use super::words::{frequency, natural, percent, sized};
use retune_study::rounded;

/// What was asked, broken into lines for the screen.
pub(super) fn question(requirements: &Requirements) -> Vec<String> {
    let broken = broken_at_spaces();
    asked(requirements).iter().map(|line| textwrap::fill(line, &broken)).collect()
}

pub(super) fn asked(requirements: &Requirements) -> Vec<String> {
    let own = natural(requirements);
    let critical = 2.0 * requirements.m1 * requirements.natural_frequency();
    let driving = match requirements.source {
        Driving::Force(force) => format!("a force of {}", sized(force, "N")),
        Driving::Imbalance(imbalance) => format!("an imbalance of {} kg·m", rounded(imbalance, 4)),
        Driving::Base(base) => format!("a base that moves by {}", sized(base, "m")),
        Driving::BaseAcceleration(acceleration) => {
            format!("a base that is accelerated by {}", sized(acceleration, "m/s²"))
        }
    };
    let unit = requirements.frequencies;
    let [from, to] = requirements.band.map(|end| frequency(end, unit));
    let from = from.trim_end_matches(unit).trim_end();
    let limits: Vec<String> =
        requirements.wishes().into_iter().map(|wish| limit(requirements, wish)).collect();
    let limits = if limits.is_empty() { String::new() } else { format!(", {}", limits.join(", ")) };
    vec![
        format!(
            "Structure: {} on {}, {own}, damping {}; {driving}, {from} to {to}.",
            sized(requirements.m1, "kg"),
            sized(requirements.k1, "N/m"),
            percent(requirements.c1 / critical)
        ),
        format!(
            "Asked for: a damper of {} ({}) with the least {}{limits}.",
            sized(requirements.mass, "kg"),
            percent(requirements.mass / requirements.m1),
            requirements.goal.name()
        ),
    ]
}

pub(super) fn limit(requirements: &Requirements, wish: Wish) -> String {
    format!("{} at most {}", wish.name(), sized(requirements.allowed(wish), wish.unit()))
}

/// Lines of at most 80 columns that are broken at spaces alone, so that no name of a file is.
pub(super) fn broken_at_spaces() -> textwrap::Options<'static> {
    textwrap::Options::new(80).subsequent_indent("  ").word_splitter(textwrap::WordSplitter::NoHyphenation)
}
