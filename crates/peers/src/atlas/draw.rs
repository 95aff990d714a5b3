//! The atlas as one picture: a method in each column, a difficulty in each row.

use super::{Cell, Verdict, WAYS};
use crate::chart::COLOURS;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
use std::path::Path;

const CELL: (i32, i32) = (104, 40);
const LEFT: i32 = 400;
const TOP: i32 = 120;

fn look(verdict: Verdict) -> (&'static str, RGBColor, RGBColor) {
    match verdict {
        Verdict::Works => ("✓", RGBColor(214, 236, 228), COLOURS[3]),
        Verdict::Inaccurate => ("≈", RGBColor(250, 233, 190), RGBColor(120, 80, 0)),
        Verdict::Says => ("!", RGBColor(205, 230, 247), COLOURS[2]),
        Verdict::Silent => ("✗", COLOURS[1], WHITE),
    }
}

/// Draws the matrix.
///
/// # Errors
/// A file that cannot be written.
pub fn matrix(path: &Path, rows: &[(&'static str, Vec<Cell>)]) -> Result<(), Box<dyn Error>> {
    let size = (LEFT + CELL.0 * WAYS.len() as i32 + 20, TOP + CELL.1 * rows.len() as i32 + 60);
    let root = SVGBackend::new(path, (size.0 as u32, size.1 as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let font = |size: i32| ("sans-serif", size).into_font();
    let centred =
        |size: i32, colour: &RGBColor| font(size).color(colour).pos(Pos::new(HPos::Center, VPos::Center));
    root.draw(&Text::new("Where methods fail", (20, 16), font(24)))?;
    root.draw(&Text::new("in each cell: the relative error of E1max", (20, 48), font(16)))?;
    for (j, way) in WAYS.iter().enumerate() {
        let x = LEFT + CELL.0 * j as i32 + CELL.0 / 2;
        let (name, rest) = way.name.split_once(' ').unwrap_or((way.name, ""));
        root.draw(&Text::new(name, (x, TOP - 40), centred(17, &BLACK)))?;
        root.draw(&Text::new(rest, (x, TOP - 18), centred(15, &BLACK)))?;
    }
    for (i, (name, cells)) in rows.iter().enumerate() {
        let y = TOP + CELL.1 * i as i32;
        root.draw(&Text::new(*name, (20, y + 12), font(16)))?;
        for (j, cell) in cells.iter().enumerate() {
            let x = LEFT + CELL.0 * j as i32;
            let (glyph, fill, ink) = look(cell.verdict);
            root.draw(&Rectangle::new([(x + 1, y + 1), (x + CELL.0 - 1, y + CELL.1 - 1)], fill.filled()))?;
            let figure = match cell.verdict {
                Verdict::Says => String::new(),
                _ => format!("{:.0e}", cell.error),
            };
            root.draw(&Text::new(glyph, (x + 22, y + CELL.1 / 2), centred(20, &ink)))?;
            root.draw(&Text::new(figure, (x + 64, y + CELL.1 / 2), centred(16, &ink)))?;
        }
    }
    let mut x = LEFT;
    let y = TOP + CELL.1 * rows.len() as i32 + 30;
    for verdict in [Verdict::Works, Verdict::Inaccurate, Verdict::Says, Verdict::Silent] {
        let (glyph, fill, ink) = look(verdict);
        root.draw(&Rectangle::new([(x, y - 13), (x + 30, y + 13)], fill.filled()))?;
        root.draw(&Text::new(glyph, (x + 15, y), centred(18, &ink)))?;
        root.draw(&Text::new(verdict.name(), (x + 38, y - 8), font(16)))?;
        x += 200;
    }
    root.present()?;
    Ok(())
}
