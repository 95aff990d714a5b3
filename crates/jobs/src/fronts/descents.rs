//! The descents of `fronts`: from each basin that a search found, and from the best design under a bound with the neighbouring bounds.
//!
//! A search on few frequencies finds designs that are good only there, and a simplex stops short of a kink, where several peaks are equally
//! high. So descents follow on finer samples ([`retune_optim::minimax`]), and each end is evaluated on the samples of the plan. The best
//! design under a bound is then a start under the neighbouring bounds. When that gains nothing more, descents start from points around the
//! best designs and on the samples of the plan, and points scattered around them and on sides of the box are evaluated. All this is
//! repeated until nothing is gained. The tasks of a round are independent, so that every thread has work.

use super::candidate::{Candidate, Under};
use super::designs::Fronts;
use super::places::{about, on_sides, scattered, starts};
use crate::Error;
use crate::rows::in_a_stage;
use crate::searches::Searches;
use crate::tune::descent::descend;
use crate::tune::objective::searched;
use retune_model::{Design, Parameter, PerVariable};
use retune_store::Journal;
use retune_study::{Study, Sweep, counted};

/// Samples of a descent, as a multiple of those of its search.
const FINER: usize = 4;
/// A bound is active if a design reaches this share of it.
const ACTIVE: f64 = 0.97;
/// Relative decrease of E1max that counts as a gain.
const GAIN: f64 = 1e-3;

/// A descent to make, or a design to evaluate.
#[derive(Clone, PartialEq)]
pub(super) struct Task {
    under: Under,
    start: PerVariable<f64>,
    samples: usize,
    /// If given, there is no descent: the design itself is kept if E1max is at most this, J, and it keeps the limits.
    most: Option<f64>,
}

impl Task {
    /// The design at the end of the task, by the objective and within the bounds of a study; none if there is none. The journal keeps its
    /// values.
    fn end(&self, mut study: Study, journal: &Journal) -> Result<Option<Design>, Error> {
        let Self { under, start, samples, most } = self;
        if let Some(optimize) = &mut study.optimize {
            (optimize.global, optimize.surf, optimize.starts) = (None, None, vec![*start]);
            if let Some(band) = &mut optimize.objective.omega {
                band.samples = *samples;
            }
        }
        let search = study.search().map_err(Error::rule(&study))?;
        let Some(at) = search.given.first() else { return Ok(None) };
        let objective = searched(&study, &search, &search.variables);
        let stage = format!("{} {samples}", under.name());
        let end = if let Some(most) = *most {
            let value = || {
                let (height, _) = objective.height_and_runs(at, most);
                if height.violation > 0.0 { f64::MAX } else { height.worst }
            };
            (journal.value(&stage, at, most, value, |_| ()) <= most).then(|| at.clone())
        } else {
            Some(descend(&objective, &search, at, journal, &stage).end.x)
        };
        let damper = end.and_then(|end| objective.damper(&end).ok());
        Ok(damper.map(|damper| Design::of_varied(&damper, &search.variables)))
    }
}

impl Fronts {
    /// Makes descents, and further ones where they gained, until nothing is gained or the plan's rounds are over.
    pub(super) fn descend_until_no_gain(
        &mut self,
        first: Vec<Task>,
        searches: &Searches,
    ) -> Result<(), Error> {
        let bounds = self.all();
        let (mut tasks, mut done) = (first, Vec::new());
        let mut followed: Vec<Option<Candidate>> = vec![None; bounds.len()];
        for round in 1..=self.plan.said.rounds {
            tasks.dedup();
            tasks.retain(|task| !done.contains(task));
            if tasks.is_empty() {
                for (under, followed) in bounds.iter().zip(&mut followed) {
                    let Some(best) = self.best(*under) else { continue };
                    if gains(&best, followed.as_ref(), *under) {
                        tasks.extend(self.refine_best(&best, *under, followed.is_none()));
                        *followed = Some(best);
                    }
                }
            }
            if tasks.is_empty() {
                break;
            }
            let before: Vec<Option<Candidate>> = bounds.iter().map(|under| self.best(*under)).collect();
            let found = self.ends(&tasks, searches)?;
            self.designs.extend(found);
            let mut line = format!("round {round}: {}", counted(tasks.len() as u64, "descent"));
            done.append(&mut tasks);
            for (under, before) in bounds.iter().zip(before) {
                let Some(best) = self.best(*under) else { continue };
                let gains = gains(&best, before.as_ref(), *under);
                if gains {
                    let (name, bound, unit) = (under.sweep.name(), under.bound, under.sweep.unit());
                    let before =
                        before.map_or_else(String::new, |before| format!("{:.2} to ", before.e1_max));
                    line += &format!("; {name} {bound} {unit}: {before}{:.2} J", best.e1_max);
                }
                if gains || round == 1 {
                    tasks.extend(self.with_neighbours(&best, *under));
                }
            }
            searches.watch.log(&line)?;
        }
        Ok(())
    }

    /// The ends of tasks that can be evaluated.
    fn ends(&self, tasks: &[Task], searches: &Searches) -> Result<Vec<Candidate>, Error> {
        let ends = in_a_stage((searches.watch, "descents"), tasks, |task| {
            let end = task.end(self.under(task.under, Vec::new())?, searches.journal())?;
            Ok(end.and_then(|at| self.candidate(task.under.damper, at)))
        });
        searches.journal().check()?;
        Ok(ends?.into_iter().flatten().collect())
    }

    /// The descents from a design under a bound, on finer samples.
    pub(super) fn descents(&self, at: &Design, under: Under) -> Vec<Task> {
        let Some(optimize) = self.optimize(under) else { return Vec::new() };
        let samples = optimize.objective.omega.map_or(1, |band| FINER * (band.samples - 1) + 1);
        starts(at, &optimize).into_iter().map(|start| Task { under, start, samples, most: None }).collect()
    }

    /// Descents from the best design under a bound on the samples of the plan, and points scattered around it; the first time also descents
    /// from points around it, and points on sides of the box.
    fn refine_best(&self, best: &Candidate, under: Under, first: bool) -> Vec<Task> {
        let optimize = self.optimize(under).filter(|_| !self.is_steady(under.damper));
        let Some(optimize) = optimize else { return Vec::new() };
        let samples = self.plan.said.samples;
        let fine = self.descents(&best.at, under).into_iter().map(|task| Task { samples, ..task });
        let mut tasks: Vec<Task> = fine.collect();
        let mut places = scattered(&best.at, &optimize);
        if first {
            tasks.extend(about(&best.at, &optimize).iter().flat_map(|at| self.descents(at, under)));
            if under.sweep == Sweep::K2 {
                places.extend(on_sides(&best.at, &optimize));
            }
        }
        let most = Some(best.e1_max);
        tasks.extend(places.into_iter().map(|start| Task { under, start, samples, most }));
        tasks
    }

    /// Descents from the best design under a bound, with the neighbouring bounds.
    fn with_neighbours(&self, best: &Candidate, from: Under) -> Vec<Task> {
        if self.is_steady(from.damper) {
            return Vec::new();
        }
        let bounds = self.plan.values(from.sweep);
        let Some(position) = bounds.iter().position(|bound| *bound == from.bound) else { return Vec::new() };
        let neighbours =
            [position.checked_sub(1), Some(position + 1)].into_iter().flatten().filter_map(|i| bounds.get(i));
        let descents = |&bound: &f64| {
            let under = Under { bound, ..from };
            start(best, under, from.bound).map(|at| self.descents(&at, under))
        };
        neighbours.filter_map(descents).flatten().collect()
    }
}

/// The start under a bound from the best design under the neighbouring bound `from`: for a tighter bound if the design breaks it, for a
/// looser one if its bound is active, with k2 scaled to the new bound. Otherwise none, since the design is as good under both.
fn start(best: &Candidate, under: Under, from: f64) -> Option<Design> {
    let reached = best.reached(under.sweep);
    if under.bound < from {
        return (reached > under.bound).then_some(best.at);
    }
    let share = if under.sweep == Sweep::K2 { under.bound / from } else { 1.0 };
    let scaled = |variable: Parameter| match variable {
        Parameter::K2 => best.at.get(variable) * share,
        _ => best.at.get(variable),
    };
    (reached > ACTIVE * from).then(|| Design::new(scaled).ok()).flatten()
}

/// Whether a design is better under a bound than `before`, by more than [`GAIN`] in E1max.
fn gains(best: &Candidate, before: Option<&Candidate>, under: Under) -> bool {
    before.is_none_or(|before| {
        best.excess(under) < before.excess(under) || best.e1_max < (1.0 - GAIN) * before.e1_max
    })
}
