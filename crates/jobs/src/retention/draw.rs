//! The figures of `retention`: E1max along k1, the re-tuned designs, and the least E1max against the retention range.

use super::retained::Retained;
use super::trade::{Point, front};
use super::tuned::{Tuned, Tuning};
use crate::caption::{made_by, words};
use retune_model::Design;
use retune_report::colour::{BLACK, BLUE, Colour, GREEN, GREY, ORANGE, PURPLE, VERMILION};
use retune_report::{
    Axis, Chart, Dash, Drawing, Key, Layer, Mark, Scale, Shape, Sheet, Stroke, Width, drawing,
};
use retune_study::short;

/// Colours and marks of the dampers.
const DAMPERS: [(Colour, Shape); 4] =
    [(BLUE, Shape::Square), (VERMILION, Shape::Disc), (GREEN, Shape::Frame), (ORANGE, Shape::Ring)];
const NONE: Stroke = Stroke::new(BLACK, 0.9, Dash::Short);
const HALF: Stroke = Stroke::new(GREY, 0.9, Dash::Dots);
const ANEW: Mark = Mark::new(Shape::Disc, BLUE, 4.0);
/// A re-tuned design that is above the nominal one.
const ABOVE: Mark = Mark::new(Shape::Ring, VERMILION, 7.0);
/// How far above it lies.
const MORE: f64 = 1e-3;

/// The line of a design that is kept.
const fn line(tuning: Tuning) -> Stroke {
    match tuning {
        Tuning::Paper => Stroke::new(PURPLE, 1.1, Dash::DashDot),
        Tuning::Nominal => Stroke::new(VERMILION, 1.1, Dash::Long),
        Tuning::Robust => Stroke::solid(GREEN),
    }
}

/// E1max against k1: a chart for each damper; with the band of each structure, or with that of the nominal k1.
pub(super) fn retention(retained: &Retained, shown: &[usize], still: bool) -> Drawing {
    let Retained { dampers, thresholds, .. } = retained;
    let curves = || retained.curves.iter().filter(move |curve| curve.still == still);
    let values = curves().flat_map(|curve| curve.points.iter().map(|(_, value)| *value));
    let energies = Axis::around("worst E1max, J", Scale::Log, values);
    let none: Vec<(f64, f64)> =
        curves().filter(|curve| curve.damper.is_none()).flat_map(|curve| curve.points.clone()).collect();
    let k1 = || none.iter().map(|(k1, _)| *k1);
    let mut above: Vec<String> = Vec::new();
    let mut chart = |&number: &usize| {
        let damper = &dampers[number];
        let mut layers = vec![Layer::Line { points: none.clone(), stroke: NONE }];
        if let (Some(threshold), false) = (thresholds.get(number), still) {
            layers
                .push(Layer::Line { points: k1().map(|k1| (k1, threshold.at(k1))).collect(), stroke: HALF });
        }
        for curve in curves().filter(|curve| curve.damper == Some(number)) {
            let points = curve.points.clone();
            layers.push(match curve.tuning {
                Some(tuning) => Layer::Line { points, stroke: line(tuning) },
                None => Layer::Marks { points, mark: ANEW },
            });
        }
        let higher = if still { Vec::new() } else { above_nominal(damper) };
        if !higher.is_empty() {
            let k1: Vec<String> = higher.iter().map(|(k1, _)| short(*k1)).collect();
            above.push(format!("{} at {}", damper.name, k1.join(" and ")));
            layers.push(Layer::Marks { points: higher, mark: ABOVE });
        }
        Chart {
            title: damper.name.clone(),
            x: Axis::linear("k1, N/m", ends(k1())),
            y: energies.clone(),
            layers,
            height: 170.0,
        }
    };
    let charts: Vec<Chart> = shown.iter().map(&mut chart).collect();
    let mut legend = vec![(Key::Line(NONE), "no damper".to_owned())];
    if !still {
        let half = "half of the reduction, in dB, of the best TMD for each k1".to_owned();
        legend.push((Key::Line(HALF), half));
    }
    for tuning in Tuning::ALL {
        if curves().any(|curve| curve.tuning == Some(tuning)) {
            legend.push((Key::Line(line(tuning)), tuning.name().to_owned()));
        }
    }
    let mut caption = Vec::new();
    if !still {
        legend.push((Key::Mark(ANEW), "re-tuned for each k1".to_owned()));
    }
    if !above.is_empty() {
        legend.push((Key::Mark(ABOVE), "re-tuned above nominal".to_owned()));
        caption.push(format!(
            "Re-tuned above nominal ({} N/m): the bound on k2 follows k1, so the design for that k1 may not have the spring that the nominal one keeps.",
            above.join("; ")
        ));
    }
    caption.push(made_by(dampers.first().map(|damper| &damper.study)));
    let band = if still { "the band of the nominal k1" } else { "each structure's own band" };
    drawing(&Sheet {
        title: "How long a tuning lasts".to_owned(),
        description: format!(
            "E1max, worst over {band}, against the stiffness k1 of the structure, a chart for each damper: {}.",
            words(&legend)
        ),
        width: if charts.len() > 1 { Width::Page } else { Width::Column },
        columns: charts.len().min(2),
        charts,
        stacked: false,
        legend,
        caption,
    })
}

/// Where tuning anew gives more than the nominal design keeps, as only a bound that follows k1 can make it: k1 and E1max of the re-tuned one.
fn above_nominal(damper: &Tuned) -> Vec<(f64, f64)> {
    let Some(nominal) = damper.of(Tuning::Nominal) else { return Vec::new() };
    let energies = |&(k1, at): &(f64, Design)| (k1, damper.energy(&at, k1), damper.energy(&nominal, k1));
    let all = damper.anew.iter().map(energies);
    all.filter(|(_, anew, kept)| *anew > (1.0 + MORE) * kept).map(|(k1, anew, _)| (k1, anew)).collect()
}

/// k2, c2, D and C of the re-tuned designs against k1.
pub(super) fn path(retained: &Retained, shown: &[usize]) -> Drawing {
    let dampers: Vec<(usize, &Tuned)> =
        shown.iter().map(|&number| (number, &retained.dampers[number])).collect();
    const LABELS: [&str; 4] = ["k2, N/m", "c2, N·s/m", "D, m", "C, m"];
    let chart = |which: usize| {
        let value = |damper: &Tuned| -> Vec<(f64, f64)> {
            damper.anew.iter().map(|(k1, at)| (*k1, at.values()[which])).collect()
        };
        let top =
            dampers.iter().flat_map(|(_, damper)| value(damper)).map(|(_, value)| value).fold(0.0, f64::max);
        let layers = dampers.iter().flat_map(|(i, damper)| {
            let (stroke, mark) = looks(*i);
            let points = value(damper);
            // Designs may exchange the roles of D and C from one k1 to the next: a line between would show what is not there.
            let line = (which < 2).then(|| Layer::Line { points: points.clone(), stroke });
            line.into_iter().chain([Layer::Marks { points, mark }])
        });
        let k1 = dampers.iter().flat_map(|(_, damper)| damper.anew.iter().map(|(k1, _)| *k1));
        Chart {
            title: String::new(),
            x: Axis::linear("k1, N/m", ends(k1)),
            y: Axis::linear(LABELS[which], (0.0, if top > 0.0 { 1.06 * top } else { 1.0 })),
            layers: layers.collect(),
            height: 120.0,
        }
    };
    let key = |(i, damper): &(usize, &Tuned)| {
        let (stroke, mark) = looks(*i);
        (Key::Marked(stroke, mark), damper.name.clone())
    };
    drawing(&Sheet {
        title: "The re-tuned designs".to_owned(),
        description: "k2, c2, D and C of each damper, tuned anew for each stiffness k1 of the structure."
            .to_owned(),
        width: Width::Page,
        charts: (0..4).map(chart).collect(),
        columns: 2,
        stacked: false,
        legend: dampers.iter().map(key).collect(),
        caption: vec![made_by(retained.dampers.first().map(|damper| &damper.study))],
    })
}

/// The least E1max at the nominal stiffness against the width of the retention range: the front of each damper as a line.
pub(super) fn range(retained: &Retained, shown: &[usize]) -> Drawing {
    let dampers = &retained.dampers;
    let points: Vec<&Point> = retained.points.iter().filter(|point| shown.contains(&point.damper)).collect();
    let own = |(tuning, point): &&(&'static str, Point)| {
        let is_paper = *tuning == Tuning::Paper.name();
        shown.contains(&point.damper) && (!is_paper || retained.is_new(point.damper, Tuning::Paper))
    };
    let kept: Vec<&(&'static str, Point)> = retained.kept.iter().filter(own).collect();
    const DOMINATED: Mark = Mark::new(Shape::Disc, GREY, 2.5);
    let at = |point: &Point| (point.factor(), point.e1_max);
    let mut layers = Vec::new();
    let mut legend = Vec::new();
    let fronts: Vec<Vec<&Point>> = (0..dampers.len()).map(|damper| front(&retained.points, damper)).collect();
    let dominated =
        points.iter().filter(|point| !fronts[point.damper].iter().any(|other| other.at == point.at));
    let dominated: Vec<(f64, f64)> = dominated.map(|point| at(point)).collect();
    let any_dominated = !dominated.is_empty();
    layers.push(Layer::Marks { points: dominated, mark: DOMINATED });
    for (i, (damper, front)) in dampers.iter().zip(&fronts).enumerate() {
        if front.is_empty() || !shown.contains(&i) {
            continue;
        }
        let (stroke, mark) = looks(i);
        let mark = Mark { size: 3.0, ..mark };
        let points: Vec<(f64, f64)> = front.iter().map(|point| at(point)).collect();
        layers.push(Layer::Line { points: points.clone(), stroke });
        layers.push(Layer::Marks { points, mark });
        legend.push((Key::Marked(stroke, mark), damper.name.clone()));
    }
    for tuning in Tuning::ALL {
        let shape = match tuning {
            Tuning::Paper => Shape::Cross,
            Tuning::Nominal => Shape::Triangle,
            Tuning::Robust => Shape::Frame,
        };
        let mark = |colour| Mark { rim: true, ..Mark::new(shape, colour, 7.0) };
        let own: Vec<&Point> = kept
            .iter()
            .filter(|(name, point)| *name == tuning.name() && point.range.is_some())
            .map(|(_, point)| point)
            .collect();
        if !own.is_empty() {
            legend.push((Key::Mark(mark(BLACK)), tuning.name().to_owned()));
        }
        for point in own {
            let (colour, _) = DAMPERS[point.damper % DAMPERS.len()];
            layers.push(Layer::Marks { points: vec![at(point)], mark: mark(colour) });
        }
    }
    if any_dominated {
        legend.push((Key::Mark(DOMINATED), "found, but dominated".to_owned()));
    }
    let all = || {
        points
            .iter()
            .copied()
            .chain(kept.iter().map(|(_, point)| point))
            .filter(|point| point.range.is_some())
    };
    let right = all().map(|point| point.factor()).fold(0.0, f64::max);
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(
            "factor by which k1 may rise and fall",
            (1.0, if right > 1.0 { 1.0 + 1.05 * (right - 1.0) } else { 2.0 }),
        ),
        y: Axis::around("E1max at the nominal k1, J", Scale::Linear, all().map(|point| point.e1_max)),
        layers,
        height: 190.0,
    };
    drawing(&Sheet {
        title: "The least E1max against the retention range".to_owned(),
        description: format!(
            "E1max at the nominal stiffness against the factor by which k1 may rise and fall while a design keeps half of the reduction, \
             in decibels, that tuning anew would give: {}.",
            words(&legend)
        ),
        width: Width::Column,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: vec![made_by(dampers.first().map(|damper| &damper.study))],
    })
}

/// The line and the mark of a damper.
pub(super) fn looks(damper: usize) -> (Stroke, Mark) {
    let (colour, shape) = DAMPERS[damper % DAMPERS.len()];
    (Stroke::solid(colour), Mark::new(shape, colour, 4.0))
}

/// The range of some stiffnesses, a little wider, so that marks at its ends are whole.
fn ends(k1: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let (low, high) = (k1.clone().fold(f64::INFINITY, f64::min), k1.fold(0.0, f64::max));
    if low < high {
        (low - 0.02 * (high - low), high + 0.02 * (high - low))
    } else {
        (0.9 * high, 1.1 * high)
    }
}
