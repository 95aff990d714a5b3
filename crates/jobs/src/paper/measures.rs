//! Measures of a design, J: at one frequency, near the design, and the worst over a band. The worst is also taken on ever finer frequencies
//! and for practically equal designs, which shows how far it can be trusted.

use super::plan::{Plan, damper};
use crate::Error;
use rayon::prelude::*;
use retune_dynamics::Parameter;
use retune_dynamics::parameter::evenly;
use retune_model::{Positive, Scene};
use retune_optim::{Ensemble, FrequencyBand, Goal, Objective, Response, Statistic};
use retune_report::cells;
use retune_report::document::Verdict;
use retune_report::table::{Cell, Column, Table};
use retune_solver::{Rows, Sample, Settings, Window, trajectory};

/// The band for which dampers are tuned, rad/s.
pub const BAND: [f64; 2] = [5.0, 8.0];

/// Least, median and largest of some energies, J.
pub struct Spread {
    pub least: f64,
    pub median: f64,
    pub largest: f64,
}

impl Spread {
    /// The spread of some values; NaN without any.
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let last = values.len().saturating_sub(1) as f64;
        let at = |share: f64| values.get((share * last).round() as usize).copied().unwrap_or(f64::NAN);
        Self { least: at(0.0), median: at(0.5), largest: at(1.0) }
    }

    pub fn holds(&self, value: f64) -> bool {
        (self.least..=self.largest).contains(&value)
    }

    pub fn words(&self) -> String {
        format!("{:.0} – {:.0} (median {:.0})", self.least, self.largest, self.median)
    }
}

/// The least and the largest of some numbers.
pub fn ends(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], one| [low.min(one), high.max(one)])
}

/// The objective of the page: the worst over [`BAND`].
pub fn over_band(samples: usize, response: Response) -> Objective {
    let [from, to] = BAND.map(Positive::new);
    let omega = from.ok().zip(to.ok()).map(|(from, to)| FrequencyBand { from, to, samples, relative: false });
    Objective { omega, response, ..Objective::default() }
}

/// E1max of a scene at its frequency; infinite where it cannot be run.
pub fn energy(scene: &Scene, window: Window, settings: &Settings) -> f64 {
    let goal = Goal { objective: Objective::default(), ..window.into() };
    goal.evaluate(scene, settings, f64::INFINITY).map_or(f64::INFINITY, |found| found.value)
}

/// E1max of a scene at its frequency in the window of the plan.
pub fn at_omega(plan: &Plan, scene: &Scene) -> f64 {
    energy(scene, plan.window(), &plan.settings())
}

/// The motion of a scene from rest in a window, every `interval` seconds.
pub fn recorded(plan: &Plan, scene: &Scene, window: Window, interval: f64) -> Result<Vec<Sample>, Error> {
    let mut samples = Vec::new();
    trajectory(scene, window, &plan.settings(), Rows::every(interval), &mut |sample| samples.push(*sample))?;
    Ok(samples)
}

/// A number as in data files: rounded to a millionth, without the rounding errors of summed intervals.
pub fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// The scene of the best TMD with the mass of the paper's: k2 and c2 minimise the steady worst case over the band at the tuned stiffness.
pub fn best_tmd(plan: &Plan) -> Result<Scene, Error> {
    let scene = plan.tmd.scene;
    Ok(Scene { damper: Some(crate::retention::best_tmd(&scene, damper(&plan.tmd)?, BAND)?.0), ..scene })
}

pub fn tmd_words(scene: &Scene) -> String {
    scene.damper.map_or(String::new(), |damper| {
        format!("k2 = {:.0} N/m, c2 = {:.0} N·s/m", damper.stiffness.get(), damper.damping.get())
    })
}

/// The values of `members` scenes whose k1, k2, c2, D and C are off by at most 0.1 %, less than the rounding of the printed D = 0.06 m.
pub fn near(members: u32, scene: &Scene, value: impl Fn(&Scene) -> f64 + Sync) -> Spread {
    let ensemble = Ensemble { members, phases: false, errors: 1e-3, seed: 0, statistic: Statistic::Worst };
    let one = |i: u32| ensemble.member(scene, i).map_or(f64::INFINITY, |(scene, _)| value(&scene));
    Spread::of((0..members).into_par_iter().map(one).collect())
}

/// Number of designs within ±0.1 %.
const MEMBERS: u32 = 21;

/// The meaning of "decided", for the rules of statements.
pub const RULE: &str = "Each number is the largest on the finest frequencies (table); what does not hold as well at the least and at the largest of 21 designs within ±0.1 % cannot be decided.";

/// The largest E1max on samples of a band, J: lower bounds of the worst case, each reached by a run.
pub struct Ladder {
    /// The values on the frequencies of the plan's ladder.
    values: Vec<f64>,
    /// The values of practically equal designs.
    pub near: Spread,
}

pub type Pick = fn(&Ladder) -> f64;
/// The numbers for which a verdict must hold: the finest, and both ends of the spread.
const PICKS: [Pick; 3] = [Ladder::finest, |ladder| ladder.near.least, |ladder| ladder.near.largest];

impl Ladder {
    /// The ladder of a scene over the frequencies of Figure 3.
    pub fn climb(plan: &Plan, scene: &Scene) -> Self {
        let near = near(MEMBERS, scene, |scene| sampled(plan, scene, middle(plan)));
        let values = plan.file.ladder.iter().map(|samples| sampled(plan, scene, *samples)).collect();
        Self { values, near }
    }

    pub fn finest(&self) -> f64 {
        self.values.last().copied().unwrap_or(f64::NAN)
    }

    /// The finest value and the spread, in words.
    pub fn words(&self) -> String {
        let Spread { least, largest, .. } = self.near;
        format!(
            "{:.0} J on the finest frequencies, {least:.0} to {largest:.0} J within ±0.1 %",
            self.finest()
        )
    }

    /// Its cells in a [`ladder_table`].
    pub fn cells(&self) -> Vec<Cell> {
        let values = self.values.iter().map(|value| format!("{value:.1}").into());
        values.chain(cells![self.near.words()]).collect()
    }
}

/// The number of frequencies in the middle of the ladder.
fn middle(plan: &Plan) -> usize {
    let rungs = &plan.file.ladder;
    rungs.get(rungs.len() / 2).copied().unwrap_or(2)
}

pub fn finest(plan: &Plan) -> usize {
    plan.file.ladder.last().copied().unwrap_or(2)
}

/// The largest E1max on evenly spaced frequencies, J, without a search between them.
pub fn sampled(plan: &Plan, scene: &Scene, samples: usize) -> f64 {
    let value = |omega| Parameter::Omega.at(*scene, omega).map_or(f64::NAN, |scene| at_omega(plan, &scene));
    let omega = evenly(plan.file.omega.from, plan.file.omega.to, samples);
    omega.into_par_iter().map(value).reduce(|| f64::NEG_INFINITY, f64::max)
}

/// Whether a statement holds; none unless it is the same on the finest frequencies and at both ends of the spread.
pub fn decided(statement: impl Fn(Pick) -> bool) -> Option<bool> {
    let [finest, least, largest] = PICKS.map(statement);
    (finest == least && finest == largest).then_some(finest)
}

/// The verdict on a statement of several parts, each of which must be decided.
pub fn verdict(parts: &[Option<bool>]) -> Verdict {
    let known: Option<Vec<bool>> = parts.iter().copied().collect();
    known.map_or(Verdict::Undecided, |parts| Verdict::of_all(&parts))
}

/// A table of ladders without rows; `head` names the columns before them.
pub fn ladder_table(plan: &Plan, head: &str) -> Table {
    let mut table = Table::headed(head);
    table.columns.extend(plan.file.ladder.iter().map(|samples| Column::new(format!("{samples} ω, J"), "")));
    let near = format!("{MEMBERS} designs within ±0.1 % on {} ω, J", middle(plan));
    table.columns.push(Column::new(near, ""));
    table
}
