//! Stationary random motion: the Lyapunov equation, the integral over a table, and optima of textbooks.

use retune_model::{Measure, Rms, Scene, Stationary};
use serde_json::{Value, json};
use std::f64::consts::PI;

const DENSITY: f64 = 0.3;

fn scene(of: &str, spectrum: Value, damper: Option<[f64; 3]>, c1: f64) -> Scene {
    let mut all = json!({
        "primary": { "m1": 2.0, "c1": c1, "k1": 50.0 },
        "forcing": { "spectrum": spectrum, "of": of, "duration": 10, "step": 0.01 }
    });
    if let Some([m2, k2, c2]) = damper {
        all["damper"] = json!({ "m2": m2, "k2": k2, "c2": c2 });
    }
    serde_json::from_value(all).expect("a scene")
}

fn white() -> Value {
    json!({ "white": DENSITY, "to": 20 })
}

/// White noise up to a frequency, as a table.
fn table(to: f64) -> Value {
    json!({ "omega": [0.0, 1.0, to], "density": [DENSITY, DENSITY, DENSITY] })
}

fn means(scene: &Scene) -> [f64; 6] {
    let found = Stationary::new(scene, 1e-11).expect("a stationary motion");
    Rms::ALL.map(|rms| found.get(rms))
}

/// Of one mass under white noise σx² = π S / (2 c k) (S. H. Crandall and W. D. Mark, 1963), half of the energy in its spring.
#[test]
fn exact_one_mass_under_white_noise_has_the_closed_form() {
    let (m, c, k) = (2.0_f64, 0.4_f64, 50.0_f64);
    let x2 = PI * DENSITY / (2.0 * c * k);
    let [e1, x1, v1, a1, ground, stroke] = means(&scene("force", white(), None, c));
    for (found, exact) in [
        (x1, x2.sqrt()),
        (v1, (k / m * x2).sqrt()),
        (e1, k * x2),
        (ground, (k * k * x2 + c * c * k / m * x2).sqrt()),
    ] {
        assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
    }
    assert!(a1.is_infinite() && stroke == 0.0);
    // On an accelerated base the mass feels -m a; of its acceleration in space that of the base is no part.
    let [_, x1, _, a1, ..] = means(&scene("base acceleration", white(), None, c));
    let x2 = m * m * x2;
    let a2 = (k * k * x2 + c * c * k / m * x2) / (m * m);
    assert!((x1 / x2.sqrt() - 1.0).abs() < 1e-14 && (a1 / a2.sqrt() - 1.0).abs() < 1e-14);
}

/// The integral over a long table comes to what the Lyapunov equation has, but for what lies beyond the table: there a force moves the mass
/// alone, and v1 lacks ∫ S / (m1 ω)² dω.
#[test]
fn reference_the_lyapunov_equation_and_the_integral_agree() {
    let end = 3e4;
    for of in ["force", "base acceleration"] {
        for (damper, c1) in [
            (None, 0.4),
            (Some([0.1, 2.3, 0.1]), 0.4),
            (Some([0.1, 2.3, 0.1]), 0.0),
            (Some([0.5, 40.0, 6.0]), 3.0),
        ] {
            let (exact, found) =
                (means(&scene(of, white(), damper, c1)), means(&scene(of, table(end), damper, c1)));
            let by: f64 = if of == "force" { 0.5 } else { 1.0 };
            let beyond = DENSITY * by * by / end;
            for (i, rms) in Rms::ALL.into_iter().enumerate() {
                let (exact, found) = match rms {
                    Rms::Acceleration if exact[i].is_infinite() => continue,
                    Rms::Energy => (exact[i], found[i] + beyond),
                    Rms::Velocity => (exact[i].powi(2), found[i].powi(2) + beyond),
                    _ => (exact[i], found[i]),
                };
                let near = match rms {
                    Rms::Displacement | Rms::Stroke => 1e-9,
                    Rms::Energy | Rms::Velocity => 1e-7,
                    _ => 1e-3,
                };
                assert!(
                    (found - exact).abs() <= near * exact,
                    "{of} {damper:?} {c1} {rms:?}: {found} {exact}"
                );
            }
        }
    }
}

/// On an undamped structure the least σx1 under white noise is that of k2 and c2 by the formula of G. B. Warburton (Earthquake Engineering and
/// Structural Dynamics 10 (1982) 381): √(1 + μ/2) / (1 + μ) times its frequency, and a damping of √(μ (1 + 3μ/4) / (4 (1 + μ)(1 + μ/2))).
#[test]
fn paper_the_optimum_under_white_noise_is_warburtons() {
    for mu in [0.01_f64, 0.05, 0.2] {
        let (m2, own) = (2.0 * mu, 5.0 * (1.0 + 0.5 * mu).sqrt() / (1.0 + mu));
        let zeta = (mu * (1.0 + 0.75 * mu) / (4.0 * (1.0 + mu) * (1.0 + 0.5 * mu))).sqrt();
        let (k2, c2) = (m2 * own * own, 2.0 * zeta * m2 * own);
        let x1 = |a: f64, b: f64| means(&scene("force", white(), Some([m2, a * k2, b * c2]), 0.0))[1];
        let best = x1(1.0, 1.0);
        let h = 1e-4;
        for [a, b] in [[h, 0.0], [0.0, h]] {
            let slope = (x1(1.0 + a, 1.0 + b) - x1(1.0 - a, 1.0 - b)) / (2.0 * h);
            assert!(slope.abs() < 1e-6 * best, "{mu}: {slope}");
        }
        for [a, b] in [[0.97, 1.0], [1.03, 1.0], [1.0, 0.9], [1.0, 1.1]] {
            assert!(x1(a, b) > best, "{mu} {a} {b}");
        }
    }
}

/// A narrow peak between the points of a table is found: the resonance of a damping ratio of 1e-5.
#[test]
fn exact_a_narrow_resonance_is_not_missed() {
    let (k, c) = (50.0_f64, 2e-4_f64);
    let found =
        means(&scene("force", json!({ "omega": [0, 200], "density": [DENSITY, DENSITY] }), None, c))[1];
    let exact = (PI * DENSITY / (2.0 * c * k)).sqrt();
    assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    let error = Stationary::new(&scene("force", table(200.0), None, c), 1e-9).expect("a motion").error;
    assert!(error <= 1e-9, "{error}");
}

#[test]
fn contract_what_is_not_stationary_has_no_means() {
    let none = |scene: Scene| assert!(Stationary::new(&scene, 1e-10).is_none());
    none(scene("force", white(), None, 0.0));
    none(scene("force", table(50.0), None, 0.0));
    none(scene("force", white(), Some([0.1, 0.0, 0.1]), 0.4));
    none(scene("base acceleration", table(50.0), Some([0.1, 0.0, 0.1]), 0.4));
    let mut harmonic = scene("force", white(), None, 0.4);
    harmonic.forcing = serde_json::from_value(json!({ "P": 1, "omega": 5 })).expect("a forcing");
    none(harmonic);
    let refused = |spectrum: Value| {
        let forcing = json!({ "spectrum": spectrum, "of": "force", "duration": 10 });
        serde_json::from_value::<retune_model::Forcing>(forcing).expect_err("refused").to_string()
    };
    for spectrum in [
        json!({ "white": 1 }),
        json!({ "to": 1 }),
        json!({ "white": 1, "to": 5, "omega": [0, 1], "density": [1, 1] }),
        json!({}),
    ] {
        let sentence = refused(spectrum);
        assert!(sentence.contains("or `white` with `to` alone"), "{sentence}");
    }
}

#[test]
fn contract_every_quantity_has_its_place_its_name_and_its_run() {
    for (i, measure) in Measure::ALL.into_iter().enumerate() {
        assert_eq!((measure.index(), measure.of_run()), (i, measure));
    }
    for rms in Rms::ALL {
        let measure = Measure::Stationary(rms);
        assert_eq!((measure.unit(), measure.index()), (measure.of_run().unit(), measure.of_run().index()));
    }
    for measure in Measure::every() {
        assert_eq!(Measure::try_from(std::borrow::Cow::from(measure.name())), Ok(measure));
    }
}
