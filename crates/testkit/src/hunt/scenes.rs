//! Compares with DOP853 on scenes over fifteen orders of magnitude that touch a wall a few times.

use super::Hunt;
use rayon::prelude::*;
use retune_model::Scene;
use retune_solver::{Method, Response, SceneKind, Settings, SolverError, Window, simulate};

/// Runs a scene by the hybrid and by DOP853, which treats contacts in physical time with its own error estimate.
pub fn both(scene: &Scene, to: f64, rtol: f64, most_steps: [u64; 2]) -> [Result<Response, SolverError>; 2] {
    let window = Window { from: 0.0, to };
    [(Method::Hybrid, rtol, most_steps[0]), (Method::Dop853, 1e-12, most_steps[1])].map(
        |(method, rtol, max_steps)| {
            let settings = Settings { method, rtol, atol: 1e-300, max_steps, ..Settings::default() };
            simulate(scene, window, &settings)
        },
    )
}

/// A relative difference.
pub fn apart(a: f64, b: f64) -> f64 {
    (a - b).abs() / a.abs().max(b.abs())
}

/// Compares the scenes that touch a wall only a few times, before small differences can grow.
pub fn scenes(scenes: &[Scene]) -> Hunt {
    // Whether a scene counts, and its fault, if any.
    let look = |scene: &Scene| -> (bool, Option<String>) {
        let [own, other] = both(scene, 1.0, 1e-9, [3_000; 2]);
        let Ok(other) = other else { return (false, None) };
        let own = match own {
            Ok(own) => own,
            Err(SolverError::TooManySteps { .. } | SolverError::TooSlow { .. }) => return (false, None),
            Err(error) => return (false, Some(format!("{error}, where DOP853 has {other:?}, {scene:?}"))),
        };
        if other.scene != SceneKind::Contact || other.impacts[0] + other.impacts[1] > 4 {
            return (false, None);
        }
        let force = |found: &Response| found.force_max[0].max(found.force_max[1]);
        let energy = apart(own.e1_max.value, other.e1_max.value);
        let force = apart(force(&own), force(&other));
        let holds = energy < 1e-6 && force < 1e-3;
        (true, (!holds).then(|| format!("{energy:e} {force:e}, {own:?}, {other:?}, {scene:?}")))
    };
    let looked: Vec<_> = scenes.par_iter().map(look).collect();
    let seen = looked.iter().filter(|(counts, _)| *counts).count();
    let count = scenes.len();
    let faults: Vec<String> = looked.into_iter().filter_map(|(_, fault)| fault).collect();
    let mut hunt = Hunt { faults, ..Hunt::default() };
    hunt.row(format!(
        "{seen} of {count} scenes touched a wall a few times; {} of them do not agree with DOP853",
        hunt.faults.len()
    ));
    hunt.check(seen > count / 50, || format!("{seen} of {count} touched a wall"));
    hunt
}
