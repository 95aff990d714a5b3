//! The figures of `fronts`.

use super::candidate::Candidate;
use super::fronts::{Fronts, Row};
use retune_figures::sheet::{BLUE, Chart, GREY, Key, Layer, ORANGE, PURPLE, VERMILION, sheet};
use retune_study::Sweep;

/// A colour for each damper, of what was found and of the damper in its study.
const COLOURS: [[&str; 2]; 2] = [[BLUE, PURPLE], [VERMILION, ORANGE]];
const LABELS: [&str; 3] = ["largest stroke, m", "largest contact force, N", "k₂, N/m"];

/// The least E1max against a bound.
pub(super) fn sweep(fronts: &Fronts, sweep: Sweep) -> String {
    let rows = fronts.rows(sweep);
    let line = |damper: usize| {
        let own = rows.iter().filter(|row| row.damper == damper);
        let energy = |row: &Row| row.design.map_or(f64::NAN, |design| design.e1_max);
        own.map(|row| (row.bound, energy(row))).collect::<Vec<(f64, f64)>>()
    };
    let mut layers = Vec::new();
    for damper in 0..fronts.plan.dampers.len() {
        let [colour, _] = COLOURS[damper % COLOURS.len()];
        layers.push(Layer::Line { points: line(damper), colour, width: 4.0, dash: "" });
        layers.push(Layer::Dots { points: line(damper), colour, size: size(damper) });
    }
    let reached = |design: &Candidate| if sweep == Sweep::K2 { design.at.k2.get() } else { design.stroke };
    layers.extend(given(fronts, reached));
    let right = 1.03 * rows.last().map_or(1.0, |row| row.bound);
    let energies = rows.iter().filter_map(|row| row.design).chain(&fronts.given).map(|design| design.e1_max);
    let label = match sweep {
        Sweep::K2 => "k₂ at most, N/m",
        Sweep::Stroke => "stroke at most, m",
    };
    let chart = Chart {
        title: title(fronts),
        labels: [label.to_owned(), "worst E₁max, J".to_owned()],
        ranges: [(0.0, right), (0.0, 1.06 * energies.fold(0.0, f64::max))],
        log: false,
        layers,
    };
    let words = legend(fronts, true, |design| reached(design) <= right);
    sheet(&[chart], 1, 700.0, &keys(&words)).wide
}

/// E1max against stroke, contact force and k2: the designs that no other dominates, and pale those that are dominated.
pub(super) fn front(fronts: &Fronts) -> String {
    let front = fronts.front();
    let all = || fronts.designs.iter().chain(&fronts.given);
    let top = 1.06 * all().map(|design| design.e1_max).fold(0.0, f64::max);
    let chart = |which: usize| {
        let value = |design: &Candidate| [design.stroke, design.force, design.at.k2.get()][which];
        let point = |design: &Candidate| (value(design), design.e1_max);
        let dominated = fronts.designs.iter().filter(|design| !front.contains(design));
        let mut layers =
            vec![Layer::Dots { points: dominated.map(point).collect(), colour: GREY, size: 10.0 }];
        for damper in 0..fronts.plan.dampers.len() {
            let [colour, _] = COLOURS[damper % COLOURS.len()];
            let points = front.iter().filter(|design| design.damper == damper).map(|design| point(design));
            layers.push(Layer::Dots { points: points.collect(), colour, size: size(damper) });
        }
        layers.extend(given(fronts, value));
        let most = all().map(value).fold(0.0, f64::max);
        Chart {
            title: if which == 0 { title(fronts) } else { String::new() },
            labels: [LABELS[which].to_owned(), "worst E₁max, J".to_owned()],
            ranges: [(-0.02 * most, 1.05 * most), (0.0, top)],
            log: false,
            layers,
        }
    };
    let charts: Vec<Chart> = (0..3).map(chart).collect();
    let mut words = legend(fronts, false, |_| true);
    words.push((Key::Dot(GREY), "found, but dominated in all".to_owned()));
    sheet(&charts, 1, 520.0, &keys(&words)).wide
}

/// The dampers in the studies, each as a dot.
fn given(fronts: &Fronts, value: impl Fn(&Candidate) -> f64) -> impl Iterator<Item = Layer> {
    let dot = move |design: &Candidate| Layer::Dots {
        points: vec![(value(design), design.e1_max)],
        colour: COLOURS[design.damper % COLOURS.len()][1],
        size: 20.0,
    };
    fronts.given.iter().map(dot)
}

/// Later dampers are drawn over earlier ones, and smaller, so that equal designs are both seen.
fn size(damper: usize) -> f64 {
    if damper == 0 { 22.0 } else { 13.0 }
}

fn title(fronts: &Fronts) -> String {
    let over = fronts.plan.dampers.last().map(|(_, study)| {
        let over = retune_study::over(&study.objective(), study.scene.forcing.frequency.get());
        format!("{over}; ")
    });
    format!("{}Retune {}", over.unwrap_or_default(), env!("CARGO_PKG_VERSION"))
}

/// The entries of the legend; of the dampers in the studies, those that are `shown`.
fn legend(fronts: &Fronts, lines: bool, shown: impl Fn(&Candidate) -> bool) -> Vec<(Key, String)> {
    let dampers = fronts.plan.dampers.iter().enumerate();
    let tuned = dampers.map(|(i, (name, _))| {
        let [colour, _] = COLOURS[i % COLOURS.len()];
        (if lines { Key::Line(colour, "") } else { Key::Dot(colour) }, format!("{name}, tuned"))
    });
    let given = fronts.given.iter().filter(|design| shown(design)).map(|design| {
        let [_, colour] = COLOURS[design.damper % COLOURS.len()];
        (Key::Dot(colour), format!("{} of the study", fronts.name(design.damper)))
    });
    tuned.chain(given).collect()
}

fn keys(words: &[(Key, String)]) -> Vec<(Key, &str)> {
    words.iter().map(|(key, words)| (*key, words.as_str())).collect()
}
