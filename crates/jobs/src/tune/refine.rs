//! The fine stage: `fminsearch` from each start, with its log.

use super::log::{self, LOG, STARTS};
use super::objective::{Task, journaled, searched};
use super::turns::OrderedReport;
use crate::Error;
use crate::summary::MadeBy;
use rayon::prelude::*;
use retune_model::Parameter;
use retune_optim::{DesignObjective, Minimum, Row, Stop, minimize};
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_store::{Directory, Journal};
use retune_study::{Search, Study};
use std::ops::ControlFlow;

/// Most successive refinements of a start, each with the motions found at the end of the one before.
const ROUNDS: usize = 4;
/// Values that differ by less than this share are the same.
const SAME: f64 = 1e-6;

pub struct Refined {
    /// The minimised objective; it counts evaluations and failures.
    pub objective: DesignObjective,
    /// A run for each start, in the order of the starts.
    pub runs: Vec<Run>,
    pub winner: usize,
    /// Number of runs that begin at the starts.
    pub starts: usize,
    /// The start of each further run, in words.
    pub beyond: Vec<&'static str>,
}

pub struct Run {
    pub rows: Vec<Row>,
    /// The minimum found; that of the descent where it is lower.
    pub minimum: Minimum,
    pub descent: Option<Descended>,
}

/// The initial value of a descent and its number of evaluations.
#[derive(Clone, Copy, Debug)]
pub struct Descended {
    /// The value at its start.
    pub from: f64,
    pub evaluations: u64,
}

impl Refined {
    /// The start of a further run, in words; none for runs from the starts.
    pub fn beyond(&self, run: usize) -> Option<&'static str> {
        self.beyond.get(run.checked_sub(self.starts)?).copied()
    }

    /// Adds a run that began at `from`.
    pub(super) fn push(&mut self, from: &'static str, run: Run) {
        self.runs.push(run);
        self.beyond.push(from);
        self.take_lowest();
    }

    /// Makes the run with the smallest value the winner; the present winner stays if none is smaller.
    pub(super) fn take_lowest(&mut self) {
        for number in 0..self.runs.len() {
            if self.runs[number].minimum.value < self.best().minimum.value {
                self.winner = number;
            }
        }
    }

    /// The run with the smallest value, the first of equal ones; after `choice::choose` the run chosen for its certificate.
    pub fn best(&self) -> &Run {
        &self.runs[self.winner]
    }
}

/// Refines every start; if there are several, writes their rows to `fminsearch-starts.csv`.
pub(super) fn refine(task: &Task, starts: &[Vec<f64>], results: &Directory) -> Result<Refined, Error> {
    let Task { study, search, watch, .. } = *task;
    let bar = watch.progress("fminsearch", starts.len() as u64);
    let (mut begun, mut best) = (0, f64::INFINITY);
    let refined = each(task, starts, |number, row, design| {
        if row.value < best {
            best = row.value;
            bar.best(&log::value_words(best, study.quantity()));
        }
        let lines = || {
            if number > begun {
                let head = log::screen_header(&search.variables, study.quantity());
                watch.log(&format!("\nfminsearch, start {number} of {}\n{head}", starts.len()))?;
            }
            watch.log(&log::screen(row, design))
        };
        let mut reported = Ok(());
        bar.aside(&mut || reported = lines());
        if number > begun {
            bar.inc(u64::from(begun > 0)); // the start before it is done
            begun = number;
        }
        reported
    })?;
    bar.finish();
    if refined.starts > 1 {
        let mut all = Table::named("start");
        all.columns.extend(crate::columns::table(&log::columns(&search.variables, study.quantity())).columns);
        for (number, run) in refined.runs.iter().enumerate() {
            let rows = table(study, &refined, run)?.rows;
            all.rows.extend(rows.into_iter().map(|row| [cells![number + 1], row].concat()));
        }
        results.write(STARTS, &all.csv())?;
    }
    Ok(refined)
}

/// A row for each iteration of a run, with the complete design.
fn table(study: &Study, refined: &Refined, run: &Run) -> Result<Table, Error> {
    let names = log::columns(refined.objective.variables(), study.quantity());
    let mut table = crate::columns::table(&names);
    for row in &run.rows {
        let Row { iteration, func_count, procedure, value, .. } = row;
        let design = columns(&refined.objective, &row.best)?.into_iter().chain([*value]).map(Cell::Number);
        table
            .push(cells![*iteration, *func_count, procedure.to_string()].into_iter().chain(design).collect());
    }
    Ok(table)
}

/// Refines every start, in parallel where possible. `report` receives the number of the start, from 1, and each row with its complete
/// design, in the order of the starts; its error ends the runs.
pub(super) fn each(
    task: &Task,
    starts: &[Vec<f64>],
    report: impl FnMut(usize, &Row, &[f64]) -> Result<(), Error> + Send,
) -> Result<Refined, Error> {
    let Task { study, search, journal, place, watch } = *task;
    let stage = format!("{place}fminsearch");
    let mut objective = searched(study, search, &search.variables);
    let ordered = OrderedReport::new(report);
    let report_of = |number: usize| {
        let ordered = &ordered;
        move |row: &Row, design: &[f64]| {
            watch.begin();
            ordered.report(number, row, design)
        }
    };
    let runs: Vec<Result<Run, Error>> = if objective.goal().follows_motions() {
        // Sequentially: each run changes the motions that the objective follows.
        let run = |(number, start): (usize, &Vec<f64>)| {
            let run = run_following(&mut objective, search, start, (journal, &stage), report_of(number));
            ordered.end(number);
            run
        };
        starts.iter().enumerate().map(run).take_while(|_| ordered.is_ok()).collect()
    } else {
        let run = |(number, start): (usize, &Vec<f64>)| {
            let run = simplex(&objective, search, start, (journal, &stage), report_of(number));
            ordered.end(number);
            run
        };
        starts.par_iter().enumerate().map(run).collect()
    };
    ordered.check()?;
    let runs = runs.into_iter().collect::<Result<Vec<Run>, Error>>()?;
    let mut refined = Refined { objective, runs, winner: 0, starts: starts.len(), beyond: Vec::new() };
    refined.take_lowest();
    Ok(refined)
}

/// The complete design, in the order of the columns of its tables.
pub(super) fn columns(objective: &DesignObjective, design: &[f64]) -> Result<Vec<f64>, Error> {
    let damper = objective.damper(design)?;
    Ok(Parameter::columns(objective.variables()).iter().map(|column| column.get(&damper)).collect())
}

/// A run whose objective covers all stable motions. The motions found at the start are followed; if the end has a motion with a larger
/// value, the run continues from there with the motions found there. `report` receives each row with its complete design and may end the
/// run.
fn run_following(
    objective: &mut DesignObjective,
    search: &Search,
    start: &[f64],
    (journal, stage): (&Journal, &str),
    mut report: impl FnMut(&Row, &[f64]) -> ControlFlow<()>,
) -> Result<Run, Error> {
    objective.learn(start)?;
    let mut whole = simplex(objective, search, start, (journal, &format!("{stage} {start:?}")), &mut report)?;
    for round in 1..=ROUNDS {
        let from = whole.minimum.clone();
        if from.stop == Stop::Interrupted {
            break;
        }
        whole.minimum.value = objective.learn(&from.x)?.ranked;
        if round == ROUNDS || whole.minimum.value <= (1.0 + SAME) * from.value {
            break;
        }
        let stage = format!("{stage} {:?}", from.x);
        let shifted = |row: &Row| Row {
            iteration: row.iteration + from.iterations,
            func_count: row.func_count + from.func_count,
            ..row.clone()
        };
        let next = simplex(objective, search, &from.x, (journal, &stage), |row, design| {
            report(&shifted(row), design)
        })?;
        whole.rows.extend(next.rows.iter().map(shifted));
        whole.minimum = Minimum {
            iterations: from.iterations + next.minimum.iterations,
            func_count: from.func_count + next.minimum.func_count,
            ..next.minimum
        };
    }
    Ok(whole)
}

/// Runs the refinement from a design without reporting its progress.
pub(super) fn run_unreported(
    task: &Task,
    objective: &mut DesignObjective,
    start: &[f64],
) -> Result<Run, Error> {
    let stage = format!("{}fminsearch", task.place);
    let report = |_: &Row, _: &[f64]| {
        task.watch.begin();
        ControlFlow::Continue(())
    };
    if objective.goal().follows_motions() {
        run_following(objective, task.search, start, (task.journal, &stage), report)
    } else {
        simplex(objective, task.search, start, (task.journal, &stage), report)
    }
}

/// One simplex run, with the motions that the objective follows held fixed.
fn simplex(
    objective: &DesignObjective,
    search: &Search,
    start: &[f64],
    (journal, stage): (&Journal, &str),
    mut report: impl FnMut(&Row, &[f64]) -> ControlFlow<()>,
) -> Result<Run, Error> {
    let mut rows = Vec::new();
    let mut design = Ok(());
    let found = minimize(journaled(objective, journal, stage, || ()), start, search.options.clone(), |row| {
        if journal.is_broken() {
            return ControlFlow::Break(());
        }
        rows.push(row.clone());
        match columns(objective, &row.best) {
            Ok(whole) => report(row, &whole),
            Err(error) => {
                design = Err(error);
                ControlFlow::Break(())
            }
        }
    });
    design?;
    journal.check()?;
    let minimum = found.map_err(|source| Error::Search { source, failures: objective.failures() })?;
    Ok(Run { rows, minimum, descent: None })
}

/// Writes `fminsearch.csv` and `fminsearch.txt` of the run that was chosen.
pub(super) fn write_winner(study: &Study, refined: &Refined, results: &Directory) -> Result<(), Error> {
    let varied = refined.objective.variables();
    results.write(LOG, &table(study, refined, refined.best())?.csv())?;
    let mut lines = vec![log::table1_header(varied, study.quantity())];
    for row in &refined.best().rows {
        lines.push(log::table1(row, &columns(&refined.objective, &row.best)?));
    }
    Ok(results.write("fminsearch.txt", &format!("{}\n\n{}\n", lines.join("\n"), MadeBy::new(study)))?)
}
