//! The largest values beside E1max: strokes, forces, phases of the force, and settled motions.

use retune_model::{Bare, Coupled, Scene};
use retune_solver::{
    Also, Ask, Extremes, Method, Rows, Settings, Settle, Window, extremes, settled, simulate, trajectory,
};
use retune_testkit::scenes::{Numbers, SSVI, TMD};
use std::f64::consts::PI;

const SHORT: Window = Window { from: 2.0, to: 12.0 };

fn seen(scene: &Scene, method: Method, phase: f64, walls: bool) -> Extremes {
    let settings = Settings { method, ..Settings::default() };
    let also = walls.then(|| Also::walls(SHORT.from));
    extremes(scene, SHORT, &settings, Ask { phase, also, ..Ask::default() }).expect("a run")
}

#[test]
fn contract_stroke_and_force_are_those_of_the_motion() {
    for scene in [SSVI.scene(), TMD.scene()] {
        let found = seen(&scene, Method::Hybrid, 0.0, true);
        let run = simulate(&scene, SHORT, &Settings::default()).expect("a run");
        let rest = scene.damper.expect("a damper").rest_distance.get();
        let mut largest = 0.0_f64;
        trajectory(&scene, SHORT, &Settings::default(), Rows::every(1e-4), &mut |sample| {
            largest = largest.max((sample.state[2] - sample.state[0] - rest).abs());
        })
        .expect("a run");
        assert!(largest <= found.stroke() && found.stroke() - largest < 1e-6, "{largest} {}", found.stroke());
        assert_eq!(found.force(), run.force_max[0].max(run.force_max[1]));
        assert_eq!(found.largest, run.e1_max);
    }
    assert_eq!(seen(&SSVI.scene(), Method::Hybrid, 0.0, false).stroke(), 0.0);
}

/// Half a turn of the force mirrors a motion without contacts; a whole turn changes nothing.
#[test]
fn exact_half_a_period_of_the_force_mirrors_a_linear_motion() {
    let bare = Scene { damper: None, ..TMD.scene() };
    for scene in [bare, TMD.scene()] {
        for method in [Method::Hybrid, Method::Dop853] {
            let [here, opposite, quarter] =
                [0.0, PI, 0.5 * PI].map(|phase| seen(&scene, method, phase, false).largest);
            assert!((here.value / opposite.value - 1.0).abs() < 1e-7, "{here:?} {opposite:?}");
            assert!((here.time - opposite.time).abs() < 1e-4, "{here:?} {opposite:?}");
            assert!((here.value / quarter.value - 1.0).abs() > 1e-3, "{here:?} {quarter:?}");
        }
    }
    let [here, round] =
        [0.0, 2.0 * PI].map(|phase| seen(&SSVI.scene(), Method::Hybrid, phase, false).largest);
    assert!((here.value / round.value - 1.0).abs() < 1e-7, "{here:?} {round:?}");
}

#[test]
fn reference_a_phase_with_contacts_is_the_same_by_another_method() {
    let [a, b] = [Method::Hybrid, Method::Dop853].map(|method| seen(&SSVI.scene(), method, 1.0, true));
    assert!((a.largest.value / b.largest.value - 1.0).abs() < 1e-6, "{a:?} {b:?}");
    assert!(
        (a.stroke() / b.stroke() - 1.0).abs() < 1e-6 && (a.force() / b.force() - 1.0).abs() < 1e-4,
        "{a:?} {b:?}"
    );
    let zero = seen(&SSVI.scene(), Method::Hybrid, 0.0, true);
    assert!((a.largest.value / zero.largest.value - 1.0).abs() > 1e-3);
}

const LONG: Window = Window { from: 50.0, to: 400.0 };

fn rest(scene: &Scene, method: Method, settle: Settle) -> Extremes {
    let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
    settled(scene, LONG, settle, &settings, Ask { also: Some(Also::walls(f64::INFINITY)), ..Ask::default() })
        .expect("a run")
}

#[test]
fn exact_a_linear_motion_settles_at_its_steady_response() {
    let (scene, settle) = (TMD.scene(), Settle { tolerance: 1e-9, ..Settle::default() });
    let system = Coupled::new(&scene.primary, &scene.forcing, &TMD.damper());
    let steady = system.steady(TMD.omega);
    for method in [Method::Hybrid, Method::Dop853] {
        let found = rest(&scene, method, settle);
        assert!(found.settled);
        assert!((found.largest.value / steady.e1_max - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found.stroke() / steady.stroke() - 1.0).abs() < 1e-6 && found.force() == 0.0, "{found:?}");
    }
    let bare = rest(&Scene { damper: None, ..scene }, Method::Hybrid, settle);
    assert_eq!(bare.largest.value, Bare::new(&scene.primary, &scene.forcing).steady(TMD.omega).e1_max);
}

/// Table 2's damper repeats after two periods of this force, with one impact.
#[test]
fn contract_a_motion_with_contacts_settles_at_what_a_late_window_shows() {
    let scene = Numbers { omega: 5.958, ..SSVI }.scene();
    let found = rest(&scene, Method::Hybrid, Settle::default());
    assert!(found.settled && found.force() > 0.0, "{found:?}");
    let late = Window { from: 300.0, to: 400.0 };
    let ask = Ask { also: Some(Also::walls(late.from)), ..Ask::default() };
    let run = extremes(&scene, late, &Settings::default(), ask).expect("a run");
    assert!((found.largest.value / run.largest.value - 1.0).abs() < 1e-4, "{found:?} {run:?}");
    assert!((found.stroke() / run.stroke() - 1.0).abs() < 1e-3, "{found:?} {run:?}");
}

/// More blocks than there are must agree: the value is that of the window, and the answer says that it has not settled.
#[test]
fn contract_a_motion_that_has_not_settled_is_marked_so() {
    let numbers = Numbers { omega: 5.958, ..SSVI };
    let scene = numbers.scene();
    let never = rest(&scene, Method::Hybrid, Settle { blocks: 1000, ..Settle::default() });
    assert!(!never.settled);
    // The first block that begins after 50 s does so at the eighth of 6 periods.
    let from = 8.0 * 6.0 * 2.0 * PI / numbers.omega;
    let window = Window { from, ..LONG };
    let ask = Ask { also: Some(Also::walls(from)), ..Ask::default() };
    let run = extremes(&scene, window, &Settings::default(), ask).expect("a run");
    assert!((never.largest.value / run.largest.value - 1.0).abs() < 1e-6, "{never:?} {run:?}");
}

/// The largest energy lies at an end of some of these windows, and its time must not leave them by rounding.
#[test]
fn contract_a_phase_is_no_error() {
    for (omega, window) in
        [(SSVI.omega, Window { from: 0.0, to: 0.9 }), (3.2, Window { from: 3.0, to: 12.0 })]
    {
        for scene in [SSVI, TMD].map(|numbers| Numbers { omega, ..numbers }.scene()) {
            for phase in (1..100).map(|i| 0.02 * PI * f64::from(i)) {
                let ask = Ask { phase, ..Ask::default() };
                let found = extremes(&scene, window, &Settings::default(), ask);
                assert!(found.is_ok(), "{omega} {phase} {found:?}");
            }
        }
    }
}

/// Stroke and force are those from any moment on: before the window, in it, inside a step or a contact.
#[test]
fn contract_stroke_and_force_are_observed_from_the_time_asked_for() {
    let scene = SSVI.scene();
    let mut largest = f64::INFINITY;
    let mut falls = 0;
    for from in (0..60).map(|i| 0.199 * f64::from(i)) {
        let window = Window { from, ..SHORT };
        let run = simulate(&scene, window, &Settings::default()).expect("a run");
        let ask = Ask { also: Some(Also::walls(from)), ..Ask::default() };
        let found = extremes(&scene, SHORT, &Settings::default(), ask).expect("a run");
        assert_eq!(found.largest, simulate(&scene, SHORT, &Settings::default()).expect("a run").e1_max);
        let force = run.force_max[0].max(run.force_max[1]);
        assert!((found.stroke() / run.spring_deflection_max - 1.0).abs() < 1e-8, "{from} {found:?} {run:?}");
        assert!((found.force() - force).abs() <= 1e-6 * force, "{from} {found:?} {run:?}");
        falls += u32::from(found.force() < largest);
        largest = found.force();
    }
    assert!(falls > 3, "{falls}");
}

/// A damper that stays off its walls settles in closed form, but its stroke on the way there is that of the run.
#[test]
fn contract_the_stroke_before_a_closed_form_counts() {
    let numbers = Numbers { omega: 5.0, c2: 40.0, k2: 2000.0, ..TMD };
    let scene = numbers.scene();
    let stroke = |walls| {
        let ask = Ask { also: Some(Also::walls(walls)), ..Ask::default() };
        settled(&scene, LONG, Settle::default(), &Settings::default(), ask).expect("a run").stroke()
    };
    let run = simulate(&scene, Window { from: 0.0, ..LONG }, &Settings::default()).expect("a run");
    let steady = numbers.coupled().steady(numbers.omega).stroke();
    assert!((stroke(0.0) / run.spring_deflection_max - 1.0).abs() < 1e-9 && stroke(0.0) > 1.1 * steady);
    assert_eq!(stroke(f64::INFINITY), steady);
}

/// Off resonance the transient is above what follows: a window that begins later knows nothing of it, with a damper or without.
#[test]
fn contract_a_window_is_observed_and_nothing_before_it() {
    let numbers = Numbers { omega: 5.0, ..TMD };
    for scene in [numbers.scene(), numbers.bare_scene()] {
        for method in [Method::Hybrid, Method::Dop853] {
            let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
            let late = Window { from: 30.0, to: 40.0 };
            let found = simulate(&scene, late, &settings).expect("a run").e1_max;
            let all = simulate(&scene, Window { from: 0.0, ..late }, &settings).expect("a run").e1_max;
            assert!(all.value > 1.2 * found.value && found.time >= 30.0, "{method:?} {all:?} {found:?}");
            let mut largest = 0.0_f64;
            trajectory(&scene, late, &settings, Rows::every(1e-3), &mut |row| largest = largest.max(row.e1))
                .expect("a run");
            assert!(largest <= found.value * (1.0 + 1e-9) && largest > found.value * (1.0 - 1e-4));
        }
    }
}
