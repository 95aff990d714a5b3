//! A chart as SVG.
//!
//! Written directly: an orbit diagram has a hundred thousand dots, which are one path here, each dot once.

use super::chart::{BLACK, Chart, Layer};
use crate::axis::{Axis, Scale};
use std::collections::BTreeSet;
use std::fmt::Write;

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Text at a place; `extra` are more attributes, each with a space before it.
pub fn words(out: &mut String, text: &str, (x, y): (f64, f64), anchor: &str, extra: &str) {
    let text = escape(text);
    let _ = writeln!(
        out,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{BLACK}\"{extra}>{text}</text>"
    );
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

/// Draws a chart into a cell, given by its left upper corner and its size, px.
pub fn draw_chart(out: &mut String, chart: &Chart, (left, top): (f64, f64), (width, height): (f64, f64)) {
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
