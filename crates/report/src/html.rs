//! The elements of a page: its head, sections, tables, figures.

use crate::Drawing;
use maud::{Markup, PreEscaped, html};

/// The style of all pages: light and dark, wide, narrow and in print.
const STYLE: &str = include_str!("page.css");

/// The head of a page: its title, and the style of all pages.
pub fn head(title: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="color-scheme" content="light dark";
            link rel="icon" href="data:,";
            title { (title) }
            style { (PreEscaped(STYLE)) }
        }
    }
}

/// Cells of more letters than this may break into lines.
const LONG: usize = 48;

/// A table. The first cell of each row is the row's heading.
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// The headings of its columns.
    pub head: Vec<String>,
    /// Its cells, row by row.
    pub rows: Vec<Vec<Markup>>,
    /// Whether its cells break into lines.
    pub wraps: bool,
}

impl Table {
    /// A table without rows; headings as in the first line of a Markdown table.
    pub fn new(caption: impl Into<String>, head: &str) -> Self {
        let head = head.split(" | ").map(str::to_owned).collect();
        Self { caption: caption.into(), head, rows: Vec::new(), wraps: false }
    }

    /// A table whose cells hold words and break into lines.
    pub fn wrapping(caption: impl Into<String>, head: &str) -> Self {
        Self { wraps: true, ..Self::new(caption, head) }
    }

    /// Adds a row of texts. Long ones break into lines in any table, in a column that stays readable.
    pub fn row(&mut self, cells: impl IntoIterator<Item = impl ToString>) {
        let wraps = self.wraps;
        let cell = |text: String| {
            let is_long = !wraps && text.chars().count() > LONG;
            html! { @if is_long { span.long { (text) } } @else { (text) } }
        };
        self.rows.push(cells.into_iter().map(|text| cell(text.to_string())).collect());
    }

    /// Its HTML; a table wider than the page scrolls in its own box.
    pub fn markup(&self) -> Markup {
        html! {
            div.scroll tabindex="0" role="group" aria-label=(self.caption) {
                table class=[self.wraps.then_some("wrap")] {
                    caption { (self.caption) }
                    thead { tr { @for name in &self.head { th scope="col" { (name) } } } }
                    tbody {
                        @for row in &self.rows {
                            tr { @for (i, cell) in row.iter().enumerate() {
                                @if i == 0 { th scope="row" { (cell) } } @else { td { (cell) } }
                            } }
                        }
                    }
                }
            }
        }
    }
}

/// A figure with its caption.
pub fn figure(drawing: &Drawing, caption: Markup) -> Markup {
    let Drawing { wide, narrow } = drawing;
    let class = if narrow.is_some() { "wide" } else { "any" };
    html! {
        figure {
            div.(class) { (PreEscaped(wide)) }
            @if let Some(narrow) = narrow { div.narrow { (PreEscaped(narrow)) } }
            figcaption { (caption) }
        }
    }
}

/// A link to a file beside the page.
pub fn link(name: &str) -> Markup {
    html! { a href=(name) { (name) } }
}

/// Text as HTML, with backticks for code as in Markdown.
pub fn with_code(words: &str) -> Markup {
    html! {
        @for (number, part) in words.split('`').enumerate() {
            @if number % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_what_stands_in_backticks_is_code() {
        let html = with_code("`retune optimize` looks at a < b.").into_string();
        assert_eq!(html, "<code>retune optimize</code> looks at a &lt; b.");
    }
}
