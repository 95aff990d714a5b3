//! The answer of `design` in words. Lines fit 80 columns.

use super::designed::Designed;
use super::requirements::Requirements;
use crate::designs::Row;
use retune_study::rounded;
use std::f64::consts::TAU;
use std::path::Path;

/// E1max that differs by less than this share is as good.
const SAME: f64 = 0.05;

/// The whole answer.
pub(super) fn answer(requirements: &Requirements, designed: &[Designed], out: &Path) -> String {
    let none = designed.first().and_then(|first| first.rows.first()).map_or(f64::NAN, |row| row.none);
    let table = [header(requirements), format!("{:<9}{:>9}", "none", number(none))];
    let table = table.into_iter().chain(designed.iter().map(|damper| line(requirements, damper)));
    let out = out.display();
    let studies = format!("Go on with {out}/studies-tmd.json and {out}/studies-ssvi.json.");
    let words = build(designed)
        .into_iter()
        .chain(costs(requirements, designed))
        .chain(designed.iter().filter_map(sure))
        .chain(walls(requirements))
        .chain([studies]);
    let broken = textwrap::Options::new(80).subsequent_indent("  ");
    let words: Vec<String> = words.map(|line| textwrap::fill(&line, &broken)).collect();
    let structure = textwrap::fill(&structure(requirements), &broken);
    let table: Vec<String> = table.collect();
    format!("{structure}\n\n{}\n\n{}", table.join("\n"), words.join("\n"))
}

/// The walls that were chosen: whoever builds the damper has others.
fn walls(requirements: &Requirements) -> Option<String> {
    let [k1, k3] = requirements.contact().ok()?.stiffness().map(|stiffness| rounded(stiffness, 3));
    Some(format!(
        "Walls were not given: the paper's, in proportion to the mass (K = {k1} and {k3} N/m^1.5); write your own into the studies."
    ))
}

fn structure(requirements: &Requirements) -> String {
    let natural = requirements.natural_frequency();
    let [from, to] = requirements.band;
    format!(
        "Structure of {} kg at {} rad/s ({} Hz), damping {} %, {} N from {} to {} rad/s ({} to {} Hz)",
        short(requirements.m1),
        short(natural),
        short(natural / TAU),
        short(50.0 * requirements.c1 / (requirements.m1 * natural)),
        short(requirements.force),
        short(from),
        short(to),
        short(from / TAU),
        short(to / TAU)
    )
}

fn header(requirements: &Requirements) -> String {
    let mut text = format!(
        "{:<10}{:>9}{:>9}{:>9}{:>9}{:>8}{:>8}",
        "damper", "E1max, J", "k2, N/m", "c2", "stroke", "D, m", "C, m"
    );
    if let Some(error) = requirements.k1_error {
        let percent = short(100.0 * error);
        text += &format!("{:>8}{:>8}", format!("k1-{percent}%"), format!("k1+{percent}%"));
    }
    text
}

fn line(requirements: &Requirements, damper: &Designed) -> String {
    let Some(row) = damper.rows.first() else { return String::new() };
    let [_, k2, c2, d, c] = row.found.values();
    let gaps = if touches(damper) { [metres(d), metres(c)] } else { ["-".to_owned(), "-".to_owned()] };
    let mut text = format!(
        "{:<9}{:>9}{:>9}{:>10}{:>10}{:>8}{:>8}",
        damper.name,
        number(row.e1_max),
        number(k2),
        number(c2),
        metres(damper.needs[0]),
        gaps[0],
        gaps[1]
    );
    if let (Some(_), Some([less, more])) = (requirements.k1_error, damper.detuned) {
        text += &format!("{:>8}{:>8}", number(less), number(more));
    }
    text
}

fn touches(damper: &Designed) -> bool {
    damper.needs[1] > 0.0
}

/// Which damper to build, and why.
fn build(designed: &[Designed]) -> Vec<String> {
    let best = |damper: &&Designed| damper.rows.first().map_or(f64::INFINITY, |row| row.e1_max);
    let feasible: Vec<&Designed> = designed.iter().filter(|damper| damper.feasible).collect();
    let Some(least) = feasible.iter().min_by(|a, b| best(a).total_cmp(&best(b))) else {
        return vec![
            "None found that keeps the limits, of either damper: loosen one of them, or give the damper more mass."
                .to_owned(),
        ];
    };
    // A damper without walls is simpler to build and easier to trust.
    let plain = feasible.iter().find(|damper| !touches(damper) && best(damper) <= (1.0 + SAME) * best(least));
    let (choice, why) = match plain {
        Some(plain) if plain.name != least.name => (plain, " it is as good to 5 %, and strikes nothing"),
        Some(plain) => (plain, " it is the best, and strikes nothing"),
        None => (least, " it is the best"),
    };
    let reduction = choice.rows.first().map_or(f64::NAN, |row| row.none / row.e1_max);
    let other = feasible.iter().find(|damper| damper.name != choice.name);
    let beside = other.map_or(String::new(), |other| {
        let idle = other.name == "SSVI NES" && !touches(other);
        let idle = if idle { ", and strikes nothing either: it has become a TMD" } else { "" };
        format!("; the {} has {} J{idle}", other.name, number(best(other)))
    });
    let touching = if choice.name == "SSVI NES" && !touches(choice) {
        " Its walls are out of reach: it has become a TMD."
    } else {
        ""
    };
    vec![format!(
        "Build the {}:{why}. E1max is {} times smaller than without a damper{beside}.{touching}",
        choice.name,
        short(reduction)
    )]
}

/// What each limit costs.
fn costs(requirements: &Requirements, designed: &[Designed]) -> Vec<String> {
    let mut lines = Vec::new();
    for (number_of, limit) in requirements.limits().into_iter().enumerate() {
        let cost = |damper: &Designed| {
            let [own, free] =
                [0, number_of + 1].map(|i| damper.rows.get(i).map_or(f64::NAN, |row: &Row| row.e1_max));
            format!("{} J for the {}", number((own - free).max(0.0)), damper.name)
        };
        let costs: Vec<String> = designed.iter().map(cost).collect();
        lines.push(format!("The limit on {} costs {}.", limit.words(), costs.join(", ")));
    }
    lines
}

/// How sure a design is.
fn sure(damper: &Designed) -> Option<String> {
    let row = damper.rows.first()?;
    let kept = if damper.feasible { "" } else { "; none found that keeps the limits, this is the nearest" };
    Some(format!("Certificate of the {}: {}{kept}.", damper.name, row.reason))
}

fn short(value: f64) -> String {
    rounded(value, 3)
}

fn number(value: f64) -> String {
    if value.is_finite() { rounded(value, 4) } else { "no bound".to_owned() }
}

/// A length, m, to a tenth of a millimetre.
fn metres(value: f64) -> String {
    format!("{value:.4}")
}
