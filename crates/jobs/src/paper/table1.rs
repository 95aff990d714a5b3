//! Table 1: the log of fminsearch, and the energies of the paper's rows.

use super::item::{Grid, Item, Verdict};
use super::measures::{Spread, at_omega, energy, near};
use super::plan::Plan;
use super::protocols::{PAPER, protocols};
use super::stiff::stiffness;
use crate::Error;
use crate::tune::log::{csv, csv_header, scientific};
use rayon::prelude::*;
use retune_dynamics::{Stretch, classify, follow};
use retune_model::{Measure, Scene};
use retune_optim::{DesignObjective, Failures, Minimum, Objective, Options, Parameter, Row, Stop, minimize};
use retune_solver::{Settings, Window};
use retune_study::Setting;
use std::cell::RefCell;
use std::ops::ControlFlow;

const PERTURBATIONS: u32 = 201;

/// Radii with which the rows are repeated, m, and windows, s: neither is in the paper.
const RADII: [f64; 5] = [0.1, 0.5, 2.0, 5.0, 10.0];
/// Designs of each median of that table.
const FEW: u32 = 51;

/// Makes Table 1.
///
/// # Errors
/// A run fails.
pub fn table1(plan: &Plan) -> Result<Item, Error> {
    let mut item = Item::new(
        "table1",
        "Table 1. The log of fminsearch",
        "Three rows of an fminsearch run and its result: E1max falls from 666.2 J over 661.1 J and 573.1 J to 563.0 J.",
        plan.made_by("MATLAB's fminsearch algorithm with its default tolerances."),
    );
    let damper = plan.ssvi.scene.damper.ok_or_else(|| Error::NoStart(Failures::default()))?;
    let objective = |window: Window, settings: Settings| {
        DesignObjective::new(plan.ssvi.scene, damper, Parameter::PAPER.to_vec(), window, settings)
    };
    let own = objective(plan.window(), plan.settings());
    worth(plan, &objective, &mut item)?;
    item.grids.push(left_out(plan)?);
    protocols(plan, &mut item)?;
    stiffness(plan, &mut item)?;
    for (start, name) in [(0, "row 1"), (3, "the published optimum")] {
        let (rows, found) = search(&own, PAPER[start].0)?;
        log(&rows, &found, name, &mut item);
    }
    row_3(&mut item)?;
    Ok(item)
}

fn worth(
    plan: &Plan,
    objective: &(impl Fn(Window, Settings) -> DesignObjective + Sync),
    item: &mut Item,
) -> Result<(), Error> {
    let head = [
        "row",
        "k2, N/m",
        "c2, N·s/m",
        "D, m",
        "C, m",
        "paper: E1max, J",
        "ours, J",
        "whole run, J",
        "parameters ±0.1 %, J",
        "rtol 1e-6 … 1e-12, J",
        "motion",
        "exponent, 1/s",
    ];
    let mut grid = Grid::new("The paper's rows, computed again", &head);
    let whole = Window { from: 0.0, to: plan.window().to };
    let own = objective(plan.window(), plan.settings());
    let bar = plan.watch.progress("table 1", PAPER.len() as u64 * u64::from(PERTURBATIONS));
    let mut fits = Vec::new();
    for (i, (design, paper)) in PAPER.iter().enumerate() {
        let value = own.value(design, f64::INFINITY);
        let scene = own.scene(design)?;
        let near = near(PERTURBATIONS, &scene, |scene| {
            bar.inc(1);
            at_omega(plan, scene)
        });
        let tolerances: Vec<f64> = (6..=12)
            .into_par_iter()
            .map(|digits| {
                let settings = Settings { rtol: 10_f64.powi(-digits), ..plan.settings() };
                objective(plan.window(), settings).value(design, f64::INFINITY)
            })
            .collect();
        let tolerances = Spread::of(tolerances);
        let regime = classify(&follow(&scene, None, Stretch::default(), &plan.settings())?);
        let mut row = vec![format!("{}", i + 1)];
        row.extend(design.iter().map(f64::to_string));
        row.extend([
            format!("{paper}"),
            format!("{value:.1}"),
            format!("{:.1}", objective(whole, plan.settings()).value(design, f64::INFINITY)),
            near.words(),
            format!("{:.1} – {:.1}", tolerances.least, tolerances.largest),
            regime.label(),
            format!("{:.2} ± {:.2}", regime.exponent.value, regime.exponent.error),
        ]);
        grid.rows.push(row);
        fits.push((value, near, *paper));
    }
    bar.finish();
    item.grids.push(grid);
    let inside: Vec<bool> =
        fits.iter().map(|(_, near, paper)| (near.least..=near.largest).contains(paper)).collect();
    item.statement(
        "The four rows have E1max = 666.2, 661.1, 573.1 and 563.0 J",
        "Holds if each of the four lies within what ours takes when k1, k2, c2, D and C are moved by up to 0.1 %, in part if some do: 0.1 % is less than the rounding of the printed D = 0.06 m.",
        Verdict::of_all(&inside),
        format!(
            "{} of the 4 values lie within the spread; medians {} J. The motions are irregular or long transients: a single E1max is one realisation, and no digits can be reproduced. What the paper leaves out moves the medians too (table)",
            inside.iter().filter(|&&within| within).count(),
            fits.iter().map(|(_, near, _)| format!("{:.0}", near.median)).collect::<Vec<_>>().join(", ")
        ),
    );
    let medians: Vec<f64> = fits.iter().map(|(_, near, _)| near.median).collect();
    let better = medians[2].max(medians[3]) < medians[0].min(medians[1]);
    item.statement(
        "The refined designs (rows 3 and 4) are better than the first (rows 1 and 2)",
        "Holds if the medians of rows 3 and 4 under ±0.1 % are below those of rows 1 and 2: a single value is one realisation.",
        Verdict::of(better),
        format!("medians {} J", medians.iter().map(|m| format!("{m:.0}")).collect::<Vec<_>>().join(", ")),
    );
    Ok(())
}

/// The medians of the four rows under ±0.1 % for other radii and for the whole run: values that the paper does not state change
/// them by more than the printed digits.
fn left_out(plan: &Plan) -> Result<Grid, Error> {
    let head = ["R, m", "window, s", "row 1, J", "row 2, J", "row 3, J", "row 4, J"];
    let mut grid = Grid::new("Medians of E1max under ±0.1 %, for other radii and windows", &head);
    let mut row = vec!["the paper".to_owned(), String::new()];
    row.extend(PAPER.iter().map(|(_, paper)| format!("{paper:.1}")));
    grid.rows.push(row);
    let own = plan.ssvi.value_of(Parameter::R).unwrap_or(f64::NAN);
    let late = plan.window();
    let radii = RADII.into_iter().filter(|radius| *radius != own).map(|radius| (radius, late));
    for (radius, window) in [(own, late), (own, Window { from: 0.0, ..late })].into_iter().chain(radii) {
        let mut row = vec![format!("{radius}"), format!("{}–{}", window.from, window.to)];
        for ([k2, c2, d, c], _) in PAPER {
            let design = [
                (Parameter::K2, k2),
                (Parameter::C2, c2),
                (Parameter::D, d),
                (Parameter::C, c),
                (Parameter::R, radius),
            ];
            let scene = plan.ssvi.scene_with(&design.map(|(name, value)| Setting::new(name, value)))?;
            let value = |scene: &Scene| energy(scene, &Objective::default(), window, &plan.settings());
            row.push(format!("{:.0}", near(FEW, &scene, value).median));
        }
        grid.rows.push(row);
    }
    Ok(grid)
}

fn search(objective: &DesignObjective, start: [f64; 4]) -> Result<(Vec<Row>, Minimum), Error> {
    let mut rows = Vec::new();
    let watch = |row: &Row| {
        rows.push(row.clone());
        ControlFlow::Continue(())
    };
    let found = minimize(|design, cutoff| objective.value(design, cutoff), &start, Options::default(), watch)
        .map_err(|source| Error::Search { source, failures: objective.failures() })?;
    Ok((rows, found))
}

fn design(row: &Row) -> [f64; 4] {
    std::array::from_fn(|i| row.best.get(i).copied().unwrap_or(f64::NAN))
}

fn log(rows: &[Row], found: &Minimum, name: &str, item: &mut Item) {
    let head = ["iteration", "procedure", "k2 opt, N/m", "c2 opt, N·s/m", "D opt, m", "C opt, m", "E1max, J"];
    let caption = format!(
        "Our fminsearch from {name}: {} iterations, {} evaluations, {}. First rows and last",
        found.iterations,
        found.func_count,
        if found.stop == Stop::Converged { "converged" } else { "stopped at a limit" }
    );
    let mut grid = Grid::new(&caption, &head);
    let last = rows.len().saturating_sub(1);
    for (_, row) in rows.iter().enumerate().filter(|(i, _)| *i < 6 || *i == last) {
        let mut cells = vec![row.iteration.to_string(), row.procedure.to_string()];
        cells.extend(design(row).map(scientific));
        cells.push(scientific(row.value));
        grid.rows.push(cells);
    }
    item.grids.push(grid);
    let lines: String = rows.iter().map(|row| csv(row, &design(row)) + "\n").collect();
    item.data.push((
        format!("table1-from-{}.csv", name.replace(' ', "-")),
        format!("{}\n{lines}", csv_header(&[], Measure::Energy)),
    ));
}

/// Row 3 from the published optimum, by a stub objective for which the k2-vertex is the worst.
fn row_3(item: &mut Item) -> Result<(), Error> {
    let values = [563.0, 640.0, 570.0, 571.0, 572.0, 650.0, 560.0];
    let count = RefCell::new(0);
    let stub = |_: &[f64], _: f64| {
        let value = values.get(*count.borrow()).copied().unwrap_or(f64::INFINITY);
        *count.borrow_mut() += 1;
        value
    };
    let mut third = None;
    let watch = |row: &Row| {
        third = Some(row.clone());
        if row.iteration == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    minimize(stub, &PAPER[3].0, Options::default(), watch)
        .map_err(|source| Error::Search { source, failures: Failures::default() })?;
    let printed = third.as_ref().map(|row| design(row).map(scientific).join("  ")).unwrap_or_default();
    let paper = PAPER[2].0.map(scientific).join("  ");
    item.statement(
        "The table is a fragment of one run that ends at the published optimum",
        "Fails if a row is a step of a run that starts at the published optimum: it cannot then come before it.",
        if printed == paper { Verdict::Fails } else { Verdict::Partly },
        format!(
            "row 3 is, to every printed digit, the first “contract inside” of a run that starts at the published optimum (with the k2 vertex worst): our algorithm gives {printed}, the paper prints {paper}{}. The last row is a start, not an end; and rows 1 and 2 differ in k2 alone, by 40 %, which no step of 5 % makes",
            if printed == paper { "" } else { " (they differ)" }
        ),
    );
    Ok(())
}
