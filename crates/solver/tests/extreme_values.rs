//! Every parameter of a study at values that nobody means: a value or an error in bounded work, and an error's advice applies.

mod problems;

use problems::scenes::{Numbers, SSVI, TMD};
use retune_solver::{Method, Settings, SolverError, Window, e1_max, simulate};

const EXTREMES: [f64; 8] = [1e-300, 1e-150, 1e-20, 1e-6, 1e6, 1e20, 1e150, 1e300];

/// Every parameter of a study but t0, which is a place in the window.
const NAMES: [&str; 13] = ["m1", "c1", "k1", "m2", "k2", "c2", "D", "C", "P", "omega", "R", "q", "T"];

fn with(mut n: Numbers, name: &str, value: f64) -> (Numbers, Window) {
    let mut window = Window { from: 50.0, to: 100.0 };
    *match name {
        "m1" => &mut n.m1,
        "c1" => &mut n.c1,
        "k1" => &mut n.k1,
        "m2" => &mut n.m2,
        "k2" => &mut n.k2,
        "c2" => &mut n.c2,
        "D" => &mut n.d,
        "C" => &mut n.c,
        "P" => &mut n.p,
        "omega" => &mut n.omega,
        "R" => &mut n.r,
        "q" => &mut n.q,
        _ => &mut window.to,
    } = value;
    window.from = window.from.min(0.5 * window.to);
    (n, window)
}

/// An error, and what holds if its advice does.
fn check_advice(what: &str, numbers: &Numbers, window: Window, settings: &Settings, error: SolverError) {
    let text = error.to_string();
    let hybrid = settings.method == Method::Hybrid;
    assert!(!(hybrid && text.contains("hybrid")), "{what}: {text}");
    assert!(!((hybrid || settings.method.has_fixed_step()) && text.contains("rtol")), "{what}: {text}");
    let shorter = |to: f64| {
        let run = simulate(&numbers.scene(), Window { from: 0.0, to }, settings);
        assert!(
            run.is_ok() || matches!(run, Err(SolverError::Implausible { .. })),
            "{what}: T = {to}: {run:?}"
        );
    };
    match error {
        // A shorter run succeeds.
        SolverError::TooFast { h, .. } if h > 1e-100 => shorter(100.0 * h),
        SolverError::TooFast { .. } => {}
        SolverError::TooManySteps { t, .. } | SolverError::TooSlow { t, .. } => {
            assert!(text.contains("shorten T"), "{what}: {text}");
            if t > 0.0 {
                shorter(0.5 * t.min(window.to));
            }
        }
        SolverError::StepTooSmall { .. } | SolverError::Unstable { .. } => assert!(!hybrid, "{what}: {text}"),
        SolverError::Contact { .. } | SolverError::Implausible { .. } | SolverError::NonFinite { .. } => {}
        SolverError::Missed { .. } => panic!("{what}: {text}"),
    }
}

fn sweep(method: Method, max_steps: u64) {
    let settings = Settings { method, max_steps, ..Settings::default() };
    for (scene, base) in [("SSVI", SSVI), ("TMD", TMD)] {
        for name in NAMES {
            for value in EXTREMES {
                let what = format!("{} {scene} {name}={value:e}", method.name());
                let (numbers, window) = with(base, name, value);
                match simulate(&numbers.scene(), window, &settings) {
                    Ok(found) => {
                        assert!(found.work.steps <= max_steps, "{what}: {found:?}");
                        assert!(found.e1_max.value.is_finite(), "{what}: {found:?}");
                    }
                    Err(error) => {
                        println!("{what}: {error}");
                        check_advice(&what, &numbers, window, &settings, error);
                    }
                }
                let found = e1_max(&numbers.scene(), window, &settings, f64::INFINITY);
                if let Err(error) = found {
                    check_advice(&what, &numbers, window, &settings, error);
                }
            }
        }
    }
}

#[test]
#[ignore = "does not end at SSVI with m1 = 1e-20 or 1e-6: not found yet why"]
fn contract_extreme_values_end_with_a_value_or_with_advice_that_applies() {
    sweep(Method::Hybrid, 1_000_000);
}

#[test]
#[ignore = "does not end at SSVI with m1 = 1e-20 or 1e-6: not found yet why"]
fn contract_extreme_values_by_other_methods() {
    for method in [Method::Ode45, Method::Ode23s, Method::Dop853, Method::Rk4, Method::Euler] {
        sweep(method, 2_000);
    }
}

/// The default limit is 20 million steps: what needs many times as many is refused long before.
#[test]
fn contract_a_run_that_cannot_succeed_is_refused_at_once() {
    for numbers in [Numbers { p: 1e150, ..SSVI }, Numbers { m2: 1e-6, ..SSVI }, Numbers { k2: 1e20, ..SSVI }]
    {
        let found = simulate(&numbers.scene(), Window { from: 50.0, to: 100.0 }, &Settings::default());
        let Err(SolverError::TooSlow { steps, needed, .. }) = found else { panic!("{found:?}") };
        assert!(steps <= 300_000 && needed > 2e9, "{found:?}");
    }
}
