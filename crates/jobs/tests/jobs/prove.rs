//! `prove`: motions that the solver finds, proven by interval arithmetic.

use retune_jobs::Error;
use retune_jobs::prove::band::{Band, Guesses, Why, band, steady_band};
use retune_jobs::prove::{Guess, Proof, prove, prove_band};
use retune_model::{Amplitude, Bare, Coupled, Finite, Forcing, NonNegative, Parameter, Scene, Source, Start};
use retune_study::Setting;
use retune_testkit::observers::{good, refused};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn place(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

fn at(omega: f64) -> Guess {
    Guess { omega: Some(Setting::new(Parameter::Omega, omega)), ..Guess::default() }
}

fn bounds(proof: &Proof, name: &str) -> [f64; 2] {
    let bounds: [Option<f64>; 2] = [0, 1].map(|i| json!(proof)["largest"][name][i].as_f64());
    bounds.map(|bound| bound.expect("a bound"))
}

/// The values of `optimum.json` are those of runs from rest in a window; that of the TMD, of its closed form.
#[test]
fn reference_the_tuned_dampers_are_proven_at_their_worst_frequencies() {
    for (results, impacts, off) in
        [("results/ssvi", "S", 1e-10), ("results/ssvi-loss", "S", 1e-10), ("results/tmd", "", 1e-13)]
    {
        let place = place(results);
        let proof = good(prove(&place, &Guess::default()));
        let optimum: Value =
            serde_json::from_str(&std::fs::read_to_string(place.join("optimum.json")).expect("a file"))
                .expect("JSON");
        assert_eq!(json!(proof)["omega"], optimum["objective"]["worst_omega"]);
        assert_eq!((proof.theorem.periods, proof.theorem.impacts.as_str()), (1, impacts));
        let (value, [lo, hi]) = (optimum["E1max"].as_f64().expect("a value"), bounds(&proof, "E1max"));
        assert!(hi - lo < 1e-10 * value, "{proof}");
        assert!((lo - value) < off * value && (value - hi) < off * value, "{value} {proof}");
        let words = proof.to_string();
        for said in [
            "proven by interval arithmetic",
            "repeats after 1 period of the force",
            "all multipliers are below ",
        ] {
            assert!(words.contains(said), "{words}");
        }
    }
}

/// A frequency that is set is proven, not that of the worst run.
#[test]
fn contract_the_frequency_that_is_set_is_proven() {
    let settings = vec![Setting::new(Parameter::Omega, 6.5)];
    let proof = good(prove(&place("results/ssvi"), &Guess { settings, ..Guess::default() }));
    assert_eq!(json!(proof)["omega"], 6.5);
}

#[test]
fn contract_a_damper_that_floats_is_not_proven_and_told_why() {
    let settings = vec![Setting::new(Parameter::K2, 0.0)];
    let guess = Guess { settings, ..at(6.0) };
    let error = refused(prove(&place("studies/tmd-free.json"), &guess));
    assert!(error.to_string().contains("without a spring (k2 = 0)"), "{error}");
}

/// Losses with the same restitution at every speed: the worst of the hedged damper's five.
#[test]
fn reference_the_hedged_damper_is_proven_at_its_worst_restitution() {
    let place = place("results/ssvi-hedged");
    let optimum: Value =
        serde_json::from_str(&std::fs::read_to_string(place.join("optimum.json")).expect("a file"))
            .expect("JSON");
    let worst = optimum["objective"]["worst_restitution"].as_f64().expect("a restitution");
    let settings = vec![Setting::new(Parameter::Restitution, worst)];
    let proof = good(prove(&place, &Guess { settings, ..Guess::default() }));
    let (value, [lo, hi]) = (optimum["E1max"].as_f64().expect("a value"), bounds(&proof, "E1max"));
    assert!(hi - lo < 1e-10 * value, "{proof}");
    assert!((lo - value) < 1e-10 * value && (value - hi) < 1e-10 * value, "{value} {proof}");
}

#[test]
fn contract_an_unstable_motion_is_proven_from_its_state_and_not_called_stable() {
    // `results/branches/tuned`, branch 0, place 160.
    let number = |value: f64| Finite::new(value).expect("finite");
    let [x1, v1, x2, v2] =
        [-0.04618206941599734, 0.12210602044391623, 0.11191069155584588, -0.23375919700486558].map(number);
    let from = Some((Start { x1, v1, x2: Some(x2), v2 }, 1));
    let proof = good(prove(&place("results/ssvi"), &Guess { from, ..at(7.531425492418166) }));
    assert!(
        proof
            .to_string()
            .contains("\nunstable      a multiplier is above 1: the largest multiplier is about -1."),
        "{proof}"
    );
    assert!(json!(proof)["stability"]["unstable"]["re"].as_f64() < Some(-1.0), "{proof}");
}

#[test]
fn contract_what_cannot_be_proven_says_why() {
    for (study, omega, said) in [
        (
            "studies/ssvi.json",
            6.3,
            "study ssvi: not proven: none found: the run settles on no periodic motion",
        ),
        (
            "results/ssvi-rigid",
            6.0,
            "study ssvi-rigid: not proven: rigid walls: nothing is proven of such scenes",
        ),
        (
            "results/ssvi",
            0.0,
            "study ssvi: not proven: a forcing whose omega is not above 0: nothing is proven",
        ),
    ] {
        let error = refused(prove(&place(study), &at(omega)));
        assert!(matches!(error, Error::NotProven { .. }), "{error}");
        assert!(error.to_string().starts_with(said), "{error}");
    }
}

#[test]
fn reference_a_band_of_the_tuned_damper_is_proven() {
    let at = |omega| Setting::new(Parameter::Omega, omega);
    let proof = good(prove_band(&place("results/ssvi"), &[], [at(6.62), at(6.6201)], 226.0));
    let all = json!(proof);
    assert_eq!((&all["omega"], all["left_out"].as_array().map(Vec::len)), (&json!([6.62, 6.6201]), Some(0)));
    let [lo, hi] = [0, 1].map(|i| all["E1max"][i].as_f64().expect("a bound"));
    // `results/branches/tuned` has 225.7923 J at 6.6241 rad/s, a little beyond.
    assert!(lo < 225.7923 && (225.75..226.0).contains(&hi), "{proof}");
    assert!(
        proof.to_string().contains("\nevery omega   has a stable motion with an E1max of at most 225."),
        "{proof}"
    );
    // The TMD touches no wall: bounds of the closed form hold what the search found at its worst frequency.
    let whole = good(prove_band(&place("results/tmd"), &[], [at(5.0), at(8.0)], f64::INFINITY));
    let [lo, hi] = [0, 1].map(|i| json!(whole)["E1max"][i].as_f64().expect("a bound"));
    assert!(lo <= 660.417196785553 && 660.417196785552 <= hi && hi - lo < 1e-5, "{whole}");
    let error = refused(prove_band(&place("results/ssvi"), &[], [at(6.62), at(6.62)], 226.0));
    assert_eq!(
        error.to_string(),
        "command line: --to: 6.62 rad/s is not allowed here: give a number above that of --omega, 6.62"
    );
    let error = refused(prove_band(&place("results/ssvi"), &[], [at(6.62), at(6.6201)], 200.0)).to_string();
    assert!(error.starts_with("study ssvi: not proven: the motion may have an E1max of 225."), "{error}");
}

/// The structure of the paper with the tuned SSVI NES of `results/ssvi`.
fn tuned() -> Scene {
    retune_study::read(&place("results/ssvi")).expect("a study").scene
}

/// The state of `results/branches/tuned`, branch 0, place 128, at 6.6241 rad/s.
const NEAR: [f64; 4] = [-0.02820555307031281, 0.6083072322136185, 0.1833641390932657, -1.121482573779919];

fn band_of(omega: [f64; 2], most: f64, guesses: Guesses<'_>) -> Band {
    band(&tuned(), omega, most, guesses)
}

/// Pieces and parts left out, in turn: they cover the band.
fn parts(found: &Band, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let left_out = found.left_out.iter().map(|part| part.omega);
    let mut all: Vec<[f64; 2]> = found.pieces.iter().map(|piece| piece.omega).chain(left_out).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert_eq!((all[0][0], all[all.len() - 1][1]), (from, to));
    assert!(all.windows(2).all(|two| two[0][1] == two[1][0]), "{all:?}");
    all
}

/// Where nothing is guessed, the motion is proven from beyond it.
#[test]
fn invariant_a_motion_is_followed_to_both_sides_of_its_guess() {
    let omega = [6.618, 6.64];
    let found = band_of(omega, 226.0, &|omega| (omega > 6.625).then_some((NEAR, 1)));
    assert!(found.left_out.is_empty() && parts(&found, omega).len() < 5, "{found:?}");
    assert!(found.pieces.iter().all(|piece| piece.periods == 1 && piece.impacts == "S"), "{found:?}");
}

/// What is beyond the goal, or has no guess, is left out with its reason, and no more than that.
#[test]
fn contract_what_is_not_proven_of_a_band_is_named() {
    let few = band_of([6.62, 6.6202], 225.0, &|_| Some((NEAR, 1)));
    assert!(
        few.pieces.is_empty() && few.left_out[0].why.to_string().contains("at most 225 J are to be proven"),
        "{few:?}"
    );
    let none = band_of([6.0, 6.01], 1e3, &|_| None);
    assert_eq!((none.left_out.len(), none.left_out[0].omega), (1, [6.0, 6.01]));
    assert_eq!(none.left_out[0].why, Why::NoGuess);
}

/// Just below the period doubling at 7.506679 rad/s the motion is stable, above it is not.
#[test]
fn contract_what_happens_next_to_a_bifurcation_is_named() {
    // `results/branches/tuned`, branch 0, place 159.
    let near = [-0.04706820096872666, 0.1284257542017473, 0.11633626692455387, -0.24632314511812572];
    let found = band_of([7.5066, 7.5067], 226.0, &|_| Some((near, 1)));
    let [part] = &found.left_out[..] else { panic!("{found:?}") };
    assert!((7.5066..7.506679).contains(&part.omega[0]) && part.from_above.is_none(), "{found:?}");
    let words = part.why.to_string();
    assert!(words.contains("the largest multiplier is about -1.000"), "{words}");
    assert!(words.ends_with(" wide, as next to a period doubling"), "{words}");
}

/// About the largest E1max of the tuned TMD, 660.4172 J, the motions have more than is to be proven; the part has a reason for each of its ends.
#[test]
fn contract_both_ends_of_a_part_that_is_left_out_have_their_reasons() {
    let scene = retune_study::read(&place("results/tmd")).expect("a study").scene;
    // The steady motion at 6.211 rad/s.
    let near = [0.01108, 1.13368, 1.96018, 0.36849];
    let found = band(&scene, [6.206, 6.216], 660.4, &|_| Some((near, 1)));
    let [part] = &found.left_out[..] else { panic!("{found:?}") };
    assert!(part.omega[0] > 6.206 && part.omega[1] < 6.216, "{found:?}");
    assert!(
        matches!(part.why, Why::Above(..)) && matches!(part.from_above, Some(Why::Above(..))),
        "{found:?}"
    );
}

/// A force, an imbalance, and bases of given displacement and acceleration, with a TMD and without.
fn linear() -> Vec<Scene> {
    let size = |size: f64| NonNegative::new(size).expect("an amplitude");
    let sources = [
        Source::Harmonic(Amplitude::Force, size(30.5)),
        Source::Harmonic(Amplitude::Imbalance, size(30.5)),
        Source::Harmonic(Amplitude::Base, size(0.02)),
        Source::Harmonic(Amplitude::BaseAcceleration, size(0.7)),
    ];
    let scene = retune_study::read(&place("results/tmd")).expect("a study").scene;
    let with = |source| Scene { forcing: Forcing { source, ..scene.forcing }, ..scene };
    let all = sources.map(with);
    all.into_iter().chain(all.map(|scene| Scene { damper: None, ..scene })).collect()
}

/// The bound is next to the largest value in doubles, and holds it; what is left out has more, but for its ends.
#[test]
fn exact_the_closed_form_of_linear_scenes_is_in_a_whole_band() {
    for scene in linear() {
        let Scene { primary, forcing, damper } = &scene;
        let (system, bare) =
            (damper.as_ref().map(|own| Coupled::new(primary, forcing, own)), Bare::new(primary, forcing));
        let at =
            |omega: f64| system.as_ref().map_or(bare.steady(omega).e1_max, |own| own.steady(omega).e1_max);
        let worst =
            system.as_ref().map_or(bare.steady_e1_max([5.0, 8.0]), |own| own.steady_e1_max([5.0, 8.0]));
        for (most, is_whole) in [(f64::INFINITY, true), (0.5 * worst.value, false)] {
            let found = steady_band(&scene, [5.0, 8.0], most).expect("a scene").expect("no wall");
            assert!(found.left_out.is_empty() == is_whole && parts(&found, [5.0, 8.0]).len() < 400);
            let all = found.energy();
            assert!(all.hi() <= most && all.wider(3e-15 * worst.value).hi() >= worst.value.min(most * 0.999));
            assert!(!is_whole || all.hi() < (1.0 + 2e-9) * worst.value, "{all:?} {worst:?}");
            for piece in &found.pieces {
                assert!(piece.multipliers < 1.0);
                for omega in piece.omega {
                    let own = at(omega);
                    assert!(piece.largest.energy.wider(3e-15 * own).contains(own), "{own} {piece:?}");
                }
            }
            for part in &found.left_out {
                assert!(at(0.5 * (part.omega[0] + part.omega[1])) > (1.0 - 1e-3) * most, "{part:?}");
            }
        }
    }
}

/// Without dashpots, and where a wall is struck at some of the frequencies, the closed form is not that of the motion.
#[test]
fn contract_a_band_in_closed_form_has_dashpots_and_no_impacts() {
    let zero = NonNegative::new(0.0).expect("zero");
    let mut scene = linear()[0];
    scene.primary.damping = zero;
    scene.damper = scene.damper.map(|damper| retune_model::Damper { damping: zero, ..damper });
    assert!(steady_band(&scene, [6.3, 6.4], 1e9).expect("a scene").is_none());
    assert!(steady_band(&tuned(), [6.3, 6.4], 1e9).expect("a scene").is_none());
}
