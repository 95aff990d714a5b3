//! Layout of a chart: margins follow from the widths of the labels, so that no two labels overlap.

use crate::axis::Axis;
use crate::chart::{Chart, Layer};
use crate::path::Rect;
use crate::text::{ems, lines};
use crate::ticks::{Tick, minor, ticks};

/// Size of titles, legends and names of quantities, pt.
pub(crate) const TEXT: f64 = 8.5;
/// Size of numbers, captions and labels, pt.
pub(crate) const SMALL: f64 = 8.0;
/// Size of the names beside a chart, pt.
pub(crate) const TINY: f64 = 7.0;
/// Height of a line of text, as a multiple of its size.
pub(crate) const LINE: f64 = 1.25;
/// Length of a tick, pt.
pub(crate) const TICK: f64 = 3.0;
/// Space between a frame and the numbers beside it, pt.
const GAP: f64 = 4.0;
/// Width of a colour bar, and its distance from the frame, pt.
const BAR: [f64; 2] = [9.0, 7.0];
/// Length of the leader from the frame to a name, including the name's mark, pt.
pub(crate) const LEADER: f64 = 15.0;

/// The left, right, upper and lower margin of a frame in its cell, pt.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Margins {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

impl Margins {
    /// Raises the left and right margins to at least those of `other`.
    pub fn with(self, other: Self) -> Self {
        Self { left: self.left.max(other.left), right: self.right.max(other.right), ..self }
    }
}

/// A line of text and its anchor point.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub text: String,
    pub at: (f64, f64),
    /// -1 for text left of its point, 1 for text right of it, 0 for centred text.
    pub side: i8,
    pub turned: bool,
    pub size: f64,
}

impl Label {
    fn new(text: impl Into<String>, at: (f64, f64), side: i8) -> Self {
        Self { text: text.into(), at, side, turned: false, size: SMALL }
    }

    /// A rectangle that encloses the text.
    #[cfg(test)]
    pub fn rect(&self) -> Rect {
        let (width, height) = (self.size * ems(&self.text), self.size);
        let (x, y) = self.at;
        let left = match self.side {
            -1 => x - width,
            0 => x - 0.5 * width,
            _ => x,
        };
        if self.turned {
            return [x - 0.5 * height, y - 0.5 * width, x + 0.5 * height, y + 0.5 * width];
        }
        [left, y - 0.5 * height, left + width, y + 0.5 * height]
    }
}

/// A colour bar.
pub(crate) struct Bar<'a> {
    pub colours: &'a Axis,
    pub rect: Rect,
    pub ticks: Vec<Tick>,
}

/// A chart with its layout.
pub(crate) struct Layout<'a> {
    pub chart: &'a Chart,
    /// The frame.
    pub frame: Rect,
    pub margins: Margins,
    /// Labelled and unlabelled ticks of abscissa and ordinate.
    pub ticks: [Vec<Tick>; 2],
    pub minor: [Vec<f64>; 2],
    /// Ticks of the second scale of the abscissa, in its own unit.
    pub second: Vec<Tick>,
    pub labels: Vec<Label>,
    pub bar: Option<Bar<'a>>,
}

impl Layout<'_> {
    /// The place of a point, pt.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let [left, top, right, bottom] = self.frame;
        (left + (right - left) * self.chart.x.fraction(x), bottom - (bottom - top) * self.chart.y.fraction(y))
    }
}

/// Whether tick labels fit side by side on `length`.
fn fits_horizontally(axis: &Axis, length: f64) -> impl Fn(&[Tick], f64) -> bool + '_ {
    move |ticks, space| {
        let ends = |(value, text): &Tick| {
            let (middle, half) = (length * axis.fraction(*value), 0.5 * SMALL * ems(text));
            (middle - half, middle + half)
        };
        ticks.windows(2).all(|pair| ends(&pair[1]).0 - ends(&pair[0]).1 >= space * SMALL)
    }
}

/// Whether tick labels fit one above the other on `length`.
fn fits_vertically(axis: &Axis, length: f64) -> impl Fn(&[Tick], f64) -> bool + '_ {
    move |ticks, space| {
        let apart = |pair: &[Tick]| length * (axis.fraction(pair[1].0) - axis.fraction(pair[0].0));
        ticks.windows(2).all(|pair| apart(pair) >= space * 2.2 * SMALL)
    }
}

fn widest(ticks: &[Tick]) -> f64 {
    let words = ticks.iter().flat_map(|(_, text)| text.split('\n'));
    words.map(|text| SMALL * ems(text)).fold(0.0, f64::max)
}

fn map_colours(chart: &Chart) -> Option<&Axis> {
    chart.layers.iter().find_map(|layer| match layer {
        Layer::Map { colours, .. } => Some(colours),
        _ => None,
    })
}

/// The width of the widest name beside a chart.
fn name_width(chart: &Chart) -> f64 {
    let width = |layer: &Layer| match layer {
        Layer::Name { text, .. } => LEADER + TINY * ems(text),
        _ => 0.0,
    };
    chart.layers.iter().map(width).fold(0.0, f64::max)
}

/// Lays a chart out in a cell: left, top, right, bottom, pt. Margins are at least `least`, so that stacked frames align. Unless
/// `labelled`, the abscissa has neither numbers nor label: it shares those of the chart below.
pub(crate) fn layout(
    chart: &Chart,
    [left, top, right, bottom]: Rect,
    labelled: bool,
    least: Margins,
) -> Layout<'_> {
    let (x, y) = (&chart.x, &chart.y);
    let row = LINE * TEXT;
    // Category names go above the frame, as in a table; numbers below.
    let named = !x.names.is_empty();
    let numbers = if named {
        LINE * SMALL * x.names.iter().map(|(_, name)| name.split('\n').count()).max().unwrap_or(1) as f64
    } else {
        GAP + SMALL
    };
    let title = lines(&chart.title, TEXT, right - left - 20.0);
    let mut margins = Margins {
        top: if title.is_empty() { 0.6 * SMALL } else { row * title.len() as f64 + 3.0 },
        bottom: if labelled && !named { numbers + 3.0 } else { 0.5 * SMALL },
        ..Margins::default()
    };
    if named {
        margins.top += numbers + 2.0;
    }
    if x.second.is_some() {
        margins.top += GAP + SMALL + row;
    }
    if labelled && !x.label.is_empty() {
        margins.bottom += row;
    }
    let height = bottom - top - margins.top - margins.bottom;
    let y_ticks = ticks(y, fits_vertically(y, height));
    let y_label = if y.label.is_empty() { 0.0 } else { row + 2.0 };
    margins.left = widest(&y_ticks) + GAP + y_label;
    let bar = map_colours(chart).map(|colours| (colours, ticks(colours, fits_vertically(colours, height))));
    let bar_width = bar.as_ref().map_or(0.0, |(colours, ticks)| {
        BAR[0] + BAR[1] + TICK + GAP + widest(ticks) + if colours.label.is_empty() { 0.0 } else { row + 2.0 }
    });
    margins.right = bar_width.max(name_width(chart)).max(2.0);
    margins = margins.with(least);
    // The last number may overhang on the right; then the frame is narrowed.
    let (mut x_ticks, mut second) = (Vec::new(), Vec::new());
    for _ in 0..3 {
        let width = right - left - margins.left - margins.right;
        x_ticks = ticks(x, fits_horizontally(x, width));
        second =
            x.second.as_deref().map(|axis| ticks(axis, fits_horizontally(axis, width))).unwrap_or_default();
        let out = |axis: &Axis, ticks: &[Tick]| {
            let over = |(value, text): &Tick| 0.5 * SMALL * ems(text) - width * (1.0 - axis.fraction(*value));
            ticks.iter().map(over).fold(0.0, f64::max)
        };
        let above = x.second.as_deref().map_or(0.0, |axis| out(axis, &second));
        let out = if labelled && !named { out(x, &x_ticks).max(above) } else { above };
        if out <= margins.right {
            break;
        }
        margins.right = out + 1.0;
    }
    let frame = [left + margins.left, top + margins.top, right - margins.right, bottom - margins.bottom];
    let bar = bar.map(|(colours, ticks)| Bar {
        colours,
        ticks,
        rect: [frame[2] + BAR[1], frame[1], frame[2] + BAR[1] + BAR[0], frame[3]],
    });
    let minor = [minor(x, &x_ticks), minor(y, &y_ticks)];
    let mut layout =
        Layout { chart, frame, margins, ticks: [x_ticks, y_ticks], minor, second, labels: Vec::new(), bar };
    layout.labels = labels(&layout, [left, top, right, bottom], &title, labelled);
    layout
}

/// All text beside the frame.
fn labels(
    layout: &Layout,
    [cell_left, cell_top, cell_right, cell_bottom]: Rect,
    title: &[String],
    labelled: bool,
) -> Vec<Label> {
    let [left, top, right, bottom] = layout.frame;
    let (x, y) = (&layout.chart.x, &layout.chart.y);
    let large = |label: Label| Label { size: TEXT, ..label };
    let row = LINE * TEXT;
    let mut all = Vec::new();
    // Centred on the frame, as far as the cell allows.
    let middle = |text: &str| {
        let half = 0.5 * TEXT * ems(text);
        (0.5 * (left + right)).min(cell_right - half).max(cell_left + half)
    };
    for (i, line) in title.iter().enumerate() {
        all.push(large(Label::new(line, (middle(line), cell_top + row * (i as f64 + 0.5)), 0)));
    }
    for (value, text) in layout.ticks[0].iter().filter(|_| labelled || !x.names.is_empty()) {
        let (at, _) = layout.at((*value, f64::NAN));
        let rows = text.split('\n').count() as f64;
        for (i, line) in text.split('\n').enumerate() {
            let below = bottom + GAP + 0.5 * SMALL;
            let above = top - 2.0 - LINE * SMALL * (rows - i as f64 - 0.5);
            all.push(Label::new(line, (at, if x.names.is_empty() { below } else { above }), 0));
        }
    }
    if let Some(axis) = x.second.as_deref() {
        for (value, text) in &layout.second {
            let at = left + (right - left) * axis.fraction(*value);
            all.push(Label::new(text, (at, top - GAP - 0.5 * SMALL), 0));
        }
        let at = (middle(&axis.label), top - GAP - SMALL - 0.5 * row);
        all.push(large(Label::new(&axis.label, at, 0)));
    }
    for (value, text) in &layout.ticks[1] {
        let (_, at) = layout.at((f64::NAN, *value));
        all.push(Label::new(text, (left - GAP, at), -1));
    }
    let upright = |text: &str, at: f64| Label {
        turned: true,
        ..large(Label::new(text, (at, 0.5 * (top + bottom)), 0))
    };
    if labelled && !x.label.is_empty() {
        let at = (middle(&x.label), cell_bottom - 0.5 * row);
        all.push(large(Label::new(&x.label, at, 0)));
    }
    if !y.label.is_empty() {
        all.push(upright(&y.label, cell_left + 0.5 * row));
    }
    if let Some(Bar { colours, rect, ticks }) = &layout.bar {
        for (value, text) in ticks {
            let at = bottom - (bottom - top) * colours.fraction(*value);
            all.push(Label::new(text, (rect[2] + TICK + GAP, at), 1));
        }
        if !colours.label.is_empty() {
            all.push(upright(&colours.label, rect[2] + TICK + GAP + widest(ticks) + 2.0 + 0.5 * row));
        }
    }
    all
}

#[cfg(test)]
#[path = "layout/tests.rs"]
mod tests;
