//! The atlas as one picture: a method in each column, a difficulty in each row.

use super::{Cell, Verdict, WAYS};
use crate::panel::{BLUE, Drawn, GREEN, GREY, INK, VERMILION, power};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

const CELL: (i32, i32) = (96, 27);
const LEFT: i32 = 380;
const TOP: i32 = 138;
/// Space between two groups of rows.
const GAP: i32 = 12;

/// A row: group, difficulty, cells.
pub type Row = (&'static str, &'static str, Vec<Cell>);

fn look(verdict: Verdict) -> (&'static str, RGBColor, RGBColor) {
    match verdict {
        Verdict::Works => ("✓", RGBColor(223, 240, 233), GREEN),
        Verdict::Inaccurate => ("≈", RGBColor(250, 230, 170), RGBColor(110, 75, 0)),
        Verdict::Says => ("!", RGBColor(200, 226, 245), BLUE),
        Verdict::Silent => ("✗", VERMILION, WHITE),
    }
}

/// `3·10⁻⁵`, or `< 10⁻¹²`.
fn figure(error: f64) -> String {
    if error < 1e-12 {
        return format!("< {}", power(-12));
    }
    let k = error.log10().floor();
    let lead = (error / 10f64.powf(k)).round();
    match (lead, k as i32) {
        (_, k) if k >= -1 => format!("{error:.1}"),
        (10.0, k) => power(k + 1),
        (1.0, k) => power(k),
        (lead, k) => format!("{lead:.0}·{}", power(k)),
    }
}

/// Draws the matrix.
///
/// # Errors
/// A file that cannot be written.
pub fn matrix(path: &Path, rows: &[Row]) -> Drawn {
    let groups = rows.windows(2).filter(|w| w[0].0 != w[1].0).count() as i32;
    let height = TOP + CELL.1 * rows.len() as i32 + GAP * groups + 56;
    let size = (LEFT + CELL.0 * WAYS.len() as i32 + 20, height);
    let root = SVGBackend::new(path, (size.0 as u32, size.1 as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let font = |size: i32| ("sans-serif", size).into_font();
    let centred =
        |size: i32, colour: &RGBColor| font(size).color(colour).pos(Pos::new(HPos::Center, VPos::Center));
    root.draw(&Text::new("Where methods fail", (20, 14), font(24).style(FontStyle::Bold)))?;
    let mut x = 20;
    for verdict in [Verdict::Works, Verdict::Inaccurate, Verdict::Says, Verdict::Silent] {
        let (glyph, fill, ink) = look(verdict);
        root.draw(&Rectangle::new([(x, 47), (x + 30, 73)], fill.filled()))?;
        root.draw(&Text::new(glyph, (x + 15, 60), centred(18, &ink)))?;
        root.draw(&Text::new(
            verdict.name(),
            (x + 38, 60),
            font(16).color(&INK).pos(Pos::new(HPos::Left, VPos::Center)),
        ))?;
        x += 160;
    }
    let note = "in each cell: the larger relative error of E1max and final state";
    root.draw(&Text::new(note, (x + 10, 60), font(15).color(&GREY).pos(Pos::new(HPos::Left, VPos::Center))))?;
    for (j, way) in WAYS.iter().enumerate() {
        let x = LEFT + CELL.0 * j as i32 + CELL.0 / 2;
        let (name, rest) = way.name.split_once(' ').unwrap_or((way.name, ""));
        let heading = centred(17, &INK);
        root.draw(&Text::new(name, (x, TOP - 36), heading))?;
        root.draw(&Text::new(rest, (x, TOP - 16), centred(14, &GREY)))?;
    }
    let (mut y, mut group) = (TOP, rows.first().map_or("", |r| r.0));
    for (of, name, cells) in rows {
        if *of != group {
            y += GAP;
            group = of;
        }
        root.draw(&Text::new(
            *name,
            (20, y + CELL.1 / 2),
            font(16).color(&INK).pos(Pos::new(HPos::Left, VPos::Center)),
        ))?;
        for (j, cell) in cells.iter().enumerate() {
            let x = LEFT + CELL.0 * j as i32;
            let (glyph, fill, ink) = look(cell.verdict);
            root.draw(&Rectangle::new([(x + 1, y + 1), (x + CELL.0 - 1, y + CELL.1 - 1)], fill.filled()))?;
            let text = if cell.verdict == Verdict::Says { "stops".into() } else { figure(cell.error) };
            root.draw(&Text::new(glyph, (x + 16, y + CELL.1 / 2), centred(17, &ink)))?;
            root.draw(&Text::new(text, (x + 58, y + CELL.1 / 2), centred(14, &ink)))?;
        }
        y += CELL.1;
    }
    let totals = |j: usize, verdict| rows.iter().filter(|r| r.2[j].verdict == verdict).count();
    let label = font(16).style(FontStyle::Bold).color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    root.draw(&Text::new(format!("works, of {}; fails silently", rows.len()), (20, y + 26), label))?;
    for j in 0..WAYS.len() {
        let x = LEFT + CELL.0 * j as i32 + CELL.0 / 2;
        let silent = totals(j, Verdict::Silent);
        let colour = if silent > 0 { VERMILION } else { INK };
        let text = format!("{}; {silent}", totals(j, Verdict::Works));
        root.draw(&Text::new(text, (x, y + 26), centred(17, &colour)))?;
    }
    root.present()?;
    Ok(())
}
