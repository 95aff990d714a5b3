//! A sheet: charts in rows and columns below one legend, and a caption.

use crate::chart::{Chart, Key, Mark, Stroke};
use crate::direct::{DirectLabel, line, place_labels};
use crate::draw::{area, chart, direct_labels, marks, sample};
use crate::layout::{LINE, Margins, SMALL, TEXT, layout};
use crate::path::Rect;
use crate::svg::{Anchor, Font, Svg};
use crate::text::{ems, lines};
use serde::{Deserialize, Serialize};

/// Width of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// A column of a journal, 85 mm.
    Column,
    /// Its whole page, 180 mm.
    Page,
}

impl Width {
    /// In points.
    const fn points(self) -> f64 {
        match self {
            Self::Column => 241.0,
            Self::Page => 510.0,
        }
    }
}

/// A figure as data.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// What it shows, in a few words: the `<title>` of the SVG.
    pub title: String,
    /// What can be seen in it, for a reader who cannot: its `<desc>`.
    pub description: String,
    /// Its width.
    pub width: Width,
    /// Its charts, row by row.
    pub charts: Vec<Chart>,
    /// Charts in a row.
    pub columns: usize,
    /// Whether the charts of a column share their abscissa: only the lowest shows its numbers and label.
    pub stacked: bool,
    /// The legend above the charts. A figure with one chart labels up to six lines directly instead, if the labels fit.
    pub legend: Vec<(Key, String)>,
    /// Paragraphs below the charts; long ones are broken into lines.
    pub caption: Vec<String>,
}

impl Sheet {
    /// A figure of charts below one another, a column wide; description, legend and caption are set afterwards.
    pub fn of(title: impl Into<String>, charts: Vec<Chart>) -> Self {
        Self {
            title: title.into(),
            description: String::new(),
            width: Width::Column,
            charts,
            columns: 1,
            stacked: false,
            legend: Vec::new(),
            caption: Vec::new(),
        }
    }

    /// A figure as wide as a page, one chart a row, without legend and caption.
    pub fn page(title: impl Into<String>, description: impl Into<String>, charts: Vec<Chart>) -> Self {
        Self { description: description.into(), width: Width::Page, ..Self::of(title, charts) }
    }

    /// The text of its legend.
    pub fn legend_words(&self) -> String {
        self.legend.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>().join("; ")
    }
}

/// A figure and, where it would be too small to read on a narrow screen, a version for that.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Drawing {
    /// For print and wide screens.
    pub wide: String,
    /// One chart a row, as wide as a column.
    pub narrow: Option<String>,
}

impl From<String> for Drawing {
    fn from(wide: String) -> Self {
        Self { wide, narrow: None }
    }
}

/// Space at the edges of a sheet, pt.
const EDGE: f64 = 3.0;
/// Space between columns, pt.
const GUTTER: f64 = 9.0;
/// Length of a line in the legend, pt.
const SAMPLE: f64 = 18.0;
/// Height of a row of the legend, pt.
const ROW: f64 = 1.45 * TEXT;

/// A sheet as SVG.
pub fn svg(sheet: &Sheet) -> String {
    on_width(sheet, sheet.width.points(), sheet.columns)
}

/// A sheet as SVG, with a version for narrow screens if it is as wide as a page.
pub fn drawing(sheet: &Sheet) -> Drawing {
    let narrow = (sheet.width == Width::Page).then(|| on_width(sheet, Width::Column.points(), 1));
    Drawing { wide: svg(sheet), narrow }
}

fn on_width(sheet: &Sheet, page: f64, columns: usize) -> String {
    let mut out = Svg::default();
    let (columns, count) = (columns.max(1), sheet.charts.len());
    let named = labels_beside_lines(sheet, page);
    let is_shown = |key: &&(Key, String)| named.is_none() || line(key).is_none();
    let shown: Vec<(Key, String)> = sheet.legend.iter().filter(is_shown).cloned().collect();
    let mut y = EDGE + legend(&mut out, &shown, page);
    let width = (page - 2.0 * EDGE - GUTTER * (columns - 1) as f64) / columns as f64;
    let lowest = |i: usize| i + columns >= count;
    let mut cells: Vec<(Rect, bool)> = Vec::new();
    for (row, charts) in sheet.charts.chunks(columns).enumerate() {
        let height = charts.iter().map(|chart| chart.height).fold(0.0, f64::max);
        for column in 0..charts.len() {
            let left = EDGE + column as f64 * (width + GUTTER);
            cells.push((
                [left, y, left + width, y + height],
                !sheet.stacked || lowest(row * columns + column),
            ));
        }
        y += height + if sheet.stacked { 0.0 } else { 4.0 };
    }
    for column in 0..columns.min(count) {
        let own = || (column..count).step_by(columns);
        let margins =
            own().map(|i| layout(&sheet.charts[i], cells[i].0, cells[i].1, Margins::default()).margins);
        let least = margins.fold(Margins::default(), Margins::with);
        for i in own() {
            // Frames of a column are aligned on the left, and on the right too if they share their abscissa.
            let least = Margins { right: if sheet.stacked { least.right } else { 0.0 }, ..least };
            chart(&mut out, &layout(&sheet.charts[i], cells[i].0, cells[i].1, least));
        }
    }
    direct_labels(&mut out, &named.unwrap_or_default());
    y += 2.0;
    for line in sheet.caption.iter().flat_map(|text| lines(text, SMALL, page - 2.0 * EDGE)) {
        out.text(&line, (EDGE, y + 0.5 * LINE * SMALL), Font::new(SMALL, Anchor::Start));
        y += LINE * SMALL;
    }
    out.document((page, y + EDGE), &sheet.title, &sheet.description)
}

/// Direct labels of a figure with one chart, which then replace the legend; none if one does not fit.
fn labels_beside_lines(sheet: &Sheet, page: f64) -> Option<Vec<DirectLabel>> {
    let [chart] = sheet.charts.as_slice() else { return None };
    let others: Vec<(Key, String)> = sheet.legend.iter().filter(|key| line(key).is_none()).cloned().collect();
    let top = EDGE + legend(&mut Svg::default(), &others, page);
    let cell = [EDGE, top, page - EDGE, top + chart.height];
    place_labels(&layout(chart, cell, true, Margins::default()), &sheet.legend)
}

/// Draws the legend from the upper edge downwards; returns its height, pt.
fn legend(out: &mut Svg, keys: &[(Key, String)], page: f64) -> f64 {
    let heading = |key: &Key| matches!(key, Key::Heading);
    let indent = keys
        .iter()
        .filter(|(key, _)| heading(key))
        .map(|(_, text)| TEXT * ems(text) + 6.0)
        .fold(0.0, f64::max);
    let (mut x, mut y) = (EDGE, EDGE);
    let mut used = 0.0;
    for (key, text) in keys {
        let begins = heading(key);
        let room = page - EDGE - EDGE - indent - if begins { 0.0 } else { SAMPLE + 4.0 };
        let words = if begins { vec![text.clone()] } else { lines(text, TEXT, room) };
        let longest = words.iter().map(|line| TEXT * ems(line)).fold(0.0, f64::max);
        let length = if begins { indent } else { SAMPLE + 4.0 + longest };
        if (begins && used > 0.0) || (x > EDGE + indent && x + length > page - EDGE) {
            y += used;
            x = if begins { EDGE } else { EDGE + indent };
            used = 0.0;
        }
        let middle = y + 0.5 * ROW;
        let text_at = if begins { x } else { x + SAMPLE + 4.0 };
        draw_key(out, key, (x, middle));
        for (i, line) in words.iter().enumerate() {
            out.text(line, (text_at, middle + LINE * TEXT * i as f64), Font::new(TEXT, Anchor::Start));
        }
        used = f64::max(used, ROW + LINE * TEXT * (words.len().max(1) - 1) as f64);
        x += length + if begins { 0.0 } else { 11.0 };
    }
    if keys.is_empty() { 0.0 } else { y + used - EDGE + 3.0 }
}

fn draw_key(out: &mut Svg, key: &Key, (x, y): (f64, f64)) {
    let middle = (x + 0.5 * SAMPLE, y);
    let line = |out: &mut Svg, stroke: &Stroke| sample(out, (x, y), SAMPLE, *stroke);
    let mark = |out: &mut Svg, mark: &Mark| marks(out, &[middle], *mark);
    match key {
        Key::Line(stroke) => line(out, stroke),
        Key::Marked(stroke, shape) => {
            line(out, stroke);
            mark(out, shape);
        }
        Key::Mark(shape) => mark(out, shape),
        Key::Area(colour, opacity) => area(out, [x, y - 3.5, x + SAMPLE, y + 3.5], colour, *opacity),
        Key::Heading => {}
    }
}
