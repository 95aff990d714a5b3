//! The figures of `fronts`.

use super::candidate::Candidate;
use super::designs::{Fronts, Row};
use crate::pages::figure;
use retune_report::colour::{BLACK, BLUE, Colour, ORANGE, PURPLE, VERMILION};
use retune_report::{Axis, Chart, Drawing, Key, Layer, Mark, Shape, Sheet, Stroke, Width};
use retune_study::Sweep;

/// The colours of each damper: of the designs found and of the study's damper.
const COLOURS: [[Colour; 2]; 2] = [[BLUE, PURPLE], [VERMILION, ORANGE]];
/// The bounded quantities, in the order of the charts of the front, with the labels of their values and of bounds on them.
const BOUNDED: [(Sweep, &str, &str); 3] = [
    (Sweep::Stroke, "largest stroke, m", "stroke at most, m"),
    (Sweep::ContactForce, "contact force, N", "contact force at most, N"),
    (Sweep::K2, "k2, N/m", "k2 at most, N/m"),
];
const ENERGY: &str = "worst E1max, J";
/// A design whose E1max rises on more samples.
const RISES: Mark = Mark::new(Shape::Ring, BLACK, 8.0);

/// The mark of a damper's designs. Later dampers are drawn over earlier ones, and smaller, so that equal designs are both seen.
fn found(damper: usize) -> Mark {
    let [colour, _] = COLOURS[damper % COLOURS.len()];
    let (shape, size) = if damper == 0 { (Shape::Disc, 6.5) } else { (Shape::Square, 4.0) };
    Mark::new(shape, colour, size)
}

/// The mark of the study's damper.
fn of_study(damper: usize) -> Mark {
    let [_, colour] = COLOURS[damper % COLOURS.len()];
    let shape = if damper == 0 { Shape::Triangle } else { Shape::Cross };
    Mark { rim: true, ..Mark::new(shape, colour, 7.0) }
}

/// The least E1max against a bound.
pub(super) fn sweep(fronts: &Fronts, sweep: Sweep) -> Drawing {
    let rows = fronts.rows(sweep);
    let line = |damper: usize| {
        let rows_of_damper = rows.iter().filter(|(under, _)| under.damper == damper);
        let point = |(under, design): &Row| (under.bound, design.map_or(f64::NAN, |design| design.e1_max));
        rows_of_damper.map(point).collect::<Vec<(f64, f64)>>()
    };
    let mut layers = Vec::new();
    for damper in 0..fronts.plan.dampers.len() {
        let mark = found(damper);
        // Steps, since a design stays feasible until the next bound and nothing was searched for in between.
        layers.push(Layer::Steps { points: line(damper), stroke: Stroke::solid(mark.colour) });
        layers.push(Layer::Marks { points: line(damper), mark });
    }
    let rising = |(under, design): &Row| Some((under.bound, design.filter(|design| design.rises())?.e1_max));
    let risen: Vec<(f64, f64)> = rows.iter().filter_map(rising).collect();
    let right = 1.03 * rows.last().map_or(1.0, |(under, _)| under.bound);
    let mut legend = legend(fronts, |design| design.reached(sweep) <= right);
    if !risen.is_empty() {
        let words = format!("rises by more than 1 % on {} frequencies", fronts.plan.check());
        legend.push((Key::Mark(RISES), words));
    }
    layers.push(Layer::Marks { points: risen, mark: RISES });
    layers.extend(given(fronts, sweep));
    let energies =
        rows.iter().filter_map(|(_, design)| *design).chain(&fronts.given).map(|design| design.e1_max);
    let label = BOUNDED.iter().find(|(of, ..)| *of == sweep).map_or("", |(.., label)| label);
    let x = Axis::linear(label, (0.0, right));
    let chart = Chart::of(x, Axis::from_zero(ENERGY, energies), layers, 165.0);
    let title = format!("The least E1max against a bound: {label}");
    let description = "The worst E1max of the best design of each damper under each bound".to_owned();
    draw(fronts, Sheet { description, legend, ..Sheet::of(title, vec![chart]) })
}

/// E1max against stroke, contact force and k2: all designs, and the front of each damper in each chart.
pub(super) fn front(fronts: &Fronts) -> Drawing {
    let all = || fronts.designs.iter().chain(&fronts.given);
    let chart = |(which, &(of, label, _)): (usize, &(Sweep, &str, &str))| {
        let point = |design: &Candidate| (design.reached(of), design.known());
        let most = all().map(|design| design.reached(of)).fold(0.0, f64::max);
        let mut layers = Vec::new();
        for damper in 0..fronts.plan.dampers.len() {
            let designs = fronts.designs.iter().filter(|design| design.damper == damper);
            let points: Vec<(f64, f64)> = designs.map(point).collect();
            let (mark, line) = (found(damper), front_of(points.clone()));
            layers.push(Layer::Marks { points, mark: Mark { size: 0.5 * mark.size, ..mark } });
            layers.push(Layer::Steps { points: line, stroke: Stroke::solid(mark.colour) });
        }
        layers.extend(given(fronts, of));
        let energy = if which == 0 { ENERGY } else { "" };
        let y = Axis::from_zero(energy, all().map(Candidate::known));
        Chart::of(Axis::linear(label, (-0.03 * most, 1.05 * most)), y, layers, 150.0)
    };
    let charts = BOUNDED.iter().enumerate().map(chart).collect();
    let description = format!(
        "Three charts of the same {} designs. A line is the front of a damper in the two quantities of its chart",
        fronts.designs.len(),
    );
    let sheet = Sheet::of("E1max against stroke, contact force and k2", charts);
    let legend = legend(fronts, |_| true);
    draw(fronts, Sheet { description, legend, width: Width::Page, columns: 3, ..sheet })
}

fn draw(fronts: &Fronts, sheet: Sheet) -> Drawing {
    figure(sheet, fronts.plan.dampers.last().map(|(_, study)| study))
}

/// The non-dominated points, from left to right: those with no other to the left and below.
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

/// The marks of the studies' dampers.
fn given(fronts: &Fronts, of: Sweep) -> impl Iterator<Item = Layer> {
    fronts.given.iter().map(move |design| Layer::Marks {
        points: vec![(design.reached(of), design.known())],
        mark: of_study(design.damper),
    })
}

/// The entries of the legend; the studies' dampers only where `shown`.
fn legend(fronts: &Fronts, shown: impl Fn(&Candidate) -> bool) -> Vec<(Key, String)> {
    let tuned = fronts.plan.dampers.iter().enumerate().map(|(i, (name, _))| {
        let mark = found(i);
        (Key::Marked(Stroke::solid(mark.colour), mark), format!("{name}, tuned"))
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
