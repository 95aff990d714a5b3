//! `prove`: motions that the solver finds, proven by interval arithmetic.

use retune_jobs::Error;
use retune_jobs::prove::{Guess, Proof, prove, prove_band};
use retune_model::{Finite, Parameter, Start};
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
    assert!(proof.to_string().contains("\nunstable      a multiplier is above 1\n"), "{proof}");
    assert_eq!(json!(proof)["stability"], json!("unstable"));
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
