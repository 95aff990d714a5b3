//! A run of 40 s under a record of 4001 samples beside the same length under a harmonic force, with about as many impacts: the least time of
//! many, of E1max, and how far it is from DOP853 begun anew at each sample. `just lab bench-records`.
#![expect(clippy::print_stdout, reason = "a measurement is printed")]

use retune_model::{Of, Samples, Scene};
use retune_solver::{Method, Settings, Window, e1_max, simulate};
use retune_testkit::histories::record;
use retune_testkit::scenes::{Numbers, SSVI, Spread};
use std::hint::black_box;
use std::time::Instant;

const WHOLE: Window = Window { from: 0.0, to: 40.0 };
const ROUNDS: usize = 400;
/// The damper of `results/ssvi`.
const TUNED: Numbers = Numbers { k2: 583.9, c2: 94.97, d: 0.02885, c: 1.105, ..SSVI };

/// Noise on ground of 2.5 Hz, of at most `peak` (m/s²).
fn ground(peak: f64, step: f64, even: bool) -> Samples {
    let (mut spread, mut x, mut v) = (Spread::new(1940), 0.0, 0.0);
    let count = (40.0 / step) as usize;
    let mut values = Vec::new();
    for _ in 0..=count {
        let w = (0..12).map(|_| spread.signed()).sum::<f64>();
        values.push(2.0 * 0.6 * 15.6 * v + 15.6 * 15.6 * x);
        for _ in 0..20 {
            v += step / 20.0 * (w - 2.0 * 0.6 * 15.6 * v - 15.6 * 15.6 * x);
            x += step / 20.0 * v;
        }
    }
    let most = values.iter().fold(0.0, |most: f64, a: &f64| most.max(a.abs()));
    values.iter_mut().for_each(|a| *a *= peak / most);
    if even {
        return Samples::every(0.0, step, values).expect("a record");
    }
    let times = (0..=count).map(|i| step * (i as f64 + 0.2 * spread.signed())).map(f64::abs).collect();
    Samples::at(times, values).expect("a record")
}

fn main() {
    let under = |damper: Numbers, peak, step, even| {
        damper.under(record(Of::BaseAcceleration, ground(peak, step, even)))
    };
    // Each with the number of the harmonic run that stands beside it.
    let scenes: [(&str, Scene, usize); 7] = [
        ("harmonic", TUNED.scene(), 0),
        ("4001 samples", under(TUNED, 4.0, 0.01, true), 0),
        ("4001 samples, not equidistant", under(TUNED, 4.0, 0.01, false), 0),
        ("401 samples", under(TUNED, 4.0, 0.1, true), 0),
        ("40001 samples", under(TUNED, 4.0, 0.001, true), 0),
        ("harmonic, Table 2", SSVI.scene(), 5),
        ("4001 samples, Table 2, more than 60 impacts", under(SSVI, 20.0, 0.01, true), 5),
    ];
    let settings = Settings::default();
    let exact = Settings { method: Method::Dop853, rtol: 1e-13, atol: 1e-15, ..settings };
    let value = |scene: &Scene, settings: &Settings| {
        e1_max(black_box(scene), WHOLE, settings, f64::INFINITY).expect("a run").value
    };
    // All in turn, so that what else the machine does falls on all.
    let mut times = [const { Vec::new() }; 7];
    for _ in 0..ROUNDS {
        for ((_, scene, _), times) in scenes.iter().zip(&mut times) {
            let start = Instant::now();
            black_box(value(scene, &settings));
            times.push(start.elapsed().as_secs_f64());
        }
    }
    let least = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
    for ((name, scene, beside), of) in scenes.iter().zip(&times) {
        let beside = &times[*beside];
        let mut shares: Vec<f64> = of.iter().zip(beside).map(|(time, other)| time / other).collect();
        shares.sort_by(f64::total_cmp);
        let found = simulate(scene, WHOLE, &settings).expect("a run");
        let error = (value(scene, &settings) / value(scene, &exact) - 1.0).abs();
        println!(
            "{name}: {:.1} µs, {:.2} times ({:.2} in the median of pairs), impacts {:?}, error {error:.0e}, {:?}",
            1e6 * least(of),
            least(of) / least(beside),
            shares[ROUNDS / 2],
            found.impacts,
            found.work
        );
    }
}
