//! The worst over a band: of known functions, of the paper's scenes, and the best designs against closed forms.

use rayon::ThreadPoolBuilder;
use retune_model::{Positive, Scene, Worst};
use retune_optim::objective::band::all_worst_over;
use retune_optim::{
    Band, Bounds, DesignObjective, FrequencyBand, Goal, Objective, Options, Parameter, Response, Scaling,
    Unusable, minimize, worst_over,
};
use retune_solver::{Settings, Window};
use retune_testkit::scenes::{Numbers, SSVI, TMD};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

const BAND: Band = Band { from: 5.0, to: 8.0, samples: 61 };

/// The largest E1 in a window, or steady where there is none, over a band.
fn goal(window: Option<Window>, band: Option<Band>) -> Goal {
    let positive = |value| Positive::new(value).expect("above 0");
    let omega = band.map(|Band { from, to, samples }| FrequencyBand {
        from: positive(from),
        to: positive(to),
        samples,
        relative: false,
    });
    let response = if window.is_some() { Response::Window } else { Response::Steady };
    let window = window.unwrap_or(Window { from: 0.0, to: 1.0 });
    Goal { objective: Objective { omega, response, ..Objective::default() }, ..window.into() }
}

/// Its value and frequency.
fn e1_max(scene: &Scene, window: Option<Window>, band: Option<Band>) -> Result<Worst, Unusable> {
    let found = goal(window, band).evaluate(scene, &Settings::default(), f64::INFINITY)?;
    Ok(Worst { value: found.ranked, frequency: found.worst.scene.forcing.frequency.get() })
}

fn over(band: Band, f: impl Fn(f64) -> f64 + Sync) -> Worst {
    worst_over(&band, |omega| Ok::<f64, ()>(f(omega)), f64::INFINITY).expect("no failures")
}

#[test]
fn exact_peaks_between_samples_are_found() {
    // A resonance 0.02 rad/s wide between samples 0.05 apart: the sample beside it is far below it.
    let peak = |at: f64| move |omega: f64| 1.0 / (1.0 + ((omega - at) / 0.01).powi(2));
    for at in [5.011, 6.284, 7.333_333, 7.993] {
        let worst = over(BAND, peak(at));
        assert!((worst.value - 1.0).abs() < 1e-5, "{at}: {worst:?}");
        assert!((worst.frequency - at).abs() < 1e-4, "{at}: {worst:?}");
    }
    let parabola = over(BAND, |omega| -(omega - 6.111_f64).powi(2));
    assert!(parabola.value.abs() < 1e-15 && (parabola.frequency - 6.111).abs() < 1e-7, "{parabola:?}");
}

#[test]
fn contract_the_higher_of_two_peaks_is_found_though_its_sample_is_lower() {
    let worst = over(BAND, |omega: f64| {
        let peak = |at: f64, width: f64| 1.0 / (1.0 + ((omega - at) / width).powi(2));
        0.9 * peak(5.5, 0.2) + peak(7.024, 0.02)
    });
    assert!((worst.frequency - 7.024).abs() < 1e-3 && worst.value > 1.0, "{worst:?}");
}

#[test]
fn contract_ends_of_the_band_are_included() {
    assert_eq!(over(BAND, |omega| omega), Worst { value: 8.0, frequency: 8.0 });
    assert_eq!(over(BAND, |omega| -omega), Worst { value: -5.0, frequency: 5.0 });
}

#[test]
fn contract_the_number_of_evaluations_is_bounded_and_a_cutoff_ends_them() {
    let count = AtomicUsize::new(0);
    let rugged = |omega: f64| {
        count.fetch_add(1, Relaxed);
        Ok::<f64, ()>((1e5 * omega).sin())
    };
    worst_over(&BAND, rugged, f64::INFINITY).expect("no failures");
    assert!(count.load(Relaxed) <= 61 + 11 * 31, "{}", count.load(Relaxed));
    count.store(0, Relaxed);
    worst_over(&BAND, rugged, -2.0).expect("no failures");
    assert_eq!(count.load(Relaxed), 1, "one sample is enough");
}

/// A value equal to the cutoff is not above it: the search continues.
#[test]
fn contract_a_search_ends_above_its_cutoff_not_at_it() {
    let band = Band { from: 5.0, to: 8.0, samples: 7 };
    let looked = std::sync::Mutex::new(Vec::new());
    let peak = |omega: f64| {
        let value = 1.0 / (1.0 + (omega - 6.21).powi(2));
        looked.lock().expect("no panic").push(value);
        Ok::<f64, ()>(value)
    };
    let whole = worst_over(&band, peak, f64::INFINITY).expect("no failures");
    let refined = looked.lock().expect("no panic")[7..].to_vec();
    let sample = 1.0 / (1.0 + 0.21_f64.powi(2));
    let first = *refined.iter().find(|value| **value > sample).expect("a better place");
    assert!(first < whole.value);
    let found = worst_over(&band, peak, first).expect("no failures");
    assert!(found.value > first, "{found:?} {first}");
}

/// The points that a search evaluates: few where the function is smooth, and never more than 11 in addition to the samples.
#[test]
fn regress_places_that_a_search_looks_at() {
    let band = Band { from: 5.0, to: 8.0, samples: 4 };
    let functions: [fn(f64) -> f64; 6] = [
        |x| -(x - 6.111_f64).powi(2),
        |x| 1.0 / (1.0 + ((x - 6.3) / 0.2).powi(2)),
        |x| -(x - 6.111_f64).powi(4),
        |x| -(x - 6.223_f64).abs(),
        |x| (x - 4.9) * (-2.0 * (x - 4.9)).exp(),
        |x| -((x - 6.4) / 0.3).tanh().powi(2) * (1.0 + 0.3 * (x - 6.4)),
    ];
    let looks = functions.map(|f| {
        let looked = std::sync::Mutex::new((0, 0.0));
        let told = worst_over(
            &band,
            |omega| {
                let mut looked = looked.lock().expect("no panic");
                *looked = (looked.0 + 1, looked.1 + omega);
                Ok::<f64, ()>(f(omega))
            },
            f64::INFINITY,
        );
        let (count, sum) = *looked.lock().expect("no panic");
        (count, (1e6 * sum).round() / 1e6, (1e6 * told.expect("no failures").frequency).round() / 1e6)
    });
    // Their number, their sum and the largest: the last function increases up to the end of the band.
    let expected = [
        (7, 44.333, 6.111),
        (15, 95.59636, 6.3),
        (12, 74.986217, 6.111),
        (15, 94.500972, 6.222996),
        (14, 80.601403, 5.4),
        (15, 81.618018, 5.0),
    ];
    assert_eq!(looks, expected);
}

#[test]
fn contract_the_first_failure_in_the_order_of_the_band_is_returned() {
    let failing = |omega: f64| if omega > 6.0 { Err(omega) } else { Ok(1.0) };
    assert_eq!(worst_over(&BAND, failing, f64::INFINITY), Err(BAND.at(21)));
}

#[test]
fn contract_runs_over_a_band_are_the_same_bits_at_any_number_of_threads() {
    let band = Band { from: 6.0, to: 6.6, samples: 7 };
    let window = Window { from: 5.0, to: 15.0 };
    let on = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let run = || e1_max(&SSVI.scene(), Some(window), Some(band));
        let worst = pool.install(run).expect("runs");
        (worst.value.to_bits(), worst.frequency.to_bits())
    };
    let one = on(1);
    assert_eq!([on(2), on(3)], [one; 2]);
    // The worst value is that of a run at the returned frequency, and no sample exceeds it.
    let at = |omega: f64| {
        let scene = Numbers { omega, ..SSVI }.scene();
        e1_max(&scene, Some(window), None).expect("a run").value
    };
    let (value, frequency) = (f64::from_bits(one.0), f64::from_bits(one.1));
    assert_eq!(at(frequency).to_bits(), value.to_bits());
    assert!((0..7).all(|i| at(band.at(i)) <= value));
}

/// Runs in a late window, and the closed form.
#[test]
fn exact_late_runs_over_a_band_agree_with_the_steady_response() {
    let scene = TMD.scene();
    let value = |window| e1_max(&scene, window, Some(BAND)).expect("a value");
    let (runs, steady) = (value(Some(Window { from: 150.0, to: 170.0 })), value(None));
    assert!((runs.value / steady.value - 1.0).abs() < 1e-9, "{runs:?} {steady:?}");
    assert!((runs.frequency - steady.frequency).abs() < 1e-4, "{runs:?} {steady:?}");
}

#[test]
fn contract_a_steady_motion_that_reaches_a_wall_has_no_value() {
    let steady = |numbers: Numbers| e1_max(&numbers.scene(), None, Some(BAND));
    let stroke = TMD.coupled().steady_stroke_max([BAND.from, BAND.to]);
    let refused = steady(Numbers { d: 0.999 * stroke.value, ..TMD });
    let expected =
        Unusable::Touches { omega: stroke.frequency, stroke: stroke.value, room: 0.999 * stroke.value };
    assert_eq!(refused, Err(expected));
    assert_eq!(steady(Numbers { d: 1.001 * stroke.value, ..TMD }), steady(TMD));
    let bare = e1_max(&TMD.bare_scene(), None, Some(BAND));
    assert_eq!(bare, Ok(TMD.bare().steady_e1_max([BAND.from, BAND.to])));
}

/// The best k2 and c2, N/m and N·s/m, of the worst steady E1max over a band, J.
fn best(numbers: Numbers, band: Band, start: [f64; 2]) -> [f64; 3] {
    let (scene, damper) = (numbers.scene(), numbers.damper());
    let objective = DesignObjective::new(
        scene,
        damper,
        vec![Parameter::K2, Parameter::C2],
        goal(None, Some(band)),
        Settings::default(),
    );
    let mut x = start.to_vec();
    let mut value = f64::INFINITY;
    for _ in 0..4 {
        // Once more from the previous end: on the ridge line of two equal peaks a simplex may collapse early.
        let options = Options {
            tol_x: 1e-12,
            tol_fun: 1e-12,
            scaling: Scaling::Start,
            bounds: vec![Bounds { lower: Some(0.0), upper: None }; 2],
            ..Options::default()
        };
        let found = minimize(
            |x: &[f64], cutoff| objective.value(x, cutoff),
            &x,
            options,
            |_| ControlFlow::Continue(()),
        );
        let found = found.expect("a start with a value");
        (x, value) = (found.x, found.value);
    }
    [x[0], x[1], value]
}

/// Made by `tests/reference/tmd_band.py`.
#[test]
fn reference_the_best_tmd_over_the_band() {
    let [k2, c2, value] = best(TMD, BAND, [600.0, 262.0]);
    assert!((k2 - 2_083.081_03).abs() < 1e-3 && (c2 - 111.892_94).abs() < 1e-3, "{k2} {c2}");
    assert!((value - 160.605_045_247).abs() < 1e-7, "{value}");
}

/// `c1 -> 0` and a light damper: E1max is the spring's energy at the lower peak and the mass's at the upper. Den Hartog's argument
/// (Mechanical Vibrations, 4th ed. 1956, section 3.3) with the energy in the place of the displacement: all curves pass through
/// two points, which are level where `g_Q |1 - g_P² (1 + μ)| = |1 - g_Q² (1 + μ)|`. That tuning is an eighth of μ above his
/// f = 1/(1 + μ) of the displacement, which the energy shares in the limit only, as it does ζ = √(3μ/8(1 + μ)). (The displacement
/// itself is tested against its exact optimum in `crates/model/tests/band.rs`.) The peaks lie a little above the fixed points,
/// in a share of order μ.
#[test]
fn reference_den_hartog_in_the_undamped_limit() {
    let natural = (TMD.k1 / TMD.m1).sqrt();
    let points = |f: f64, mu: f64| {
        let half = (1.0 + f * f * (1.0 + mu)) / (2.0 + mu);
        let root = (half * half - 2.0 * f * f / (2.0 + mu)).sqrt();
        [(half - root).sqrt(), (half + root).sqrt()]
    };
    for mu in [1e-3, 1e-2] {
        let m2 = mu * TMD.m1;
        let f0 = 1.0 / (1.0 + mu);
        let zeta0 = (3.0 * mu / (8.0 * (1.0 + mu))).sqrt();
        // The tuning whose fixed points are level in energy, by halving.
        let (mut low, mut high) = (0.9 * f0, 1.1 * f0);
        for _ in 0..60 {
            let f = 0.5 * (low + high);
            let [p, q] = points(f, mu);
            let difference = q * (1.0 - p * p * (1.0 + mu)).abs() - (1.0 - q * q * (1.0 + mu)).abs();
            if difference > 0.0 { low = f } else { high = f }
        }
        let start = [m2 * (f0 * natural).powi(2), 2.0 * m2 * f0 * natural * zeta0];
        let band = Band { from: 0.5 * natural, to: 2.0 * natural, samples: 2 };
        let numbers = Numbers { c1: 0.0, m2, d: 1e3, c: 1e3, ..TMD };
        let [k2, c2, value] = best(numbers, band, start);
        let (f, damper_frequency) = ((k2 / m2).sqrt() / natural, (k2 / m2).sqrt());
        let zeta = c2 / (2.0 * m2 * damper_frequency);
        let [p, _] = points(low, mu);
        let height = 0.5 * TMD.p * TMD.p / TMD.k1 / (1.0 - p * p * (1.0 + mu)).powi(2);
        assert!((f - low).abs() < 0.05 * mu * mu, "{f} {low}");
        assert!(((f - f0) / mu - 0.125).abs() < 0.25 * mu.sqrt(), "{f} {f0}");
        assert!((zeta / zeta0 - 1.0).abs() < 0.15 * mu.sqrt(), "{zeta} {zeta0}");
        assert!(value > height && value < height * (1.0 + 0.1 * mu), "{value} {height}");
    }
}

/// The second quantity is a parabola that rises from its sample at 6 by 0.04 to 1: a search allows for four times what the
/// samples show of that rise, and runs only if that could break the limit.
#[test]
fn contract_peaks_that_cannot_break_a_limit_are_not_searched() {
    let band = Band { from: 5.0, to: 8.0, samples: 4 };
    let evaluations = |limit| {
        let count = AtomicUsize::new(0);
        let values = |omega: f64| {
            count.fetch_add(1, Relaxed);
            Ok::<_, ()>([0.0, 1.0 - (omega - 6.2).powi(2)])
        };
        let found = all_worst_over(&band, &values, f64::INFINITY, [Some(f64::INFINITY), Some(limit)], true)
            .expect("values");
        (count.into_inner(), found[1].value)
    };
    // Samples -0.44, 0.96, 0.36: at most 0.96 + 0.5 (1.92 + 0.44 - 0.36) = 1.96.
    let (searched, largest) = evaluations(1.95);
    assert!(searched > 4 && (largest - 1.0).abs() < 1e-12, "{searched} {largest}");
    assert_eq!(evaluations(1.97), (4, 1.0 - 0.2_f64.powi(2)));
}
