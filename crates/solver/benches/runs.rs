//! Cost of a run of 100 s on one core, beside what it must not cost. `just bench`.

#![allow(clippy::approx_constant, reason = "6.28 and 0.318 are the paper's inputs, not 2π and 1/π")]

use criterion::{Criterion, criterion_group, criterion_main};
use retune_model::{
    Bare, Contact, Coupled, Damper, Forcing, NonNegative, PoissonRatio, Positive, Primary, Scene,
};
use retune_solver::{Method, Settings, Window, e1_max};
use std::hint::black_box;

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("a positive number")
}

fn non_negative(value: f64) -> NonNegative {
    NonNegative::new(value).expect("a number not below zero")
}

fn nu(value: f64) -> PoissonRatio {
    PoissonRatio::new(value).expect("a Poisson's ratio")
}

/// The paper's structure with a damper `(k2, c2, D, C)`, R = 2 m, ω = 6.28 rad/s.
fn scene([k2, c2, d, c]: [f64; 4]) -> Scene {
    let contact = Contact {
        radius: positive(2.0),
        coefficient: positive(0.318),
        young_1: positive(2.1e11),
        poisson_1: nu(0.3),
        young_2: positive(2.21e7),
        poisson_2: nu(0.4),
        young_3: positive(2.1e11),
        poisson_3: nu(0.3),
        young_4: positive(2.05e7),
        poisson_4: nu(0.4),
    };
    let damper = Damper {
        mass: positive(60.0),
        stiffness: non_negative(k2),
        damping: non_negative(c2),
        rest_distance: non_negative(d),
        clearance: non_negative(c),
        contact,
    };
    Scene {
        primary: Primary {
            mass: positive(1000.0),
            damping: non_negative(452.0),
            stiffness: non_negative(3.95e4),
        },
        forcing: Forcing { amplitude: non_negative(800.0), frequency: non_negative(6.28) },
        damper: Some(damper),
    }
}

const TABLE_2: [f64; 4] = [215.0, 232.0, 0.06, 0.36];
const ROW_3: [f64; 4] = [220.375, 233.45, 0.060375, 0.36225];
const TMD: [f64; 4] = [600.0, 262.0, 2.08, 4.7];
const WHOLE: Window = Window { from: 0.0, to: 100.0 };

fn runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("E1max over 100 s");
    for (name, design) in [("SSVI, Table 2", TABLE_2), ("SSVI, Table 1 row 3", ROW_3)] {
        let scene = scene(design);
        let converged =
            e1_max(&scene, WHOLE, &Settings { rtol: 1e-12, ..Settings::default() }, f64::INFINITY);
        let converged = converged.expect("a run").value;
        for rtol in [2e-7, 1e-8, 1e-10] {
            let settings = Settings { rtol, ..Settings::default() };
            let value = e1_max(&scene, WHOLE, &settings, f64::INFINITY).expect("a run").value;
            let error = (value / converged - 1.0).abs();
            group.bench_function(format!("{name}, rtol {rtol:e} (error {error:.0e})"), |bencher| {
                bencher.iter(|| e1_max(black_box(&scene), WHOLE, &settings, f64::INFINITY));
            });
        }
    }
    let tmd = scene(TMD);
    group.bench_function("TMD", |bencher| {
        bencher.iter(|| e1_max(black_box(&tmd), WHOLE, &Settings::default(), f64::INFINITY));
    });
    let bare = Scene { damper: None, ..tmd };
    group.bench_function("no damper", |bencher| {
        bencher.iter(|| e1_max(black_box(&bare), WHOLE, &Settings::default(), f64::INFINITY));
    });
    group.sample_size(10);
    for rtol in [1e-6, 1e-8] {
        let settings = Settings { method: Method::Ode45, rtol, atol: 1e-3 * rtol, ..Settings::default() };
        let ssvi = scene(ROW_3);
        group.bench_function(format!("SSVI, Table 1 row 3, ode45, rtol {rtol:e}"), |bencher| {
            bencher.iter(|| e1_max(black_box(&ssvi), WHOLE, &settings, f64::INFINITY));
        });
    }
    group.finish();

    let damper = tmd.damper.expect("a damper");
    let coupled = Coupled::new(&tmd.primary, &tmd.forcing, &damper);
    criterion.bench_function("steady response at one frequency, TMD", |bencher| {
        bencher.iter(|| coupled.steady(black_box(6.28)));
    });
    let bare = Bare::new(&tmd.primary, &tmd.forcing);
    criterion.bench_function("steady response at one frequency, no damper", |bencher| {
        bencher.iter(|| bare.steady(black_box(6.28)));
    });
}

criterion_group!(benches, runs);
criterion_main!(benches);
