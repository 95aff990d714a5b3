//! A sweep as a figure: a chart for each quantity, one below the other, with a damper and without.

use crate::rows::Rows;
use crate::sweep::points::Sweep;
use crate::sweep::words::{each, extreme, shown, title};
use retune_report::colour::{BLACK, VERMILION};
use retune_report::table::Table;
use retune_report::{
    Axis, Chart, Dash, Key, Layer, Mark, Scale, Shape, Sheet, Stroke, Width, scale_for, svg,
};
use retune_study::{hertz_and_rpm, rounded};

/// The lines: with a damper, and without.
const WITH: Stroke = Stroke::new(VERMILION, 1.3, Dash::Solid);
const NONE: Stroke = Stroke::new(BLACK, 1.1, Dash::Short);
/// Fewer values than this are marked one by one.
const FEW: usize = 40;

/// The figure of a sweep as SVG.
pub fn draw(sweep: &Sweep, table: &Table) -> String {
    let names = shown(sweep);
    let charts: Vec<Chart> =
        names.iter().enumerate().map(|(i, name)| chart(sweep, table, name, i == 0, names.len())).collect();
    let damped = sweep.study().scene.damper.is_some();
    let line = if sweep.len() < FEW { Key::Marked(WITH, MARK) } else { Key::Line(WITH) };
    let mut legend = vec![(line, if damped { "with the damper" } else { "no damper" }.to_owned())];
    if names.iter().any(|name| table.column(&format!("{name}_none")).is_some()) && damped {
        legend.push((Key::Line(NONE), "no damper".to_owned()));
    }
    let peaks: Vec<String> = names.iter().filter_map(|name| peak(sweep, table, name)).collect();
    svg(&Sheet {
        title: title(sweep),
        description: format!("{}, {}. {}.", title(sweep), each(sweep), peaks.join("; ")),
        width: Width::Column,
        charts,
        columns: 1,
        stacked: true,
        legend,
        caption: vec![format!("{}, {}; {}", title(sweep), each(sweep), made_by(sweep))],
    })
}

/// How a value is marked.
const MARK: Mark = Mark::new(Shape::Disc, VERMILION, 3.0);

fn peak(sweep: &Sweep, table: &Table, name: &str) -> Option<String> {
    let (row, value) = extreme(&table.column(name)?, 1.0)?;
    let over = sweep.plan().over;
    let unit = table.unit(name);
    let at = rounded(sweep.value(row), 4);
    Some(format!(
        "{name} is largest at {} = {at} {}: {} {unit}",
        over.symbol(),
        over.unit(),
        rounded(value, 4)
    ))
}

fn made_by(sweep: &Sweep) -> String {
    let solver = sweep.study().solver;
    let version = env!("CARGO_PKG_VERSION");
    format!("Retune {version}, {}, rtol {:e}", solver.method.name(), solver.rtol)
}

fn chart(sweep: &Sweep, table: &Table, name: &str, top: bool, count: usize) -> Chart {
    let column = |name: &str| table.column(name).unwrap_or_default();
    let points = |values: &[f64]| -> Vec<(f64, f64)> {
        table.rows.iter().map(|row| row[0].number()).zip(values.iter().copied()).collect()
    };
    let (with, without) = (column(name), column(&format!("{name}_none")));
    let mut layers = Vec::new();
    if !without.is_empty() {
        layers.push(Layer::Line { points: points(&without), stroke: NONE });
    }
    layers.push(Layer::Line { points: points(&with), stroke: WITH });
    if sweep.len() < FEW {
        layers.push(Layer::Marks { points: points(&with), mark: MARK });
    }
    let unit = table.unit(name);
    let label =
        if unit.is_empty() { name.replace('_', " ") } else { format!("{}, {unit}", name.replace('_', " ")) };
    let values: Vec<f64> = with.iter().chain(&without).copied().collect();
    let high = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
    let y = match scale_for(&values) {
        Scale::Log => Axis::around(label, Scale::Log, values),
        Scale::Linear => Axis::linear(label, (0.0, if high > 0.0 { 1.06 * high } else { 1.0 })),
    };
    let plan = sweep.plan();
    let scale = match plan.scale {
        retune_optim::Scale::Linear => Scale::Linear,
        retune_optim::Scale::Log => Scale::Log,
    };
    let symbol = if plan.over.is_frequency() { "ω" } else { plan.over.symbol() };
    let x = Axis::new(format!("{symbol}, {}", plan.over.unit()), scale, (plan.from, plan.to));
    let x = if plan.over.is_frequency() && top {
        x.with_second("frequency, Hz", hertz_and_rpm(1.0)[0])
    } else {
        x
    };
    Chart { title: String::new(), x, y, layers, height: if count == 1 { 175.0 } else { 130.0 } }
}
