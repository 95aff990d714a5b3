//! How far a worst over a band can be trusted: the same on ever finer frequencies, and of designs that are practically equal.

use super::item::{Grid, Verdict};
use super::measures::{Spread, energy, near};
use super::plan::Plan;
use rayon::prelude::*;
use retune_dynamics::parameter::evenly;
use retune_model::{NonNegative, Scene};
use retune_optim::Objective;

/// Designs within ±0.1 %.
const MEMBERS: u32 = 21;

/// The largest E1max on samples of a band, J: lower bounds, each of which a run reaches.
pub struct Ladder {
    /// On the frequencies of the plan's ladder.
    values: Vec<f64>,
    /// Of the practically equal designs.
    pub near: Spread,
}

/// A value of a ladder that a verdict must hold on.
type Pick = fn(&Ladder) -> f64;
/// The finest, and both ends of the spread.
const PICKS: [Pick; 3] = [Ladder::finest, |ladder| ladder.near.least, |ladder| ladder.near.largest];

impl Ladder {
    /// Of a scene over the frequencies of Figure 3.
    pub fn climb(plan: &Plan, scene: &Scene) -> Self {
        let rungs = &plan.file.ladder;
        let near = near(MEMBERS, scene, |scene| sampled(plan, scene, middle(rungs)));
        Self { values: rungs.iter().map(|samples| sampled(plan, scene, *samples)).collect(), near }
    }

    /// On the finest frequencies.
    pub fn finest(&self) -> f64 {
        self.values.last().copied().unwrap_or(f64::NAN)
    }

    /// The range of the finest and the spread, in words.
    pub fn words(&self) -> String {
        let Spread { least, largest, .. } = self.near;
        format!(
            "{:.0} J on the finest frequencies, {least:.0} to {largest:.0} J within ±0.1 %",
            self.finest()
        )
    }

    /// Cells of a row of [`grid`].
    pub fn cells(&self) -> Vec<String> {
        let mut cells: Vec<String> = self.values.iter().map(|value| format!("{value:.1}")).collect();
        cells.push(self.near.words());
        cells
    }
}

fn middle(rungs: &[usize]) -> usize {
    rungs.get(rungs.len() / 2).copied().unwrap_or(2)
}

/// The finest number of frequencies.
pub fn finest(plan: &Plan) -> usize {
    plan.file.ladder.last().copied().unwrap_or(2)
}

/// The largest on the finest frequencies, J.
pub fn on_the_finest(plan: &Plan, scene: &Scene) -> f64 {
    sampled(plan, scene, finest(plan))
}

/// The largest on evenly spaced frequencies, without a search between them.
fn sampled(plan: &Plan, scene: &Scene, samples: usize) -> f64 {
    let (from, to) = (plan.file.omega.from, plan.file.omega.to);
    let value = |omega: f64| {
        let Ok(frequency) = NonNegative::new(omega) else { return f64::NAN };
        let mut scene = *scene;
        scene.forcing.frequency = frequency;
        energy(&scene, &Objective::default(), plan.window(), &plan.settings())
    };
    evenly(from, to, samples).into_par_iter().map(value).reduce(|| f64::NEG_INFINITY, f64::max)
}

/// What a statement is on the finest frequencies and at both ends of the spread, where it is the same on all three.
pub fn decided(statement: impl Fn(&dyn Fn(&Ladder) -> f64) -> bool) -> Option<bool> {
    let [finest, least, largest] = PICKS.map(|pick| statement(&pick));
    (finest == least && finest == largest).then_some(finest)
}

/// The verdict on a statement of several parts, each of which must be decided.
pub fn verdict(parts: &[Option<bool>]) -> Verdict {
    let known: Option<Vec<bool>> = parts.iter().copied().collect();
    known.map_or(Verdict::Undecided, |parts| Verdict::of_all(&parts))
}

/// What "decided" means, for the rules of statements.
pub const RULE: &str = "Each number is the largest on the finest frequencies (table); what does not hold as well at the least and at the largest of 21 designs within ±0.1 % cannot be decided.";

/// A table of ladders; `head` names the columns before them.
pub fn grid(plan: &Plan, caption: &str, head: &[&str]) -> Grid {
    let rungs = &plan.file.ladder;
    let mut all: Vec<String> = head.iter().map(|&name| name.to_owned()).collect();
    all.extend(rungs.iter().map(|samples| format!("{samples} ω, J")));
    all.push(format!("{MEMBERS} designs within ±0.1 % on {} ω, J", middle(rungs)));
    Grid { head: all, ..Grid::new(caption, &[]) }
}
