//! Charts of speed against accuracy, one panel for each scene, and of the saving by the smallest exact model.

use crate::panel::{Drawn, Line, WIDTHS, look, panel, sheet};
use crate::reading::{Curve, Measure, curves, rank};
use crate::record::Row;
use crate::savings::Saving;
use crate::scenes::Case;
use retune_figures::colour::{BLUE, Colour, GREEN, GREY, ORANGE, PURPLE, VERMILION};
use retune_figures::{Axis, Chart, Key, Layer, Shape, Sheet, Stand, Width, svg};
use retune_solver::Method;
use std::fs;
use std::path::Path;

/// The cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Time, ms.
    Time,
    /// Evaluations of the right-hand side.
    Evaluations,
}

/// Colour by program and mark by method; the hybrid and the paper's method are emphasised.
fn style(name: &str) -> (Colour, f64, Shape) {
    let thin = |colour, shape| (colour, WIDTHS[0], shape);
    match name {
        "rk4" => thin(GREEN, Shape::Disc),
        "euler" => thin(GREEN, Shape::Square),
        "Octave ode23s" => (ORANGE, WIDTHS[1], Shape::Disc),
        _ if name.starts_with("differential-equations") => thin(PURPLE, Shape::Disc),
        _ if name.starts_with("ivp") => thin(PURPLE, Shape::Square),
        _ if name.starts_with("diffsol") => thin(PURPLE, Shape::Triangle),
        _ if name.starts_with("Octave") => thin(ORANGE, Shape::Square),
        _ if name.starts_with("SUNDIALS") => thin(GREY, Shape::Square),
        _ => Method::ALL
            .into_iter()
            .find(|method| method.name() == name)
            .map_or_else(|| thin(GREY, Shape::Disc), look),
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
    kept.sort_by(|a, b| style(&a.name).1.total_cmp(&style(&b.name).1));
    kept
}

fn line(curve: &Curve<'_>, cost: Cost) -> Line {
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
    Line::new(&name, points, style(&curve.name))
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
    let panels = cases.iter().map(|case| {
        let lines = shown(curves(rows, case, measure)).iter().map(|c| line(c, cost)).collect();
        panel(
            &format!("{} (T = {} s)", case.label, case.to),
            Axis::log(format!("relative error of {error}"), (1e-15, 1e1)),
            Axis::log(unit, (low, high)),
            lines,
            180.0,
        )
    });
    let title = format!("Error of {error} against {what}: lower left is better");
    let key = "Vermilion: Retune's hybrid. Black: the paper's ode23s. Blue, green: Retune's other methods, adaptive and of fixed step. \
               Purple: Rust crates. Orange: GNU Octave. Grey: SciPy, SUNDIALS.";
    let note = "Of every other program the method that served the scene best; contacts located unless it says stepped. \
                Points beyond the axes lie on their ends. All runs, failures with their reason: runs.csv.";
    sheet(path, &title, &[key, note], 2, panels.collect())
}

/// Time of each scene under the smallest exact model and under the full one.
///
/// # Errors
/// A file that cannot be written.
pub fn savings(path: &Path, savings: &[Saving]) -> Drawn {
    const COLOURS: [Colour; 2] = [VERMILION, BLUE];
    let longest = 1e6 * savings.iter().flat_map(|s| s.seconds).fold(0.0, f64::max);
    let mut layers = Vec::new();
    for (i, s) in savings.iter().enumerate() {
        for (j, (seconds, model)) in s.seconds.into_iter().zip([s.model, "full contact model"]).enumerate() {
            let (time, middle) = (1e6 * seconds, -(i as f64) + 0.2 - 0.4 * j as f64);
            let y = (middle - 0.17, middle + 0.17);
            layers.push(Layer::Band { x: (0.0, time), y, colour: COLOURS[j], opacity: 1.0 });
            let at = (time + 0.015 * longest, middle);
            layers.push(Layer::Text { at, text: format!("{time:.1}  {model}"), stand: Stand::Right });
        }
    }
    let names = savings.iter().enumerate().map(|(i, s)| (-(i as f64), s.label.to_owned())).collect();
    let count = savings.len() as f64;
    let chart = Chart {
        title: String::new(),
        x: Axis::linear("time of one E1max, µs", (0.0, 1.9 * longest)),
        y: Axis::of_names((0.5 - count, 0.5), names),
        layers,
        height: 30.0 + 24.0 * count,
    };
    let key = |j: usize, words: &str| (Key::Area(COLOURS[j], 1.0), words.to_owned());
    fs::write(
        path,
        svg(&Sheet {
            title: "Time of one E1max: the smallest model that is exact, and the full contact model"
                .to_owned(),
            description: "Two bars for each scene, with the time in microseconds.".to_owned(),
            width: Width::Page,
            charts: vec![chart],
            columns: 1,
            stacked: false,
            legend: vec![key(0, "the smallest model that is exact"), key(1, "the full contact model")],
            caption: Vec::new(),
        }),
    )?;
    Ok(())
}
