//! The figures of `losses`: the value of each damper over the restitution, the re-tuned dashpot, and where the energy goes.

use super::compared::{Losses, Point, Tuning};
use crate::pages::figure;
use retune_model::Parameter;
use retune_report::colour::{BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILION};
use retune_report::{Axis, Chart, Dash, Drawing, Key, Layer, Mark, Scale, Shape, Sheet, Stroke};

/// The line of a damper.
const fn line(tuning: Tuning) -> Stroke {
    match tuning {
        Tuning::Paper => Stroke::new(PURPLE, 1.1, Dash::DashDot),
        Tuning::Lossless => Stroke::new(VERMILION, 1.3, Dash::Long),
        Tuning::Hedged => Stroke::solid(GREEN),
        Tuning::Anew => Stroke::new(BLUE, 1.3, Dash::Solid),
    }
}

const ANEW: Mark = Mark::new(Shape::Disc, BLUE, 4.0);

/// Points of a damper, by its restitution.
fn points(losses: &Losses, tuning: Tuning, value: impl Fn(&Point) -> f64) -> Vec<(f64, f64)> {
    losses.of(tuning).map(|point| (point.restitution, value(point))).collect()
}

/// The axis of the restitution.
fn restitution(losses: &Losses) -> Axis {
    let all: Vec<f64> = losses.points.iter().map(|point| point.restitution).collect();
    let [low, high] = [f64::min, f64::max].map(|of| all.iter().copied().reduce(of).unwrap_or(1.0));
    Axis::new("restitution e", Scale::Linear, (low, high))
}

/// The value of each damper over the restitution.
pub(super) fn values(losses: &Losses) -> Drawing {
    let shown = Tuning::ALL.map(|tuning| (tuning, points(losses, tuning, |point| point.worth.value)));
    let quantity = losses.study.quantity();
    let all = shown.iter().flat_map(|(_, points)| points.iter().map(|(_, value)| *value));
    let y = Axis::around(format!("worst {}, {}", quantity.name(), quantity.unit()), Scale::Log, all);
    let layers =
        shown.iter().map(|(tuning, points)| Layer::Line { points: points.clone(), stroke: line(*tuning) });
    let chart = Chart::of(restitution(losses), y, layers.collect(), 220.0);
    let legend = Tuning::ALL.map(|tuning| (Key::Line(line(tuning)), tuning.name().to_owned()));
    let title = "Dampers whose contacts lose energy";
    figure(
        Sheet {
            description: format!("Worst {} over the restitution", quantity.name()),
            legend: legend.into(),
            ..Sheet::of(title, vec![chart])
        },
        Some(&losses.study),
    )
}

/// The dashpot of the re-tuned damper over the restitution.
pub(super) fn dashpot(losses: &Losses) -> Drawing {
    let shown = points(losses, Tuning::Anew, |point| point.design.get(Parameter::C2));
    let values: Vec<f64> = shown.iter().map(|(_, value)| *value).chain([0.0]).collect();
    let layers = vec![
        Layer::Line { points: shown.clone(), stroke: line(Tuning::Anew) },
        Layer::Marks { points: shown, mark: ANEW },
    ];
    let chart = Chart::of(restitution(losses), Axis::fitting("c2, N·s/m", &values), layers, 175.0);
    let legend = vec![(Key::Marked(line(Tuning::Anew), ANEW), Tuning::Anew.name().to_owned())];
    let title = "The dashpot of the re-tuned damper";
    figure(
        Sheet { description: title.to_owned(), legend, ..Sheet::of(title, vec![chart]) },
        Some(&losses.study),
    )
}

/// Where the energy of the worst run goes: a chart for each damper.
pub(super) fn powers(losses: &Losses) -> Drawing {
    let parts = [
        ("dashpot of the structure", Stroke::new(BLACK, 1.1, Dash::Short)),
        ("dashpot of the damper", Stroke::new(BLUE, 1.3, Dash::Solid)),
        ("impacts", Stroke::new(ORANGE, 1.3, Dash::Long)),
    ];
    let all: Vec<f64> =
        losses.points.iter().flat_map(|point| point.worth.powers.parts()).chain([0.0]).collect();
    let y = Axis::fitting("mean power, W", &all);
    let chart = |tuning: Tuning| {
        let layer = |part: usize| Layer::Line {
            points: points(losses, tuning, |point| point.worth.powers.parts()[part]),
            stroke: parts[part].1,
        };
        let chart = Chart::of(restitution(losses), y.clone(), (0..3).map(layer).collect(), 150.0);
        Chart { title: tuning.name().to_owned(), ..chart }
    };
    let legend = parts.map(|(name, stroke)| (Key::Line(stroke), name.to_owned()));
    let title = "Where the energy of the worst run goes";
    figure(
        Sheet {
            description: title.to_owned(),
            legend: legend.into(),
            ..Sheet::of(title, Tuning::ALL.map(chart).into())
        },
        Some(&losses.study),
    )
}
