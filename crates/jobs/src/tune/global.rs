//! The global search of a study, and the basins that it and the refinements found.

use super::log::{BASINS, value_words};
use super::objective::{Task, coarse, journaled, searched};
use super::refine::{Refined, Run, columns};
use crate::Error;
use crate::amount::{Amount, measured};
use rayon::prelude::*;
use retune_model::{Measure, Parameter, PerVariable};
use retune_optim::{
    Basin, Counts, Descent, DesignObjective, Failures, Point, Space, basins, explore, value_of,
};
use retune_report::cells;
use retune_report::table::{Cell, Column, Table};
use retune_store::Directory;
use retune_study::{Search, counted, joined, short};
use serde::Serialize;
use std::time::Instant;

pub struct Explored {
    /// The CMA-ES searches, in the order of their starts.
    pub searches: Vec<Descent>,
    pub basins: Vec<Basin>,
    pub space: Space,
    /// Distance below which two minima belong to one basin.
    pub apart: f64,
    pub failures: Failures,
    pub counts: Counts,
}

/// Runs the global search of a study, if it asks for one. The journal keeps its values under names that begin with `place`.
pub(super) fn global(task: &Task) -> Result<Option<Explored>, Error> {
    let Task { study, search, journal, place, watch } = *task;
    let Some((global, space, apart)) = search.global.clone() else { return Ok(None) };
    let objective = coarse(study, search, &search.variables);
    watch.log(&format!(
        "global: {} over the box of {}, then {} of at most {} each{}",
        counted(global.samples.into(), "design"),
        joined(&search.variables, " "),
        counted(global.searches as u64, "CMA-ES search"),
        counted(global.evaluations, "evaluation"),
        study.coarse()
    ))?;
    let begun = Instant::now();
    let most = u64::from(global.samples) + global.searches as u64 * global.evaluations;
    let bar = watch.progress("global", most);
    let stages = ["global", "ends"].map(|stage| format!("{place}{stage}"));
    let value = journaled(&objective, journal, &stages[0], || bar.known());
    let found = explore(&value, &space, &global, || bar.inc(1));
    bar.finish();
    journal.check()?;
    let failures = objective.failures();
    let searches = found.map_err(|source| Error::Global { source, failures: failures.clone() })?;
    let exact = searched(study, search, &search.variables);
    let value = journaled(&exact, journal, &stages[1], || ());
    let reevaluate = |point: &Point| Point { value: value(&point.x, f64::INFINITY), x: point.x.clone() };
    let ends: Vec<Point> = searches.par_iter().map(|search| reevaluate(&search.found)).collect();
    let basins = basins(value, &space, &ends, apart);
    let counts = objective.counts().and(exact.counts());
    let explored = Explored { searches, basins, space, apart, failures, counts };
    watch.log(&explored.report(search, study.quantity(), begun.elapsed().as_secs_f64()))?;
    Ok(Some(explored))
}

impl Explored {
    /// The starts of refinements: the best design of each of the best `count` basins.
    pub(super) fn starts(&self, count: usize) -> Vec<Vec<f64>> {
        self.basins.iter().take(count).map(|basin| basin.best.x.clone()).collect()
    }

    fn report(&self, search: &Search, quantity: Measure, seconds: f64) -> String {
        let best = &self.basins[0].best;
        let at = search.variables.iter().zip(&best.x);
        let at: Vec<String> = at.map(|(variable, value)| format!("{variable} = {}", short(*value))).collect();
        let evaluations = counted(self.counts.evaluations, "evaluation");
        let searches = counted(self.searches.len() as u64, "search");
        let (places, best) = (counted(self.basins.len() as u64, "place"), value_words(best.value, quantity));
        let at = at.join(", ");
        format!(
            "global: {seconds:.1} s, {evaluations}; {searches} came to {places}; the best has {best} at {at}"
        )
    }
}

/// Basins after the refinements, and how often each was reached.
#[derive(Clone, Debug, Serialize)]
pub struct Basins {
    /// Designs evaluated as samples and by the searches.
    pub(crate) evaluations: u64,
    pub(crate) searches: usize,
    /// Number of searches that ended in the basin of the optimum.
    pub(crate) reached_optimum: usize,
    /// Best first.
    pub(crate) basins: Vec<BasinNote>,
}

/// A basin: its best design, and the searches and refinements that ended in it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct BasinNote {
    #[serde(flatten)]
    pub(crate) design: PerVariable<f64>,
    /// null if it breaks a limit.
    #[serde(flatten)]
    pub(crate) found: Amount,
    pub(crate) searches: usize,
    pub(crate) refinements: usize,
}

impl Basins {
    /// Groups the minima of searches and refinements; where a basin was refined, the refined minimum replaces that of the search. In the
    /// runs the refinements of basins follow `skip` others, in the order of the basins.
    pub(super) fn new(task: &Task, explored: &Explored, refined: &Refined, skip: usize) -> Self {
        let Task { study, search, journal, place, .. } = *task;
        let quantity = study.quantity();
        let runs = &refined.runs;
        let stage = format!("{place}basins");
        let value = journaled(&refined.objective, journal, &stage, || ());
        let end = |run: &Run| Point { x: run.minimum.x.clone(), value: run.minimum.value };
        let count = explored.basins.len().min(search.starts);
        let mut points: Vec<Point> = explored.basins.iter().map(|basin| basin.best.clone()).collect();
        for (point, run) in points.iter_mut().zip(&runs[skip..]).take(count) {
            *point = end(run);
        }
        let others = runs[..skip].iter().chain(&runs[skip + count..]);
        points.extend(others.map(end));
        let is_refined = |i: usize| i < count || i >= explored.basins.len();
        let notes =
            basins(value, &explored.space, &points, explored.apart).into_iter().map(|basin| BasinNote {
                design: PerVariable::of(&search.variables, &basin.best.x),
                found: Amount::new(quantity, value_of(basin.best.value)),
                searches: basin
                    .reached_by
                    .iter()
                    .filter_map(|&i| explored.basins.get(i))
                    .map(|basin| basin.reached_by.len())
                    .sum(),
                refinements: basin.reached_by.iter().filter(|&&i| is_refined(i)).count(),
            });
        let basins: Vec<BasinNote> = notes.collect();
        Self {
            evaluations: explored.counts.evaluations,
            searches: explored.searches.len(),
            reached_optimum: basins.first().map_or(0, |basin| basin.searches),
            basins,
        }
    }

    /// The best design of each basin, best first.
    pub(super) fn places(&self) -> impl Iterator<Item = PerVariable<f64>> {
        self.basins.iter().map(|basin| basin.design)
    }

    pub(super) fn write(&self, objective: &DesignObjective, results: &Directory) -> Result<(), Error> {
        let quantity = self.basins.first().map_or_else(Measure::default, |basin| basin.found.quantity);
        let mut table = Table::new(["basin", "searches", "refinements"].map(|name| Column::new(name, "")));
        table.columns.extend(
            Parameter::columns(objective.variables()).iter().map(|one| Column::new(one.symbol(), one.unit())),
        );
        table.columns.push(Column::new(quantity.name(), quantity.unit()));
        for (i, basin) in self.basins.iter().enumerate() {
            let BasinNote { design: at, found, searches, refinements } = basin;
            let x: Vec<f64> = objective.variables().iter().filter_map(|&v| at.get(v)).collect();
            let mut row = cells![i + 1, *searches, *refinements];
            row.extend(columns(objective, &x)?.into_iter().chain([found.value]).map(Cell::Number));
            table.push(row);
        }
        Ok(results.write(BASINS, &table.csv())?)
    }

    pub(super) fn report(&self) -> String {
        let Self { searches, reached_optimum, basins, .. } = self;
        let next = basins.get(1).map(|basin| basin.found).filter(|found| !found.value.is_nan());
        let next = next.map_or_else(String::new, |Amount { value, quantity, .. }| {
            format!("; the next has {}", measured(value, quantity))
        });
        let lonely = match reached_optimum {
            0 => "no search came to it, a given start or the grid did",
            1 => "a lonely one: more searches may find better",
            _ => "",
        };
        let lonely = if lonely.is_empty() { String::new() } else { format!(" ({lonely})") };
        format!(
            "basins: {} found; that of the optimum was reached by {reached_optimum} of {}{lonely}{next}",
            basins.len(),
            counted(*searches as u64, "search")
        )
    }
}
