//! Where the design lies: in the grid, and within its bounds.

use super::findings::Findings;
use super::numbers::{amount, digits, four};
use maud::{Markup, html};
use retune_optim::{Bounds, value_of};
use retune_report::document::{Block, Section};
use retune_report::html::{Table, figure, link};
use retune_store::Directory;

/// Bytes of maps that a page holds; of more it holds links alone.
const MOST: usize = 220_000;

pub fn section(findings: &Findings, files: &[String], results: &Directory) -> Section {
    let maps: Vec<(&String, String)> = files
        .iter()
        .filter(|name| name.starts_with("surf-") && name.ends_with(".svg"))
        .filter_map(|name| Some((name, results.read(name)?)))
        .collect();
    let fits = maps.iter().map(|(_, text)| text.len()).sum::<usize>() <= MOST;
    let body = html! {
        (words(findings))
        (table(findings).markup())
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

fn words(findings: &Findings) -> Markup {
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

fn table(findings: &Findings) -> Table {
    let mut head =
        vec!["parameter", "lower bound", "the study's", "found", "upper bound", "between the bounds"];
    let best = findings.surf.map(|surf| (surf, surf.point(surf.best)));
    if best.is_some() {
        head.insert(3, "best of the grid");
    }
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
