//! The page of `retention`, which begins with its answer. Every number on it is one of the tables beside it.

use super::curves::ANEW;
use super::draw;
use super::force::{Forced, GAPS, HALF};
use super::opening::{answer, joule};
use super::range::Range;
use super::retained::Retained;
use super::trade::Point;
use super::tuned::{CURVES, DESIGNS, FORCES, Tuning};
use crate::designs::Row;
use crate::{Error, pages};
use retune_model::{Measure, Parameter};
use retune_report::document::{Block, Document};
use retune_store::Directory;
use retune_study::{SpringBounds, design_words, rounded, short};

/// Writes the page in both forms, and its figures.
///
/// # Errors
/// A file cannot be written.
pub(super) fn write(retained: &Retained, directory: &Directory) -> Result<(), Error> {
    let words = "E1max, worst over each structure's own band, against its stiffness";
    let mut energy = vec![
        Block::figure("retention.svg", draw::retention(retained, false), words),
        worst(retained),
        cliffs(retained),
    ];
    if retained.curves.iter().any(|curve| curve.still) {
        let words = "The same with the band of frequencies where it is at the nominal k1";
        energy.push(Block::figure("still.svg", draw::retention(retained, true), words));
    }
    let words = "The least E1max at the nominal k1 against the retention range";
    let range = vec![
        Block::figure("range.svg", draw::range(retained), words),
        Block::words(RULE.to_owned() + if retained.varies_mass() { MASS } else { "" }),
        ranges(retained),
        Block::List(retained.shown().into_iter().map(|damper| traded(retained, damper)).collect()),
    ];
    let words = "E1max of the nominal designs as a share of that without a damper";
    let force = vec![Block::figure("force.svg", draw::force(retained), words), forces(retained)];
    let words = "The re-tuned designs against k1";
    let designs = vec![designs(retained), Block::figure("path.svg", draw::path(retained), words)];
    let files = [DESIGNS, CURVES, "range.csv", FORCES, "resolved.json", "manifest.json"];
    let page = Document {
        title: "How long a tuning lasts".to_owned(),
        command: "retune retention",
        opening: vec![Block::List(answer(retained)), Block::words(compared(retained))],
        sections: vec![
            ("range", "Retention range", range),
            ("force", "A smaller force", force),
            ("energy", "E1max along k1", energy),
            ("designs", "Designs", designs),
            ("data", "Data", vec![Block::files(&files)]),
        ],
    };
    pages::write(&page, directory)
}

const RULE: &str = "A damper does its work at a stiffness k1 if its reduction, 10 lg(E1max without damper / E1max), is at least half of that of the \
    best TMD of the same mass for that k1, with k2 and c2 free. It keeps its work over its retention range, the interval about the nominal k1 in \
    which it does. The range is looked for in steps of 2 % from 0.2 to 5 times the nominal k1; where it reaches so far its end is marked with >. It is \
    counted by the factor by which k1 may rise and fall, the smaller of its two sides.";

/// What is to be added where the dampers do not all have one mass.
const MASS: &str = " Where m2 is varied, this TMD has the mass of the damper in the study.";

/// What was compared.
fn compared(Retained { dampers, bounds, .. }: &Retained) -> String {
    let Some(first) = dampers.first() else { return String::new() };
    let samples = first.samples.map(|samples| format!(" on {samples} frequencies")).unwrap_or_default();
    format!(
        "Each design is compared by its E1max, {}{samples}, at each stiffness k1 of the structure. The nominal k1 is {} N/m; a k1-robust design is \
         tuned for the worst over {} N/m, a re-tuned one for each of them, with bounds on k2 {}.",
        pages::over(&first.study),
        short(first.nominal()),
        retune_study::joined(&first.anew.iter().map(|(k1, _)| short(*k1)).collect::<Vec<_>>(), ", "),
        match bounds {
            SpringBounds::Scaled => "in proportion to k1",
            SpringBounds::Fixed => "that stay as they are",
        }
    )
}

/// The values at the stiffnesses that were tuned for.
fn worst(retained: &Retained) -> Block {
    let mut rows = Vec::new();
    for number in retained.shown() {
        let damper = &retained.dampers[number];
        let mut add = |tuning: &str, energies: Vec<f64>| {
            let mut row = vec![damper.name.clone(), tuning.to_owned()];
            row.extend(energies.into_iter().map(joule));
            rows.push(row);
        };
        for kept in damper.kept.iter().filter(|kept| retained.is_new(number, kept.tuning)) {
            let energies = damper.anew.iter().map(|(k1, _)| damper.energy(&kept.at, *k1));
            add(kept.tuning.name(), energies.collect());
        }
        add(ANEW, damper.anew.iter().map(|(k1, at)| damper.energy(at, *k1)).collect());
    }
    let k1 = retained.dampers.iter().take(1).flat_map(|damper| damper.anew.iter().map(|(k1, _)| short(*k1)));
    let k1: Vec<String> = k1.collect();
    let caption = format!("E1max, J, at k1 = {} N/m.", k1.join(", "));
    Block::table(caption, ["damper", "tuning"].into_iter().map(str::to_owned).chain(k1), rows)
}

/// The cliffs of the curves.
fn cliffs(retained: &Retained) -> Block {
    let (mut lines, shown) = (Vec::new(), retained.shown());
    for curve in
        retained.curves.iter().filter(|curve| curve.damper.is_some_and(|damper| shown.contains(&damper)))
    {
        let (Some(number), Some(tuning)) = (curve.damper, curve.tuning) else { continue };
        let side = |(k1, energy): (f64, f64)| format!("{} J at {} N/m", joule(energy), rounded(k1, 6));
        let found: Vec<String> =
            curve.cliffs().map(|[from, to]| format!("from {} to {}", side(from), side(to))).collect();
        if !found.is_empty() {
            lines.push(format!(
                "Cliffs of the {}, {}{}: {}.",
                retained.name(number),
                tuning.name(),
                if curve.still { ", in the band of the nominal k1" } else { "" },
                found.join("; ")
            ));
        }
    }
    if lines.is_empty() { Block::words("No cliffs.") } else { Block::List(lines) }
}

/// The ranges of each design that is kept.
fn ranges(retained: &Retained) -> Block {
    let cells = |range: Option<Range>| match range {
        None => ["none", "", ""].map(str::to_owned),
        Some(range) => {
            let [low, high] = range.open.map(|open| if open { "> " } else { "" });
            let [from, to] =
                [(low, range.from), (high, range.to)].map(|(open, end)| format!("{open}{}", rounded(end, 4)));
            [from, to, rounded(range.factor(), 3)]
        }
    };
    let still = retained.kept.iter().any(|point| point.still.is_some());
    let row = |point: &Point| {
        let mut row = [retained.name(point.damper), point.tuning_name()].map(str::to_owned).to_vec();
        row.push(joule(point.e1_max));
        row.extend(cells(point.range));
        row.extend(still.then(|| cells(point.still)).into_iter().flatten());
        row
    };
    let mut head = vec!["damper", "tuning", "E1max at the nominal k1, J", "from, N/m", "to, N/m", "factor"];
    if still {
        head.extend(["band kept: from, N/m", "to, N/m", "factor"]);
    }
    let caption = "The retention range of the designs that are kept; on the right with the band of frequencies where it is at the nominal k1.";
    let rows = retained.shown_kept().into_iter().map(row).collect();
    Block::table(caption, head, rows)
}

/// The shares of the nominal designs under forces that halve.
fn forces(retained: &Retained) -> Block {
    let shown = retained.shown();
    let row = |of: &Forced| {
        let mut row =
            vec![retained.name(of.damper).to_owned(), GAPS[usize::from(of.proportional)].to_owned()];
        row.extend((0..of.points.len()).step_by(HALF).map(|step| rounded(of.share(step), 3)));
        row
    };
    let mut head = vec!["damper".to_owned(), "D and C".to_owned()];
    if let Some(first) = retained.forced.first() {
        head.extend(first.points.iter().step_by(HALF).map(|(force, _)| format!("{} N", rounded(*force, 4))));
    }
    let caption =
        "E1max of the nominal designs at the nominal k1 as a share of that without a damper, by the force.";
    let rows = retained.forced.iter().filter(|of| shown.contains(&of.damper)).map(row).collect();
    Block::table(caption, head, rows)
}

/// The trade of one damper in words.
fn traded(retained: &Retained, damper: usize) -> String {
    let (name, front) = (retained.name(damper), retained.front(damper));
    let (Some(least), Some(widest)) = (front.first(), front.last()) else {
        return format!("{name}: no design that was found does half of the work even at the nominal k1.");
    };
    let said = |point: &Point| {
        let ends = point.range.map_or(String::new(), |range| {
            format!("{} to {} N/m", rounded(range.from, 4), rounded(range.to, 4))
        });
        format!(
            "{ends} (a factor of {}) with {} J ({})",
            rounded(point.factor(), 3),
            joule(point.e1_max),
            design_words(&point.at, 4)
        )
    };
    format!("{name}: from {}, to {}.", said(least), said(widest))
}

/// All designs.
fn designs(retained: &Retained) -> Block {
    let shown = retained.shown();
    let is_shown = |row: &Row| {
        let damper = shown.iter().find(|damper| retained.name(**damper) == row.damper);
        let is_paper = row.label == Tuning::Paper.name();
        damper.is_some_and(|damper| !is_paper || retained.is_new(*damper, Tuning::Paper))
    };
    let table = retained.table.table().only(retained.table.rows.iter().map(is_shown));
    let mut parameters = retained.table.parameters();
    if retained.varies_mass() {
        parameters.push(Parameter::M2);
    }
    let mut columns = ["damper", "tuning"].map(|name| table.exact(name)).to_vec();
    let four = |value| rounded(value, 4);
    columns.extend(parameters.iter().map(|parameter| table.show(parameter.symbol(), four).or("none")));
    columns.extend([table.show(Measure::Energy.name(), joule).or("-"), table.exact("verdict")]);
    let (head, rows) = table.shown(&columns);
    let caption =
        "All designs, each with its E1max for what it was tuned for (the paper's: for the nominal k1).";
    Block::table(caption, head, rows)
}
