//! The two charts of Figure 4 for one stiffness: impact zones with energies, and the orbit diagram with its regimes.

use super::family::Family;
use super::motions::Motions;
use super::plan::stiffness;
use retune_dynamics::sweep::zones;
use retune_dynamics::{Kind, Zone};
use retune_figures::sheet::{
    BLACK, BLUE, Chart, Drawing, GREEN, GREY, Key, Layer, ORANGE, PURPLE, SKY, VERMILION, YELLOW, sheet,
};

/// Height of the strip on top of the orbit diagram, as a share of the chart's.
const STRIP: f64 = 0.05;
/// Heights of the two alternating rows of regime labels, as shares of the chart's height.
const ROWS: [f64; 2] = [0.89, 0.83];
/// Width of a letter of a label, as a share of the chart's width.
const LETTER: f64 = 0.019;

/// Both charts with their legend.
pub fn picture(family: &Family, motions: &Motions) -> Drawing {
    let omega = (motions.omega[0], motions.omega[motions.omega.len() - 1]);
    sheet(&[zone_chart(family, omega), orbit_chart(family, motions, omega)], 2, 560.0, &legend())
}

/// The colour of a kind of motion.
fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Periodic => GREY,
        Kind::AmplitudeModulated => YELLOW,
        Kind::Chaotic => VERMILION,
        Kind::Intermittent => GREEN,
        Kind::Settling => BLACK,
    }
}

fn legend() -> Vec<(Key, &'static str)> {
    let kinds = [Kind::Periodic, Kind::AmplitudeModulated, Kind::Chaotic, Kind::Intermittent, Kind::Settling];
    let mut keys = vec![
        (Key::Heading, "zones:"),
        (Key::Area(PURPLE, 0.35), "both walls struck"),
        (Key::Area(SKY, 0.35), "PS only"),
        (Key::Heading, "curves:"),
        (Key::Line(BLACK, "12 8"), "E₁max, no damper"),
        (Key::Line(VERMILION, "3 5"), "E₁max, SSVI"),
        (Key::Line(GREEN, ""), "E₁max, TMD"),
        (Key::Line(ORANGE, ""), "E₂max, SSVI"),
        (Key::Heading, "dots:"),
        (Key::Dot(BLACK), "from rest"),
        (Key::Dot(BLUE), "sweep up"),
        (Key::Dot(ORANGE), "sweep down"),
        (Key::Heading, "strip:"),
    ];
    keys.extend(kinds.map(|kind| (Key::Area(colour(kind), 1.0), kind.words())));
    keys
}

fn zone_chart(family: &Family, omega: (f64, f64)) -> Chart {
    let mut layers: Vec<Layer> = zones(&family.points[1])
        .into_iter()
        .filter_map(|(zone, from, to)| {
            let colour = match zone {
                Zone::Bilateral => PURPLE,
                Zone::PrimaryOnly => SKY,
                Zone::ObstacleOnly | Zone::None => return None,
            };
            Some(Layer::Band { from, to, colour, opacity: 0.35, height: (0.0, 1.0) })
        })
        .collect();
    layers.push(Layer::Upright { x: family.natural });
    let curve = |scene: usize, damper: bool| {
        family.points[scene].iter().map(|p| (p.value, if damper { p.e2_max } else { p.e1_max })).collect()
    };
    layers.push(Layer::Line { points: curve(0, false), colour: BLACK, width: 3.0, dash: "12 8" });
    layers.push(Layer::Line { points: curve(2, false), colour: GREEN, width: 4.0, dash: "" });
    layers.push(Layer::Line { points: curve(1, true), colour: ORANGE, width: 3.5, dash: "" });
    layers.push(Layer::Line { points: curve(1, false), colour: VERMILION, width: 5.0, dash: "3 5" });
    let top = family.highest(0).energy.max(family.highest(1).energy);
    Chart {
        title: format!("k₁ = {} N/m: impact zones, energies", stiffness(family.k1)),
        labels: ["ω, rad/s".into(), "E, J".into()],
        ranges: [omega, (0.0, 1.05 * top)],
        log: false,
        layers,
    }
}

fn orbit_chart(family: &Family, motions: &Motions, omega: (f64, f64)) -> Chart {
    let dots = |start: usize, colour, size| Layer::Dots {
        points: motions.orbits[start]
            .iter()
            .flat_map(|o| o.samples.iter().map(|y| (o.value, y[2])))
            .collect(),
        colour,
        size,
    };
    let mut layers = strip(motions);
    layers.push(Layer::Upright { x: family.natural });
    layers.extend([dots(0, BLACK, 6.0), dots(2, ORANGE, 4.5), dots(1, BLUE, 3.0)]);
    layers.extend(labels(motions, omega));
    let values = motions.orbits.iter().flatten().flat_map(|o| o.samples.iter().map(|y| y[2]));
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    Chart {
        title: "x₂ at the crests of the force; regimes nT, m, k".into(),
        labels: ["ω, rad/s".into(), "x₂, m".into()],
        // Space on top for the strip and two rows of labels.
        ranges: [omega, (low - 0.05 * (high - low), high + 0.3 * (high - low))],
        log: false,
        layers,
    }
}

/// A strip coloured by the kind of motion from rest.
fn strip(motions: &Motions) -> Vec<Layer> {
    let omega = &motions.omega;
    let middle = |i: usize, j: usize| 0.5 * (omega[i] + omega[j]);
    let band = |(i, regime): (usize, &retune_dynamics::Regime)| Layer::Band {
        from: middle(i.saturating_sub(1), i),
        to: middle(i, (i + 1).min(omega.len() - 1)),
        colour: colour(regime.kind),
        opacity: 1.0,
        height: (1.0 - STRIP, 1.0),
    };
    motions.regimes.iter().enumerate().map(band).collect()
}

/// Names of periodic motions where there is space for them, the widest windows first.
fn labels(motions: &Motions, (first, last): (f64, f64)) -> Vec<Layer> {
    let mut windows = motions.windows();
    windows
        .retain(|(label, from, to)| label.starts_with(|c: char| c.is_ascii_digit() || c == 'T') && to > from);
    windows.sort_by_key(|(_, from, to)| std::cmp::Reverse(to - from));
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    let mut layers = Vec::new();
    for (text, from, to) in windows {
        let half = 0.5 * LETTER * (text.chars().count() + 1) as f64 * (last - first);
        let middle = 0.5 * (motions.omega[from] + motions.omega[to]);
        let x = middle.clamp(first + half, last - half);
        // A label is placed above its own window, or omitted.
        if !(motions.omega[from]..=motions.omega[to]).contains(&x) {
            continue;
        }
        let free = |row: &&f64| {
            taken.iter().all(|(other, width, place)| place != *row || (x - other).abs() > half + width)
        };
        if let Some(&share) = ROWS.iter().find(free) {
            taken.push((x, half, share));
            layers.push(Layer::Words { x, share, text });
        }
    }
    layers
}
