//! The descents of `fronts`: from each place that a search came to, and from the best design under one bound under the bounds beside it.
//!
//! A search that looks at few frequencies finds designs that are good at those alone, and a simplex stops short of a kink, where several
//! peaks are equally high. So the slope is followed down on finer samples ([`retune_optim::minimax`]), and every end is looked at on the
//! samples of the study of fronts. The best under a bound is then a start under the bounds beside it; when that brings nothing more, the best
//! are followed down once more from places about them, on the finer samples, and places scattered about them and on sides of the box are looked
//! at; and all this as long as it brings anything anywhere. The tasks of a round are independent of each other, so that every thread has work.

use super::candidate::{CONTINUED, Candidate, by_excess};
use super::designs::Fronts;
use super::refinement::{Under, about, descend, on_sides, scattered, screen, set_samples, starts};
use crate::searches::Searches;
use crate::{Error, Observer};
use rayon::prelude::*;
use retune_model::{Design, Parameter, PerVariable};
use retune_study::{Sweep, counted};

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
    /// The design itself is kept if it has no more than this, J; there is no descent.
    most: Option<f64>,
}

impl Fronts {
    /// Makes descents, and then those that they give reason for, until nothing is gained.
    ///
    /// # Errors
    /// A study cannot be followed down under a bound, or the journal cannot be written.
    pub(super) fn go_down(
        &mut self,
        first: Vec<Task>,
        searches: &Searches,
        watch: &dyn Observer,
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
                        tasks.extend(self.once_more(&best, *under, followed.is_none()));
                        *followed = Some(best);
                    }
                }
            }
            if tasks.is_empty() {
                break;
            }
            let before: Vec<Option<Candidate>> = bounds.iter().map(|under| self.best(*under)).collect();
            let found = self.ends(&tasks, searches, watch)?;
            self.designs.extend(found);
            let mut said = format!("round {round}: {}", counted(tasks.len() as u64, "descent"));
            done.append(&mut tasks);
            for (under, before) in bounds.iter().zip(before) {
                let Some(best) = self.best(*under) else { continue };
                let gains = gains(&best, before.as_ref(), *under);
                if gains {
                    let Under { sweep, bound, .. } = under;
                    let before =
                        before.map_or_else(String::new, |before| format!("{:.2} to ", before.e1_max));
                    said +=
                        &format!("; {} {bound} {}: {before}{:.2} J", sweep.name(), sweep.unit(), best.e1_max);
                }
                if gains || round == 1 {
                    tasks.extend(self.beside(&best, *under));
                }
            }
            watch.log(&said)?;
        }
        Ok(())
    }

    /// The ends of descents that keep a value.
    fn ends(
        &self,
        tasks: &[Task],
        searches: &Searches,
        watch: &dyn Observer,
    ) -> Result<Vec<Candidate>, Error> {
        let bar = watch.progress("descents", tasks.len() as u64);
        let end = |Task { under, start, samples, most }: &Task| -> Result<Option<Candidate>, Error> {
            let mut study = self.under(*under, Vec::new())?;
            set_samples(&mut study, *samples);
            let journal = searches.journal();
            let end = match *most {
                None => descend(&study, start, *under, journal)?,
                Some(most) => screen(&study, start, most, *under, journal)?,
            };
            bar.inc(1);
            Ok(end.and_then(|at| self.candidate(under.damper, at, CONTINUED)))
        };
        let ends: Vec<Result<Option<Candidate>, Error>> = tasks.par_iter().map(end).collect();
        bar.finish();
        searches.journal().check()?;
        ends.into_iter().filter_map(Result::transpose).collect()
    }

    /// The descents from a design under a bound.
    pub(super) fn descents(&self, at: &Design, under: Under) -> Vec<Task> {
        let study = self.under(under, Vec::new()).ok();
        let Some(optimize) = study.and_then(|study| study.optimize) else { return Vec::new() };
        let samples = optimize.objective.omega.map_or(1, |band| FINER * (band.samples - 1) + 1);
        starts(at, &optimize).into_iter().map(|start| Task { under, start, samples, most: None }).collect()
    }

    /// The descents from the best design under a bound on the samples of the study of fronts, and places scattered about it; the first time also
    /// the descents from places about it, and places on sides of the box.
    fn once_more(&self, best: &Candidate, under: Under, first: bool) -> Vec<Task> {
        let study = self.under(under, Vec::new()).ok();
        let Some(optimize) = study.and_then(|study| study.optimize).filter(|_| !self.is_steady(under.damper))
        else {
            return Vec::new();
        };
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
        let mut bounds = self.plan.values(from.sweep);
        bounds.sort_by(f64::total_cmp);
        let Some(own) = bounds.iter().position(|bound| *bound == from.bound) else { return Vec::new() };
        let beside = [own.checked_sub(1), Some(own + 1)].into_iter().flatten().filter_map(|i| bounds.get(i));
        let starts = beside.filter_map(|&bound| {
            let under = Under { bound, ..from };
            Some((self.start(best, under, from.bound)?, under))
        });
        let starts: Vec<(Design, Under)> = starts.collect();
        starts.iter().flat_map(|(at, under)| self.descents(at, *under)).collect()
    }

    /// The best design of a damper under a bound, or that which is beyond it by least.
    pub(super) fn best(&self, Under { damper, sweep, bound }: Under) -> Option<Candidate> {
        let own = self.designs.iter().filter(|design| design.damper == damper);
        own.min_by(|a, b| by_excess(a, b, sweep, bound)).cloned()
    }

    /// Where the best design under the bound beside it is worth a descent under this one: a tighter bound that it breaks, or a looser one
    /// if it touches its own, a spring then with the same share of the bound. Otherwise it is as good under both.
    fn start(&self, start: &Candidate, under: Under, from: f64) -> Option<Design> {
        let reached = start.reached(under.sweep);
        if under.bound < from {
            return (reached > under.bound).then_some(start.at);
        }
        let share = if under.sweep == Sweep::K2 { under.bound / from } else { 1.0 };
        let scaled = |variable: Parameter| match variable {
            Parameter::K2 => start.at.get(variable) * share,
            _ => start.at.get(variable),
        };
        (reached > TOUCHES * from).then(|| Design::new(scaled).ok()).flatten()
    }
}

/// Whether a design is better under a bound than another, by more than what is no gain.
fn gains(best: &Candidate, before: Option<&Candidate>, Under { sweep, bound, .. }: Under) -> bool {
    before.is_none_or(|before| {
        best.excess(sweep, bound) < before.excess(sweep, bound) || best.e1_max < (1.0 - GAIN) * before.e1_max
    })
}
