//! `design`: from a structure to two dampers, on structures of very different size.

use retune_jobs::design::{Requirements, design};
use retune_jobs::tune::optimize;
use retune_jobs::{Error, Request, Silent};
use retune_model::{Coupled, Design, Parameter};
use retune_optim::{Options, Scaling, minimize};
use retune_solver::{Method, Settings, Window, e1_max};
use retune_study::{Refine, Study};
use retune_testkit::desk::Desk;
use retune_testkit::observers::{good, refused};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::ops::ControlFlow;

/// The example of the README, a machine foundation of 5 t at 12 Hz, a bench model of 2 kg at 25 Hz.
fn structures() -> [Requirements; 3] {
    let example = Requirements {
        m1: 500.0,
        k1: 2e4,
        c1: 100.0,
        force: 800.0,
        band: [5.0, 8.0],
        mass: 25.0,
        stroke: None,
        k2_max: None,
        k1_error: None,
    };
    let at = |m1: f64, hertz: f64, share: f64| {
        let natural = TAU * hertz;
        let k1 = m1 * natural * natural;
        let band = [0.8 * natural, 1.25 * natural];
        Requirements {
            m1,
            k1,
            c1: 0.02 * m1 * natural,
            force: 0.01 * k1 * 1e-3,
            band,
            mass: share * m1,
            ..example.clone()
        }
    };
    [example.clone(), at(5000.0, 12.0, 0.05), at(2.0, 25.0, 0.1)]
}

fn searched(study: &Study) -> Value {
    let desk = Desk::new();
    let order = Request::new(&desk.path("none.json")).order("design");
    let (optimum, results) = good(optimize(study, &desk.path("out"), &order, &Silent));
    drop(results);
    json!(optimum)
}

/// The worst steady energy over the band is a closed form; another search of it, from Den Hartog's damper, finds the same optimum.
#[test]
fn reference_the_tmd_of_a_design_is_the_optimum_of_the_closed_form() {
    for requirements in structures() {
        let study = good(requirements.tmd());
        let found = searched(&study);
        let damper = study.scene.damper.expect("a damper");
        let worst = |x: &[f64], _: f64| {
            let mut damper = damper;
            let [k2, c2] = [x[0], x[1]].map(retune_model::NonNegative::new);
            let (Ok(k2), Ok(c2)) = (k2, c2) else { return f64::INFINITY };
            (damper.stiffness, damper.damping) = (k2, c2);
            Coupled::new(&study.scene.primary, &study.scene.forcing, &damper)
                .steady_e1_max(requirements.band)
                .value
        };
        let start = [damper.stiffness.get(), damper.damping.get()];
        let options = Options { scaling: Scaling::Start, tol_x: 1e-9, tol_fun: 1e-15, ..Options::default() };
        let own = minimize(worst, &start, options, |_| ControlFlow::Continue(())).expect("an optimum");
        let e1_max = found["E1max"].as_f64().expect("a number");
        assert!((e1_max / own.value - 1.0).abs() < 1e-8, "{e1_max} {} {requirements:?}", own.value);
        for (name, value) in [("k2", own.x[0]), ("c2", own.x[1])] {
            let found = found[name].as_f64().expect("a number");
            assert!((found / value - 1.0).abs() < 1e-3, "{name} {found} {value} {requirements:?}");
        }
    }
}

/// The worst run of the SSVI NES by methods that share nothing with the hybrid but the equations.
#[test]
fn reference_the_ssvi_nes_of_a_design_has_the_energy_that_other_methods_find() {
    for requirements in structures() {
        let mut study = good(requirements.ssvi());
        let optimize = study.optimize.as_mut().expect("a search");
        optimize.surf = None;
        optimize.refine = Refine { max_fun_evals: Some(12), ..optimize.refine };
        optimize.objective.omega.as_mut().expect("a band").samples = 7;
        optimize.objective.starts = Some(1);
        // A fifth of the run: descents from a damper that rests on a wall are long.
        let fifth = |x: f64| 0.2 * x;
        study.window.t0 = retune_model::NonNegative::new(fifth(study.window.t0.get())).expect("a time");
        study.window.end = retune_model::Positive::new(fifth(study.window.end.get())).expect("a time");
        study.solver.search_rtol = Some(1e-6);
        let found = searched(&study);
        let number = |name: &str| found[name].as_f64().expect("a number");
        assert!(number("E1max") < number("E1max_none"), "{found}");
        // Twenty periods, so that not even a chaotic motion makes more of a rounding error than the tolerance below.
        let value = |parameter: Parameter| found[parameter.symbol()].as_f64().unwrap_or(f64::NAN);
        let design = Design::new(value).expect("a design");
        let found_scene = study.scene_at(&design).expect("a damper");
        // The damper that was found, and the one where the search starts, which strikes its walls.
        let worst = found["objective"]["worst_omega"].as_f64().expect("a number");
        let omegas = [requirements.band[0], worst, requirements.natural_frequency()];
        let mut impacts = 0;
        for (mut scene, omega) in
            [found_scene, study.scene].into_iter().flat_map(|scene| omegas.map(|omega| (scene, omega)))
        {
            scene.forcing.frequency = retune_model::NonNegative::new(omega).expect("a frequency");
            let window = Window { from: 0.0, to: 20.0 * TAU / requirements.natural_frequency() };
            let [own, other] = [(Method::Hybrid, 1e-10), (Method::Dop853, 1e-12)].map(|(method, rtol)| {
                let settings = Settings { method, rtol, atol: 1e-14, ..Settings::default() };
                e1_max(&scene, window, &settings, f64::INFINITY).expect("a run").value
            });
            assert!((own / other - 1.0).abs() < 1e-6, "{own} {other} at {omega}: {requirements:?}");
            let run = retune_solver::simulate(&scene, window, &Settings::default()).expect("a run");
            impacts += run.impacts.iter().sum::<u64>();
        }
        assert!(impacts > 3, "{impacts}: {requirements:?}");
    }
}

#[test]
fn contract_wishes_that_cannot_be_are_refused_by_name() {
    let [requirements, ..] = structures();
    let desk = Desk::new();
    let said = |requirements: &Requirements| {
        let request = Request { out: Some(desk.path("out")), ..Request::new(&desk.path("out")) };
        match refused(design(requirements, &request, &Silent)) {
            Error::Rule { name, rule } => format!("{name}: {rule}"),
            other => panic!("{other}"),
        }
    };
    for (requirements, words) in [
        (Requirements { m1: -1.0, ..requirements.clone() }, "design: --m1: -1 is not allowed here"),
        (
            Requirements { band: [8.0, 5.0], ..requirements.clone() },
            "design: --band: 8 to 5 rad/s is not allowed here",
        ),
        (Requirements { mass: 501.0, ..requirements.clone() }, "design: --mass: 501 is not allowed here"),
        (
            Requirements { k1_error: Some(10.0), ..requirements.clone() },
            "design: --k1-error: 10 is not allowed here",
        ),
        (
            Requirements { stroke: Some(f64::NAN), ..requirements.clone() },
            "design: --stroke: NaN is not allowed here",
        ),
    ] {
        let sentence = said(&requirements);
        assert!(sentence.starts_with(words), "{sentence}");
    }
    assert!(desk.names(".").is_empty(), "nothing is left behind");
}
