//! Every parameter of a study at values that nobody means: a value or an error in bounded work, and an error's advice applies.

use rayon::prelude::*;
use retune_solver::{Contacts, Method, Remedy, Settings, SolverError, Window, e1_max, simulate};
use retune_testkit::scenes::{Numbers, SSVI, TMD};

const EXTREMES: [f64; 8] = [1e-300, 1e-150, 1e-20, 1e-6, 1e6, 1e20, 1e150, 1e300];

/// Every parameter of a study but t0, which is a place in the window.
const NAMES: [&str; 13] = ["m1", "c1", "k1", "m2", "k2", "c2", "D", "C", "P", "omega", "R", "q", "T"];

fn with(mut n: Numbers, to: f64, name: &str, value: f64) -> (Numbers, Window) {
    let mut window = Window { from: 0.5 * to, to };
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

/// A run that failed, and that its advice is right: a shorter run or more steps help, what is to be lowered is the parameter that
/// nobody means, and the hybrid ends the run or says the same of itself.
fn check_advice(name: &str, numbers: &Numbers, window: Window, settings: &Settings, error: SolverError) {
    let (text, hybrid) = (error.to_string(), settings.method == Method::Hybrid);
    let what = format!("{} {name} {numbers:?} {window:?}: {text}", settings.method.name());
    let run = |to: f64, settings: &Settings| {
        simulate(&numbers.scene(), Window { from: window.from.min(0.5 * to), to }, settings)
    };
    let more = || run(window.to, &Settings { max_steps: 4 * settings.max_steps, ..*settings });
    let by_hybrid = || {
        if let Err(error) = run(window.to, &HYBRID) {
            check_advice(name, numbers, window, &HYBRID, error);
        }
    };
    let time = |error: &SolverError| match *error {
        SolverError::TooManySteps { t, .. } | SolverError::TooSlow { t, .. } => t,
        _ => f64::INFINITY,
    };
    match error {
        SolverError::TooManySteps { t, .. } => {
            assert!(text.ends_with("raise max_steps"), "{what}");
            let found = more();
            assert!(found.is_ok() || found.is_err_and(|error| time(&error) > t), "{what}: {found:?}");
        }
        SolverError::TooFast { remedy, .. } | SolverError::TooSlow { remedy, .. } => match remedy {
            Remedy::ShorterRun => {
                let to = match error {
                    SolverError::TooFast { h, .. } => 100.0 * h,
                    _ => 0.5 * time(&error).min(window.to),
                };
                assert!(name == "T" && run(to, settings).is_ok(), "{what}: {:?}", run(to, settings));
            }
            Remedy::Slower(fastest) => {
                assert!(hybrid && fastest.split('/').any(|one| one == name), "{what}");
            }
            Remedy::LessForce => assert!(hybrid && name == "P", "{what}"),
            Remedy::Hybrid => {
                assert!(!hybrid, "{what}");
                by_hybrid();
            }
        },
        SolverError::Contact { .. } => assert!(hybrid && ["R", "q"].contains(&name), "{what}"),
        SolverError::StepTooSmall { .. } | SolverError::Unstable { .. } => {
            assert!(!hybrid && text.ends_with("choose the hybrid solver"), "{what}");
            by_hybrid();
        }
        SolverError::NonFinite { .. } | SolverError::Implausible { .. } => assert!(!hybrid, "{what}"),
        SolverError::Missed { .. }
        | SolverError::RigidWalls { .. }
        | SolverError::Grazing { .. }
        | SolverError::NoPeriod { .. }
        | SolverError::NoDerivatives { .. } => {
            panic!("{what}")
        }
    }
}

const HYBRID: Settings = Settings {
    method: Method::Hybrid,
    contacts: Contacts::Located,
    rtol: 1e-10,
    atol: 1e-12,
    step: None,
    max_steps: 100_000,
};

fn sweep(method: Method, to: f64, max_steps: u64, every: usize) {
    let settings = Settings { method, max_steps, ..HYBRID };
    let check = |(scene, base): (&str, Numbers), name: &str| {
        for value in EXTREMES.into_iter().step_by(every) {
            let what = format!("{} {scene} {name}={value:e}", method.name());
            let (numbers, window) = with(base, to, name, value);
            match simulate(&numbers.scene(), window, &settings) {
                Ok(found) => {
                    assert!(found.work.steps <= max_steps, "{what}: {found:?}");
                    assert!(found.e1_max.value.is_finite(), "{what}: {found:?}");
                }
                Err(error) => check_advice(name, &numbers, window, &settings, error),
            }
            match e1_max(&numbers.scene(), window, &settings, f64::INFINITY) {
                Ok(found) => assert!(found.value.is_finite(), "{what}: {found:?}"),
                Err(error) => check_advice(name, &numbers, window, &settings, error),
            }
        }
    };
    NAMES
        .into_par_iter()
        .for_each(|name| [("SSVI", SSVI), ("TMD", TMD)].into_iter().for_each(|scene| check(scene, name)));
}

#[test]
fn contract_extreme_values_end_with_a_value_or_with_advice_that_applies() {
    sweep(Method::Hybrid, 100.0, HYBRID.max_steps, 1);
}

#[test]
fn contract_extreme_values_by_other_methods() {
    for method in [Method::Ode45, Method::Ode23s, Method::Ode23, Method::Dop853, Method::Rk4, Method::Euler] {
        sweep(method, 2.0, 2_500, 3);
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
