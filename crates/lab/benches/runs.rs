//! Cost of a run of 100 s on one core, beside what it must not cost. `just lab bench`.

use criterion::{Criterion, criterion_group, criterion_main};
use retune_model::{Bare, Coupled, Parameter, Scene};
use retune_solver::observe::{PrimaryEnergy, RunningMaximum, Unobserved};
use retune_solver::{Follower, Method, Motion, Phase, Settings, Tangent, Window, e1_max};
use retune_testkit::scenes::{Numbers, ROW3, SSVI, TMD};
use std::hint::black_box;

const WHOLE: Window = Window { from: 0.0, to: 100.0 };

fn runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("E1max over 100 s");
    for (name, numbers) in [("SSVI, Table 2", SSVI), ("SSVI, Table 1 row 3", ROW3)] {
        let scene = numbers.scene();
        let converged =
            e1_max(&scene, WHOLE, &Settings { rtol: 1e-12, ..Settings::default() }, f64::INFINITY);
        let converged = converged.expect("a run").value;
        for rtol in [1e-6, 1e-9, 1e-10] {
            let settings = Settings { rtol, ..Settings::default() };
            let value = e1_max(&scene, WHOLE, &settings, f64::INFINITY).expect("a run").value;
            let error = (value / converged - 1.0).abs();
            group.bench_function(format!("{name}, rtol {rtol:e} (error {error:.0e})"), |bencher| {
                bencher.iter(|| e1_max(black_box(&scene), WHOLE, &settings, f64::INFINITY));
            });
        }
    }
    let tmd = TMD.scene();
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
        let ssvi = ROW3.scene();
        group.bench_function(format!("SSVI, Table 1 row 3, ode45, rtol {rtol:e}"), |bencher| {
            bencher.iter(|| e1_max(black_box(&ssvi), WHOLE, &settings, f64::INFINITY));
        });
    }
    group.finish();

    let damper = tmd.damper.expect("a damper");
    let coupled = Coupled::new(&tmd.primary, &tmd.forcing, &damper);
    criterion.bench_function("steady response at one frequency, TMD", |bencher| {
        bencher.iter(|| coupled.steady(black_box(TMD.omega)));
    });
    criterion.bench_function("steady E1max, the worst over 5 to 8 rad/s, TMD", |bencher| {
        bencher.iter(|| coupled.steady_e1_max(black_box([5.0, 8.0])));
    });
    criterion.bench_function("steady stroke, the worst over 5 to 8 rad/s, TMD", |bencher| {
        bencher.iter(|| coupled.steady_stroke_max(black_box([5.0, 8.0])));
    });
    let bare = Bare::new(&tmd.primary, &tmd.forcing);
    criterion.bench_function("steady response at one frequency, no damper", |bencher| {
        bencher.iter(|| bare.steady(black_box(TMD.omega)));
    });
}

/// A run with its derivatives beside the same run without: by the first state, and by all ten parameters as well.
fn derivatives(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("a run over 100 s");
    for (name, numbers) in [("Table 2", SSVI), ("Table 1 row 3", ROW3)] {
        let system = numbers.coupled();
        let settings = Settings::default();
        let start = Motion { t: 0.0, y: system.start(), phase: Phase::Flight };
        group.bench_function(format!("{name}, E1max alone"), |bencher| {
            let mut follower = Follower::new(&system, &settings, WHOLE.to);
            bencher.iter(|| {
                let mut e1 = RunningMaximum::new(PrimaryEnergy::new(&system), f64::INFINITY);
                follower.propagate(black_box(start), WHOLE.to, &mut e1).map(|_| e1.record())
            });
        });
        for parameters in [&[][..], &[Parameter::Omega], &Parameter::VARIED] {
            group.bench_function(
                format!("{name}, derivatives by {} parameters", parameters.len()),
                |bencher| {
                    let mut tangent = Tangent::new(&system, &settings, WHOLE.to, parameters);
                    bencher.iter(|| tangent.propagate(black_box(start), WHOLE.to, &mut Unobserved));
                },
            );
        }
    }
    group.finish();
}

/// One damper with every kind of wall: Hertz's without loss, with λ, with one restitution at every speed, and rigid.
fn walls(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("E1max over 100 s, e = 0.7");
    for (name, numbers) in [("Table 2", SSVI), ("Table 1 row 3", ROW3)] {
        for (walls, numbers) in [
            ("no loss", numbers),
            ("lambda", Numbers { lambda: 0.45, ..numbers }),
            ("restitution", Numbers { e: 0.7, ..numbers }),
            ("rigid", Numbers { rigid: Some(0.7), ..numbers }),
        ] {
            let scene = numbers.scene();
            for rtol in [1e-6, 1e-10] {
                let settings = Settings { rtol, ..Settings::default() };
                group.bench_function(format!("{name}, {walls}, rtol {rtol:e}"), |bencher| {
                    bencher.iter(|| e1_max(black_box(&scene), WHOLE, &settings, f64::INFINITY));
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, runs, walls, derivatives);
criterion_main!(benches);
