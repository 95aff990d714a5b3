//! Several charts on one sheet, in rows and columns, below one common legend, as on a page of the paper.

mod chart;
mod draw;

pub use chart::{BLACK, BLUE, Chart, GREEN, GREY, Layer, ORANGE, PURPLE, SKY, VERMILION, YELLOW};

use draw::{draw_chart, words};
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// The symbol of an entry in the legend.
#[derive(Clone, Copy, Debug)]
pub enum Key {
    /// A line: its colour and `stroke-dasharray`.
    Line(&'static str, &'static str),
    /// A dot: its colour.
    Dot(&'static str),
    /// An area: its colour and opacity.
    Area(&'static str, f64),
    /// No symbol: the text is the heading of a row of entries.
    Heading,
}

const WIDTH: f64 = 1600.0;
/// Width for narrow screens: on a telephone text is then about 12 px high.
const NARROW: f64 = 800.0;
const TEXT: f64 = 27.0;

/// A figure, and a version of it for narrow screens, on which the figure itself would be too small to read.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Drawing {
    /// For print and wide screens.
    pub wide: String,
    /// One chart a row, half as wide.
    pub narrow: Option<String>,
}

impl From<String> for Drawing {
    fn from(wide: String) -> Self {
        Self { wide, narrow: None }
    }
}

/// Draws `charts` in rows of `columns`, each `height` px high.
pub fn sheet(charts: &[Chart], columns: usize, height: f64, legend: &[(Key, &str)]) -> Drawing {
    let wide = on_width(WIDTH, charts, columns, height, legend);
    Drawing { wide, narrow: Some(on_width(NARROW, charts, 1, height, legend)) }
}

fn on_width(page: f64, charts: &[Chart], columns: usize, height: f64, legend: &[(Key, &str)]) -> String {
    let mut body = String::new();
    let mut y = 26.0;
    let mut x = 30.0;
    for (key, words) in legend {
        let heading = matches!(key, Key::Heading);
        let length = if heading { 125.0 } else { 74.0 + 16.0 * words.chars().count() as f64 + 12.0 };
        if (heading && x > 30.0) || x + length > page {
            (x, y) = (30.0, y + 44.0);
        }
        draw_key(&mut body, key, words, x, y);
        x += length;
    }
    let top = if legend.is_empty() { 20.0 } else { y + 40.0 };
    let (cell_width, cell_height) = (page / columns as f64, height);
    for (i, chart) in charts.iter().enumerate() {
        let corner = ((i % columns) as f64 * cell_width, top + (i / columns) as f64 * cell_height);
        draw_chart(&mut body, chart, corner, (cell_width, cell_height));
    }
    let total = top + charts.len().div_ceil(columns) as f64 * cell_height + 10.0;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {page} {total}\" width=\"{page}\" height=\"{total}\" font-family=\"sans-serif\" \
         font-size=\"{TEXT}\">\n<rect class=\"paper\" width=\"{page}\" height=\"{total}\" fill=\"#FFFFFF\"/>\n{body}</svg>\n"
    )
}

fn draw_key(out: &mut String, key: &Key, text: &str, x: f64, y: f64) {
    let _ = match key {
        Key::Line(colour, dash) => writeln!(
            out,
            "<path d=\"M{x} {y}h56\" stroke=\"{colour}\" stroke-width=\"5\" stroke-dasharray=\"{dash}\" fill=\"none\"/>"
        ),
        Key::Dot(colour) => {
            writeln!(out, "<circle cx=\"{}\" cy=\"{y}\" r=\"8\" fill=\"{colour}\"/>", x + 40.0)
        }
        Key::Area(colour, opacity) => writeln!(
            out,
            "<rect x=\"{x}\" y=\"{}\" width=\"56\" height=\"26\" fill=\"{colour}\" fill-opacity=\"{opacity}\"/>",
            y - 13.0
        ),
        Key::Heading => {
            words(out, text, (x, y + 9.0), "start", "");
            return;
        }
    };
    words(out, text, (x + 68.0, y + 9.0), "start", "");
}
