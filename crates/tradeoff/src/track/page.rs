//! The page of `track`, and its answer in words. Every number on it is one of the tables beside it.

use super::curves::Curve;
use super::draw;
use super::tracked::Tracked;
use super::trade::{Point, front};
use super::tuned::{CURVES, DESIGNS, Tuned, Tuning};
use retune_store::Directory;
use retune_study::{SpringBounds, design_cells, design_words, rounded, short};
use retune_workbench::Error;
use retune_workbench::document::{Block, Document};

/// Writes the page in both forms, and its figures.
///
/// # Errors
/// A file cannot be written.
pub(super) fn write(tracked: &Tracked, directory: &Directory) -> Result<(), Error> {
    let Tracked { dampers, curves, thresholds, kept, points, .. } = tracked;
    let retention = draw::retention(dampers, curves, thresholds);
    let (path, range) = (draw::path(dampers), draw::range(dampers, kept, points));
    for (name, drawing) in [("retention.svg", &retention), ("path.svg", &path), ("range.svg", &range)] {
        directory.write(name, &drawing.wide)?;
    }
    let figure = |name, drawing, words: &str| Block::Figure(name, drawing, words.to_owned());
    let sections = vec![
        (
            "energy",
            "E1max along k1",
            vec![
                figure(
                    "retention.svg",
                    retention,
                    "E1max, worst over each structure's own band, against its stiffness",
                ),
                worst(tracked),
                cliffs(tracked),
            ],
        ),
        (
            "range",
            "Retention range",
            vec![
                Block::Words(RULE.to_owned()),
                ranges(tracked),
                figure("range.svg", range, "The least E1max at the nominal k1 against the retention range"),
                Block::List(
                    dampers.iter().enumerate().map(|(i, damper)| traded(tracked, i, damper)).collect(),
                ),
            ],
        ),
        (
            "designs",
            "Designs",
            vec![designs(tracked), figure("path.svg", path, "The re-tuned designs against k1")],
        ),
        (
            "data",
            "Data",
            vec![Block::Files(
                [DESIGNS, CURVES, "range.csv", "resolved.json", "manifest.json"].map(str::to_owned).to_vec(),
            )],
        ),
    ];
    let document = Document {
        title: "How long a tuning lasts".to_owned(),
        command: "retune track",
        opening: vec![Block::Words(asked(tracked)), Block::List(answer(tracked))],
        sections,
    };
    directory.write("README.md", &document.markdown())?;
    Ok(directory.write("report.html", &document.html())?)
}

const RULE: &str = "A design does its work at a stiffness k1 if its reduction, 10 lg(E1max without damper / E1max), is at least half of that of the \
    best TMD of the same mass for that k1, with k2 and c2 free. The retention range is the interval about the nominal k1 in which it does. It is \
    looked for in steps of 2 % from 0.2 to 5 times the nominal k1; where it reaches so far its end is marked with >. It is counted by the factor by which k1 may \
    rise and fall, the smaller of its two sides.";

/// What was compared.
fn asked(Tracked { dampers, bounds, .. }: &Tracked) -> String {
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

/// The answer: one line for each damper.
pub(super) fn answer(tracked: &Tracked) -> Vec<String> {
    tracked.dampers.iter().enumerate().map(|(i, damper)| one(tracked, i, damper)).collect()
}

fn one(tracked: &Tracked, number: usize, damper: &Tuned) -> String {
    let nominal = damper.nominal();
    let worst = |tuning: Option<Tuning>| {
        let own = |curve: &&Curve| curve.damper == Some(number) && curve.tuning == tuning;
        tracked.curves.iter().find(own).and_then(Curve::worst)
    };
    let mut words = format!("{}: ", damper.name);
    if let (Some((k1, kept)), Some(at)) = (worst(Some(Tuning::Nominal)), damper.of(Tuning::Nominal)) {
        words += &format!(
            "tuned for k1 = {} N/m it has {} J there and at worst {} J, at {} N/m",
            short(nominal),
            joule(damper.energy(&at, nominal)),
            joule(kept),
            rounded(k1, 4)
        );
    }
    if let (Some((k1, robust)), Some(at)) = (worst(Some(Tuning::Robust)), damper.of(Tuning::Robust)) {
        words += &format!(
            "; k1-robust it has {} J there and at worst {} J, at {} N/m",
            joule(damper.energy(&at, nominal)),
            joule(robust),
            rounded(k1, 4)
        );
    }
    if let Some((_, anew)) = worst(None) {
        words += &format!("; re-tuned for each k1 at most {} J", joule(anew));
    }
    words + "."
}

/// The values at the stiffnesses that were tuned for.
fn worst(Tracked { dampers, .. }: &Tracked) -> Block {
    let mut rows = Vec::new();
    for damper in dampers {
        for kept in &damper.kept {
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
fn cliffs(Tracked { dampers, curves, .. }: &Tracked) -> Block {
    let mut lines = Vec::new();
    for curve in curves {
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
                "Cliffs of the {}, {}: {}.",
                dampers[number].name,
                tuning.name(),
                found.join("; ")
            ));
        }
    }
    if lines.is_empty() { Block::Words("No cliffs.".to_owned()) } else { Block::List(lines) }
}

/// The range of each design that is kept.
fn ranges(Tracked { dampers, kept, .. }: &Tracked) -> Block {
    let row = |(tuning, point): &(&'static str, Point)| {
        let [from, to, width] = match point.range {
            None => ["none", "", ""].map(str::to_owned),
            Some(range) => {
                let [low, high] = range.open.map(|open| if open { "> " } else { "" });
                [
                    format!("{low}{}", rounded(range.from, 4)),
                    format!("{high}{}", rounded(range.to, 4)),
                    rounded(range.factor(), 3),
                ]
            }
        };
        vec![dampers[point.damper].name.clone(), (*tuning).to_owned(), joule(point.e1_max), from, to, width]
    };
    let head = ["damper", "tuning", "E1max at the nominal k1, J", "from, N/m", "to, N/m", "factor"];
    Block::Table(
        "The retention range of the designs that are kept.".to_owned(),
        head.map(str::to_owned).to_vec(),
        kept.iter().map(row).collect(),
    )
}

/// The trade of one damper in words.
fn traded(Tracked { points, .. }: &Tracked, number: usize, damper: &Tuned) -> String {
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
fn designs(Tracked { table, .. }: &Tracked) -> Block {
    let rows = table.rows.iter().map(|row| {
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

fn joule(value: f64) -> String {
    if value.is_finite() { rounded(value, 4) } else { "-".to_owned() }
}
