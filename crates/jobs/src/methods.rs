//! Recomputes the tables of the comparison of methods (`crates/lab`), except what depends on the machine's speed. The plan beside them
//! holds the tolerance of the reference, the limit on steps, and the settings behind names.

use crate::Error;
use crate::artefact::Kind;
use crate::recompute::{Row, Source};
use crate::resolved::{Resolved, SEVERAL};
use retune_model::Scene;
use retune_solver::{Contacts, Method, Response, Settings, Window, simulate, touch_downs};
use retune_study::Study;
use serde_json::{Value, json};
use std::path::Path;

/// The files of the comparison of speed and accuracy.
pub static ACCURACY: Kind = Kind {
    command: "accuracy",
    answer: "runs.csv",
    input: SEVERAL,
    rows: &[("runs.csv", recompute)],
    whole: &[],
    derived: &["models.csv", "machine.json", "*.svg", "README.md"],
};

/// The files of the atlas of failures.
pub static STABILITY: Kind = Kind {
    command: "stability",
    answer: "atlas.csv",
    input: SEVERAL,
    rows: &[("atlas.csv", recompute)],
    whole: &[],
    derived: &["*.csv", "*.svg", "README.md"],
};

/// Settings of a method at a tolerance, or at a step (s).
pub fn settings(method: Method, contacts: Contacts, setting: f64, max_steps: u64) -> Settings {
    let shared = Settings { method, contacts, max_steps, ..Settings::default() };
    if method.has_fixed_step() {
        Settings { step: Some(setting), ..shared }
    } else {
        Settings { rtol: setting, atol: setting * 1e-3, ..shared }
    }
}

/// Relative errors of E1max and of the final state (positions weighed by ω, rad/s) against a reference.
pub fn errors([e1_max, e1_reference]: [f64; 2], states: [[f64; 4]; 2], omega: f64) -> [f64; 2] {
    let [a, b] = states.map(|y| [y[0] * omega, y[1], y[2] * omega, y[3]]);
    let norm = |v: [f64; 4]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let state = norm(std::array::from_fn(|i| a[i] - b[i])) / norm(b);
    [(e1_max / e1_reference - 1.0).abs(), state]
}

/// Evaluations of a run; each step of the hybrid method counts as one.
pub fn evaluations(method: Method, response: &Response) -> u64 {
    response.work.evaluations + if method == Method::Hybrid { response.work.steps } else { 0 }
}

/// The plan of a comparison: `ways` gives method, contacts and setting behind the names in the column `method`.
pub fn plan<'a>(
    reference_rtol: f64,
    max_steps: u64,
    ways: impl Iterator<Item = (&'a str, Method, Contacts, f64)>,
) -> Value {
    let ways: serde_json::Map<String, Value> = ways
        .map(|(name, method, contacts, setting)| {
            (name.to_owned(), json!({ "method": method, "contacts": contacts, "setting": setting }))
        })
        .collect();
    json!({ "reference_rtol": reference_rtol, "max_steps": max_steps, "ways": ways })
}

/// Recomputes the rows of Retune's runs on one of the scenes.
fn recompute(place: &Path, _name: &str) -> Result<Source, Error> {
    let resolved = Resolved::read(place)?;
    let (plan, studies) = (resolved.plan.clone(), resolved.studies()?);
    let names: Vec<String> = studies.iter().map(|(name, _)| name.clone()).collect();
    let source = Source::new(move |row| {
        let (_, study) = studies.iter().find(|(name, _)| name == scene_of(row))?;
        Some(columns(row).iter().map(|&name| name.to_owned()).zip(numbers(&plan, row, study)?).collect())
    });
    Ok(source.only(move |row| {
        ["", "retune"].contains(&row.text("program")) && names.iter().any(|name| name == scene_of(row))
    }))
}

/// The name of the study of a row.
fn scene_of(row: Row<'_>) -> &str {
    row.text(if is_of_atlas(row) { "difficulty" } else { "scene" })
}

/// The columns that are recomputed.
fn columns(row: Row) -> &'static [&'static str] {
    const ATLAS: [&str; 4] = ["impacts", "expected_impacts", "evaluations", "error"];
    const RUNS: [&str; 6] =
        ["impacts", "expected_impacts", "evaluations", "E1max", "E1max_error", "state_error"];
    if is_of_atlas(row) { &ATLAS } else { &RUNS }
}

/// Whether a row belongs to the atlas of failures, which names a scene by its difficulty.
fn is_of_atlas(row: Row) -> bool {
    row.text("scene").is_empty()
}

/// The numbers of these columns; none where the method is unknown, infinite where the run fails.
fn numbers(plan: &Value, row: Row, study: &Study) -> Option<Vec<f64>> {
    let way = &plan["ways"][row.text("method")];
    let text = |name: &str| way[name].as_str().unwrap_or_else(|| row.text(name)).to_owned();
    let method = if way.is_null() { row.text("method").to_owned() } else { text("method") };
    let method: Method = serde_json::from_value(method.into()).ok()?;
    let contacts = text("contacts");
    let contacts =
        if contacts == "exact" { Contacts::Located } else { serde_json::from_value(contacts.into()).ok()? };
    let setting = way["setting"].as_f64().unwrap_or_else(|| row.number("setting"));
    let max_steps = plan["max_steps"].as_u64()?;
    let (scene, window) = (&study.scene, study.window.window());
    let reference = settings(Method::Hybrid, Contacts::Located, plan["reference_rtol"].as_f64()?, max_steps);
    let expected = run(scene, window, &reference)?;
    let found = run(scene, window, &settings(method, contacts, setting, max_steps));
    let Some((found, impacts)) = found else {
        let none = if is_of_atlas(row) { 0.0 } else { f64::INFINITY };
        let failed = if is_of_atlas(row) { vec![f64::NAN] } else { vec![f64::INFINITY; 3] };
        return Some([vec![none, expected.1 as f64, none], failed].concat());
    };
    let states = [found.final_state, expected.0.final_state];
    let energies = [found.e1_max.value, expected.0.e1_max.value];
    let [e1, state] = errors(energies, states, scene.forcing.frequency.get());
    let counts = vec![impacts as f64, expected.1 as f64, evaluations(method, &found) as f64];
    // Errors are printed to three digits in the atlas, to four among the runs.
    let values = if is_of_atlas(row) {
        vec![printed(e1.max(state), 2)]
    } else {
        vec![found.e1_max.value, printed(e1, 3), printed(state, 3)]
    };
    Some([counts, values].concat())
}

/// A number as printed in a table, with this many decimals.
fn printed(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$e}").parse().unwrap_or(f64::NAN)
}

fn run(scene: &Scene, window: Window, settings: &Settings) -> Option<(Response, usize)> {
    let response = simulate(scene, window, settings).ok()?;
    Some((response, touch_downs(scene, window, settings).ok()?.len()))
}
