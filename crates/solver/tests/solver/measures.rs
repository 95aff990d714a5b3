//! What is measured of a run beside its energy: one quantity alone, as a search asks for it, is that of a full simulation.

use retune_model::{Bare, Coupled, Measure, Scene};
use retune_solver::{Also, Ask, Method, Settings, Settle, Window, extremes, settled, simulate};
use retune_testkit::scenes::{Numbers, SSVI, TMD};

const WINDOW: Window = Window { from: 2.0, to: 30.0 };

fn asked(scene: &Scene, measure: Measure, settings: &Settings, cutoff: f64) -> f64 {
    let ask = Ask { measure, cutoff, ..Ask::default() };
    extremes(scene, WINDOW, settings, ask).expect("a run").largest.value
}

#[test]
fn exact_every_measure_is_that_of_a_full_simulation() {
    for scene in [SSVI.scene(), TMD.scene(), Numbers { omega: 5.0, ..SSVI }.scene(), SSVI.bare_scene()] {
        for method in [Method::Hybrid, Method::Dop853] {
            let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
            let run = simulate(&scene, WINDOW, &settings).expect("a run");
            for measure in Measure::ALL {
                let (found, all) = (asked(&scene, measure, &settings, f64::INFINITY), run.largest(measure));
                assert!((found - all).abs() <= 1e-12 * all, "{method:?} {measure:?} {found} {all}");
            }
        }
    }
}

/// Walls beside it change no value, and a run that ends at its cutoff has passed it.
#[test]
fn contract_a_cutoff_is_passed_and_walls_change_nothing() {
    let scene = SSVI.scene();
    let settings = Settings::default();
    for measure in Measure::ALL {
        let full = asked(&scene, measure, &settings, f64::INFINITY);
        let ask = Ask { measure, also: Some(Also::walls(0.0)), ..Ask::default() };
        let beside = extremes(&scene, WINDOW, &settings, ask).expect("a run");
        assert_eq!(beside.largest.value, full, "{measure:?}");
        assert!(WINDOW.from <= beside.largest.time && beside.largest.time <= WINDOW.to);
        let cut = asked(&scene, measure, &settings, 0.5 * full);
        assert!(cut > 0.5 * full && cut <= full, "{measure:?} {cut} {full}");
    }
}

/// A damper that touches nothing, and none: the closed form and a late window agree.
#[test]
fn exact_settled_measures_of_linear_scenes_are_those_of_the_closed_form() {
    let late = Window { from: 900.0, to: 1000.0 };
    for scene in [TMD.scene(), TMD.bare_scene()] {
        let bare = Bare::new(&scene.primary, &scene.forcing);
        let omega = scene.forcing.frequency.get();
        let steady = match &scene.damper {
            None => bare.steady(omega),
            Some(damper) => Coupled::new(&scene.primary, &scene.forcing, damper).steady(omega),
        };
        for measure in Measure::ALL {
            let ask = Ask { measure, ..Ask::default() };
            let expected = steady.largest(&bare, omega, measure);
            let settings = Settings::default();
            let found = settled(&scene, late, Settle::default(), &settings, ask).expect("a run").largest;
            assert_eq!(found.value, expected, "{measure:?}");
            let run = extremes(&scene, late, &settings, ask).expect("a run").largest;
            assert!((run.value - expected).abs() <= 1e-9 * expected, "{measure:?} {run:?} {expected}");
        }
    }
}

/// Of a motion with impacts that repeats, a block once it has settled is a late window.
#[test]
fn contract_settled_measures_of_impacts_are_those_of_a_late_window() {
    let scene = Numbers { omega: 5.958, ..SSVI }.scene();
    let (late, all) = (Window { from: 300.0, to: 400.0 }, Window { from: 50.0, to: 400.0 });
    for measure in Measure::ALL {
        let ask = Ask { measure, ..Ask::default() };
        let settings = Settings::default();
        let found = settled(&scene, all, Settle::default(), &settings, ask).expect("a run");
        let run = extremes(&scene, late, &settings, ask).expect("a run").largest.value;
        assert!(
            found.settled && (found.largest.value / run - 1.0).abs() < 1e-3,
            "{measure:?} {found:?} {run}"
        );
    }
}
