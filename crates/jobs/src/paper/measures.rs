//! What a design is worth, in J: by each of the objectives that the paper may have meant, and near it.

use super::plan::Plan;
use crate::Error;
use rayon::prelude::*;
use retune_model::{Positive, Scene};
use retune_optim::{Ensemble, Failures, FrequencyBand, Goal, Objective, Response, Statistic};
use retune_solver::{Settings, Window};

/// The band for which dampers are tuned, rad/s.
pub const BAND: [f64; 2] = [5.0, 8.0];

/// Least, median and largest of some energies, J.
pub struct Spread {
    pub least: f64,
    pub median: f64,
    pub largest: f64,
}

impl Spread {
    /// Of some values; NaN of none.
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            values
                .get((share * (values.len().max(1) - 1) as f64).round() as usize)
                .copied()
                .unwrap_or(f64::NAN)
        };
        Self { least: at(0.0), median: at(0.5), largest: at(1.0) }
    }

    /// Its three numbers in words.
    pub fn words(&self) -> String {
        format!("{:.0} – {:.0} (median {:.0})", self.least, self.largest, self.median)
    }
}

/// The worst over the band of the page.
pub fn over_band(samples: usize, response: Response) -> Objective {
    let [from, to] = BAND.map(Positive::new);
    let omega = from.ok().zip(to.ok()).map(|(from, to)| FrequencyBand { from, to, samples, relative: false });
    Objective { omega, response, ..Objective::default() }
}

/// E1max of a scene by an objective; infinite where it cannot be run.
pub fn energy(scene: &Scene, objective: &Objective, window: Window, settings: &Settings) -> f64 {
    let goal = Goal { objective: objective.clone(), ..window.into() };
    goal.evaluate(scene, settings, f64::INFINITY).map_or(f64::INFINITY, |found| found.value)
}

/// At the scene's own frequency, in the window.
pub fn at_omega(plan: &Plan, scene: &Scene) -> f64 {
    energy(scene, &Objective::default(), plan.window(), &plan.settings())
}

/// At the scene's own frequency, from rest to the end of the window.
pub fn whole(plan: &Plan, scene: &Scene) -> f64 {
    let window = Window { from: 0.0, to: plan.window().to };
    energy(scene, &Objective::default(), window, &plan.settings())
}

/// The scene of the TMD with the mass of the paper's, k2 and c2 free, that has the least steady worst over the band at the tuned stiffness.
pub fn best_tmd(plan: &Plan) -> Result<Scene, Error> {
    let scene = plan.tmd.scene;
    let damper = scene.damper.ok_or_else(|| Error::NoStart(Failures::default()))?;
    Ok(Scene { damper: Some(crate::retention::best_tmd(&scene, damper, BAND)?.0), ..scene })
}

/// Its spring and its damping in words.
pub fn tmd_words(scene: &Scene) -> String {
    scene.damper.map_or(String::new(), |damper| {
        format!("k2 = {:.0} N/m, c2 = {:.0} N·s/m", damper.stiffness.get(), damper.damping.get())
    })
}

/// The values of `members` scenes near one, each of whose k1, k2, c2, D and C are off by at most 0.1 %, which is less than the rounding
/// of the printed D = 0.06 m.
pub fn near(members: u32, scene: &Scene, value: impl Fn(&Scene) -> f64 + Sync) -> Spread {
    let ensemble = Ensemble { members, phases: false, errors: 1e-3, seed: 0, statistic: Statistic::Worst };
    let one = |i: u32| ensemble.member(scene, i).map_or(f64::INFINITY, |(scene, _)| value(&scene));
    Spread::of((0..members).into_par_iter().map(one).collect())
}
