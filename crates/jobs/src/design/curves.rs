//! All candidates over the band, a chart for each quantity.

use super::candidate::{Candidate, What};
use super::comparison::Comparison;
use super::requirements::{Requirements, Wish};
use crate::pages::made_by;
use crate::tune::band::at;
use rayon::prelude::*;
use retune_model::{Bare, Coupled, Measure, PerMeasure, unit};
use retune_optim::Limit;
use retune_report::colour::{BLACK, BLUE, GREY, VERMILION};
use retune_report::{Axis, Chart, Dash, Drawing, Key, Layer, Scale, Sheet, Stroke, Width, drawing};
use retune_solver::{Also, Ask, extremes};

/// Frequencies of a curve in closed form, and of one of runs.
const FINE: usize = 401;
const RUNS: usize = 101;

const fn line(what: What) -> Stroke {
    match what {
        What::None => Stroke::new(BLACK, 0.9, Dash::Short),
        What::Tmd => Stroke::solid(BLUE),
        What::Ssvi => Stroke::new(VERMILION, 1.1, Dash::Long),
    }
}

/// A frequency, rad/s, and the quantities there, in SI units.
type Curve = Vec<(f64, PerMeasure<f64>)>;

/// Every quantity of a candidate at frequencies of the band (rad/s), once its motion is steady; NaN where a run fails.
fn curve(of: &Candidate, [from, to]: [f64; 2]) -> Curve {
    let study = &of.study;
    let closed = study.goal().objective.is_steady();
    let points = if closed { FINE } else { RUNS };
    let value = |i: usize| {
        let omega = from + (to - from) * i as f64 / (points - 1) as f64;
        let none = PerMeasure::all(f64::NAN);
        let Some(scene) = at(omega, study.scene) else { return (omega, none) };
        if closed {
            let bare = Bare::new(&scene.primary, &scene.forcing);
            let steady = scene.damper.map_or_else(
                || bare.steady(omega),
                |damper| Coupled::new(&scene.primary, &scene.forcing, &damper).steady(omega),
            );
            return (omega, PerMeasure(Measure::ALL.map(|measure| steady.largest(&bare, omega, measure))));
        }
        let window = study.window.window();
        let also = Some(Also { measures: PerMeasure::EVERY, from: window.from });
        let run = extremes(&scene, window, &study.solver.settings(), Ask { also, ..Ask::default() });
        (omega, run.map_or(none, |run| run.reached))
    };
    (0..points).into_par_iter().map(value).collect()
}

pub(super) fn curves(requirements: &Requirements, compared: &Comparison) -> Drawing {
    let size = unit::FREQUENCY
        .iter()
        .find(|(name, _)| *name == requirements.frequencies)
        .map_or(1.0, |(_, size)| *size);
    let curves: Vec<(What, Curve)> =
        compared.all().map(|of| (of.what, curve(of, requirements.band))).collect();
    let ends = requirements.band.map(|end| end / size);
    let strikes = compared.dampers().any(Candidate::strikes);
    let shown = Measure::ALL.into_iter().filter(|measure| !measure.is_of_walls() || strikes);
    let chart = |measure: Measure| {
        let all: Vec<f64> = curves
            .iter()
            .flat_map(|(_, points)| points.iter().map(|(_, values)| values.get(measure)))
            .collect();
        let largest = all.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
        let (name, number) = unit::readable(largest, measure.unit());
        let scale = if number == 0.0 { 1.0 } else { number / largest };
        let scaled: Vec<f64> = all.iter().map(|value| scale * value).filter(|value| *value > 0.0).collect();
        let label = format!("{}, {name}", measure.name().replace('_', " "));
        // What a wall feels is zero where nothing is struck.
        let of_walls = measure.is_of_walls();
        let y =
            if of_walls { Axis::from_zero(label, scaled) } else { Axis::around(label, Scale::Log, scaled) };
        let allowed = requirements.allowed(Wish::Of(Limit::Of(measure)));
        let mut layers = Vec::new();
        if allowed.is_finite() {
            layers.push(Layer::Band {
                x: (f64::NEG_INFINITY, f64::INFINITY),
                y: (scale * allowed, f64::INFINITY),
                colour: GREY,
                opacity: 0.25,
            });
        }
        for (what, points) in &curves {
            let points = points.iter().map(|(omega, values)| (omega / size, scale * values.get(measure)));
            layers.push(Layer::line(points.filter(|(_, value)| of_walls || *value > 0.0), line(*what)));
        }
        Chart::of(
            Axis::linear(format!("frequency, {}", requirements.frequencies), (ends[0], ends[1])),
            y,
            layers,
            130.0,
        )
    };
    let charts: Vec<Chart> = shown.map(chart).collect();
    let legend = compared.all().map(|of| (Key::Line(line(of.what)), of.what.name().to_owned())).collect();
    let sheet = Sheet::of("All candidates over the band", charts);
    let description =
        "Each quantity against the frequency of the forcing, for the structure alone and with each damper."
            .to_owned();
    drawing(&Sheet {
        description,
        width: Width::Page,
        columns: 2,
        legend,
        caption: vec![made_by(None)],
        ..sheet
    })
}
