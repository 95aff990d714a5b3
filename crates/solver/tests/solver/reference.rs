//! Runs against SciPy's (`tests/reference/scipy_scenes.py`, which made the numbers without Retune).

use crate::problems::{assert_close, assert_states};
use retune_model::Scene;
use retune_solver::{Contacts, Method, Response, SceneKind, Settings, Window, simulate};
use retune_testkit::scenes::{Numbers, SSVI};
use serde::Deserialize;

#[derive(Deserialize)]
struct File {
    scenes: Vec<Reference>,
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "the paper's symbols, as in the file")]
struct Reference {
    name: String,
    m1: f64,
    c1: f64,
    k1: f64,
    m2: Option<f64>,
    k2: Option<f64>,
    c2: Option<f64>,
    D: Option<f64>,
    C: Option<f64>,
    P: f64,
    omega: f64,
    R: Option<f64>,
    q: Option<f64>,
    T: f64,
    t0: f64,
    E1max: f64,
    t_E1max: f64,
    /// The largest other local maximum: where it is as large, the time of the maximum says little.
    E1max_runner_up: Option<f64>,
    E2max: Option<f64>,
    force_max_primary: Option<f64>,
    force_max_obstacle: Option<f64>,
    relative_displacement_max: Option<f64>,
    impacts_primary: Option<u64>,
    impacts_obstacle: Option<u64>,
    state_T: [Option<f64>; 4],
    /// How far SciPy's own integrations differ at T.
    state_T_disagreement: f64,
    /// How much the scene enlarges a small error from the start to T.
    amplification: f64,
}

impl Reference {
    fn scene(&self) -> Scene {
        let or = |value: Option<f64>, default| value.unwrap_or(default);
        let numbers = Numbers {
            m1: self.m1,
            c1: self.c1,
            k1: self.k1,
            p: self.P,
            omega: self.omega,
            m2: or(self.m2, 1.0),
            k2: or(self.k2, 0.0),
            c2: or(self.c2, 0.0),
            d: or(self.D, 0.0),
            c: or(self.C, 0.0),
            r: or(self.R, 1.0),
            q: or(self.q, 1.0),
            ..SSVI
        };
        if self.m2.is_some() { numbers.scene() } else { numbers.bare_scene() }
    }

    fn run(&self, settings: &Settings) -> Response {
        let window = Window { from: self.t0, to: self.T };
        simulate(&self.scene(), window, settings).unwrap_or_else(|e| panic!("{}: {e}", self.name))
    }

    fn impacts(&self) -> [u64; 2] {
        [self.impacts_primary, self.impacts_obstacle].map(|count| count.unwrap_or(0))
    }
}

fn references() -> Vec<Reference> {
    let file: File = serde_json::from_str(include_str!("../../../../tests/reference/scipy_scenes.json"))
        .expect("the scenes");
    assert!(file.scenes.len() >= 20);
    file.scenes
}

fn named<'a>(all: &'a [Reference], name: &str) -> &'a Reference {
    all.iter().find(|scene| scene.name == name).unwrap_or_else(|| panic!("a scene named {name}"))
}

#[test]
fn reference_hybrid_on_every_scene() {
    for scene in references() {
        let name = &scene.name;
        let found = scene.run(&Settings::default());
        assert_eq!(found.impacts, scene.impacts(), "{name}");
        assert_close(found.e1_max.value, scene.E1max, scene.E1max, 1e-8, &format!("E1max of {name}"));
        if scene.E1max_runner_up.is_some_and(|other| other < (1.0 - 1e-6) * scene.E1max) {
            assert_close(found.e1_max.time, scene.t_E1max, 1.0, 1e-7, &format!("t of E1max of {name}"));
        }
        let [on_primary, on_obstacle] = found.force_max;
        for (what, found, expected) in [
            ("E2max", found.e2_max.value, scene.E2max),
            ("force on the primary structure", on_primary, scene.force_max_primary),
            ("force on the obstacle", on_obstacle, scene.force_max_obstacle),
            ("relative displacement", found.relative_displacement_max, scene.relative_displacement_max),
        ] {
            let expected = expected.unwrap_or(0.0);
            let allowed = 1e-8 * (0.1 * scene.amplification).max(1.0);
            assert_close(found, expected, expected, allowed, &format!("{what} of {name}"));
        }
        let state = scene.state_T.map(|v| v.unwrap_or(0.0));
        let allowed = 1e-9 * scene.amplification.max(1.0) + 10.0 * scene.state_T_disagreement;
        assert_states(
            found.final_state,
            state,
            [1.0, scene.omega],
            allowed,
            &format!("state at T of {name}"),
        );
        let kind = match (scene.m2, scene.impacts()) {
            (None, _) => SceneKind::Bare,
            (_, [0, 0]) => SceneKind::Linear,
            _ => SceneKind::Contact,
        };
        assert_eq!(found.scene, kind, "{name}");
    }
}

#[test]
fn reference_ode45_with_located_contacts() {
    let all = references();
    let settings = Settings { method: Method::Ode45, rtol: 1e-11, atol: 1e-13, ..Settings::default() };
    for name in [
        "bare",
        "tmd_heavy",
        "row1",
        "ssvi_k2e4",
        "ssvi_k3e4",
        "no_clearance",
        "soft_contact",
        "tiny_clearance",
    ] {
        let scene = named(&all, name);
        let found = scene.run(&settings);
        assert_close(found.e1_max.value, scene.E1max, scene.E1max, 1e-7, name);
        assert_eq!(found.impacts, scene.impacts(), "{name}");
    }
}

/// A method of order 2 with a per-step tolerance gives about the square root of it: honest, not exact.
#[test]
fn reference_ode23s_with_located_contacts() {
    let all = references();
    for (name, rtol, allowed) in [
        ("bare", 1e-7, 2e-3),
        ("tmd_heavy", 1e-7, 1e-3),
        ("ssvi_k2e4", 1e-7, 1e-3),
        ("heavy_damper", 1e-7, 1e-3),
        ("ssvi_omega7", 1e-7, 1e-3),
    ] {
        let scene = named(&all, name);
        let settings = Settings { method: Method::Ode23s, rtol, atol: 1e-2 * rtol, ..Settings::default() };
        let found = scene.run(&settings);
        assert_close(found.e1_max.value, scene.E1max, scene.E1max, allowed, name);
        assert_eq!(found.impacts, scene.impacts(), "{name}");
    }
}

/// Stepping over the kinks, as the paper does, converges too, if slowly.
#[test]
fn reference_contacts_stepped_over() {
    let all = references();
    for (method, rtol, allowed) in [(Method::Ode45, 1e-10, 1e-6), (Method::Ode23s, 1e-7, 1e-3)] {
        for name in ["ssvi_k2e4", "heavy_damper"] {
            let scene = named(&all, name);
            let settings = Settings {
                method,
                contacts: Contacts::Stepped,
                rtol,
                atol: 1e-2 * rtol,
                ..Settings::default()
            };
            let found = scene.run(&settings);
            assert_close(found.e1_max.value, scene.E1max, scene.E1max, allowed, name);
            assert_eq!(found.impacts, scene.impacts(), "{name}");
        }
    }
}
