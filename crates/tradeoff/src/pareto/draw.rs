//! The figures of `fronts`.

use super::candidate::Candidate;
use super::fronts::{Fronts, Row};
use retune_figures::colour::{BLUE, Colour, GREY, ORANGE, PURPLE, VERMILION};
use retune_figures::{Axis, Chart, Key, Layer, Mark, Shape, Sheet, Stroke, Width, svg};
use retune_study::Sweep;

/// A colour for each damper, of what was found and of the damper in its study.
const COLOURS: [[Colour; 2]; 2] = [[BLUE, PURPLE], [VERMILION, ORANGE]];
const LABELS: [&str; 3] = ["largest stroke, m", "contact force, N", "k2, N/m"];
const ENERGY: &str = "worst E1max, J";

/// The mark of a damper's designs. Later dampers are drawn over earlier ones, and smaller, so that equal designs are both seen.
fn found(damper: usize) -> Mark {
    let [colour, _] = COLOURS[damper % COLOURS.len()];
    let (shape, size) = if damper == 0 { (Shape::Disc, 6.5) } else { (Shape::Square, 4.0) };
    Mark::new(shape, colour, size)
}

/// The mark of the damper in a study.
fn of_study(damper: usize) -> Mark {
    let [_, colour] = COLOURS[damper % COLOURS.len()];
    let shape = if damper == 0 { Shape::Triangle } else { Shape::Cross };
    Mark { rim: true, ..Mark::new(shape, colour, 7.0) }
}

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
        let mark = found(damper);
        layers.push(Layer::Line { points: line(damper), stroke: Stroke::solid(mark.colour) });
        layers.push(Layer::Marks { points: line(damper), mark });
    }
    let reached = |design: &Candidate| if sweep == Sweep::K2 { design.at.k2.get() } else { design.stroke };
    layers.extend(given(fronts, reached));
    let right = 1.03 * rows.last().map_or(1.0, |row| row.bound);
    let energies = rows.iter().filter_map(|row| row.design).chain(&fronts.given).map(|design| design.e1_max);
    let label = match sweep {
        Sweep::K2 => "k2 at most, N/m",
        Sweep::Stroke => "stroke at most, m",
    };
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(label, (0.0, right)),
        y: Axis::linear(ENERGY, (0.0, 1.06 * energies.fold(0.0, f64::max))),
        layers,
        height: 165.0,
    };
    let legend = legend(fronts, true, |design| reached(design) <= right);
    svg(&Sheet {
        title: format!("The least E1max against a bound: {label}"),
        description: format!(
            "The worst E1max of the best design of each damper under each bound: {}.",
            words(&legend)
        ),
        width: Width::Column,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: vec![made_by(fronts)],
    })
}

/// E1max against stroke, contact force and k2: the designs that no other dominates, and pale those that are dominated.
pub(super) fn front(fronts: &Fronts) -> String {
    const DOMINATED: Mark = Mark::new(Shape::Disc, GREY, 2.5);
    let front = fronts.front();
    let all = || fronts.designs.iter().chain(&fronts.given);
    let top = 1.06 * all().map(|design| design.e1_max).fold(0.0, f64::max);
    let chart = |which: usize| {
        let value = |design: &Candidate| [design.stroke, design.force, design.at.k2.get()][which];
        let point = |design: &Candidate| (value(design), design.e1_max);
        let dominated = fronts.designs.iter().filter(|design| !front.contains(design));
        let mut layers = vec![Layer::Marks { points: dominated.map(point).collect(), mark: DOMINATED }];
        for damper in 0..fronts.plan.dampers.len() {
            let points = front.iter().filter(|design| design.damper == damper).map(|design| point(design));
            layers.push(Layer::Marks { points: points.collect(), mark: found(damper) });
        }
        layers.extend(given(fronts, value));
        let most = all().map(value).fold(0.0, f64::max);
        Chart {
            title: String::new(),
            x: Axis::linear(LABELS[which], (-0.03 * most, 1.05 * most)),
            y: Axis::linear(if which == 0 { ENERGY } else { "" }, (0.0, top)),
            layers,
            height: 150.0,
        }
    };
    let mut legend = legend(fronts, false, |_| true);
    legend.push((Key::Mark(DOMINATED), "found, but dominated in all".to_owned()));
    svg(&Sheet {
        title: "E1max against stroke, contact force and k2".to_owned(),
        description: format!(
            "Three charts of the same {} designs, of which {} are not dominated by any other: {}.",
            fronts.designs.len(),
            front.len(),
            words(&legend)
        ),
        width: Width::Page,
        charts: (0..3).map(chart).collect(),
        columns: 3,
        stacked: false,
        legend,
        caption: vec![made_by(fronts)],
    })
}

/// The dampers in the studies, each marked.
fn given(fronts: &Fronts, value: impl Fn(&Candidate) -> f64) -> impl Iterator<Item = Layer> {
    let mark = move |design: &Candidate| Layer::Marks {
        points: vec![(value(design), design.e1_max)],
        mark: of_study(design.damper),
    };
    fronts.given.iter().map(mark)
}

/// What the designs are tuned for, and by what.
fn made_by(fronts: &Fronts) -> String {
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
        let mark = found(i);
        let key = if lines { Key::Marked(Stroke::solid(mark.colour), mark) } else { Key::Mark(mark) };
        (key, format!("{name}, tuned"))
    });
    let given = fronts.given.iter().filter(|design| shown(design)).map(|design| {
        (Key::Mark(of_study(design.damper)), format!("{} of the study", fronts.name(design.damper)))
    });
    tuned.chain(given).collect()
}

/// The words of a legend.
fn words(legend: &[(Key, String)]) -> String {
    legend.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>().join("; ")
}
