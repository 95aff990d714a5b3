//! The two charts of Figure 4 for one stiffness: impact zones with energies, and the orbit diagram with its regimes.

use super::family::Family;
use super::measures::ends;
use super::motions::Motions;
use super::plan::stiffness;
use retune_dynamics::sweep::zones;
use retune_dynamics::{Kind, Orbit, Point, Zone};
use retune_report::colour::{BLACK, BLUE, Colour, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, YELLOW};
use retune_report::{Axis, Chart, Dash, Key, Layer, Mark, Shape, Sheet, Stand, Stroke};

/// Height of the strip on top of the orbit diagram, as a share of the chart's.
const STRIP: f64 = 0.05;
/// Heights of the two alternating rows of regime labels, as shares of the chart's height.
const ROWS: [f64; 2] = [0.9, 0.82];
/// Width of a letter of a label, as a share of the chart's width.
const LETTER: f64 = 0.022;
/// The lines of the energies.
const NONE: Stroke = Stroke::new(BLACK, 0.9, Dash::Long);
const SSVI: Stroke = Stroke::new(VERMILION, 1.4, Dash::Dots);
const TMD: Stroke = Stroke::solid(GREEN);
const DAMPER: Stroke = Stroke::solid(ORANGE);
const NATURAL: Stroke = Stroke::new(BLACK, 0.7, Dash::Solid);

pub fn picture(family: &Family, motions: &Motions) -> Sheet {
    let omega = (motions.omega[0], motions.omega[motions.omega.len() - 1]);
    let k1 = stiffness(family.k1);
    Sheet {
        columns: 2,
        legend: legend(),
        ..Sheet::page(
            format!("Impact zones and motions at k1 = {k1} N/m"),
            format!(
                "Against ω from {:.3} to {:.3} rad/s: on the left zones of impacts and the energies E1max and E2max, on the right x2 at the \
                 crests of the force, with the names of the motions.",
                omega.0, omega.1
            ),
            vec![zone_chart(family, omega), orbit_chart(family, motions, omega)],
        )
    }
}

fn colour(kind: Kind) -> Colour {
    match kind {
        Kind::Periodic => GREY,
        Kind::AmplitudeModulated => YELLOW,
        Kind::Chaotic => BLACK,
        Kind::Intermittent => BLUE,
        Kind::Settling => PURPLE,
    }
}

fn legend() -> Vec<(Key, String)> {
    let kinds = [Kind::Periodic, Kind::AmplitudeModulated, Kind::Chaotic, Kind::Intermittent, Kind::Settling];
    let others = [
        (Key::Heading, "zones:"),
        (Key::Area(PURPLE, 0.35), "both walls struck"),
        (Key::Area(SKY, 0.35), "PS only"),
        (Key::Heading, "curves:"),
        (Key::Line(NONE), "E1max, no damper"),
        (Key::Line(SSVI), "E1max, SSVI"),
        (Key::Line(TMD), "E1max, TMD"),
        (Key::Line(DAMPER), "E2max, SSVI"),
        (Key::Heading, "dots:"),
        (Key::Mark(Mark::new(Shape::Disc, BLACK, 4.0)), "from rest"),
        (Key::Mark(Mark::new(Shape::Disc, VERMILION, 4.0)), "another motion, on the way up"),
        (Key::Mark(Mark::new(Shape::Disc, SKY, 4.0)), "another motion, on the way down"),
        (Key::Heading, "strip:"),
    ];
    let kinds = kinds.map(|kind| (Key::Area(colour(kind), 1.0), kind.words()));
    others.into_iter().chain(kinds).map(|(key, words)| (key, words.to_owned())).collect()
}

const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

fn zone_chart(family: &Family, omega: (f64, f64)) -> Chart {
    let mut layers: Vec<Layer> = zones(&family.points[1])
        .into_iter()
        .filter_map(|(zone, from, to)| {
            let colour = match zone {
                Zone::Bilateral => PURPLE,
                Zone::PrimaryOnly => SKY,
                Zone::ObstacleOnly | Zone::None => return None,
            };
            Some(Layer::Band { x: (from, to), y: EVERYWHERE, colour, opacity: 0.35 })
        })
        .collect();
    layers.push(Layer::Upright { x: family.natural, stroke: NATURAL });
    let curve = |scene: usize, energy: fn(&Point) -> f64, stroke| {
        Layer::line(family.points[scene].iter().map(|p| (p.value, energy(p))), stroke)
    };
    layers.push(curve(0, |p| p.e1_max, NONE));
    layers.push(curve(2, |p| p.e1_max, TMD));
    layers.push(curve(1, |p| p.e2_max, DAMPER));
    layers.push(curve(1, |p| p.e1_max, SSVI));
    let top = family.highest(0).energy.max(family.highest(1).energy);
    let title = format!("k1 = {} N/m: impact zones, energies", stiffness(family.k1));
    chart(title, omega, Axis::linear("E, J", (0.0, 1.05 * top)), layers)
}

fn orbit_chart(family: &Family, motions: &Motions, omega: (f64, f64)) -> Chart {
    let points = |orbit: &Orbit| {
        let value = orbit.value;
        orbit.samples.iter().map(move |y| (value, y[2])).collect::<Vec<_>>()
    };
    let from_rest = motions.orbits[0].iter().flat_map(points).collect();
    let from_rest = Layer::Dots { points: from_rest, colour: BLACK, size: 1.3 };
    // Motions of a sweep are drawn only where they differ from the one from rest: elsewhere dots would hide dots.
    let others = |start: usize, colour| {
        let reached =
            motions.coexisting.iter().filter(|here| here.motions.iter().any(|(other, _)| *other == start));
        let points = reached.flat_map(|here| points(&motions.orbits[start][here.index])).collect();
        Layer::Dots { points, colour, size: 2.6 }
    };
    let values = motions.orbits.iter().flatten().flat_map(|o| o.samples.iter().map(|y| y[2]));
    let [low, high] = ends(values);
    // Space on top for the strip and two rows of labels.
    let range = (low - 0.05 * (high - low), high + 0.3 * (high - low));
    let height = |share: f64| range.0 + share * (range.1 - range.0);
    let mut layers = strip(motions, height(1.0 - STRIP));
    layers.push(Layer::Upright { x: family.natural, stroke: NATURAL });
    layers.extend([from_rest, others(1, VERMILION), others(2, SKY)]);
    layers.extend(labels(motions, family.natural, omega, ROWS.map(height)));
    let title = "x2 at the crests of the force; regimes nT, m, k".to_owned();
    chart(title, omega, Axis::linear("x2, m", range), layers)
}

fn chart(title: String, omega: (f64, f64), y: Axis, layers: Vec<Layer>) -> Chart {
    Chart { title, ..Chart::of(Axis::linear("ω, rad/s", omega), y, layers, 190.0) }
}

/// A strip at the top, above `from`, coloured by the kind of motion from rest.
fn strip(motions: &Motions, from: f64) -> Vec<Layer> {
    let omega = &motions.omega;
    let middle = |i: usize, j: usize| 0.5 * (omega[i] + omega[j]);
    let band = |(i, regime): (usize, &retune_dynamics::Regime)| Layer::Band {
        x: (middle(i.saturating_sub(1), i), middle(i, (i + 1).min(omega.len() - 1))),
        y: (from, f64::INFINITY),
        colour: colour(regime.kind),
        opacity: 1.0,
    };
    motions.regimes.iter().enumerate().map(band).collect()
}

/// Names of periodic motions at two heights, where there is space for them, the widest windows first.
fn labels(motions: &Motions, natural: f64, (first, last): (f64, f64), heights: [f64; 2]) -> Vec<Layer> {
    let mut windows = motions.windows();
    windows
        .retain(|(label, from, to)| label.starts_with(|c: char| c.is_ascii_digit() || c == 'T') && to > from);
    windows.sort_by_key(|(_, from, to)| std::cmp::Reverse(to - from));
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    let mut layers = Vec::new();
    for (text, from, to) in windows {
        let half = 0.5 * LETTER * (text.chars().count() + 1) as f64 * (last - first);
        let middle = 0.5 * (motions.omega[from] + motions.omega[to]);
        // Beside the line of the natural frequency, not across it.
        let middle =
            if (middle - natural).abs() < half { natural + half.copysign(middle - natural) } else { middle };
        let x = middle.clamp(first + half, last - half);
        // A label that does not fit above its own window is omitted.
        if !(motions.omega[from]..=motions.omega[to]).contains(&x) {
            continue;
        }
        let free = |row: &&f64| {
            taken.iter().all(|(other, width, place)| place != *row || (x - other).abs() > half + width)
        };
        if let Some(&height) = heights.iter().find(free) {
            taken.push((x, half, height));
            layers.push(Layer::Text { at: (x, height), text, stand: Stand::Over });
        }
    }
    layers
}
