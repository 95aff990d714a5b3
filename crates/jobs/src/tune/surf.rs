//! The coarse stage: the objective on a grid.

use super::log::{GRID, value_words};
use super::objective::{Task, coarse, journaled, searched};
use super::refine::columns;
use crate::Error;
use crate::rows::{Rows, compute};
use retune_model::Measure;
use retune_optim::{Counts, DesignObjective, Failures, Grid, Parameter, best_separated_above};
use retune_report::table::{Cell, line};
use retune_store::Directory;
use retune_study::{Coarse, Search, Study, counted, joined, short};
use std::time::Instant;

// A journal must hold every grid that a study may have.
const _: () = assert!(retune_study::MOST_GRID_POINTS <= retune_store::MOST_POINTS);

/// The objective at every point of the grid.
pub struct Surf {
    /// The grid's parameters, in the order of its axes.
    pub variables: Vec<Parameter>,
    pub grid: Grid,
    /// The value at each point in the unit of the quantity, by the objective of the grid; at most [`Coarse::up_to`], +∞ where it could not
    /// be computed.
    pub values: Vec<f64>,
    pub best: usize,
    /// The value at the best point in the unit of the quantity, at the tolerance of refinements and with the peaks between samples.
    pub least: f64,
    /// The numbers of the points where refinements start.
    chosen: Vec<usize>,
    /// The points that could not be computed.
    pub failures: Failures,
    pub counts: Counts,
}

/// The designs of a grid, each with its value.
pub(super) struct Designs {
    pub objective: DesignObjective,
    /// The value above which values are not distinguished.
    pub most: f64,
    pub grid: Grid,
}

impl Designs {
    /// The designs of the grid of a study; none where it has no grid.
    pub(super) fn of(study: &Study, search: &Search) -> Option<Self> {
        let (variables, grid) = search.surf.clone()?;
        Some(Self { objective: coarse(study, search, &variables), most: study.coarse().up_to(), grid })
    }
}

impl Rows for Designs {
    fn len(&self) -> usize {
        self.grid.len()
    }

    fn width(&self) -> usize {
        1
    }

    fn numbers(&self, row: usize) -> (Vec<f64>, Option<String>) {
        (vec![self.objective.value_up_to(&point(&self.grid, row), self.most)], None)
    }

    fn recall(&self, numbers: &[f64]) {
        self.objective.recall(numbers[0]);
    }
}

/// Computes the grid of a study, if it has one, and writes `surf.csv`.
pub(super) fn surf(task: &Task, results: &Directory) -> Result<Option<Surf>, Error> {
    let Task { study, search, journal, watch, .. } = *task;
    let Some(rows) = Designs::of(study, search) else { return Ok(None) };
    let (grid, variables) = (&rows.grid, rows.objective.variables().to_vec());
    let axes: Vec<String> = grid.axes().iter().map(|axis| axis.points().to_string()).collect();
    let (axes, points, over) =
        (axes.join(" x "), counted(grid.len() as u64, "point"), joined(&variables, " "));
    let up_to = study.coarse().most.map(|most| format!(", up to {}", value_words(most, study.quantity())));
    let up_to = up_to.unwrap_or_default();
    watch.log(&format!("surf: {axes} = {points} over {over}{}{up_to}", study.coarse()))?;

    let begun = Instant::now();
    let bar = watch.progress("surf", grid.len() as u64);
    let found = compute(&rows, 0..rows.len(), journal, &*bar);
    let Designs { objective, grid, .. } = rows;
    let values: Vec<f64> = found.into_iter().flat_map(|(numbers, _)| numbers).collect();
    bar.finish();
    journal.check()?;

    let (failures, mut counts) = (objective.failures(), objective.counts());
    let exact = searched(study, search, &variables);
    let value = journaled(&exact, journal, "surf", || ());
    let is_coarse = study.coarse() != Coarse::default();
    let at = |i: usize| if is_coarse { value(&point(&grid, i), f64::INFINITY) } else { values[i] };
    let chosen = best_separated_above(&grid, &values, at, search.starts, search.apart);
    journal.check()?;
    let Some(&(best, least)) = chosen.first() else {
        return Err(Error::NoStart(if failures.count > 0 { failures } else { exact.failures() }));
    };
    counts.evaluations += exact.counts().evaluations;
    let chosen = chosen.into_iter().map(|(i, _)| i).collect();
    write(&objective, &grid, &values, study.quantity(), results)?;
    let surf = Surf { variables, grid, values, best, least, chosen, failures, counts };
    watch.log(&surf.report(study.quantity(), begun.elapsed().as_secs_f64()))?;
    Ok(Some(surf))
}

fn point(grid: &Grid, i: usize) -> Vec<f64> {
    let mut point = vec![0.0; grid.dim()];
    grid.point(i, &mut point);
    point
}

/// Writes a row for each point: the complete design and the value.
fn write(
    objective: &DesignObjective,
    grid: &Grid,
    values: &[f64],
    quantity: Measure,
    results: &Directory,
) -> Result<(), Error> {
    let mut file = results.file(GRID)?;
    let names = Parameter::columns(objective.variables());
    let names = names.iter().map(|one| one.symbol()).chain([quantity.name()]).map(Cell::from);
    file.push(&line(&names.collect::<Vec<_>>()))?;
    let mut point = vec![0.0; grid.dim()];
    for (i, value) in values.iter().enumerate() {
        grid.point(i, &mut point);
        let row = columns(objective, &point)?.into_iter().chain([*value]).map(Cell::Number);
        file.push(&line(&row.collect::<Vec<_>>()))?;
    }
    file.finish()?;
    Ok(())
}

impl Surf {
    pub fn point(&self, i: usize) -> Vec<f64> {
        point(&self.grid, i)
    }

    /// Where the refinements start: a value for each tuned parameter.
    pub(super) fn starts(&self, search: &Search) -> Vec<Vec<f64>> {
        let start = |&i: &usize| {
            let point = self.point(i);
            let on_grid = |variable| self.variables.iter().position(|other| *other == variable);
            let value = |&variable: &Parameter| match on_grid(variable) {
                Some(axis) => point[axis],
                None => variable.get(&search.damper),
            };
            search.variables.iter().map(value).collect()
        };
        self.chosen.iter().map(start).collect()
    }

    fn report(&self, quantity: Measure, seconds: f64) -> String {
        let failed = match self.failures.count {
            0 => String::new(),
            count => format!("; {count} could not be computed"),
        };
        let point: Vec<String> = self.point(self.best).iter().map(|value| short(*value)).collect();
        let at: Vec<String> = self
            .variables
            .iter()
            .zip(point)
            .map(|(variable, value)| format!("{variable} = {value}"))
            .collect();
        let least = value_words(self.least, quantity);
        format!("surf: {seconds:.1} s; least {} {least} at {}{failed}", quantity.name(), at.join(", "))
    }
}
