//! The page: every item beside the paper's statements, in one file that needs no network.

use super::item::{Grid, Item, Picture, Statement, Verdict};
use super::variants;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use retune_report::Drawing;
use retune_report::html::head;

/// What this page has beside the style of all pages.
const OWN: &str = include_str!("page.css");

/// The whole page.
pub fn page(items: &[Item]) -> String {
    let count = |verdict: Verdict| {
        let of_paper = items.iter().flat_map(|item| &item.statements).filter(|s| !s.conjecture);
        of_paper.filter(|s| s.verdict == verdict).count()
    };
    let all = [Verdict::Holds, Verdict::Partly, Verdict::Fails, Verdict::Undecided];
    let [holds, partly, fails, undecided] = all.map(count);
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            (head("Retune: the paper on one page", OWN))
            body {
                header {
                    h1 { "Retention of tuning for vibro-impact and linear dampers: the whole paper, made again" }
                    p {
                        "Each table and figure of the paper beside what Retune " (env!("CARGO_PKG_VERSION"))
                        " computes, and a verdict on each statement. Of " (holds + partly + fails + undecided) " statements "
                        (holds) " hold, " (partly) " hold in part, " (fails) " do not hold under our settings, and "
                        (undecided) " cannot be decided: practically equal designs decide them differently. What is marked as our conjecture is not counted."
                    }
                    p {
                        "Only the text of the paper was available, not the data of its figures: what a figure shows is taken from the "
                        "words about it. The paper leaves out the radius R and the coefficient q of the contact, the length of a run, the window of its "
                        "maxima and the tolerances. Ours stand under each item; which verdicts hang on R and on the window stands "
                        @if items.iter().any(|item| item.name == variants::NAME) { a href={ "#" (variants::NAME) } { "at the end" } } @else { "at the end of the whole page" }
                        "."
                    }
                    p {
                        "Two samplings of the frequency, each under one name. " b { "Finest" } ": the largest of as many runs over Figure 3's frequencies as the last column of its tables "
                        "says, with the least and the largest of 21 designs within ±0.1 % beside it; every verdict on a worst case is by this. "
                        b { "Coarse" } ": 31 frequencies over 5 to 8 rad/s and the peaks between them; by this searches and Figure 2's maps compare designs, no more."
                    }
                    nav { ul { @for item in items { li { a href={ "#" (item.name) } { (item.title) } } } } }
                }
                main { @for item in items { (section(item)) } }
                footer { p { "Made by " code { "retune reproduce" } ". All data stand beside this page as CSV, all figures as SVG; the study is " a href="study.json" { "study.json" } ", with all that it names " a href="resolved.json" { "resolved.json" } "; what made each file stands in " a href="manifest.json" { "manifest.json" } "." } }
            }
        }
    };
    markup.into_string()
}

fn section(item: &Item) -> Markup {
    html! {
        section id=(item.name) {
            h2 { (item.title) }
            p.paper-says { b { "In the paper: " } (item.paper) }
            @if !item.statements.is_empty() { ul.statements { @for s in &item.statements { (statement(s)) } } }
            @for picture in &item.pictures { (figure(picture)) }
            @for grid in &item.grids { (table(grid)) }
            @for note in &item.notes { p.note { (note) } }
            p.made-by { b { "Made by: " } (item.made_by) }
            @if !item.data.is_empty() {
                p.made-by { b { "Data: " } @for (name, _) in &item.data { a href=(name) { (name) } " " } }
            }
        }
    }
}

fn statement(statement: &Statement) -> Markup {
    let class = match statement.verdict {
        Verdict::Holds => "holds",
        Verdict::Partly => "partly",
        Verdict::Fails => "fails",
        Verdict::Undecided => "undecided",
    };
    html! {
        li class=(class) {
            span.says { @if statement.conjecture { b { "Our conjecture: " } } (statement.paper) small.rule { (statement.rule) } }
            span.verdict { (statement.verdict.words()) }
            span.found { (statement.found) }
        }
    }
}

fn figure(picture: &Picture) -> Markup {
    let Drawing { wide, narrow } = &picture.drawing;
    let class = if narrow.is_some() { "wide" } else { "any" };
    html! {
        figure {
            div.(class) role="img" aria-label=(picture.caption) { (PreEscaped(wide)) }
            @if let Some(narrow) = narrow { div.narrow role="img" aria-label=(picture.caption) { (PreEscaped(narrow)) } }
            figcaption { (picture.caption) " " a href={ (picture.name) ".svg" } { (picture.name) ".svg" } }
        }
    }
}

/// Cells of more letters than this may break into lines.
const LONG: usize = 48;

fn table(grid: &Grid) -> Markup {
    let cell = |text: &String| {
        let long = text.chars().count() > LONG;
        html! { td class=[long.then_some("long")] { (text) } }
    };
    html! {
        p.caption { (grid.caption) }
        div.scroll tabindex="0" {
            table {
                thead { tr { @for name in &grid.head { th { (name) } } } }
                tbody { @for row in &grid.rows { tr { @for text in row { (cell(text)) } } } }
            }
        }
    }
}
