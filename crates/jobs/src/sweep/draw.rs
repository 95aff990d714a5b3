//! The figure of a sweep: stacked charts, one for each quantity, with and without a damper.

use crate::pages::abscissa;
use crate::rows::Rows;
use crate::sweep::points::Sweep;
use crate::sweep::words::{each, extreme, shown, title};
use retune_report::colour::{BLACK, VERMILION};
use retune_report::table::{Column, Table};
use retune_report::{Axis, Chart, Dash, Key, Layer, Mark, Scale, Shape, Sheet, Stroke, svg};
use retune_study::rounded;

/// The lines: with a damper, and without.
const WITH: Stroke = Stroke::new(VERMILION, 1.3, Dash::Solid);
const NONE: Stroke = Stroke::new(BLACK, 1.1, Dash::Short);
/// With fewer values than this, each is marked.
const FEW: usize = 40;

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
    let what = format!("{}, {}", title(sweep), each(sweep));
    let description = format!("{what}. {}.", peaks.join("; "));
    let caption = vec![format!("{what}; {}", made_by(sweep))];
    svg(&Sheet { stacked: true, description, legend, caption, ..Sheet::of(title(sweep), charts) })
}

const MARK: Mark = Mark::new(Shape::Disc, VERMILION, 3.0);

fn peak(sweep: &Sweep, table: &Table, name: &str) -> Option<String> {
    let (row, value) = extreme(&table.column(name)?, 1.0)?;
    let over = sweep.plan().over;
    let unit = table.unit(name);
    let [at, value] = [sweep.value(row), value].map(|value| rounded(value, 4));
    Some(format!("{name} is largest at {over} = {at} {}: {value} {unit}", over.unit()))
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
    let label = Column::new(name.replace('_', " "), table.unit(name).to_owned()).heading();
    let values: Vec<f64> = with.iter().chain(&without).copied().collect();
    let plan = sweep.plan();
    let scale = match plan.scale {
        retune_optim::Scale::Linear => Scale::Linear,
        retune_optim::Scale::Log => Scale::Log,
    };
    let x = abscissa(plan.over, scale, (plan.from, plan.to), top);
    Chart::of(x, Axis::fitting(label, &values), layers, if count == 1 { 175.0 } else { 130.0 })
}
