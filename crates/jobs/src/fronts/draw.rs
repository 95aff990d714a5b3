//! The figures of `fronts`.

use super::candidate::Candidate;
use super::designs::{Fronts, Row};
use crate::caption::{made_by, words};
use retune_model::Parameter;
use retune_report::colour::{BLACK, BLUE, Colour, ORANGE, PURPLE, VERMILION};
use retune_report::{Axis, Chart, Drawing, Key, Layer, Mark, Shape, Sheet, Stroke, Width, drawing};
use retune_study::Sweep;

/// A colour for each damper, of what was found and of the damper in its study.
const COLOURS: [[Colour; 2]; 2] = [[BLUE, PURPLE], [VERMILION, ORANGE]];
const LABELS: [&str; 3] = ["largest stroke, m", "contact force, N", "k2, N/m"];
const ENERGY: &str = "worst E1max, J";
/// A design whose E1max rises on more samples.
const RISES: Mark = Mark::new(Shape::Ring, BLACK, 8.0);

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
pub(super) fn sweep(fronts: &Fronts, sweep: Sweep) -> Drawing {
    let rows = fronts.rows(sweep);
    let line = |damper: usize| {
        let own = rows.iter().filter(|row| row.damper == damper);
        let energy = |row: &Row| row.design.map_or(f64::NAN, |design| design.e1_max);
        own.map(|row| (row.bound, energy(row))).collect::<Vec<(f64, f64)>>()
    };
    let mut layers = Vec::new();
    for damper in 0..fronts.plan.dampers.len() {
        let mark = found(damper);
        // A design stays allowed until the next bound: between bounds nothing was searched for.
        layers.push(Layer::Steps { points: line(damper), stroke: Stroke::solid(mark.colour) });
        layers.push(Layer::Marks { points: line(damper), mark });
    }
    let rising = |row: &&Row| row.design.is_some_and(Candidate::rises);
    let risen: Vec<(f64, f64)> =
        rows.iter().filter(rising).filter_map(|row| Some((row.bound, row.design?.e1_max))).collect();
    let any_rises = !risen.is_empty();
    layers.push(Layer::Marks { points: risen, mark: RISES });
    let reached = |design: &Candidate| design.reached(sweep);
    layers.extend(given(fronts, reached));
    let right = 1.03 * rows.last().map_or(1.0, |row| row.bound);
    let energies = rows.iter().filter_map(|row| row.design).chain(&fronts.given).map(|design| design.e1_max);
    let label = match sweep {
        Sweep::K2 => "k2 at most, N/m",
        Sweep::Stroke => "stroke at most, m",
        Sweep::ContactForce => "contact force at most, N",
    };
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(label, (0.0, right)),
        y: Axis::linear(ENERGY, (0.0, 1.06 * energies.fold(0.0, f64::max))),
        layers,
        height: 165.0,
    };
    let mut legend = legend(fronts, true, |design| reached(design) <= right);
    if any_rises {
        legend.push((
            Key::Mark(RISES),
            format!("rises by more than 1 % on {} frequencies", fronts.plan.check()),
        ));
    }
    drawing(&Sheet {
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
        caption: vec![made_by(fronts.plan.dampers.last().map(|(_, study)| study))],
    })
}

/// E1max against stroke, contact force and k2: all designs, and the front of each damper in each chart.
pub(super) fn front(fronts: &Fronts) -> Drawing {
    let all = || fronts.designs.iter().chain(&fronts.given);
    let top = 1.06 * all().map(|design| design.e1_max).fold(0.0, f64::max);
    let chart = |which: usize| {
        let value = |design: &Candidate| [design.stroke, design.force, design.at.get(Parameter::K2)][which];
        let point = |design: &Candidate| (value(design), design.e1_max);
        let most = all().map(value).fold(0.0, f64::max);
        let mut layers = Vec::new();
        for damper in 0..fronts.plan.dampers.len() {
            let own = || fronts.designs.iter().filter(|design| design.damper == damper).map(point);
            let line = front_of(own().collect());
            let mark = found(damper);
            let pale = Mark { size: 0.5 * mark.size, ..mark };
            layers.push(Layer::Marks { points: own().collect(), mark: pale });
            layers.push(Layer::Steps { points: line, stroke: Stroke::solid(mark.colour) });
        }
        layers.extend(given(fronts, value));
        Chart {
            title: String::new(),
            x: Axis::linear(LABELS[which], (-0.03 * most, 1.05 * most)),
            y: Axis::linear(if which == 0 { ENERGY } else { "" }, (0.0, top)),
            layers,
            height: 150.0,
        }
    };
    let legend = legend(fronts, true, |_| true);
    drawing(&Sheet {
        title: "E1max against stroke, contact force and k2".to_owned(),
        description: format!(
            "Three charts of the same {} designs. A line is the front of a damper in the two quantities of its chart: {}.",
            fronts.designs.len(),
            words(&legend)
        ),
        width: Width::Page,
        charts: (0..3).map(chart).collect(),
        columns: 3,
        stacked: false,
        legend,
        caption: vec![made_by(fronts.plan.dampers.last().map(|(_, study)| study))],
    })
}

/// Of some points those that no other is left of and below, from left to right.
fn front_of(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    points.retain(|(_, energy)| {
        let better = *energy < least;
        least = least.min(*energy);
        better
    });
    points
}

/// The dampers in the studies, each marked.
fn given(fronts: &Fronts, value: impl Fn(&Candidate) -> f64) -> impl Iterator<Item = Layer> {
    let mark = move |design: &Candidate| Layer::Marks {
        points: vec![(value(design), design.e1_max)],
        mark: of_study(design.damper),
    };
    fronts.given.iter().map(mark)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_front_of_points() {
        let points = vec![(2.0, 3.0), (1.0, 5.0), (3.0, 3.0), (2.5, 4.0), (4.0, 1.0), (1.0, 6.0)];
        assert_eq!(front_of(points), [(1.0, 5.0), (2.0, 3.0), (4.0, 1.0)]);
    }
}
