//! The atlas as one picture: a method in each column, a difficulty in each row.

use super::{Cell, Verdict};
use crate::Any;
use retune_report::colour::{Colour, GREEN, ORANGE, SKY, VERMILION, YELLOW};
use retune_report::{Axis, Chart, Key, Layer, Sheet, Stand, Width, svg, ten_to};
use std::fs;
use std::path::Path;

/// Space between two groups of rows, in rows.
const GAP: f64 = 0.4;
/// Height of a row, pt.
const ROW: f64 = 15.5;
/// All verdicts of runs, the best first.
pub const VERDICTS: [Verdict; 5] =
    [Verdict::Works, Verdict::Miscounts, Verdict::Inaccurate, Verdict::ReportsError, Verdict::Silent];

/// A row: group, difficulty, cells.
pub type Row = (&'static str, &'static str, Vec<Cell>);

/// Sign, colour and its opacity.
const fn look(verdict: Verdict) -> (&'static str, Colour, f64) {
    match verdict {
        Verdict::Works => ("✓", GREEN, 0.16),
        Verdict::Miscounts => ("±", YELLOW, 0.4),
        Verdict::Inaccurate => ("≈", ORANGE, 0.4),
        Verdict::ReportsError => ("!", SKY, 0.4),
        Verdict::Silent => ("✗", VERMILION, 0.85),
        Verdict::NotRun => ("–", SKY, 0.0),
    }
}

/// `3·10⁻⁵`, or `< 10⁻¹²`.
fn figure(error: f64) -> String {
    if error < 1e-12 {
        return format!("< {}", ten_to(-12));
    }
    let k = error.log10().floor();
    let lead = (error / 10f64.powf(k)).round();
    match (lead, k as i32) {
        (_, k) if k >= -1 => format!("{error:.1}"),
        (10.0, k) => ten_to(k + 1),
        (1.0, k) => ten_to(k),
        (lead, k) => format!("{lead:.0}·{}", ten_to(k)),
    }
}

/// `5.3 k`, or `12 M`.
fn thousands(count: u64) -> String {
    match count as f64 {
        n if n < 1e3 => format!("{n}"),
        n if n < 1e4 => format!("{:.1} k", n / 1e3),
        n if n < 1e6 => format!("{:.0} k", n / 1e3),
        n => format!("{:.1} M", n / 1e6),
    }
}

/// A name in two lines, the last word on the second.
fn in_lines(name: &str) -> String {
    match name.rsplit_once(' ') {
        Some((first, "ms")) => in_lines(first) + " ms",
        Some((first, last)) => format!("{first}\n{last}"),
        None => name.to_owned(),
    }
}

/// Draws the matrix; `ways` are the names of the methods.
pub fn matrix(path: &Path, title: &str, ways: &[&str], rows: &[Row]) -> Any<()> {
    let mut layers = Vec::new();
    let (mut names, mut y, mut group) = (Vec::new(), 0.0, rows.first().map_or("", |row| row.0));
    for (of, name, cells) in rows {
        if *of != group {
            y -= GAP;
            group = of;
        }
        names.push((y, (*name).to_owned()));
        for (x, cell) in cells.iter().enumerate().map(|(j, cell)| (j as f64, cell)) {
            let (sign, colour, opacity) = look(cell.verdict);
            layers.push(Layer::Band { x: (x - 0.48, x + 0.48), y: (y - 0.46, y + 0.46), colour, opacity });
            let said = match cell.verdict {
                Verdict::ReportsError => "stops".into(),
                Verdict::NotRun => "not run".into(),
                _ => figure(cell.error),
            };
            layers.push(Layer::Text { at: (x, y + 0.2), text: format!("{sign} {said}"), stand: Stand::Cell });
            if cell.evaluations > 0 {
                layers.push(Layer::Text {
                    at: (x, y - 0.22),
                    text: thousands(cell.evaluations),
                    stand: Stand::Cell,
                });
            }
        }
        y -= 1.0;
    }
    let totals = |j: usize, verdict| rows.iter().filter(|row| row.2[j].verdict == verdict).count();
    y -= GAP;
    names.push((y, format!("works, of {}; fails silently", rows.len())));
    for j in 0..ways.len() {
        let text = format!("{}; {}", totals(j, Verdict::Works), totals(j, Verdict::Silent));
        layers.push(Layer::Text { at: (j as f64, y), text, stand: Stand::Over });
    }
    let columns = ways.iter().enumerate().map(|(j, way)| (j as f64, in_lines(way))).collect();
    let chart = Chart {
        title: String::new(),
        x: Axis::of_names((-0.55, ways.len() as f64 - 0.45), columns),
        y: Axis::of_names((y - 0.6, 0.6), names),
        layers,
        height: ROW * (1.2 - y) + 30.0,
    };
    let key = |verdict: Verdict| {
        let (sign, colour, opacity) = look(verdict);
        (Key::Area(colour, opacity), format!("{sign} {}", verdict.name()))
    };
    let count = |verdict| (0..ways.len()).map(|j| totals(j, verdict)).sum::<usize>();
    let counts = VERDICTS.map(|verdict| format!("{} {}", count(verdict), verdict.name()));
    fs::write(
        path,
        svg(&Sheet {
            title: title.to_owned(),
            description: format!(
                "A table of {} difficulties and {} methods. Of its cells: {}.",
                rows.len(),
                ways.len(),
                counts.join(", ")
            ),
            width: Width::Page,
            charts: vec![chart],
            columns: 1,
            stacked: false,
            legend: VERDICTS.map(key).to_vec(),
            caption: vec![
                "In each cell: the larger relative error of E1max and final state; below, evaluations of right-hand side and Jacobian (k: thousands), \
                 each exact step of the hybrid as one."
                    .to_owned(),
            ],
        }),
    )?;
    Ok(())
}
