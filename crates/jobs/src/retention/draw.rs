//! The figures of `retention`: E1max along k1, the re-tuned designs, the least E1max against the retention range, smaller forces.

use super::force::{Forced, amplitude};
use super::retained::Retained;
use super::trade::Point;
use super::tuned::{OWN, Tuned, Tuning};
use crate::columns::{column, of_designs, symbols};
use crate::pages::{figure, made_by};
use retune_model::{Design, Parameter};
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
/// A re-tuned design with a larger E1max than the nominal one.
const ABOVE: Mark = Mark::new(Shape::Ring, VERMILION, 7.0);
/// Relative difference above which it is marked so.
const MORE: f64 = 1e-3;

/// The line of a kept design.
const fn line(tuning: Tuning) -> Stroke {
    match tuning {
        Tuning::Paper | Tuning::Study => Stroke::new(PURPLE, 1.1, Dash::DashDot),
        Tuning::Nominal => Stroke::new(VERMILION, 1.1, Dash::Long),
        _ => Stroke::solid(GREEN),
    }
}

/// E1max against k1, a chart for each damper; with the band of each structure, or with that of the nominal k1.
pub(super) fn retention(retained: &Retained, band: usize) -> Drawing {
    let curves = || retained.curves.iter().filter(move |curve| curve.band == band);
    let values = curves().flat_map(|curve| curve.points.iter().map(|(_, value)| *value));
    let energies = Axis::around("worst E1max, J", Scale::Log, values);
    let bare = curves().filter(|curve| curve.damper.is_none());
    let none: Vec<(f64, f64)> = bare.flat_map(|curve| curve.points.clone()).collect();
    let k1 = || none.iter().map(|(k1, _)| *k1);
    let mut above: Vec<String> = Vec::new();
    let mut chart = |&number: &usize| {
        let damper = &retained.dampers[number];
        let mut layers = vec![Layer::line(none.clone(), NONE)];
        if band == OWN {
            layers.push(Layer::line(k1().map(|k1| (k1, damper.thresholds[OWN].at(k1))), HALF));
        }
        for curve in curves().filter(|curve| curve.damper == Some(number)) {
            let points = curve.points.clone();
            layers.push(match curve.tuning {
                Tuning::Anew => Layer::Marks { points, mark: ANEW },
                tuning => Layer::line(points, line(tuning)),
            });
        }
        let higher = if band == OWN { above_nominal(damper) } else { Vec::new() };
        if !higher.is_empty() {
            let k1: Vec<String> = higher.iter().map(|(k1, _)| short(*k1)).collect();
            above.push(format!("{} at {}", damper.name, k1.join(" and ")));
            layers.push(Layer::Marks { points: higher, mark: ABOVE });
        }
        let chart = Chart::of(along_k1(k1()), energies.clone(), layers, 170.0);
        Chart { title: damper.name.clone(), ..chart }
    };
    let charts: Vec<Chart> = retained.shown().iter().map(&mut chart).collect();
    let in_own_band = |key, words: &str| (band == OWN).then(|| (key, words.to_owned()));
    let mut legend = vec![(Key::Line(NONE), "no damper".to_owned())];
    legend.extend(in_own_band(Key::Line(HALF), "half of the reduction, in dB, of the best TMD for each k1"));
    let kept = Tuning::KEPT.into_iter().filter(|tuning| curves().any(|curve| curve.tuning == *tuning));
    legend.extend(kept.map(|tuning| (Key::Line(line(tuning)), tuning.name().to_owned())));
    legend.extend(in_own_band(Key::Mark(ANEW), "re-tuned for each k1"));
    let mut caption = Vec::new();
    if !above.is_empty() {
        legend.push((Key::Mark(ABOVE), "re-tuned above nominal".to_owned()));
        caption.push(format!(
            "Re-tuned above nominal ({} N/m): the bound on k2 follows k1, so the design for that k1 may not have the spring that the nominal one keeps.",
            above.join("; ")
        ));
    }
    let band = if band == OWN { "each structure's own band" } else { "the band of the nominal k1" };
    let description = format!(
        "E1max, worst over {band}, against the stiffness k1 of the structure, a chart for each damper"
    );
    let width = if charts.len() > 1 { Width::Page } else { Width::Column };
    let columns = charts.len().min(2);
    let sheet = Sheet::of("How long a tuning lasts", charts);
    figure(Sheet { description, width, columns, legend, caption, ..sheet }, retained.study())
}

/// The k1 and E1max of re-tuned designs that are worse than the nominal one, which only a bound in proportion to k1 can cause.
fn above_nominal(damper: &Tuned) -> Vec<(f64, f64)> {
    let Some(nominal) = damper.of(Tuning::Nominal) else { return Vec::new() };
    let energies = |&(k1, at): &(f64, Design)| (k1, damper.energy(&at, k1), damper.energy(&nominal, k1));
    let all = damper.anew.iter().map(energies);
    all.filter(|(_, anew, kept)| *anew > (1.0 + MORE) * kept).map(|(k1, anew, _)| (k1, anew)).collect()
}

/// k2, c2, D, C and other varied parameters of the re-tuned designs against k1.
pub(super) fn path(retained: &Retained) -> Drawing {
    let shown = retained.shown();
    let dampers = || shown.iter().map(|&number| (number, &retained.dampers[number]));
    let parameters = of_designs(dampers().flat_map(|(_, damper)| damper.anew.iter().map(|(_, at)| at)));
    let chart = |&variable: &Parameter| {
        let points = |damper: &Tuned| -> Vec<(f64, f64)> {
            damper.anew.iter().map(|(k1, at)| (*k1, at.get(variable))).collect()
        };
        let mut layers = Vec::new();
        for (number, damper) in dampers() {
            let (stroke, mark) = style(number);
            // The roles of D and C may be exchanged from one k1 to the next, so a line between them would mislead.
            if !variable.is_gap() {
                layers.push(Layer::line(points(damper), stroke));
            }
            layers.push(Layer::Marks { points: points(damper), mark });
        }
        let all = || dampers().flat_map(|(_, damper)| points(damper));
        let y = Axis::from_zero(column(variable.symbol()).heading(), all().map(|(_, value)| value));
        Chart::of(along_k1(all().map(|(k1, _)| k1)), y, layers, 120.0)
    };
    let key = |(number, damper): (usize, &Tuned)| {
        let (stroke, mark) = style(number);
        (Key::Marked(stroke, mark), damper.name.clone())
    };
    let names = symbols(&parameters);
    let (last, first) = names.split_last().unwrap_or((&"", &[]));
    let description = format!(
        "{} and {last} of each damper, tuned anew for each stiffness k1 of the structure.",
        first.join(", ")
    );
    let (legend, caption) = (dampers().map(key).collect(), vec![made_by(retained.study())]);
    let sheet = Sheet::of("The re-tuned designs", parameters.iter().map(chart).collect());
    drawing(&Sheet { description, width: Width::Page, columns: 2, legend, caption, ..sheet })
}

/// The least E1max at the nominal stiffness against the width of the retention range: the front of each damper as a line.
pub(super) fn range(retained: &Retained) -> Drawing {
    const DOMINATED: Mark = Mark::new(Shape::Disc, GREY, 2.5);
    let (shown, kept) = (retained.shown(), retained.shown_kept());
    let points: Vec<&Point> = retained.points.iter().filter(|point| shown.contains(&point.damper)).collect();
    let at = |point: &Point| (point.factor(), point.e1_max);
    let fronts: Vec<(usize, Vec<&Point>)> =
        shown.iter().map(|&damper| (damper, retained.front(damper))).collect();
    let is_front = |point: &Point| {
        let mut fronts = fronts.iter().flat_map(|(_, front)| front);
        fronts.any(|other| other.damper == point.damper && other.at == point.at)
    };
    let dominated: Vec<(f64, f64)> =
        points.iter().filter(|point| !is_front(point)).map(|point| at(point)).collect();
    let last = (!dominated.is_empty()).then(|| (Key::Mark(DOMINATED), "found, but dominated".to_owned()));
    let mut layers = vec![Layer::Marks { points: dominated, mark: DOMINATED }];
    let mut legend = Vec::new();
    for (damper, front) in fronts.iter().filter(|(_, front)| !front.is_empty()) {
        let (stroke, mark) = style(*damper);
        let points: Vec<(f64, f64)> = front.iter().map(|point| at(point)).collect();
        layers.push(Layer::line(points.clone(), stroke));
        let small = Mark { size: 3.0, ..mark };
        layers.push(Layer::Marks { points, mark: small });
        legend.push((Key::Marked(stroke, small), retained.name(*damper).to_owned()));
    }
    let shapes = [Shape::Cross, Shape::Cross, Shape::Triangle, Shape::Frame];
    for (tuning, shape) in Tuning::KEPT.into_iter().zip(shapes) {
        let mark = |colour| Mark { rim: true, ..Mark::new(shape, colour, 7.0) };
        let points_of_tuning =
            || kept.iter().filter(|point| point.tuning == tuning && point.range().is_some());
        legend.extend(points_of_tuning().next().map(|_| (Key::Mark(mark(BLACK)), tuning.name().to_owned())));
        let colour = |point: &Point| style(point.damper).1.colour;
        let marks = |point: &&Point| Layer::Marks { points: vec![at(point)], mark: mark(colour(point)) };
        layers.extend(points_of_tuning().map(marks));
    }
    legend.extend(last);
    let all = || points.iter().chain(&kept).filter(|point| point.range().is_some());
    let right = all().map(|point| point.factor()).fold(0.0, f64::max);
    let right = if right > 1.0 { 1.0 + 1.05 * (right - 1.0) } else { 2.0 };
    let x = Axis::linear("factor by which k1 may rise and fall", (1.0, right));
    let y = Axis::around("E1max at the nominal k1, J", Scale::Linear, all().map(|point| point.e1_max));
    let description = "E1max at the nominal stiffness against the factor by which k1 may rise and fall while a design keeps half of the reduction, \
                       in decibels, that tuning anew would give"
        .to_owned();
    let chart = Chart::of(x, y, layers, 190.0);
    let sheet = Sheet::of("The least E1max against the retention range", vec![chart]);
    figure(Sheet { description, legend, ..sheet }, retained.study())
}

/// E1max of the nominal designs as a share of that without a damper, against the force.
pub(super) fn force(retained: &Retained) -> Drawing {
    let shown = retained.shown();
    let amplitude = retained.study().and_then(amplitude).unwrap_or(Parameter::P);
    let symbol = amplitude.symbol();
    let all = || retained.forced.iter().filter(|of| shown.contains(&of.damper));
    let points = |of: &Forced| -> Vec<(f64, f64)> {
        (0..of.points.len()).map(|step| (of.points[step].0, of.share(step))).collect()
    };
    let stroke = |of: &Forced| {
        let (stroke, _) = style(of.damper);
        if of.proportional { Stroke { dash: Dash::Short, ..stroke } } else { stroke }
    };
    let top = all().flat_map(points).map(|(_, share)| share).fold(0.0, f64::max);
    let right = all().flat_map(points).map(|(force, _)| force).fold(0.0, f64::max);
    let key = |of: &Forced| {
        let gaps =
            if of.proportional { format!(", D and C in proportion to {symbol}") } else { String::new() };
        (Key::Line(stroke(of)), format!("{}{gaps}", retained.name(of.damper)))
    };
    let legend = all().map(key).collect();
    let x = Axis::linear(
        format!("{symbol}, {}", amplitude.unit()),
        (0.0, if right > 0.0 { 1.03 * right } else { 1.0 }),
    );
    let y = Axis::linear("E1max / without a damper", (0.0, if top > 0.0 { 1.08 * top } else { 1.0 }));
    let layers = all().map(|of| Layer::line(points(of), stroke(of))).collect();
    let description = format!(
        "The worst E1max of the nominal designs at the nominal k1, as a share of that without a damper, against the amplitude {symbol} of the force"
    );
    let sheet = Sheet::of("What a smaller force leaves of a tuning", vec![Chart::of(x, y, layers, 170.0)]);
    figure(Sheet { description, legend, ..sheet }, retained.study())
}

/// The line and the mark of a damper.
fn style(damper: usize) -> (Stroke, Mark) {
    let (colour, shape) = DAMPERS[damper % DAMPERS.len()];
    (Stroke::solid(colour), Mark::new(shape, colour, 4.0))
}

/// An axis slightly wider than the stiffnesses, so that marks at its ends are not cut off.
fn along_k1(k1: impl Iterator<Item = f64> + Clone) -> Axis {
    let (low, high) = (k1.clone().fold(f64::INFINITY, f64::min), k1.fold(0.0, f64::max));
    let ends = if low < high {
        (low - 0.02 * (high - low), high + 0.02 * (high - low))
    } else {
        (0.9 * high, 1.1 * high)
    };
    Axis::linear("k1, N/m", ends)
}
