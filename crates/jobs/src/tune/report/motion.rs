//! The motion at the worst frequency: the last periods of the window.

use super::findings::Findings;
use super::numbers::{digits, four, frequency, millimetres};
use crate::Error;
use crate::amount::label;
use maud::html;
use retune_model::{Coupled, Side};
use retune_report::colour::{BLACK, BLUE, GREEN, GREY, VERMILION};
use retune_report::document::{Block, Section};
use retune_report::html::{Table, figure};
use retune_report::{Axis, Chart, Dash, Drawing, Key, Layer, Scale, Sheet, Stroke, Width, drawing};
use retune_solver::{Rows, Sample, Window, trajectory};

/// Periods of the force that are drawn, and points of a period.
const PERIODS: f64 = 6.0;
const POINTS: f64 = 150.0;
/// A wall is drawn unless it lies farther from the damper than this many times the width of its motion.
const NEAR: f64 = 2.0;

pub fn section(findings: &Findings) -> Result<Section, Error> {
    let window = stretch(findings);
    let interval = (window.to - window.from) / (PERIODS * POINTS);
    let mut rows: Vec<Sample> = Vec::new();
    let settings = findings.study.solver.settings();
    trajectory(&findings.worst, window, &settings, Rows { interval, events: true }, &mut |row| {
        rows.push(*row)
    })?;
    let body = html! {
        (words(findings).markup())
        (figure(&picture(findings, window, &rows), html! {
            "The motion from t = " (four(window.from)) " s to " (four(window.to)) " s of a run from rest"
            @if findings.worst_omega() > 0.0 { " at ω = " (frequency(findings.worst_omega())) } ". Grey: the walls of the cavity; dotted: where the damper rests."
        }))
        (methods(findings).markup())
    };
    let title = if findings.worst_omega() > 0.0 { "Motion at the worst frequency" } else { "Motion" };
    Ok(("motion", title, vec![Block::Elements(body)]))
}

fn stretch(findings: &Findings) -> Window {
    let Window { from, to } = findings.study.window.window();
    let omega = findings.worst_omega();
    let period = if omega > 0.0 { std::f64::consts::TAU / omega } else { to - from };
    Window { from: from.max(to - PERIODS * period), to }
}

fn words(findings: &Findings) -> Table {
    let (motion, response) = (&findings.measured().motion, findings.response);
    let [structure, obstacle] = motion.contacts_per_period;
    let exponent = format!("{} ± {}", four(motion.exponent), digits(motion.exponent_error, 2));
    let mut table = Table::wrapping("The motion in numbers", "quantity | value | meaning");
    let mut row = |name: &str, value: String, meaning: &str| table.row([name, &value, meaning]);
    row(
        "kind",
        motion.regime.clone(),
        "nT, m, k: it repeats after n periods of the force, with m impacts on the structure and k on the obstacle",
    );
    if motion.exponent.is_finite() {
        row("impacts on the structure", digits(structure, 3), "in a period of the force, once settled");
        row("impacts on the obstacle", digits(obstacle, 3), "in a period of the force, once settled");
        row(
            "largest Lyapunov exponent",
            format!("{exponent} /s"),
            "below zero, neighbouring motions converge",
        );
    }
    row(
        "stroke",
        millimetres(response.spring_deflection_max),
        "largest spring deflection |x2 − x1 − D| in the window",
    );
    row(
        "relative displacement",
        millimetres(response.relative_displacement_max),
        "largest |x2 − x1| in the window",
    );
    row(
        "force on the structure",
        format!("{} N", four(response.force_max[0])),
        "largest contact force in the window",
    );
    row(
        "force on the obstacle",
        format!("{} N", four(response.force_max[1])),
        "largest contact force in the window",
    );
    row("E1max", format!("{} J", four(response.e1_max.value)), "in the window of this run");
    table
}

/// The worst run by other methods.
fn methods(findings: &Findings) -> Table {
    let quantity = findings.quantity();
    let caption = format!("{} of the worst run by other methods and tolerances", quantity.name());
    let mut table = Table::new(caption, &format!("method | relative tolerance | {}", label(quantity)));
    for run in &findings.measured().convergence {
        table.row([run.method.name(), &format!("{:e}", run.rtol), &digits(run.value.value, 10)]);
    }
    table
}

fn picture(findings: &Findings, window: Window, rows: &[Sample]) -> Drawing {
    let line = |value: &dyn Fn(&Sample) -> f64, stroke: Stroke| Layer::Line {
        points: rows.iter().map(|row| (row.t, value(row))).collect(),
        stroke,
    };
    let chart = |label: &str, y: Axis, layers: Vec<Layer>, height: f64| Chart {
        title: label.to_owned(),
        x: Axis::linear("t, s", (window.from, window.to)),
        y,
        layers,
        height,
    };
    let around = |label: &str, value: &dyn Fn(&Sample) -> f64| {
        Axis::around(label, Scale::Linear, rows.iter().map(value))
    };
    let x1 = |row: &Sample| 1e3 * row.state[0];
    let mut charts = vec![chart(
        "displacement of the structure",
        around("x1, mm", &x1),
        vec![line(&x1, Stroke::solid(BLACK))],
        95.0,
    )];
    if findings.worst.damper.is_some() {
        let (title, y, layers) = relative(findings, rows);
        charts.push(chart(&title, y, layers, 120.0));
    }
    let largest = |side: usize| rows.iter().map(|row| row.forces[side]).fold(0.0, f64::max);
    let touches = largest(0).max(largest(1)) > 0.0;
    let mut legend = Vec::new();
    if touches {
        let (unit, scale) = if largest(0).max(largest(1)) < 1e4 { ("N", 1.0) } else { ("kN", 1e-3) };
        let sides = [
            (VERMILION, Dash::Solid, "force on the structure"),
            (GREEN, Dash::Solid, "force on the obstacle"),
        ];
        let mut layers = Vec::new();
        for (side, (colour, dash, name)) in
            sides.into_iter().enumerate().filter(|(side, _)| largest(*side) > 0.0)
        {
            let stroke = Stroke::new(colour, 1.1, dash);
            layers.push(line(&|row| scale * row.forces[side], stroke));
            legend.push((Key::Line(stroke), name.to_owned()));
        }
        let top = 1.06 * scale * largest(0).max(largest(1));
        charts.push(chart(
            "contact forces",
            Axis::linear(format!("force, {unit}"), (0.0, top)),
            layers,
            95.0,
        ));
    }
    let axis = Axis::from_zero("E1, J", rows.iter().map(|row| row.e1));
    charts.push(chart(
        "energy of the structure",
        axis,
        vec![line(&|row| row.e1, Stroke::solid(BLACK))],
        120.0,
    ));
    let names: Vec<&str> = charts.iter().map(|chart| chart.title.as_str()).collect();
    drawing(&Sheet {
        description: format!(
            "Against time from {} to {} s, one below the other: {}.",
            four(window.from),
            four(window.to),
            names.join(", ")
        ),
        width: Width::Page,
        stacked: true,
        legend,
        ..Sheet::of("Motion at the worst frequency", charts)
    })
}

/// The position of the damper in its cavity, with the walls nearby.
fn relative(findings: &Findings, rows: &[Sample]) -> (String, Axis, Vec<Layer>) {
    let place = |row: &Sample| 1e3 * (row.state[2] - row.state[0]);
    let (low, high) = rows
        .iter()
        .map(place)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let (rest, [structure, obstacle]) = findings.worst.damper.map_or((0.0, [0.0; 2]), |damper| {
        let system = Coupled::new(&findings.worst.primary, &findings.worst.forcing, &damper);
        (1e3 * system.rest_distance(), Side::BOTH.map(|side| 1e3 * system.wall(side)))
    });
    let reach = NEAR * (high - low);
    let walls: Vec<f64> = [(structure, low), (obstacle, high)]
        .into_iter()
        .filter(|(wall, end)| (wall - end).abs() <= reach)
        .map(|(wall, _)| wall)
        .collect();
    let y = Axis::around("x2 − x1, mm", Scale::Linear, [low, high].into_iter().chain(walls.iter().copied()));
    let (bottom, top) = (f64::NEG_INFINITY, f64::INFINITY);
    let wall = |y: (f64, f64)| Layer::Band { x: (bottom, top), y, colour: GREY, opacity: 0.4 };
    let mut layers = vec![
        wall((bottom, structure)),
        wall((obstacle, top)),
        Layer::Level { y: rest, stroke: Stroke::new(GREY, 0.8, Dash::Dots) },
        Layer::Line {
            points: rows.iter().map(|row| (row.t, place(row))).collect(),
            stroke: Stroke::solid(BLUE),
        },
    ];
    layers.retain(|layer| !matches!(layer, Layer::Band { y, .. } if !y.0.is_finite() && !y.1.is_finite()));
    let off: Vec<String> = [("structure", structure), ("obstacle", obstacle)]
        .into_iter()
        .filter(|(_, wall)| wall.is_finite() && !walls.contains(wall))
        .map(|(name, wall)| format!("{name} at {} mm", four(wall)))
        .collect();
    let off = if off.is_empty() { String::new() } else { format!(" (off the chart: {})", off.join(", ")) };
    (format!("place of the damper in its cavity{off}"), y, layers)
}
