//! Charts: log–log, colours of M. Okabe and K. Ito (2008), every line labelled where it ends.

use crate::reading::{Curve, Saving, curves};
use crate::record::Row;
use crate::scenes::Case;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// Okabe and Ito's colours: black, vermilion, blue, green, orange, sky blue, purple, and a grey.
pub const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(204, 121, 167),
    RGBColor(120, 120, 120),
];

type Drawn = Result<(), Box<dyn Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const PANEL: (u32, u32) = (680, 500);
const LABELS: u32 = 190;

/// Colour by whose method it is, and width: the hybrid stands out.
fn style(name: &str) -> (RGBColor, u32) {
    match name.split(' ').next().unwrap_or_default() {
        "hybrid" => (COLOURS[1], 4),
        "differential-equations" => (COLOURS[3], 1),
        "ivp" => (COLOURS[4], 1),
        "diffsol" => (COLOURS[6], 1),
        "Octave" => (COLOURS[0], 2),
        "SciPy" => (COLOURS[7], 2),
        "SUNDIALS" => (COLOURS[5], 2),
        _ => (COLOURS[2], 2),
    }
}

fn short(curve: &Curve<'_>) -> String {
    let name = curve.name.replace("differential-equations", "diff-eq");
    let way = if curve.contacts == "stepped" { ", stepped" } else { "" };
    let failed = if curve.failed > 0 { format!(" ({} failed)", curve.failed) } else { String::new() };
    format!("{name}{way}{failed}")
}

/// One panel a scene: relative error of E1max across, cost up.
///
/// # Errors
/// A file that cannot be written.
pub fn work_precision(path: &Path, cases: &[Case], rows: &[Row], in_time: bool) -> Drawn {
    let title = if in_time { "Time of a run, ms" } else { "Evaluations of the right-hand side" };
    let root = SVGBackend::new(path, (3 * PANEL.0, 2 * PANEL.1 + 50)).into_drawing_area();
    root.fill(&WHITE)?;
    let note = format!(
        "{title}, against the relative error of E1max.  Vermilion: Retune's hybrid; blue: Retune's general methods; \
         green, orange, purple: Rust peers; black, grey, sky blue: Octave, SciPy, SUNDIALS (out of process)"
    );
    root.draw(&Text::new(note, (20, 16), ("sans-serif", 21).into_font()))?;
    let (_, panels) = root.split_vertically(50);
    for (panel, case) in panels.split_evenly((2, 3)).iter().zip(cases) {
        draw_panel(panel, case, &curves(rows, case), in_time)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(panel: &Area<'_>, case: &Case, curves: &[Curve<'_>], in_time: bool) -> Drawn {
    let (left, margin) = panel.split_horizontally(PANEL.0 - LABELS);
    let scale = if in_time { 1e3 } else { 1.0 };
    let (low, high) = if in_time { (1e-3, 1e5) } else { (1e2, 1e8) };
    let caption = format!("{} (T = {} s)", case.label, case.to);
    let mut chart = ChartBuilder::on(&left)
        .caption(caption, ("sans-serif", 20))
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d((1e-15..1e1).log_scale(), (low..high).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(230, 230, 230))
        .x_desc("relative error of E1max")
        .y_desc(if in_time { "time, ms" } else { "evaluations" })
        .x_label_formatter(&|v: &f64| format!("1e{:.0}", v.log10()))
        .y_label_formatter(&|v: &f64| format!("1e{:.0}", v.log10()))
        .label_style(("sans-serif", 15))
        .draw()?;
    let mut ends: Vec<(i32, i32, i32, String, RGBColor, bool)> = Vec::new();
    for curve in curves {
        let (colour, width) = style(&curve.name);
        let points: Vec<(f64, f64)> = curve
            .points
            .iter()
            .filter_map(|(error, row)| Some((error.clamp(1e-15, 9.9), row.cost(in_time)? * scale)))
            .filter(|p| p.1.is_finite() && p.1 > 0.0)
            .collect();
        let Some(&end) = points.last() else { continue };
        chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(width)))?;
        let size = if width > 3 { 4 } else { 2 };
        chart.draw_series(points.iter().map(|&p| Circle::new(p, size, colour.filled())))?;
        let (x, y) = chart.backend_coord(&end);
        ends.push((y, x, y, short(curve), colour, width > 3));
    }
    let base = left.get_base_pixel();
    label(&margin, ends, base)
}

/// Names beside the lines' ends, moved apart, with a thin line from each name to its end.
fn label(
    margin: &Area<'_>,
    mut ends: Vec<(i32, i32, i32, String, RGBColor, bool)>,
    base: (i32, i32),
) -> Drawn {
    ends.sort_by_key(|e| e.0);
    let spacing = 17;
    let (top, bottom) = (34, PANEL.1 as i32 - 70);
    let count = ends.len() as i32;
    for end in &mut ends {
        end.0 -= base.1;
    }
    for i in 0..ends.len() {
        let least = if i == 0 { top } else { ends[i - 1].0 + spacing };
        ends[i].0 = ends[i].0.max(least);
    }
    for i in (0..ends.len()).rev() {
        let most =
            if i + 1 == ends.len() { bottom.max(top + count * spacing) } else { ends[i + 1].0 - spacing };
        ends[i].0 = ends[i].0.min(most);
    }
    let left = base.0 - margin.get_base_pixel().0;
    for (y, x_end, y_end, name, colour, bold) in ends {
        let from = (x_end - base.0 + left, y_end - base.1);
        margin.draw(&PathElement::new(vec![from, (0, y)], colour.mix(0.25)))?;
        let font = ("sans-serif", if bold { 17 } else { 14 }).into_font();
        let font = if bold { font.style(FontStyle::Bold) } else { font };
        margin.draw(&Text::new(name, (3, y - 8), font.color(&colour)))?;
    }
    Ok(())
}

/// Time of each scene under the smallest exact model and under the full one.
///
/// # Errors
/// A file that cannot be written.
pub fn savings(path: &Path, savings: &[Saving]) -> Drawn {
    let root = SVGBackend::new(path, (860, 90 + 62 * savings.len() as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    root.draw(&Text::new(
        "Time of E1max: smallest exact model (vermilion), full contact model (blue)",
        (20, 16),
        ("sans-serif", 19).into_font(),
    ))?;
    let longest = savings.iter().flat_map(|s| s.seconds).fold(0.0, f64::max);
    for (i, s) in savings.iter().enumerate() {
        let y = 60 + 62 * i as i32;
        root.draw(&Text::new(s.label, (20, y + 10), ("sans-serif", 16).into_font()))?;
        for (j, (seconds, colour)) in s.seconds.into_iter().zip([COLOURS[1], COLOURS[2]]).enumerate() {
            let (y, width) = (y + 22 * j as i32, (430.0 * seconds / longest) as i32);
            root.draw(&Rectangle::new([(230, y), (230 + width.max(1), y + 18)], colour.filled()))?;
            let text = format!("{:.1} µs", seconds * 1e6);
            root.draw(&Text::new(text, (238 + width, y + 2), ("sans-serif", 14).into_font()))?;
        }
    }
    root.present()?;
    Ok(())
}
