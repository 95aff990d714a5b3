//! Settled responses beside much longer runs: `just lab test-settled` looks at thousands of random scenes, the suite at some.

use retune_model::Scene;
use retune_solver::{Also, Ask, Extremes, Method, Settings, Settle, Window, extremes, settled};
use retune_testkit::scenes::{Numbers, SSVI, Spread};

/// Of the settled motion alone.
fn of_settled() -> Ask {
    Ask { also: Some(Also::walls(f64::INFINITY)), ..Ask::default() }
}

/// The extremes of the settled motion; none where it does not settle in 400 s or is answered in closed form.
fn rest(scene: &Scene) -> Option<Extremes> {
    let window = Window { from: 50.0, to: 400.0 };
    let found = settled(scene, window, Settle::default(), &Settings::default(), of_settled()).expect("a run");
    (found.settled && found.largest.time < window.to).then_some(found)
}

/// Those of a run five times as long.
fn late(scene: &Scene) -> Extremes {
    let window = Window { from: 1900.0, to: 2000.0 };
    let ask = Ask { also: Some(Also::walls(window.from)), ..Ask::default() };
    extremes(scene, window, &Settings::default(), ask).expect("a run")
}

/// By how much they differ, as a share of what may be: a thousandth of E1max and of the stroke, a hundredth of the force or 0.1 N.
fn difference(found: Extremes, late: Extremes) -> [f64; 3] {
    let share = |a: f64, b: f64, most: f64| (a - b).abs() / most;
    [
        share(found.largest.value, late.largest.value, 1e-3 * late.largest.value),
        share(found.stroke(), late.stroke(), 1e-3 * late.stroke()),
        share(found.force(), late.force(), (1e-2 * late.force()).max(0.1)),
    ]
}

/// Dampers that creep for up to minutes (c2/k2), touch one wall, two or none, about the structure's resonance.
#[test]
fn invariant_what_has_settled_stays() {
    let scenes: usize = match std::env::var("RETUNE_SETTLED") {
        Ok(number) => number.parse().expect("RETUNE_SETTLED: a number of scenes"),
        Err(_) => 150,
    };
    let mut spread = Spread::new(13);
    let (mut looked_at, mut off, mut worst) = (0, [0; 3], [0.0_f64; 3]);
    for _ in 0..scenes {
        let mut between = |low, high| spread.logarithmic(low, high);
        let numbers = Numbers {
            k1: between(2e4, 6e4),
            omega: between(4.0, 9.0),
            m2: between(10.0, 300.0),
            k2: between(3.0, 3000.0),
            c2: between(3.0, 400.0),
            d: between(0.005, 0.5),
            c: between(0.005, 0.7),
            ..SSVI
        };
        let scene = numbers.scene();
        let Some(found) = rest(&scene) else { continue };
        let difference = difference(found, late(&scene));
        looked_at += 1;
        for (i, difference) in difference.into_iter().enumerate() {
            off[i] += u32::from(difference > 1.0);
            worst[i] = worst[i].max(difference);
        }
        if difference.iter().any(|difference| *difference > 1.0) {
            println!("{numbers:?}: {found:?}, differences {difference:?}");
        }
    }
    println!(
        "{scenes} scenes, {looked_at} settled; off: E1max {}, stroke {}, force {}; worst differences as shares of those allowed {worst:?}",
        off[0], off[1], off[2]
    );
    assert!(2 * looked_at > scenes && off == [0; 3], "{looked_at} {off:?}");
}

/// Its E1max has settled long before the damper has crept to the wall.
#[test]
fn contract_a_damper_that_creeps_has_not_settled() {
    let numbers = Numbers {
        k2: 10.317_189_989_760_958,
        c2: 332.345_202_151_484_86,
        d: 0.084_375_876_743_818_79,
        c: 0.449_683_133_363_699_2,
        ..SSVI
    };
    for omega in [5.5, SSVI.omega, 7.0] {
        let scene = Numbers { omega, ..numbers }.scene();
        let late = late(&scene);
        if let Some(found) = rest(&scene) {
            assert!(
                difference(found, late).iter().all(|difference| *difference <= 1.0),
                "{omega} {found:?} {late:?}"
            );
        }
    }
}

/// A transient that falls by 5 % a period changes little from return to return, and twenty times as much in all that follows: only
/// the latter may be below the tolerance.
#[test]
fn exact_a_slow_decay_has_not_settled_before_all_that_is_left_of_it_is_small() {
    let numbers = Numbers { c1: 100.0, k2: 0.0, c2: 0.0, d: 5.0, c: 5.0, ..SSVI };
    let settings = Settings { method: Method::Dop853, rtol: 1e-9, atol: 1e-11, ..Settings::default() };
    let window = Window { from: 0.0, to: 600.0 };
    let found =
        settled(&numbers.scene(), window, Settle::default(), &settings, Ask::default()).expect("a run");
    let steady = numbers.bare().steady(numbers.omega).e1_max;
    let error = (found.largest.value / steady - 1.0).abs();
    assert!(found.settled && error < 5e-5, "{} {error:e}", found.settled);
}
