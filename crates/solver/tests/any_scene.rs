//! Any valid scene: a finite answer or a typed error, within the work allowed. What the fuzzer found stands here as well.

mod anything;

use anything::scenes::{Numbers, SSVI};
use anything::{Anything, DRAWS};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use retune_model::NonNegative;
use retune_solver::{Method, SceneKind, Settings, SolverError, Window, e1_max, simulate};

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
    #![proptest_config(config(600))]

    #[test]
    fn invariant_any_scene_has_a_finite_answer_or_a_typed_error(draws in draws(1.0)) {
        Anything::new(&draws).check();
    }

    /// What is written is read again to the last bit.
    #[test]
    fn invariant_any_scene_is_read_as_it_was_written(draws in draws(1.0)) {
        let scene = Anything::new(&draws).scene;
        let text = serde_json::to_string(&scene).expect("JSON");
        let again: retune_model::Scene = serde_json::from_str(&text).expect("a scene");
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

/// Parameters so far apart that the exact method loses all digits: it says so.
#[test]
fn regress_energy_out_of_nothing_is_an_error() {
    let mut found = 0;
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/numbers");
    for entry in std::fs::read_dir(corpus).expect("the corpus") {
        let bytes = std::fs::read(entry.expect("an entry").path()).expect("an input");
        let Anything { scene, window, settings } = Anything::of_bytes(&bytes);
        let end = e1_max(&scene, window, &settings, f64::INFINITY);
        if let Err(SolverError::Implausible { value, time, most, .. }) = end {
            let late = !(window.from..=window.to).contains(&time);
            assert!(value < 0.0 || late || (value > most && settings.method == Method::Hybrid), "{end:?}");
            found += 1;
        }
    }
    assert!(found >= 3, "{found}");
}

/// Found by the fuzzer: the state is finite and its square is not.
#[test]
fn regress_an_infinite_energy_is_an_error() {
    let settings = Settings { method: Method::Euler, ..Settings::default() };
    let mut scene = SSVI.scene();
    scene.primary.stiffness = NonNegative::new(1e20).expect("a stiffness");
    let window = Window { from: 0.0, to: 0.02 };
    let found = e1_max(&scene, window, &settings, f64::INFINITY);
    assert!(matches!(found, Err(SolverError::NonFinite { t }) if t <= window.to), "{found:?}");
    let found = simulate(&scene, window, &settings);
    assert!(matches!(found, Err(SolverError::NonFinite { t }) if t <= window.to), "{found:?}");
}

/// Found by the fuzzer: a damper that rests on a wall at t = 0 and is pressed was called linear, for it never touches down.
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
    assert!(
        matches!(found, Err(SolverError::StepTooSmall { t, .. }) if t >= 99.0 && t < window.to),
        "{found:?}"
    );
}
