//! The page of `retention`, which begins with its answer. Every number on it is one of the tables beside it.

use super::draw;
use super::force::{Forced, GAPS, HALF};
use super::forces;
use super::opening::{answer, joule, shown};
use super::range::Range;
use super::retained::Retained;
use super::trade::{Point, front};
use super::tuned::{CURVES, DESIGNS, FORCES, Tuned, Tuning};
use crate::Error;
use crate::designs::Row;
use retune_report::document::{Block, Document};
use retune_store::Directory;
use retune_study::{SpringBounds, design_cells, design_words, rounded, short};

/// Writes the page in both forms, and its figures.
///
/// # Errors
/// A file cannot be written.
pub(super) fn write(retained: &Retained, directory: &Directory) -> Result<(), Error> {
    let shown = shown(retained);
    let retention = draw::retention(retained, &shown, false);
    let still =
        retained.curves.iter().any(|curve| curve.still).then(|| draw::retention(retained, &shown, true));
    let (path, range) = (draw::path(retained, &shown), draw::range(retained, &shown));
    let force = forces::draw(retained, &shown);
    let all =
        [("range.svg", &range), ("retention.svg", &retention), ("path.svg", &path), ("force.svg", &force)];
    for (name, drawing) in all.into_iter().chain(still.iter().map(|still| ("still.svg", still))) {
        directory.write(name, &drawing.wide)?;
    }
    let figure = |name, drawing, words: &str| Block::Figure(name, drawing, words.to_owned());
    let mut energy = vec![figure(
        "retention.svg",
        retention,
        "E1max, worst over each structure's own band, against its stiffness",
    )];
    energy.extend([worst(retained, &shown), cliffs(retained, &shown)]);
    let words = "The same with the band of frequencies where it is at the nominal k1";
    energy.extend(still.map(|still| figure("still.svg", still, words)));
    let sections = vec![
        (
            "range",
            "Retention range",
            vec![
                figure("range.svg", range, "The least E1max at the nominal k1 against the retention range"),
                Block::Words(RULE.to_owned()),
                ranges(retained, &shown),
                Block::List(shown.iter().map(|&i| traded(retained, i, &retained.dampers[i])).collect()),
            ],
        ),
        (
            "force",
            "A smaller force",
            vec![
                figure(
                    "force.svg",
                    force,
                    "E1max of the nominal designs as a share of that without a damper",
                ),
                forces(retained, &shown),
            ],
        ),
        ("energy", "E1max along k1", energy),
        (
            "designs",
            "Designs",
            vec![designs(retained, &shown), figure("path.svg", path, "The re-tuned designs against k1")],
        ),
        (
            "data",
            "Data",
            vec![Block::Files(
                [DESIGNS, CURVES, "range.csv", FORCES, "resolved.json", "manifest.json"]
                    .map(str::to_owned)
                    .to_vec(),
            )],
        ),
    ];
    let document = Document {
        title: "How long a tuning lasts".to_owned(),
        command: "retune retention",
        opening: vec![Block::List(answer(retained)), Block::Words(asked(retained))],
        sections,
    };
    directory.write("README.md", &document.markdown())?;
    Ok(directory.write("report.html", &document.html())?)
}

const RULE: &str = "A damper does its work at a stiffness k1 if its reduction, 10 lg(E1max without damper / E1max), is at least half of that of the \
    best TMD of the same mass for that k1, with k2 and c2 free. It keeps its work over its retention range, the interval about the nominal k1 in \
    which it does. The range is looked for in steps of 2 % from 0.2 to 5 times the nominal k1; where it reaches so far its end is marked with >. It is \
    counted by the factor by which k1 may rise and fall, the smaller of its two sides.";

/// What was compared.
fn asked(Retained { dampers, bounds, .. }: &Retained) -> String {
    let Some(first) = dampers.first() else { return String::new() };
    let samples = first.samples.map(|samples| format!(" on {samples} frequencies")).unwrap_or_default();
    format!(
        "Each design is compared by its E1max, {}{samples}, at each stiffness k1 of the structure. The nominal k1 is {} N/m; a k1-robust design is \
         tuned for the worst over {} N/m, a re-tuned one for each of them, with bounds on k2 {}.",
        retune_study::over(&first.study.objective(), first.study.scene.forcing.frequency.get()),
        short(first.nominal()),
        retune_study::joined(&first.anew.iter().map(|(k1, _)| short(*k1)).collect::<Vec<_>>(), ", "),
        match bounds {
            SpringBounds::Scaled => "in proportion to k1",
            SpringBounds::Fixed => "that stay as they are",
        }
    )
}

/// The values at the stiffnesses that were tuned for.
fn worst(retained: &Retained, shown: &[usize]) -> Block {
    let (dampers, mut rows) = (&retained.dampers, Vec::new());
    for &number in shown {
        let damper = &dampers[number];
        for kept in damper.kept.iter().filter(|kept| retained.is_new(number, kept.tuning)) {
            let mut row = vec![damper.name.clone(), kept.tuning.name().to_owned()];
            row.extend(damper.anew.iter().map(|(k1, _)| joule(damper.energy(&kept.at, *k1))));
            rows.push(row);
        }
        let mut row = vec![damper.name.clone(), "re-tuned".to_owned()];
        row.extend(damper.anew.iter().map(|(k1, at)| joule(damper.energy(at, *k1))));
        rows.push(row);
    }
    let k1 = dampers.first().map(|damper| damper.anew.iter().map(|(k1, _)| short(*k1)).collect::<Vec<_>>());
    let caption = format!("E1max, J, at k1 = {} N/m.", k1.as_deref().unwrap_or_default().join(", "));
    let mut head = vec!["damper".to_owned(), "tuning".to_owned()];
    head.extend(k1.unwrap_or_default());
    Block::Table(caption, head, rows)
}

/// The cliffs of the curves.
fn cliffs(Retained { dampers, curves, .. }: &Retained, shown: &[usize]) -> Block {
    let mut lines = Vec::new();
    for curve in curves.iter().filter(|curve| curve.damper.is_some_and(|damper| shown.contains(&damper))) {
        let (Some(number), Some(tuning)) = (curve.damper, curve.tuning) else { continue };
        let found: Vec<String> = curve
            .cliffs()
            .map(|[(from, low), (to, high)]| {
                format!(
                    "from {} J at {} N/m to {} J at {} N/m",
                    joule(low),
                    rounded(from, 6),
                    joule(high),
                    rounded(to, 6)
                )
            })
            .collect();
        if !found.is_empty() {
            lines.push(format!(
                "Cliffs of the {}, {}{}: {}.",
                dampers[number].name,
                tuning.name(),
                if curve.still { ", in the band of the nominal k1" } else { "" },
                found.join("; ")
            ));
        }
    }
    if lines.is_empty() { Block::Words("No cliffs.".to_owned()) } else { Block::List(lines) }
}

/// The ranges of each design that is kept.
fn ranges(retained: &Retained, shown: &[usize]) -> Block {
    let Retained { dampers, kept, .. } = retained;
    let cells = |range: Option<Range>| match range {
        None => ["none", "", ""].map(str::to_owned),
        Some(range) => {
            let [low, high] = range.open.map(|open| if open { "> " } else { "" });
            let [from, to] =
                [(low, range.from), (high, range.to)].map(|(open, end)| format!("{open}{}", rounded(end, 4)));
            [from, to, rounded(range.factor(), 3)]
        }
    };
    let still = kept.iter().any(|(_, point)| point.still.is_some());
    let row = |(tuning, point): &(&'static str, Point)| {
        let mut row = vec![dampers[point.damper].name.clone(), (*tuning).to_owned(), joule(point.e1_max)];
        row.extend(cells(point.range));
        row.extend(still.then(|| cells(point.still)).into_iter().flatten());
        row
    };
    let own = |(tuning, point): &&(&'static str, Point)| {
        let is_paper = *tuning == Tuning::Paper.name();
        shown.contains(&point.damper) && (!is_paper || retained.is_new(point.damper, Tuning::Paper))
    };
    let mut head = vec!["damper", "tuning", "E1max at the nominal k1, J", "from, N/m", "to, N/m", "factor"];
    if still {
        head.extend(["band kept: from, N/m", "to, N/m", "factor"]);
    }
    Block::Table(
        "The retention range of the designs that are kept; on the right with the band of frequencies where it is at the nominal k1."
            .to_owned(),
        head.into_iter().map(str::to_owned).collect(),
        kept.iter().filter(own).map(row).collect(),
    )
}

/// The shares of the nominal designs under forces that halve.
fn forces(Retained { dampers, forced, .. }: &Retained, shown: &[usize]) -> Block {
    let row = |of: &Forced| {
        let steps = (0..of.points.len()).step_by(HALF).map(|step| rounded(of.share(step), 3));
        [dampers[of.damper].name.clone(), GAPS[usize::from(of.proportional)].to_owned()]
            .into_iter()
            .chain(steps)
            .collect()
    };
    let mut head = vec!["damper".to_owned(), "D and C".to_owned()];
    if let Some(first) = forced.first() {
        head.extend(first.points.iter().step_by(HALF).map(|(force, _)| format!("{} N", rounded(*force, 4))));
    }
    Block::Table(
        "E1max of the nominal designs at the nominal k1 as a share of that without a damper, by the force."
            .to_owned(),
        head,
        forced.iter().filter(|of| shown.contains(&of.damper)).map(row).collect(),
    )
}

/// The trade of one damper in words.
fn traded(Retained { points, .. }: &Retained, number: usize, damper: &Tuned) -> String {
    let front = front(points, number);
    let (Some(least), Some(widest)) = (front.first(), front.last()) else {
        return format!(
            "{}: no design that was found does half of the work even at the nominal k1.",
            damper.name
        );
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
    format!("{}: from {}, to {}.", damper.name, said(least), said(widest))
}

/// All designs.
fn designs(retained: &Retained, shown: &[usize]) -> Block {
    let own = |row: &&Row| {
        let is_it = |damper: &&usize| retained.dampers[**damper].name == row.damper;
        let is_paper = row.label == Tuning::Paper.name();
        shown.iter().find(is_it).is_some_and(|damper| !is_paper || retained.is_new(*damper, Tuning::Paper))
    };
    let rows = retained.table.rows.iter().filter(own).map(|row| {
        let [k2, c2, d, c] = design_cells(&row.found.design, 4);
        vec![row.damper.clone(), row.label.clone(), k2, c2, d, c, joule(row.e1_max), row.verdict.to_owned()]
    });
    let head = ["damper", "tuning", "k2, N/m", "c2, N·s/m", "D, m", "C, m", "E1max, J", "verdict"];
    Block::Table(
        "All designs, each with its E1max for what it was tuned for (the paper's: for the nominal k1)."
            .to_owned(),
        head.map(str::to_owned).to_vec(),
        rows.collect(),
    )
}
