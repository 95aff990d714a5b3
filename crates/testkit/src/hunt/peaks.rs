//! Results and cost of searching the peaks between 31 samples of a band, compared with 1201 samples: the paper's structure with dampers
//! drawn from the ranges of the main job's grid, and around its result.

use super::Hunt;
use crate::scenes::SSVI;
use rayon::prelude::*;
use retune_model::{Measure, NonNegative, Scene};
use retune_optim::{Band, DesignObjective, Parameter, worst_over};
use retune_solver::{Ask, Settings, Window, extremes};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

const BAND: Band = Band { from: 5.0, to: 8.0, samples: 31 };
const FINE: Band = Band { samples: 1201, ..BAND };
const WINDOW: Window = Window { from: 50.0, to: 100.0 };
/// Relative shortfalls from the fine samples that the table counts.
const SHORTFALLS: [f64; 5] = [1e-6, 1e-4, 1e-3, 1e-2, 1e-1];

/// Largest E1 in the window at a frequency, J.
fn e1_max(scene: &Scene, omega: f64) -> f64 {
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let mut scene = *scene;
    scene.forcing.frequency = NonNegative::new(omega).expect("a frequency");
    let ask = Ask { measure: Measure::default(), phase: 0.0, also: None, cutoff: f64::INFINITY };
    extremes(&scene, WINDOW, &settings, ask).expect("a run").largest.value
}

/// Logarithmic interpolation.
fn ratio(from: f64, to: f64, share: f64) -> f64 {
    from * (to / from).powf(share)
}

/// For one damper: the relative shortfall of its value, the runs of the peak searches, and the number of peaks.
fn measure(scene: &Scene) -> (f64, usize, usize) {
    let runs = AtomicUsize::new(0);
    let value = |omega: f64| {
        runs.fetch_add(1, Relaxed);
        Ok::<f64, ()>(e1_max(scene, omega))
    };
    let found = worst_over(&BAND, value, f64::INFINITY).expect("runs").value;
    let of = |band: &Band| -> Vec<f64> { (0..band.samples).map(|i| e1_max(scene, band.at(i))).collect() };
    let samples = of(&BAND);
    let rises = |i: usize| i == 0 || samples[i] > samples[i - 1];
    let falls = |i: usize| i + 1 == samples.len() || samples[i] >= samples[i + 1];
    let peaks = (0..samples.len()).filter(|&i| rises(i) && falls(i)).count();
    let most = of(&FINE).into_iter().fold(found, f64::max);
    (1.0 - found / most, runs.into_inner() - BAND.samples, peaks)
}

/// A design from four numbers in [0, 1).
type Design = fn([f64; 4]) -> [f64; 4];

/// Two kinds of dampers: any of the grid, whose motions are irregular somewhere in the band, and some like those at which a search ends.
pub fn peaks(dampers: u32) -> Hunt {
    let of_the_grid: Design =
        |u| [ratio(50.0, 600.0, u[0]), ratio(20.0, 400.0, u[1]), 0.24 * u[2], 0.06 + 0.72 * u[3]];
    let near_the_result: Design =
        |u| [ratio(400.0, 600.0, u[0]), ratio(70.0, 130.0, u[1]), 0.06 * u[2], 0.5 + u[3]];
    let (scene, damper, varied) = (SSVI.scene(), SSVI.damper(), Parameter::VARIED.to_vec());
    let objective = DesignObjective::new(scene, damper, varied, WINDOW, Settings::default());
    let mut hunt = Hunt::default();
    for (name, design, most) in
        [("the grid of the main job", of_the_grid, 0.25), ("about its result", near_the_result, 0.1)]
    {
        let place = |i: u32| std::array::from_fn(|d| f64::from(sobol_burley::sample(i, d as u32, 7)));
        let one = |i: u32| measure(&objective.scene(&design(place(i))).expect("a damper"));
        let found: Vec<(f64, usize, usize)> = (0..dampers).into_par_iter().map(one).collect();
        let runs: usize = found.iter().map(|(_, runs, _)| runs).sum();
        let peaks: usize = found.iter().map(|(.., peaks)| peaks).sum();
        let a_peak = runs as f64 / peaks as f64;
        let below = SHORTFALLS.map(|share| found.iter().filter(|(short, ..)| *short > share).count());
        let cells = below.map(|count| format!(" {count} |")).concat();
        hunt.row(format!("| {name} | {dampers} | {peaks} | {a_peak:.2} |{cells}"));
        // Some ten on average, twelve at most, were needed before searches stopped early when nothing could be gained.
        hunt.check(a_peak < 7.0, || format!("{name}: {a_peak} runs a peak"));
        let share = below[3] as f64 / f64::from(dampers);
        hunt.check(share < most, || format!("{name}: {share} of the dampers are 1 % too low"));
    }
    hunt
}
