//! The figure of smaller forces.

use super::draw::looks;
use super::force::Forced;
use super::retained::Retained;
use crate::caption::{made_by, words};
use retune_report::{Axis, Chart, Dash, Drawing, Key, Layer, Sheet, Stroke, Width, drawing};

/// E1max of the nominal designs as a share of that without a damper, against the force.
pub(super) fn draw(retained: &Retained, shown: &[usize]) -> Drawing {
    let all: Vec<&Forced> = retained.forced.iter().filter(|of| shown.contains(&of.damper)).collect();
    let points = |of: &Forced| -> Vec<(f64, f64)> {
        (0..of.points.len()).map(|step| (of.points[step].0, of.share(step))).collect()
    };
    let stroke = |of: &Forced| {
        let (stroke, _) = looks(of.damper);
        if of.proportional { Stroke { dash: Dash::Short, ..stroke } } else { stroke }
    };
    let top = all.iter().flat_map(|of| points(of)).map(|(_, share)| share).fold(0.0, f64::max);
    let forces = all.iter().flat_map(|of| of.points.iter().map(|(force, _)| *force));
    let right = forces.fold(0.0, f64::max);
    let legend: Vec<(Key, String)> = all
        .iter()
        .map(|of| {
            let gaps = if of.proportional { ", D and C in proportion to P" } else { "" };
            (Key::Line(stroke(of)), format!("{}{gaps}", retained.dampers[of.damper].name))
        })
        .collect();
    let chart = Chart {
        title: String::new(),
        x: Axis::linear("P, N", (0.0, if right > 0.0 { 1.03 * right } else { 1.0 })),
        y: Axis::linear("E1max / without a damper", (0.0, if top > 0.0 { 1.08 * top } else { 1.0 })),
        layers: all.iter().map(|of| Layer::Line { points: points(of), stroke: stroke(of) }).collect(),
        height: 170.0,
    };
    drawing(&Sheet {
        title: "What a smaller force leaves of a tuning".to_owned(),
        description: format!(
            "The worst E1max of the nominal designs at the nominal k1, as a share of that without a damper, against the amplitude P of the force: {}.",
            words(&legend)
        ),
        width: Width::Column,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: vec![made_by(retained.dampers.first().map(|damper| &damper.study))],
    })
}
