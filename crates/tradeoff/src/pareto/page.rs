//! The page of `fronts`: the answer in words, whose numbers are those of the tables.

use super::candidate::{Candidate, SAME};
use super::fronts::{Certified, Fronts, Row};
use retune_study::Sweep;
use retune_study::{rounded, short};

/// The page.
pub(super) fn page(fronts: &Fronts) -> String {
    let names: Vec<&str> = fronts.plan.dampers.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = format!("# What the {} is good for\n\n", names.last().unwrap_or(&""));
    text += &format!(
        "Made by `retune fronts` ({}); every number is from the tables beside this page. E1max is the worst over the band of the \
         studies. Searches look at the samples of their studies and keep 1 % below a limit of stroke; what they found is looked at \
         again on {} samples, and under each bound stands the best design that keeps it, whichever search found it, or that of \
         the study: a looser bound is never worse. Strokes (spring deflections |x2 - x1 - D|) and forces are the largest of whole runs from rest.\n",
        names.join(", "),
        fronts.plan.said.samples
    );
    for (damper, name) in names.iter().enumerate() {
        if fronts.is_steady(damper) {
            text +=
                &format!("The {name} is taken in its steady motion, in closed form, and touches nothing.\n");
        }
    }
    text += &format!("\n{}\n", answer(fronts));
    for sweep in Sweep::ALL {
        let (name, unit) = (sweep.name(), sweep.unit());
        text += &format!("\n## {name} at most\n\n![E1max against the bound]({name}.svg)\n\n");
        text += &format!(
            "| {name} at most, {unit} | damper | E1max, J | k2, N/m | c2, N·s/m | D, m | C, m | stroke, m | force, N | verdict |\n"
        );
        text += "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
        for row in fronts.rows(sweep) {
            let fields =
                row.design.map_or("no design that was found keeps it | | | | | | |".to_owned(), cells);
            text += &format!("| {} | {} | {fields} |\n", row.bound, fronts.name(row.damper));
        }
    }
    text += "\n## The trade\n\nDesigns that no other dominates in all of E1max, stroke, contact force and k2 (`front.csv`); pale, those that are dominated.\n\n";
    text += "![E1max against stroke, contact force and k2](front.svg)\n\n";
    if fronts.certified.is_empty() {
        return text
            + "No design that strikes a wall is better than the first damper under the same bound.\n";
    }
    text += "## Certified\n\n";
    for one in &fronts.certified {
        text += &certificate(fronts, one);
    }
    text
}

/// The advantage of each damper over the first, in words.
pub(super) fn answer(fronts: &Fronts) -> String {
    let mut words = Vec::new();
    for given in &fronts.given {
        words.push(format!(
            "The {} of the study (k2 = {} N/m) has {} J, with a stroke of {} m.",
            fronts.name(given.damper),
            short(given.at.k2.get()),
            joule(given.e1_max),
            metre(given.stroke)
        ));
    }
    for damper in 1..fronts.plan.dampers.len() {
        for sweep in Sweep::ALL {
            words.push(compared(fronts, sweep, damper));
        }
    }
    words.join("\n")
}

/// A damper beside the first along a bound.
fn compared(fronts: &Fronts, sweep: Sweep, damper: usize) -> String {
    let (name, first) = (fronts.name(damper), fronts.name(0));
    let (what, unit) = (sweep.name(), sweep.unit());
    let rows = fronts.rows(sweep);
    let share = |row: &Row| Some(row.design?.e1_max / fronts.reference(row)?);
    let own = || rows.iter().filter(|row| row.damper == damper);
    let best =
        own().filter_map(|row| Some((share(row)?, row))).min_by(|(one, _), (other, _)| one.total_cmp(other));
    let better: Vec<String> = own()
        .filter(|row| share(row).is_some_and(|share| share < 1.0 - SAME))
        .map(|row| row.bound.to_string())
        .collect();
    let mut words = match best {
        Some((gain, Row { bound, design: Some(design), .. })) if gain < 1.0 - SAME => format!(
            "**{what} at most {bound} {unit}**: the best {name} has {} J, the best {first} {} J. There its advantage is largest; it is better by \
             more than 1 % for {what} at most {} {unit}.",
            joule(design.e1_max),
            joule(design.e1_max / gain),
            better.join(", ")
        ),
        _ => format!("**{what}**: under no bound is the {name} better than the {first} by more than 1 %."),
    };
    let alone: Vec<String> = own()
        .filter(|row| row.design.is_some() && fronts.reference(row).is_none())
        .map(|row| row.bound.to_string())
        .collect();
    if !alone.is_empty() {
        words += &format!(" Only the {name} keeps {what} at most {} {unit}.", alone.join(", "));
    }
    let draws: Vec<String> = own()
        .filter(|row| row.design.is_some_and(|design| design.verdict == "single chaotic realisation"))
        .map(|row| row.bound.to_string())
        .collect();
    if !draws.is_empty() {
        words += &format!(
            " For {what} at most {} {unit} it is a single chaotic realisation: practically equal designs have much more or \
             less.",
            draws.join(", ")
        );
    }
    let idle: Vec<String> = own()
        .filter(|row| row.design.is_some_and(|design| design.force == 0.0))
        .map(|row| row.bound.to_string())
        .collect();
    if !idle.is_empty() {
        words += &format!(
            " For {what} at most {} {unit} the best {name} touches nothing: it has become a TMD.",
            idle.join(", ")
        );
    }
    words
}

fn certificate(fronts: &Fronts, one: &Certified) -> String {
    let Certified { sweep, bound, design, reference, file, certificate } = one;
    let [k2, c2, d, c] = design.at.values().map(|value| rounded(value, 4));
    let reference = reference.map_or("none".to_owned(), |reference| format!("{} J", joule(reference)));
    format!(
        "- {}, {} at most {bound} {}: k2 = {k2} N/m, c2 = {c2} N·s/m, D = {d} m, C = {c} m with {} J (best {} under the same bound: {reference}). \
         [{file}]({file}):\n\n```text\n{}\n```\n\n",
        fronts.name(design.damper),
        sweep.name(),
        sweep.unit(),
        joule(design.e1_max),
        fronts.name(0),
        certificate.short(),
    )
}

fn cells(design: &Candidate) -> String {
    let [k2, c2, d, c] = design.at.values().map(|value| rounded(value, 4));
    format!(
        "{} | {k2} | {c2} | {d} | {c} | {} | {:.0} | {}",
        joule(design.e1_max),
        metre(design.stroke),
        design.force,
        design.verdict
    )
}

fn joule(value: f64) -> String {
    format!("{value:.1}")
}

fn metre(value: f64) -> String {
    format!("{value:.3}")
}
