//! Several charts on one sheet, in rows and columns, with one legend above them all: a page of the paper.
//!
//! Written as SVG directly: an orbit diagram has a hundred thousand dots, which here are one path, each dot once.

use super::axis::{Axis, Scale};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Ink and the colours of M. Okabe and K. Ito's palette (2008).
pub const BLACK: &str = "#000000";
/// Orange.
pub const ORANGE: &str = "#E69F00";
/// Sky blue.
pub const SKY: &str = "#56B4E9";
/// Bluish green.
pub const GREEN: &str = "#009E73";
/// Blue.
pub const BLUE: &str = "#0072B2";
/// Vermilion.
pub const VERMILION: &str = "#D55E00";
/// Reddish purple; pale, the pink of the paper's bilateral zones.
pub const PURPLE: &str = "#CC79A7";

/// Yellow.
pub const YELLOW: &str = "#F0E442";
/// What needs no attention.
pub const GREY: &str = "#B8B8B8";

/// Something drawn on a chart.
pub enum Layer {
    /// A line through points; values that are not finite break it.
    Line {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Its colour.
        colour: &'static str,
        /// Its width.
        width: f64,
        /// Lengths of dashes and gaps as SVG writes them; empty for a solid line.
        dash: &'static str,
    },
    /// Dots; each pixel once.
    Dots {
        /// Their places.
        points: Vec<(f64, f64)>,
        /// Their colour.
        colour: &'static str,
        /// Their diameter.
        size: f64,
    },
    /// A pale background between two places, over a share of the height.
    Band {
        /// Its left end.
        from: f64,
        /// Its right end.
        to: f64,
        /// Its colour.
        colour: &'static str,
        /// From 0 to 1.
        opacity: f64,
        /// Its lower and upper end, as shares of the height.
        height: (f64, f64),
    },
    /// An upright line.
    Upright {
        /// Where it stands.
        x: f64,
    },
    /// Words at a place, at a share of the height.
    Words {
        /// Where they begin.
        x: f64,
        /// At which share of the height.
        share: f64,
        /// The words.
        text: String,
    },
}

/// A chart.
pub struct Chart {
    /// Above it.
    pub title: String,
    /// Below and to the left of it.
    pub labels: [String; 2],
    /// Ranges of its axes.
    pub ranges: [(f64, f64); 2],
    /// Whether its ordinate is logarithmic.
    pub log: bool,
    /// From back to front.
    pub layers: Vec<Layer>,
}

/// How a line or an area of the legend looks.
#[derive(Clone, Copy, Debug)]
pub enum Key {
    /// A line.
    Line(&'static str, &'static str),
    /// A dot.
    Dot(&'static str),
    /// An area.
    Area(&'static str, f64),
    /// Words that begin a row and say what its keys are for.
    Heading,
}

const WIDTH: f64 = 1600.0;
/// Half of it: on a telephone text is then about 12 px high.
const NARROW: f64 = 800.0;
const TEXT: f64 = 27.0;

/// A picture, and the same for a narrow screen where the picture itself would be too small to read.
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

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn words(out: &mut String, text: &str, (x, y): (f64, f64), anchor: &str, extra: &str) {
    let text = escape(text);
    let _ = writeln!(
        out,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{BLACK}\"{extra}>{text}</text>"
    );
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

/// A chart's frame on the sheet with its axes.
struct Place<'a> {
    x: &'a Axis,
    y: &'a Axis,
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Place<'_> {
    fn pixel(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.left + self.width * self.x.share(x), self.top + self.height * (1.0 - self.y.share(y)))
    }
}

fn draw_chart(out: &mut String, chart: &Chart, (left, top): (f64, f64), (width, height): (f64, f64)) {
    let axis = |side: usize, scale| {
        Axis::new(chart.labels[side].clone(), scale, chart.ranges[side].0, chart.ranges[side].1)
    };
    let (x, y) = (axis(0, Scale::Linear), axis(1, if chart.log { Scale::Log } else { Scale::Linear }));
    let place = Place {
        x: &x,
        y: &y,
        left: left + 135.0,
        top: top + 46.0,
        width: width - 190.0,
        height: height - 136.0,
    };
    words(out, &chart.title, (place.left + 0.5 * place.width, place.top - 16.0), "middle", "");
    for layer in &chart.layers {
        draw_layer(out, layer, &place);
    }
    let (right, bottom) = (place.left + place.width, place.top + place.height);
    let mut ticks = String::new();
    for (value, label) in x.ticks(5) {
        let (at, _) = place.pixel((value, f64::NAN));
        let _ = write!(ticks, "M{at:.1} {bottom:.1}v-9M{at:.1} {:.1}v9", place.top);
        words(out, &label, (at, bottom + 32.0), "middle", "");
    }
    for (value, label) in y.ticks(5) {
        let (_, at) = place.pixel((f64::NAN, value));
        let _ = write!(ticks, "M{:.1} {at:.1}h9M{right:.1} {at:.1}h-9", place.left);
        words(out, &label, (place.left - 10.0, at + 9.0), "end", "");
    }
    let _ = writeln!(
        out,
        "<path d=\"{ticks}M{:.1} {:.1}H{right:.1}V{bottom:.1}H{:.1}Z\" stroke=\"{BLACK}\" stroke-width=\"2\" fill=\"none\"/>",
        place.left, place.top, place.left
    );
    words(out, x.label(), (place.left + 0.5 * place.width, bottom + 70.0), "middle", "");
    let (at_x, at_y) = (left + 30.0, place.top + 0.5 * place.height);
    words(out, y.label(), (at_x, at_y), "middle", &format!(" transform=\"rotate(-90 {at_x:.1} {at_y:.1})\""));
}

fn draw_layer(out: &mut String, layer: &Layer, place: &Place) {
    let _ = match layer {
        Layer::Line { points, colour, width, dash } => {
            let path = path_of(points, place);
            writeln!(
                out,
                "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dash}\" fill=\"none\" stroke-linejoin=\"round\"/>"
            )
        }
        Layer::Dots { points, colour, size } => {
            let on_chart = points.iter().filter(|(x, y)| place.x.holds(*x) && place.y.holds(*y));
            let pixels: BTreeSet<(i64, i64)> = on_chart
                .map(|&point| place.pixel(point))
                .map(|(x, y)| ((2.0 * x).round() as i64, (0.5 * y).round() as i64))
                .collect();
            let mut path = String::new();
            for (x, y) in pixels {
                let _ = write!(path, "M{} {}h0", 0.5 * x as f64, 2 * y);
            }
            writeln!(
                out,
                "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{size}\" stroke-linecap=\"round\" fill=\"none\"/>"
            )
        }
        Layer::Band { from, to, colour, opacity, height } => {
            // Whole pixels: bands that meet share an edge.
            let [left, right] = [from, to].map(|x| place.pixel((*x, f64::NAN)).0.round());
            let (top, tall) =
                (place.top + place.height * (1.0 - height.1), place.height * (height.1 - height.0));
            writeln!(
                out,
                "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{tall:.1}\" fill=\"{colour}\" fill-opacity=\"{opacity}\" shape-rendering=\"crispEdges\"/>",
                right - left
            )
        }
        Layer::Upright { x } => {
            let (at, _) = place.pixel((*x, f64::NAN));
            let (top, height) = (place.top, place.height);
            writeln!(
                out,
                "<path d=\"M{at:.1} {top:.1}v{height:.1}\" stroke=\"{BLACK}\" stroke-width=\"2.5\" fill=\"none\"/>"
            )
        }
        Layer::Words { x, share, text } => {
            let (at, _) = place.pixel((*x, f64::NAN));
            let y = place.top + place.height * (1.0 - share);
            // A halo in the colour of the paper, so that lines behind do not cross the words.
            let halo = " stroke=\"#FFFFFF\" stroke-width=\"6\" paint-order=\"stroke\"";
            words(out, text, (at, y), "middle", &format!(" font-size=\"21\"{halo}"));
            Ok(())
        }
    };
}

/// A path through points; it breaks at values that are not finite or beyond the chart, and drops points within half a pixel.
fn path_of(points: &[(f64, f64)], place: &Place) -> String {
    let mut path = String::new();
    let mut last: Option<(f64, f64)> = None;
    for &(x, y) in points {
        if !(x.is_finite() && y.is_finite() && place.x.holds(x)) {
            last = None;
            continue;
        }
        let (at_x, at_y) = place.pixel((x, y));
        let near = |(a, b): (f64, f64)| (a - at_x).abs() < 0.5 && (b - at_y).abs() < 0.5;
        match last {
            Some(before) if near(before) => continue,
            Some(_) => drop(write!(path, "L{at_x:.1} {at_y:.1}")),
            None => drop(write!(path, "M{at_x:.1} {at_y:.1}")),
        }
        last = Some((at_x, at_y));
    }
    path
}
