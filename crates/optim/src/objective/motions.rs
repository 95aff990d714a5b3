//! The largest over every motion that is found, for the response "motions".

use super::spec::{Objective, STARTS};
use super::unusable::Unusable;
use retune_dynamics::periodic::branches::Plan;
use retune_dynamics::periodic::worst::{motions, quantity};
use retune_model::{Measure, Parameter, Scene};
use retune_solver::Settings;

/// What was found.
pub(super) struct Found {
    /// Where the quantity is largest, rad/s.
    pub at: f64,
    /// The largest quantity, stroke (m) and contact force (N).
    pub largest: [f64; 3],
    /// Whether stable periodic motions are known in the whole band.
    pub settled: bool,
}

/// Finds the motions of a scene from one frequency to another, by runs at so many of them.
pub(super) fn largest_motion(
    scene: &Scene,
    (from, to, samples): (f64, f64, usize),
    term: &Objective,
    settings: &Settings,
) -> Result<Found, Unusable> {
    let starts = term.starts.unwrap_or(STARTS);
    let plan = Plan { samples, starts, looks: 1, ..Plan::over(Parameter::Omega, [from, to]) };
    let kinds = [term.quantity, Measure::Stroke, Measure::ContactForce];
    let found = motions(scene, plan, settings, &kinds.map(quantity))?;
    let value = |i: usize| found.largest.get(i).and_then(Option::as_ref).map_or(0.0, |largest| largest.value);
    let at = found.largest.first().and_then(Option::as_ref).map_or(from, |largest| largest.at);
    Ok(Found { at, largest: [0, 1, 2].map(value), settled: found.irregular.is_empty() })
}
