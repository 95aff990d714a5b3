//! The response at each value of a parameter, every run from rest.

use crate::parameter::Error;
use rayon::prelude::*;
use retune_model::{Parameter, Scene, energy_ratios};
use retune_solver::{Settings, Window, simulate};
use serde::Serialize;

/// The walls that the damper struck.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Zone {
    /// Both: the structure directly and the obstacle.
    Bilateral,
    /// The structure only.
    PrimaryOnly,
    /// The obstacle only.
    ObstacleOnly,
    /// Neither.
    None,
}

impl Zone {
    /// The zone for given numbers of impacts on the structure and on the obstacle.
    pub fn of([primary, obstacle]: [u64; 2]) -> Self {
        match (primary > 0, obstacle > 0) {
            (true, true) => Self::Bilateral,
            (true, false) => Self::PrimaryOnly,
            (false, true) => Self::ObstacleOnly,
            (false, false) => Self::None,
        }
    }
}

/// The result of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The parameter's value.
    pub value: f64,
    /// Largest energy of the primary structure in the window, J.
    pub e1_max: f64,
    /// Largest energy of the damper (the paper's E2) in the window, J.
    pub e2_max: f64,
    /// Impacts in the window, on the structure and on the obstacle.
    pub impacts: [u64; 2],
    /// Largest relative displacement `|x2 - x1|` in the window, m.
    pub relative_displacement_max: f64,
}

impl Point {
    /// The energy ratios `[R1, R2]`.
    pub fn ratios(&self) -> [f64; 2] {
        energy_ratios(self.e1_max, self.e2_max)
    }

    /// The walls struck in the window.
    pub fn zone(&self) -> Zone {
        Zone::of(self.impacts)
    }
}

/// Runs the scene at each of `values` from rest, in parallel; the points are in the order of `values`. `done` is called after each
/// run, from any thread.
///
/// # Errors
/// A value out of the parameter's range, or a run that could not be finished.
pub fn independent(
    scene: &Scene,
    parameter: Parameter,
    values: &[f64],
    window: Window,
    settings: &Settings,
    done: impl Fn() + Sync,
) -> Result<Vec<Point>, Error> {
    let run = |&value: &f64| {
        let response = simulate(&parameter.at(*scene, value)?, window, settings)?;
        done();
        Ok(Point {
            value,
            e1_max: response.e1_max.value,
            e2_max: response.e2_max.value,
            impacts: response.impacts,
            relative_displacement_max: response.relative_displacement_max,
        })
    };
    let runs: Vec<Result<Point, Error>> = values.par_iter().map(run).collect();
    runs.into_iter().collect() // the first failure in the order of the values, not in that of the threads
}

/// Runs of neighbouring points in the same zone: `(zone, from, to)`, borders halfway between points.
pub fn zones(points: &[Point]) -> Vec<(Zone, f64, f64)> {
    let mut found: Vec<(Zone, f64, f64)> = Vec::new();
    for (i, point) in points.iter().enumerate() {
        let before = i.checked_sub(1).map_or(point.value, |j| 0.5 * (points[j].value + point.value));
        let after = points.get(i + 1).map_or(point.value, |next| 0.5 * (next.value + point.value));
        match found.last_mut() {
            Some((zone, _, to)) if *zone == point.zone() => *to = after,
            _ => found.push((point.zone(), before, after)),
        }
    }
    found
}
