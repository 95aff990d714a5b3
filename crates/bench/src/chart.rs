//! Charts of speed against accuracy, one panel for each scene, and of the saving by the smallest exact model.

use crate::panel::{
    Axis, BLUE, Drawn, GREEN, GREY, INK, Line, Marker, ORANGE, PURPLE, Panel, VERMILION, sheet,
};
use crate::reading::{Curve, Measure, curves, rank};
use crate::record::Row;
use crate::savings::Saving;
use crate::scenes::Case;
use plotters::prelude::*;
use std::path::Path;

/// The cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Time, ms.
    Time,
    /// Evaluations of the right-hand side.
    Evaluations,
}

/// Colour by program and marker by method; the hybrid and the paper's method are emphasised.
fn style(name: &str) -> (RGBColor, u32, Marker) {
    match name {
        "hybrid" => (VERMILION, 4, Marker::Disc),
        "ode23s" => (INK, 3, Marker::Disc),
        "ode45" => (BLUE, 2, Marker::Disc),
        "ode23" => (BLUE, 2, Marker::Square),
        "dop853" => (BLUE, 2, Marker::Triangle),
        "rk4" => (GREEN, 1, Marker::Disc),
        "euler" => (GREEN, 1, Marker::Square),
        _ if name.starts_with("differential-equations") => (PURPLE, 1, Marker::Disc),
        _ if name.starts_with("ivp") => (PURPLE, 1, Marker::Square),
        _ if name.starts_with("diffsol") => (PURPLE, 1, Marker::Triangle),
        "Octave ode23s" => (ORANGE, 2, Marker::Disc),
        _ if name.starts_with("Octave") => (ORANGE, 1, Marker::Square),
        _ if name.starts_with("SUNDIALS") => (GREY, 1, Marker::Square),
        _ => (GREY, 1, Marker::Disc),
    }
}

/// Retune's methods, both of Octave's, and of every other program the best one for the scene.
fn shown<'a>(all: Vec<Curve<'a>>) -> Vec<Curve<'a>> {
    let mut kept: Vec<Curve<'a>> = Vec::new();
    for curve in all {
        let program = curve.program();
        let rival = kept.iter().position(|k| k.program() == program);
        match rival {
            Some(i) if program != "retune" && program != "Octave" => {
                if rank(&curve) < rank(&kept[i]) {
                    kept[i] = curve;
                }
            }
            _ => kept.push(curve),
        }
    }
    // The most important lines are drawn last, on top.
    kept.sort_by_key(|c| style(&c.name).1);
    kept
}

fn line(curve: &Curve<'_>, cost: Cost) -> Line {
    let (colour, width, marker) = style(&curve.name);
    let way = if curve.contacts == "stepped" { ", stepped" } else { "" };
    let failed = if curve.failed > 0 { format!(" ({} failed)", curve.failed) } else { String::new() };
    let name = format!("{}{way}{failed}", curve.name.replace("differential-equations", "diff-eq"));
    let scale = if cost == Cost::Time { 1e3 } else { 1.0 };
    let points = curve
        .points
        .iter()
        .filter_map(|(error, row)| Some((*error, row.cost(cost == Cost::Time)? * scale)))
        .filter(|p| p.1 > 0.0)
        .collect();
    Line { name, points, colour, width, marker }
}

/// One panel for each scene: error on the horizontal axis, cost on the vertical axis.
///
/// # Errors
/// A file that cannot be written.
pub fn work_precision(path: &Path, cases: &[Case], rows: &[Row], measure: Measure, cost: Cost) -> Drawn {
    let (what, unit, low, high) = match cost {
        Cost::Time => ("time of a run", "time of a run, ms", 1e-2, 1e5),
        Cost::Evaluations => {
            ("evaluations of the right-hand side", "evaluations of the right-hand side", 1e1, 1e7)
        }
    };
    let error = measure.name();
    let panels: Vec<Panel> = cases
        .iter()
        .map(|case| Panel {
            caption: format!("{} (T = {} s)", case.label, case.to),
            x: Axis::log(&format!("relative error of {error}"), 1e-15, 1e1),
            y: Axis::log(unit, low, high),
            lines: shown(curves(rows, case, measure)).iter().map(|c| line(c, cost)).collect(),
        })
        .collect();
    let title = format!("Error of {error} against {what}: lower left is better");
    let key = "Vermilion: Retune's hybrid. Black: the paper's ode23s. Blue, green: Retune's other methods, adaptive and of fixed step. \
               Purple: Rust crates. Orange: GNU Octave. Grey: SciPy, SUNDIALS.";
    let note = "Of every other program the method that served the scene best; contacts located unless it says stepped. \
                All runs, failures with their reason: runs.csv.";
    sheet(path, &[&title, key, note], 3, (690, 500), &panels)
}

/// Time of each scene under the smallest exact model and under the full one.
///
/// # Errors
/// A file that cannot be written.
pub fn savings(path: &Path, savings: &[Saving]) -> Drawn {
    let root = SVGBackend::new(path, (900, 84 + 62 * savings.len() as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let bold = |size| ("sans-serif", size).into_font().style(FontStyle::Bold);
    root.draw(&Text::new(
        "Time of one E1max, µs: the smallest model that is exact, and the full contact model",
        (20, 14),
        bold(18),
    ))?;
    let longest = savings.iter().flat_map(|s| s.seconds).fold(0.0, f64::max);
    for (i, s) in savings.iter().enumerate() {
        let top = 60 + 62 * i as i32;
        root.draw(&Text::new(s.label, (20, top + 12), ("sans-serif", 16).into_font()))?;
        let models = [(s.model, VERMILION), ("full contact model", BLUE)];
        for (j, (seconds, (model, colour))) in s.seconds.into_iter().zip(models).enumerate() {
            let (y, width) = (top + 22 * j as i32, (330.0 * seconds / longest) as i32);
            root.draw(&Rectangle::new([(250, y), (250 + width.max(1), y + 18)], colour.filled()))?;
            let text = format!("{:.1}  {model}", seconds * 1e6);
            root.draw(&Text::new(text, (258 + width, y + 2), ("sans-serif", 14).into_font().color(&colour)))?;
        }
    }
    root.present()?;
    Ok(())
}
