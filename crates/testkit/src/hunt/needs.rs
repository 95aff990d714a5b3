//! Compares what a damper needs with a plain scan: on other structures than the paper's, no run at any of many frequencies may exceed the
//! reported values.

use super::Hunt;
use crate::scenes::{Numbers, SSVI};
use rayon::prelude::*;
use retune_model::{Measure, NonNegative, PerMeasure, Positive, Scene, drawn_number};
use retune_optim::{FrequencyBand, Goal, Objective};
use retune_solver::{Also, Ask, Settings, Window, extremes};

/// Relative shortfalls that the table counts.
const SHORTFALLS: [f64; 4] = [1e-6, 1e-4, 1e-3, 1e-2];

/// A structure of 0.3 to 30 t and 2 to 20 rad/s with a nearly tuned damper, with gaps of a fraction of its stroke or without walls; its
/// band; and its window, the second half of `periods` periods.
pub fn drawn(number: u64, walls: bool, periods: f64) -> (Scene, FrequencyBand, Window) {
    let mut seed = number.wrapping_mul(7919) + u64::from(walls);
    let mut between = |from: f64, to: f64| from * (to / from).powf(drawn_number(&mut seed));
    let (m1, natural, share) = (between(300.0, 30_000.0), between(2.0, 20.0), between(0.01, 0.1));
    let (k1, m2) = (m1 * natural * natural, share * m1);
    let c1 = 2.0 * between(0.002, 0.05) * m1 * natural;
    let detuned = if walls { between(0.1, 1.0) } else { between(0.6, 1.4) };
    let k2 = m2 * natural * natural * detuned;
    let c2 = 2.0 * between(0.02, 0.3) * (m2 * k2).sqrt();
    let p = 0.01 * k1 * between(1e-3, 1e-1);
    let static_stroke = p / k1 / share.sqrt();
    let gap = |x: f64| if walls { x * static_stroke } else { 1e6 };
    let (d, c) = (gap(between(0.2, 5.0)), gap(between(1.0, 50.0)));
    let scene = Numbers { m1, c1, k1, p, omega: natural, m2, k2, c2, d, c, ..SSVI }.scene();
    let limit = |x: f64| Positive::new(x * natural).expect("above 0");
    let omega = FrequencyBand { from: limit(0.8), to: limit(1.25), samples: 31, relative: false };
    let period = std::f64::consts::TAU / natural;
    (scene, omega, Window { from: 0.5 * periods * period, to: periods * period })
}

/// The largest values of runs from rest at `count` frequencies.
fn scanned(scene: &Scene, band: &FrequencyBand, window: Window, count: usize) -> PerMeasure<f64> {
    let band = retune_optim::Band { samples: count, ..band.of(&scene.primary) };
    let at = |i: usize| {
        let mut scene = *scene;
        scene.forcing.frequency = NonNegative::new(band.at(i)).expect("a frequency");
        let also = Some(Also { measures: PerMeasure::EVERY, from: 0.0 });
        extremes(&scene, window, &Settings::default(), Ask { also, ..Ask::default() }).expect("a run").reached
    };
    (0..count).into_par_iter().map(at).reduce(PerMeasure::default, PerMeasure::max)
}

/// The relative shortfall of the reported value from a scan, for each measure; negative if it is above.
fn shortfalls(number: u64, walls: bool, periods: f64, count: usize) -> [f64; Measure::ALL.len()] {
    let (scene, omega, window) = drawn(number, walls, periods);
    let objective = Objective { omega: Some(omega), ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let found = goal.needs(&scene, &Settings::default(), &|| true).expect("runs").whole;
    let scan = scanned(&scene, &omega, window, count);
    std::array::from_fn(|i| {
        let (found, scan) = (found.0[i].value, scan.0[i]);
        if scan == 0.0 { 0.0 } else { 1.0 - found / scan }
    })
}

/// Compares `dampers` dampers, without and with walls, over `periods` periods with a scan of `count` frequencies. Without walls the
/// shortfall may be at most `allowed`; with walls a motion may be irregular, and the reported value is only a lower bound.
pub fn needs(dampers: u64, periods: f64, count: usize, allowed: f64) -> Hunt {
    let mut hunt = Hunt::default();
    for (name, walls) in [("without walls", false), ("with walls", true)] {
        let all: Vec<_> = (0..dampers).map(|number| shortfalls(number, walls, periods, count)).collect();
        for measure in Measure::ALL {
            let shares: Vec<f64> = all.iter().map(|below| below[measure.index()]).collect();
            let short =
                SHORTFALLS.map(|least| shares.iter().filter(|share| **share > least).count().to_string());
            let most = shares.iter().copied().fold(0.0, f64::max);
            let measure = measure.name();
            hunt.row(format!("| {name} | {measure} | {dampers} | {} | {most:.1e} |", short.join(" | ")));
            hunt.check(walls || most <= allowed, || format!("{name}, {measure}: {most}"));
        }
    }
    hunt
}
