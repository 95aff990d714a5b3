//! What a damper needs, beside a plain scan: for structures that are not the paper's, no run at any of many frequencies may reach more than is
//! told. `just lab hunt-needs` draws more than the tests do.

use rayon::prelude::*;
use retune_model::{Measure, NonNegative, PerMeasure, Positive, Scene};
use retune_optim::{FrequencyBand, Goal, Objective, Response};
use retune_solver::{Also, Ask, Settings, Window, extremes};
use retune_testkit::scenes::{Numbers, SSVI};

/// Shares by which what is told may be below the scan.
const SHORT: [f64; 4] = [1e-6, 1e-4, 1e-3, 1e-2];

/// Number `i` of a sequence, in [0, 1).
fn draw(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *seed;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// A structure of 0.3 to 30 t and 2 to 20 rad/s with a damper near its tuning, in gaps of a share of its stroke or without walls; its band
/// and its window, the later half of so many periods.
fn drawn(number: u64, walls: bool, periods: f64) -> (Scene, FrequencyBand, Window) {
    let mut seed = number.wrapping_mul(7919) + u64::from(walls);
    let mut between = |from: f64, to: f64| from * (to / from).powf(draw(&mut seed));
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

/// The largest values of runs from rest at so many frequencies.
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

/// By which share what is told is below a scan, for each measure; negative where it is above.
fn below(number: u64, walls: bool, periods: f64, count: usize) -> [f64; 7] {
    let (scene, omega, window) = drawn(number, walls, periods);
    let objective = Objective { omega: Some(omega), ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let told = goal.needs(&scene, &Settings::default(), &|| true).expect("runs").whole;
    let scan = scanned(&scene, &omega, window, count);
    std::array::from_fn(|i| {
        let (told, scan) = (told.0[i].value, scan.0[i]);
        if scan == 0.0 { 0.0 } else { 1.0 - told / scan }
    })
}

#[test]
fn reference_needs_beside_a_scan() {
    let dampers: u64 =
        std::env::var("RETUNE_NEEDS").map_or(2, |count| count.parse().expect("RETUNE_NEEDS is a number"));
    let (periods, count) = if dampers > 2 { (100.0, 2001) } else { (30.0, 151) };
    println!("| dampers | quantity | number | below by 1e-6 | 1e-4 | 1e-3 | 1e-2 | most |");
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, walls) in [("without walls", false), ("with walls", true)] {
        let all: Vec<[f64; 7]> = (0..dampers).map(|number| below(number, walls, periods, count)).collect();
        for measure in Measure::ALL {
            let shares: Vec<f64> = all.iter().map(|below| below[measure as usize]).collect();
            let short = SHORT.map(|least| shares.iter().filter(|share| **share > least).count().to_string());
            let most = shares.iter().copied().fold(0.0, f64::max);
            println!("| {name} | {} | {dampers} | {} | {most:.1e} |", measure.name(), short.join(" | "));
            // A hunt is recorded in its table.
            if dampers == 2 && !walls {
                assert!(most <= 1e-6, "{}: {most}", measure.name());
            }
        }
    }
}

/// A steady response is told in closed form, with the transient before it from a run.
#[test]
fn exact_needs_of_a_steady_response_are_its_closed_form_or_the_run_before_it() {
    let (scene, omega, window) = drawn(1, false, 30.0);
    let objective = Objective { omega: Some(omega), response: Response::Steady, ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let needs = goal.needs(&scene, &Settings::default(), &|| true).expect("a value");
    let damper = scene.damper.expect("a damper");
    let system = retune_model::Coupled::new(&scene.primary, &scene.forcing, &damper);
    for measure in Measure::ALL {
        let worst = system.steady_max(measure, [omega.from.get(), omega.to.get()]);
        let own = needs.own.get(measure);
        assert_eq!(own.value, worst.value, "{}", measure.name());
        if worst.value > 0.0 {
            assert_eq!(own.omega, worst.frequency, "{}", measure.name());
        }
        assert!(needs.whole.get(measure).value >= worst.value);
    }
}

/// No linear damper of the same mass near the best has a smaller value.
#[test]
fn exact_no_neighbour_of_the_best_linear_damper_is_better() {
    let (scene, omega, window) = drawn(2, true, 30.0);
    let objective = Objective { omega: Some(omega), response: Response::Steady, ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let best = goal.best_linear(&scene, &Settings::default()).expect("a damper");
    let value = |k2: f64, c2: f64| {
        let mut scene = best;
        let damper = scene.damper.as_mut().expect("a damper");
        damper.stiffness = NonNegative::new(k2 * damper.stiffness.get()).expect("a stiffness");
        damper.damping = NonNegative::new(c2 * damper.damping.get()).expect("a damping");
        goal.evaluate(&scene, &Settings::default(), f64::INFINITY).expect("a value").ranked
    };
    let own = value(1.0, 1.0);
    for (k2, c2) in [(1.01, 1.0), (0.99, 1.0), (1.0, 1.05), (1.0, 0.95), (1.01, 1.05), (0.99, 0.95)] {
        assert!(value(k2, c2) > own, "{k2} {c2}");
    }
}
