//! The descents of `fronts`: from each place that a search came to, and from the best design under one bound under the bounds beside it.
//!
//! A search that looks at few frequencies finds designs that are good at those alone, and a simplex stops short of a kink, where several
//! peaks are equally high. So the slope is followed down on finer samples ([`retune_optim::minimax`]), and every end is looked at on the
//! samples of the study of fronts. The best under a bound is then a start under the bounds beside it; when that brings nothing more, the best
//! are followed down once more from places about them, on the finer samples, and places scattered about them and on sides of the box are looked
//! at; and all this as long as it brings anything anywhere. The tasks of a round are independent of each other, so that every thread has work.

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
/// A design touches a bound if it reaches this share of it.
const TOUCHES: f64 = 0.97;
/// E1max that is lower by this share is a gain.
const GAIN: f64 = 1e-3;

/// A descent that is to be made, or a design that is to be looked at.
#[derive(Clone, PartialEq)]
pub(super) struct Task {
    under: Under,
    start: PerVariable<f64>,
    samples: usize,
    /// The design itself is kept if it has no more than this, J, and keeps the limits; there is no descent.
    most: Option<f64>,
}

impl Task {
    /// The design at its end, by the objective and within the bounds of a study; none where there is no way down. The journal keeps what is
    /// evaluated.
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
        let of = searched(&study, &search, &search.variables);
        let stage = format!("{} {samples}", under.name());
        let end = if let Some(most) = *most {
            let value = || {
                let (height, _) = of.height_and_runs(at, most);
                if height.violation > 0.0 { f64::MAX } else { height.worst }
            };
            (journal.value(&stage, at, most, value, |_| ()) <= most).then(|| at.clone())
        } else {
            Some(descend(&of, &search, at, journal, &stage).end.x)
        };
        let damper = end.and_then(|end| of.damper(&end).ok());
        Ok(damper.map(|damper| Design::of_varied(&damper, &search.variables)))
    }
}

impl Fronts {
    /// Makes descents, and then those that they give reason for, until nothing is gained.
    pub(super) fn go_down(&mut self, first: Vec<Task>, searches: &Searches) -> Result<(), Error> {
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
                        tasks.extend(self.once_more(&best, *under, followed.is_none()));
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
            let mut said = format!("round {round}: {}", counted(tasks.len() as u64, "descent"));
            done.append(&mut tasks);
            for (under, before) in bounds.iter().zip(before) {
                let Some(best) = self.best(*under) else { continue };
                let gains = gains(&best, before.as_ref(), *under);
                if gains {
                    let (name, bound, unit) = (under.sweep.name(), under.bound, under.sweep.unit());
                    let before =
                        before.map_or_else(String::new, |before| format!("{:.2} to ", before.e1_max));
                    said += &format!("; {name} {bound} {unit}: {before}{:.2} J", best.e1_max);
                }
                if gains || round == 1 {
                    tasks.extend(self.beside(&best, *under));
                }
            }
            searches.watch.log(&said)?;
        }
        Ok(())
    }

    /// The ends of descents that keep a value.
    fn ends(&self, tasks: &[Task], searches: &Searches) -> Result<Vec<Candidate>, Error> {
        let ends = in_a_stage((searches.watch, "descents"), tasks, |task| {
            let end = task.end(self.under(task.under, Vec::new())?, searches.journal())?;
            Ok(end.and_then(|at| self.candidate(task.under.damper, at)))
        });
        searches.journal().check()?;
        Ok(ends?.into_iter().flatten().collect())
    }

    /// The descents from a design under a bound.
    pub(super) fn descents(&self, at: &Design, under: Under) -> Vec<Task> {
        let Some(optimize) = self.optimize(under) else { return Vec::new() };
        let samples = optimize.objective.omega.map_or(1, |band| FINER * (band.samples - 1) + 1);
        starts(at, &optimize).into_iter().map(|start| Task { under, start, samples, most: None }).collect()
    }

    /// The descents from the best design under a bound on the samples of the study of fronts, and places scattered about it; the first time also
    /// the descents from places about it, and places on sides of the box.
    fn once_more(&self, best: &Candidate, under: Under, first: bool) -> Vec<Task> {
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

    /// The descents from the best design under a bound under the bounds beside it.
    fn beside(&self, best: &Candidate, from: Under) -> Vec<Task> {
        if self.is_steady(from.damper) {
            return Vec::new();
        }
        let bounds = self.plan.values(from.sweep);
        let Some(own) = bounds.iter().position(|bound| *bound == from.bound) else { return Vec::new() };
        let beside = [own.checked_sub(1), Some(own + 1)].into_iter().flatten().filter_map(|i| bounds.get(i));
        let descents = |&bound: &f64| {
            let under = Under { bound, ..from };
            start(best, under, from.bound).map(|at| self.descents(&at, under))
        };
        beside.filter_map(descents).flatten().collect()
    }
}

/// Where the best design under the bound beside it is worth a descent under this one: a tighter bound that it breaks, or a looser one if it
/// touches its own, a spring then with the same share of the bound. Otherwise it is as good under both.
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
    (reached > TOUCHES * from).then(|| Design::new(scaled).ok()).flatten()
}

/// Whether a design is better under a bound than another, by more than what is no gain.
fn gains(best: &Candidate, before: Option<&Candidate>, under: Under) -> bool {
    before.is_none_or(|before| {
        best.excess(under) < before.excess(under) || best.e1_max < (1.0 - GAIN) * before.e1_max
    })
}
