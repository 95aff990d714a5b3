//! The figures of `track`: E1max along k1, and the designs against k1.

use super::tuned::{Curves, Tuned};
use retune_figures::colour::{BLACK, BLUE, Colour, GREEN, ORANGE, VERMILION};
use retune_figures::{Axis, Chart, Dash, Key, Layer, Mark, Shape, Sheet, Stroke, Width, svg};
use retune_workbench::tune::Found;

/// A colour for each damper, of its tuning that is kept and of its tuning anew.
const COLOURS: [[Colour; 2]; 2] = [[ORANGE, VERMILION], [GREEN, BLUE]];
/// Marks of the designs of each damper.
const SHAPES: [Shape; 2] = [Shape::Disc, Shape::Square];

/// Lines of a damper: as it was tuned, and tuned anew, with the marks of its designs.
fn looks(damper: usize) -> (Stroke, Stroke, Mark) {
    let [kept, anew] = COLOURS[damper % COLOURS.len()];
    let mark = Mark::new(SHAPES[damper % SHAPES.len()], anew, 4.0);
    (Stroke::new(kept, 1.1, Dash::Long), Stroke::solid(anew), mark)
}

/// E1max against k1: none, as tuned for the study's own k1, and tuned anew.
pub(super) fn retention(tuned: &[Tuned], curves: &Curves) -> String {
    let none = Stroke::new(BLACK, 1.1, Dash::Short);
    let line = |energies: &[f64]| curves.k1.iter().copied().zip(energies.iter().copied()).collect();
    let mut layers = vec![Layer::Line { points: line(&curves.none), stroke: none }];
    let mut legend = vec![(Key::Line(none), "no damper".to_owned())];
    for (i, damper) in tuned.iter().enumerate() {
        let (kept, anew, mark) = looks(i);
        layers.push(Layer::Line { points: line(&curves.kept[i]), stroke: kept });
        let points: Vec<(f64, f64)> =
            damper.designs.iter().map(|(k1, Found { e1_max, .. })| (*k1, *e1_max)).collect();
        layers.push(Layer::Line { points: points.clone(), stroke: anew });
        layers.push(Layer::Marks { points, mark });
        let Tuned { name, nominal, .. } = damper;
        legend.push((Key::Line(kept), format!("{name} tuned for k1 = {nominal} N/m")));
        legend.push((Key::Marked(anew, mark), format!("{name} re-tuned")));
    }
    let energies = curves.none.iter().chain(curves.kept.iter().flatten());
    let top = energies.copied().filter(|e| e.is_finite()).fold(0.0, f64::max);
    let chart = Chart {
        title: String::new(),
        x: Axis::linear("k1, N/m", ends(curves.k1.iter().copied())),
        y: Axis::linear("E1max, J", (0.0, if top > 0.0 { 1.06 * top } else { 1.0 })),
        layers,
        height: 170.0,
    };
    svg(&Sheet {
        title: "How long a tuning lasts".to_owned(),
        description: format!(
            "E1max against the stiffness k1 of the structure: {}.",
            legend.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>().join("; ")
        ),
        width: Width::Column,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: vec![made_by(tuned)],
    })
}

/// k2, c2, D and C against k1.
pub(super) fn path(tuned: &[Tuned]) -> String {
    const LABELS: [&str; 4] = ["k2, N/m", "c2, N·s/m", "D, m", "C, m"];
    let chart = |which: usize| {
        let value = |found: &Found| found.damper.design.values()[which];
        let all = tuned.iter().flat_map(|damper| damper.designs.iter().map(|(_, found)| value(found)));
        let top = all.fold(0.0, f64::max);
        let layers = tuned.iter().enumerate().flat_map(|(i, damper)| {
            let points: Vec<(f64, f64)> =
                damper.designs.iter().map(|(k1, found)| (*k1, value(found))).collect();
            let (_, stroke, mark) = looks(i);
            [Layer::Line { points: points.clone(), stroke }, Layer::Marks { points, mark }]
        });
        let k1 = tuned.iter().flat_map(|damper| damper.designs.iter().map(|(k1, _)| *k1));
        Chart {
            title: String::new(),
            x: Axis::linear("k1, N/m", ends(k1)),
            y: Axis::linear(LABELS[which], (0.0, if top > 0.0 { 1.06 * top } else { 1.0 })),
            layers: layers.collect(),
            height: 120.0,
        }
    };
    let key = |(i, damper): (usize, &Tuned)| {
        let (_, stroke, mark) = looks(i);
        (Key::Marked(stroke, mark), damper.name.clone())
    };
    svg(&Sheet {
        title: "The re-tuned designs".to_owned(),
        description: "k2, c2, D and C of each damper, tuned anew for each stiffness k1 of the structure."
            .to_owned(),
        width: Width::Page,
        charts: (0..4).map(chart).collect(),
        columns: 2,
        stacked: false,
        legend: tuned.iter().enumerate().map(key).collect(),
        caption: vec![made_by(tuned)],
    })
}

/// What the designs are tuned for, and by what.
fn made_by(tuned: &[Tuned]) -> String {
    let over = |first: &Tuned| {
        retune_study::over(&first.study.objective(), first.study.scene.forcing.frequency.get())
    };
    format!("{}; Retune {}", tuned.first().map(over).unwrap_or_default(), env!("CARGO_PKG_VERSION"))
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
