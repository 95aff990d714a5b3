//! Any valid scene: a finite answer or a typed error, within the work allowed. What the fuzzer found stands here as well.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use retune_model::{NonNegative, Scene};
use retune_solver::{Method, SceneKind, Settings, SolverError, Window, e1_max, simulate};
use retune_testkit::anything::{Anything, DRAWS};
use retune_testkit::hunt::scenes::{apart, both, scenes};
use retune_testkit::scenes::{Numbers, SSVI};

/// The same draws on every machine: a test that fails by luck is none.
fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(7),
        ..ProptestConfig::default()
    }
}

fn draws(width: f64) -> impl Strategy<Value = [f64; DRAWS]> {
    let any = prop::collection::vec(0.0..=1.0_f64, DRAWS);
    any.prop_map(move |all| {
        let mut draws = [0.0; DRAWS];
        for (i, (place, draw)) in draws.iter_mut().zip(all).enumerate() {
            // The scene's own numbers about the paper's, the way that it is run as it comes.
            *place = if i < 16 { 0.5 + width * (draw - 0.5) } else { draw };
        }
        draws
    })
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn invariant_any_scene_has_a_finite_answer_or_a_typed_error(draws in draws(1.0)) {
        Anything::new(&draws).check();
    }

    /// A scene that is written and read again is the same to the last bit.
    #[test]
    fn invariant_any_scene_is_read_as_it_was_written(draws in draws(1.0)) {
        let scene = Anything::new(&draws).scene;
        let text = serde_json::to_string(&scene).expect("JSON");
        let again: Scene = serde_json::from_str(&text).expect("a scene");
        assert_eq!(again, scene, "{}", text);
    }

    #[test]
    fn invariant_scenes_about_the_papers_have_too(draws in draws(0.2)) {
        Anything::new(&draws).check();
    }
}

/// The inputs that the fuzzer kept because each reaches code that no other did, and all that once failed.
#[test]
fn invariant_the_fuzzers_corpus_holds() {
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/numbers");
    let mut seen = 0;
    for entry in std::fs::read_dir(corpus).expect("the corpus") {
        let bytes = std::fs::read(entry.expect("an entry").path()).expect("an input");
        Anything::of_bytes(&bytes).check();
        seen += 1;
    }
    assert!(seen > 50, "{seen}");
}

/// Contacts that springs, dashpots and the force rule, not Hertz's law: their motion was lost at the end of the contact, and only
/// energy out of nothing was noticed.
#[test]
fn reference_contacts_that_other_forces_rule_agree_with_dop853() {
    let base = Numbers { p: 1.0, ..SSVI };
    for numbers in [
        // A light structure with a strong dashpot drags a heavy damper: a sustained contact that takes seconds to end.
        Numbers {
            m1: 442.5,
            c1: 4.761e5,
            k1: 49.89,
            p: 1.395e6,
            omega: 4.018e-3,
            m2: 2.47e5,
            k2: 0.04286,
            c2: 3049.0,
            d: 7.642e-4,
            c: 394.7,
            ..base
        },
        Numbers {
            m1: 6.223e6,
            c1: 7.855e8,
            k1: 4.456e8,
            p: 1.312e4,
            omega: 2.526e-5,
            m2: 2.727e6,
            k2: 9.096e4,
            c2: 8.144e5,
            d: 9.561e-8,
            c: 1.126e6,
            ..base
        },
        Numbers {
            m1: 2.607e8,
            c1: 1.426e10,
            k1: 63.81,
            p: 4.434e7,
            omega: 3.18,
            m2: 9.725e5,
            k2: 3.9e-5,
            c2: 1.248e9,
            d: 9.434e-8,
            c: 1.989e5,
            ..base
        },
        Numbers {
            m1: 1.057e6,
            c1: 98.14,
            k1: 14.23,
            p: 4.475e9,
            omega: 0.04104,
            m2: 126.7,
            k2: 3.154e6,
            c2: 5.792e4,
            d: 5.178e-3,
            c: 8544.0,
            ..base
        },
    ] {
        for weaker in [1.0, 1e-6, 1e-12] {
            let numbers = Numbers { young: numbers.young.map(|young| young * weaker), ..numbers };
            let scene = numbers.scene();
            for rtol in [1e-6, 1e-9, 1e-12] {
                let [own, other] =
                    both(&scene, 10.0, rtol, [15_000, 100_000]).map(|found| found.expect("a run"));
                assert!(other.scene == SceneKind::Contact && other.impacts[0] > 0);
                let energy = apart(own.e1_max.value, other.e1_max.value);
                assert!(energy < rtol.max(1e-9), "rtol {rtol}: {energy:e}, {own:?}, {other:?}");
                assert_eq!(own.impacts, other.impacts, "{own:?}, {other:?}");
            }
        }
    }
}

#[test]
fn reference_any_scene_that_touches_a_wall_agrees_with_dop853() {
    let mut runner = TestRunner::new(config(1));
    let mut drawn_scene = |width: f64| {
        let mut draws = draws(width).new_tree(&mut runner).expect("draws").current();
        draws[26] = 0.9; // with a damper
        Anything::new(&draws).scene
    };
    let widths = [0.4, 0.7, 1.0].into_iter().flat_map(|width| std::iter::repeat_n(width, 50));
    scenes(&widths.map(&mut drawn_scene).collect::<Vec<_>>()).passes();
}

/// Found by the fuzzer: a contact that begins at rest and is hardly felt was followed past the end of the run.
#[test]
fn reference_a_contact_that_is_hardly_felt_ends_with_the_run() {
    let numbers =
        Numbers { m1: 39.5, c1: 13.67, k1: 2.445e5, p: 1.053e5, omega: 0.01445, m2: 12_440.0, ..SSVI };
    let numbers = Numbers { k2: 100.5, c2: 19.66, d: 0.02007, c: 0.0, ..numbers };
    let scene = Numbers { young: SSVI.young.map(|young| young * 1e-12), ..numbers }.scene();
    for to in [0.001, 0.01] {
        let [own, other] = both(&scene, to, 1e-9, [15_000, 100_000]).map(|found| found.expect("a run"));
        assert!(apart(own.e1_max.value, other.e1_max.value) < 1e-10, "{own:?}, {other:?}");
    }
}

/// Found by the fuzzer: the state is finite and its square is not.
#[test]
fn regress_an_infinite_energy_is_an_error() {
    let settings = Settings { method: Method::Euler, ..Settings::default() };
    let mut scene = SSVI.scene();
    scene.primary.stiffness = NonNegative::new(1e20).expect("a stiffness");
    let window = Window { from: 0.0, to: 0.02 };
    let found = e1_max(&scene, window, &settings, f64::INFINITY);
    assert!(matches!(found, Err(SolverError::Unstable { t }) if t <= window.to), "{found:?}");
    let found = simulate(&scene, window, &settings);
    assert!(matches!(found, Err(SolverError::Unstable { t }) if t <= window.to), "{found:?}");
}

/// Found by the fuzzer: a damper that rests on a wall at t = 0 and is in contact was called linear, because it never touches down.
#[test]
fn regress_a_damper_that_rests_on_a_wall_is_in_contact() {
    let scene = Numbers { d: 0.0, ..SSVI }.scene();
    let found = simulate(&scene, Window { from: 0.0, to: 0.05 }, &Settings::default()).expect("a run");
    assert!(found.impacts == [0; 2] && found.force_max != [0.0; 2], "{found:?}");
    assert_eq!(found.scene, SceneKind::Contact);
}

/// Found by the fuzzer: a stiff linear scene whose steps are below the spacing of numbers late in its run did not end.
#[test]
fn regress_steps_below_the_spacing_of_time_end() {
    let numbers = Numbers { m1: 3.17e-5, c1: 0.0, k1: 3.71e11, m2: 1.9e-6, k2: 3.6e-4, c2: 7e9, ..SSVI };
    let scene = Numbers { omega: 0.0, d: 1.9e6, c: 1.14e7, ..numbers }.scene();
    let window = Window { from: 99.85, to: 99.95 };
    let found = e1_max(&scene, window, &Settings::default(), f64::INFINITY);
    assert!(matches!(found, Err(SolverError::TooFast { t, .. }) if t >= 99.0 && t < window.to), "{found:?}");
}
