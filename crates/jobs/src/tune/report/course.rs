//! How the search went: its stages, where each refinement began and ended, and why it stopped.

use super::findings::Findings;
use super::numbers::{amount, digits, four};
use crate::amount::label;
use crate::tune::log::value_words;
use crate::tune::optimum::stop_words;
use crate::tune::pictures::label as picture_label;
use crate::tune::refine::Descended;
use maud::{Markup, html};
use retune_model::Parameter;
use retune_optim::{Bounds, Counts, value_of};
use retune_report::cells;
use retune_report::document::{Block, Section};
use retune_report::html::{Table, figure, link};
use retune_report::table::Cell;
use retune_store::Directory;
use retune_study::counted;

pub fn section(findings: &Findings, results: &Directory) -> Section {
    let failures = &findings.optimum.failures;
    let winner = &findings.refined.best().minimum;
    let convergence = results.read("convergence.svg");
    let body = html! {
        p {
            @if findings.refined.winner < findings.refined.starts {
                "The design was found by refinement " (findings.refined.winner + 1) " of " (findings.refined.starts) ", which "
                (stop_words(winner.stop)) " after " (counted(winner.iterations, "iteration")) " and "
                (counted(winner.func_count, "evaluation"))
            } @else { "The design was found from " (findings.refined.beyond(findings.refined.winner).unwrap_or_default()) }
            @if let Some(Descended { from, evaluations }) = findings.refined.best().descent {
                ", by a descent with derivatives from " (value_words(from, findings.quantity())) " in " (counted(evaluations, "evaluation"))
            }
            ". "
            @if failures.count == 0 { "Every design could be computed." }
            @else { (counted(failures.count, "design")) " could not be computed." }
        }
        (stages(findings).markup())
        (starts(findings).markup())
        @if let Some(table) = basins(findings) { (table.markup()) }
        @if let Some(svg) = convergence {
            (figure(&svg.into(), html! { (findings.quantity().name()) " and the tuned parameters over the best refinement. " (link("convergence.svg")) }))
        }
    };
    ("search", "How the search went", vec![Block::Elements(body)])
}

fn stages(findings: &Findings) -> Table {
    let quantity = findings.quantity();
    let head = "stage | evaluations | broke a limit | could not be computed | best";
    let mut table = Table::new("Stages of the search", &format!("{head} {}", quantity.name()));
    let mut row = |stage: &str, counts: Counts, failed: u64, best: f64| {
        table.row(cells![stage, counts.evaluations, counts.infeasible, failed, value_words(best, quantity)]);
    };
    if let Some(surf) = findings.surf {
        row("grid", surf.counts, surf.failures.count, surf.least);
    }
    if let Some(explored) = findings.explored {
        let best = explored.basins.first().map_or(f64::NAN, |basin| basin.best.value);
        row("global search", explored.counts, explored.failures.count, best);
    }
    let objective = &findings.refined.objective;
    row("refinements", objective.counts(), objective.failures().count, findings.refined.best().minimum.value);
    table
}

/// The headings of the tuned parameters, after others.
fn variables(findings: &Findings) -> String {
    let variables = findings.search.variables.iter();
    variables.map(|variable| format!(" | {}", picture_label(*variable))).collect()
}

fn starts(findings: &Findings) -> Table {
    let (name, unit) = (findings.quantity().name(), findings.quantity().unit());
    let head = format!(
        "refinement | starts from | {name} there, {unit} | {name} found, {unit} | iterations | evaluations | stop{}",
        variables(findings)
    );
    let mut table = Table::new("Refinements", &head);
    for (i, run) in findings.refined.runs.iter().enumerate() {
        let minimum = &run.minimum;
        let start = run.rows.first().map_or(f64::NAN, |row| value_of(row.value));
        let best = if i == findings.refined.winner { " (best)" } else { "" };
        let stop = if run.descent.is_some() { "descent" } else { stop_words(minimum.stop) };
        let mut cells = cells![format!("{}{best}", i + 1), findings.origin(i), four(start)];
        cells.extend(cells![four(value_of(minimum.value)), minimum.iterations, minimum.func_count, stop]);
        cells.extend(minimum.x.iter().map(|value| Cell::from(four(*value))));
        table.row(cells);
    }
    table
}

fn basins(findings: &Findings) -> Option<Table> {
    let found = findings.optimum.global.as_ref()?;
    let head = format!(
        "basin | searches that reached it | refinements | {}{}",
        label(findings.quantity()),
        variables(findings)
    );
    let caption = format!(
        "Basins: that of the optimum was reached by {} of {}",
        found.reached_optimum,
        counted(found.searches as u64, "search")
    );
    let mut table = Table::new(caption, &head);
    for (i, basin) in found.basins.iter().enumerate() {
        let counts = cells![i + 1, basin.searches, basin.refinements, four(basin.found.value)];
        let value = |variable: &Parameter| four(basin.design.get(*variable).unwrap_or(f64::NAN)).into();
        table.row(counts.into_iter().chain(findings.search.variables.iter().map(value)));
    }
    Some(table)
}

/// Most bytes of maps that a page embeds; beyond it the page only links to them.
const MOST: usize = 220_000;

pub fn place(findings: &Findings, files: &[String], results: &Directory) -> Section {
    let maps: Vec<(&String, String)> = files
        .iter()
        .filter(|name| name.starts_with("surf-") && name.ends_with(".svg"))
        .filter_map(|name| Some((name, results.read(name)?)))
        .collect();
    let fits = maps.iter().map(|(_, text)| text.len()).sum::<usize>() <= MOST;
    let body = html! {
        (grid_words(findings))
        (tuned(findings).markup())
        @if !maps.is_empty() && fits {
            div.maps {
                @for (name, text) in &maps { (figure(&text.clone().into(), html! { (link(name)) })) }
            }
        } @else if !maps.is_empty() {
            p { "Maps of the grid: " @for (name, _) in &maps { (link(name)) " " } }
        }
    };
    ("place", "Where the design lies", vec![Block::Elements(body)])
}

fn grid_words(findings: &Findings) -> Markup {
    let quantity = findings.quantity();
    let found = amount(findings.evaluation.value, quantity);
    match findings.surf {
        None => html! { p { "This search had no grid." } },
        Some(surf) => html! { p {
            "The best of " (surf.grid.len()) " points of the grid has " (amount(value_of(surf.least), quantity)) "; the design that was found has "
            (found) "."
        } },
    }
}

fn tuned(findings: &Findings) -> Table {
    let best = findings.surf.map(|surf| (surf, surf.point(surf.best)));
    let of_grid = if best.is_some() { " | best of the grid" } else { "" };
    let head =
        format!("parameter | lower bound | the study's{of_grid} | found | upper bound | between the bounds");
    let mut table = Table::new("The tuned parameters", &head);
    let bounds = &findings.search.options.bounds;
    for (i, &variable) in findings.search.variables.iter().enumerate() {
        let Bounds { lower, upper } = bounds.get(i).copied().unwrap_or_default();
        let value = findings.refined.best().minimum.x[i];
        let text = |value: Option<f64>| html! { (value.map_or("none".to_owned(), four)) };
        let share = lower.zip(upper).map(|(lower, upper)| (value - lower) / (upper - lower));
        let mut cells = vec![
            html! { (variable) ", " (variable.unit()) },
            text(lower),
            text(findings.study.scene.damper.map(|damper| variable.get(&damper))),
            html! { strong { (four(value)) } },
            text(upper),
            share.map_or_else(|| html! { "no upper bound" }, bar),
        ];
        if let Some((surf, point)) = &best {
            let axis = surf.variables.iter().position(|other| *other == variable);
            cells.insert(3, text(axis.map(|axis| point[axis])));
        }
        table.rows.push(cells);
    }
    table
}

/// A share as a bar with a mark, and in words.
fn bar(share: f64) -> Markup {
    let percent = (100.0 * share).clamp(0.0, 100.0);
    html! {
        span.bar aria-hidden="true" { span style={ "left:" (format!("{percent:.1}")) "%" } {} }
        " " (digits(percent, 3)) " %"
    }
}
