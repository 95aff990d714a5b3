//! The figures of `track`: E1max along k1, and the designs against k1.

use super::tuned::{Curves, Tuned};
use crate::tune::Found;
use retune_figures::sheet::{BLACK, BLUE, Chart, GREEN, Key, Layer, ORANGE, VERMILION, sheet};

/// A colour for each damper, of its tuning that is kept and of its tuning anew.
const COLOURS: [[&str; 2]; 2] = [[ORANGE, VERMILION], [GREEN, BLUE]];
/// Dashes of the curve of a tuning that is kept, and of that without a damper.
const DASHES: [&str; 2] = ["18 8", "6 6"];

/// E1max against k1: none, as tuned for the study's own k1, and tuned anew.
pub(super) fn retention(tuned: &[Tuned], curves: &Curves) -> String {
    let line = |energies: &[f64]| curves.k1.iter().copied().zip(energies.iter().copied()).collect();
    let mut layers =
        vec![Layer::Line { points: line(&curves.none), colour: BLACK, width: 4.0, dash: DASHES[1] }];
    let mut keys = vec![Key::Line(BLACK, DASHES[1])];
    let mut words = vec!["no damper".to_owned()];
    for (i, damper) in tuned.iter().enumerate() {
        let [kept, anew] = COLOURS[i % COLOURS.len()];
        layers.push(Layer::Line { points: line(&curves.kept[i]), colour: kept, width: 4.0, dash: DASHES[0] });
        let points: Vec<(f64, f64)> =
            damper.designs.iter().map(|(k1, Found { e1_max, .. })| (*k1, *e1_max)).collect();
        layers.push(Layer::Line { points: points.clone(), colour: anew, width: 4.0, dash: "" });
        layers.push(Layer::Dots { points, colour: anew, size: 14.0 });
        let Tuned { name, nominal, .. } = damper;
        keys.extend([Key::Line(kept, DASHES[0]), Key::Line(anew, "")]);
        words.extend([format!("{name} tuned for k1 = {nominal} N/m"), format!("{name} re-tuned")]);
    }
    let energies = curves.none.iter().chain(curves.kept.iter().flatten());
    let top = energies.copied().filter(|e| e.is_finite()).fold(0.0, f64::max);
    let over = |first: &Tuned| {
        retune_study::over(&first.study.objective(), first.study.scene.forcing.frequency.get())
    };
    let title =
        format!("{}; Retune {}", tuned.first().map(over).unwrap_or_default(), env!("CARGO_PKG_VERSION"));
    let chart = Chart {
        title,
        labels: ["k₁, N/m".to_owned(), "E₁max, J".to_owned()],
        ranges: [ends(curves.k1.iter().copied()), (0.0, 1.06 * top)],
        log: false,
        layers,
    };
    let legend: Vec<(Key, &str)> = keys.into_iter().zip(words.iter().map(String::as_str)).collect();
    sheet(&[chart], 1, 700.0, &legend).wide
}

/// k2, c2, D and C against k1.
pub(super) fn path(tuned: &[Tuned]) -> String {
    const LABELS: [&str; 4] = ["k₂, N/m", "c₂, N·s/m", "D, m", "C, m"];
    let chart = |which: usize| {
        let value = |found: &Found| found.damper.design.values()[which];
        let all = tuned.iter().flat_map(|damper| damper.designs.iter().map(|(_, found)| value(found)));
        let top = all.fold(0.0, f64::max);
        let layers = tuned.iter().enumerate().flat_map(|(i, damper)| {
            let points: Vec<(f64, f64)> =
                damper.designs.iter().map(|(k1, found)| (*k1, value(found))).collect();
            let colour = COLOURS[i % COLOURS.len()][1];
            let line = Layer::Line { points: points.clone(), colour, width: 4.0, dash: "" };
            [line, Layer::Dots { points, colour, size: 14.0 }]
        });
        Chart {
            title: String::new(),
            labels: ["k₁, N/m".to_owned(), LABELS[which].to_owned()],
            ranges: [
                ends(tuned.iter().flat_map(|damper| damper.designs.iter().map(|(k1, _)| *k1))),
                (0.0, if top > 0.0 { 1.06 * top } else { 1.0 }),
            ],
            log: false,
            layers: layers.collect(),
        }
    };
    let charts: Vec<Chart> = (0..4).map(chart).collect();
    let legend: Vec<(Key, &str)> = tuned
        .iter()
        .enumerate()
        .map(|(i, damper)| (Key::Line(COLOURS[i % COLOURS.len()][1], ""), damper.name.as_str()))
        .collect();
    sheet(&charts, 2, 480.0, &legend).wide
}

/// The range of some stiffnesses, a little wider where there is but one.
fn ends(k1: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let (low, high) = (k1.clone().fold(f64::INFINITY, f64::min), k1.fold(0.0, f64::max));
    if low < high { (low, high) } else { (0.9 * high, 1.1 * high) }
}
