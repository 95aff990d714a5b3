//! The response against the frequency of the force: over the band of the objective, or about the one frequency of a study without one.

use super::findings::Findings;
use crate::tune::band::{at, energy, first};
use rayon::prelude::*;
use retune_model::Scene;
use retune_optim::Objective;

/// Half the width of the band about a single frequency, as a share of the natural frequency.
pub const ABOUT: f64 = 0.2;
/// Frequencies of such a band, of which as many again lie ever closer to the single one.
const POINTS: i32 = 100;
/// How often the distance to the single frequency is halved.
const CLOSER: i32 = 10;

/// Curves of the three scenes of [`Findings::scenes`]. Values that are not finite are missing.
pub struct Curves {
    /// rad/s, ascending.
    pub omega: Vec<f64>,
    /// What the search made small, in its unit.
    pub value: [Vec<f64>; 3],
    /// The largest displacement |x1| of the structure in the window of a run, mm.
    pub displacement: [Vec<f64>; 3],
    /// Whether the objective looks at all of these frequencies, or at a single one only.
    pub is_objective: bool,
}

impl Curves {
    pub fn new(findings: &Findings) -> Self {
        let own = findings.band.as_ref().filter(|rows| !rows.is_empty());
        let (omega, value) = match own {
            Some(rows) => {
                let value = [0, 1, 2].map(|scene| rows.iter().map(|row| row.1[scene]).collect());
                (rows.iter().map(|row| row.0).collect(), value)
            }
            None => about(findings),
        };
        let displacement = displacements(findings, &omega);
        Self { omega, value, displacement, is_objective: own.is_some() }
    }

    /// The largest of a curve, where there is one.
    pub fn largest(curve: &[f64]) -> f64 {
        curve.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max)
    }
}

fn about(findings: &Findings) -> (Vec<f64>, [Vec<f64>; 3]) {
    let objective = findings.study.objective();
    let term = first(&objective).cloned().unwrap_or_default();
    // One run a frequency, of the nominal scene.
    let single = Objective { omega: None, ensemble: None, k1: None, restitution: None, ..term };
    let omega = frequencies(findings);
    let value = |(scene, omega): (Scene, f64)| {
        at(omega, scene).map_or(f64::NAN, |scene| energy(findings.study, scene, &single))
    };
    let scenes = findings.scenes();
    let asked: Vec<(Scene, f64)> =
        scenes.iter().flat_map(|scene| omega.iter().map(|omega| (*scene, *omega))).collect();
    let found: Vec<f64> = asked.into_par_iter().map(value).collect();
    let of = |scene: usize| found[scene * omega.len()..(scene + 1) * omega.len()].to_vec();
    (omega.clone(), [of(0), of(1), of(2)])
}

/// The amplitude of the structure at each frequency, mm.
fn displacements(findings: &Findings, omega: &[f64]) -> [Vec<f64>; 3] {
    let (window, settings) = (findings.study.window.window(), findings.study.solver.settings());
    let value = |scene: Scene, omega: f64| {
        let run = at(omega, scene).and_then(|scene| retune_solver::simulate(&scene, window, &settings).ok());
        run.map_or(f64::NAN, |run| 1e3 * run.structure.displacement.value)
    };
    findings.scenes().map(|scene| omega.par_iter().map(|omega| value(scene, *omega)).collect())
}

fn frequencies(findings: &Findings) -> Vec<f64> {
    let middle = findings.worst_omega();
    let half = ABOUT * findings.worst.primary.natural_frequency();
    let even = (-POINTS / 2..=POINTS / 2).map(|i| 2.0 * f64::from(i) / f64::from(POINTS));
    let near = (1..=CLOSER).map(|i| 0.5_f64.powi(i)).flat_map(|share| [-share, share]);
    let mut all: Vec<f64> =
        even.chain(near).map(|share| middle + share * half).filter(|omega| *omega > 0.0).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
