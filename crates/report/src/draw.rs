//! Draws a chart that has been laid out, as SVG.

use crate::chart::{Dash, Layer, Mark, Shape, Stand, Stroke};
use crate::colour::{BLACK, Colour, GREY, PAPER, viridis};
use crate::direct::DirectLabel;
use crate::layout::{LEADER, LINE, Layout, SMALL, TICK, TINY};
use crate::path::{Rect, polyline, rectangle, shape};
use crate::svg::{Anchor, Font, Svg, units};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Width of the frame and its ticks, pt.
const FRAME: f64 = 0.6;
/// Lines meet in round corners; a point alone is a dot.
const ROUND: &str = " stroke-linejoin=\"round\" stroke-linecap=\"round\"";
/// Cells meet edge to edge: blended edges would show as a grid of pale lines.
const CRISP: &str = " shape-rendering=\"crispEdges\"";
/// Cells of a colour bar.
const BAR: i32 = 64;

/// Draws a chart.
pub(crate) fn chart(svg: &mut Svg, layout: &Layout) {
    let is_text = |layer: &&Layer| matches!(layer, Layer::Text { .. });
    for layer in layout.chart.layers.iter().filter(|layer| !is_text(layer)) {
        draw_layer(svg, layer, layout);
    }
    draw_frame(svg, layout);
    names(svg, layout);
    for layer in layout.chart.layers.iter().filter(is_text) {
        draw_layer(svg, layer, layout);
    }
    for label in &layout.labels {
        let anchor = match label.side {
            -1 => Anchor::End,
            0 => Anchor::Middle,
            _ => Anchor::Start,
        };
        svg.text(&label.text, label.at, Font { turned: label.turned, ..Font::new(label.size, anchor) });
    }
}

/// The attribute for the dashes of a line.
pub(crate) fn dashes(dash: Dash) -> &'static str {
    match dash {
        Dash::Solid => ROUND,
        Dash::Long => " stroke-dasharray=\"55 25\"",
        Dash::Short => " stroke-dasharray=\"25 20\"",
        Dash::Dots => " stroke-dasharray=\"12 14\"",
        Dash::DashDot => " stroke-dasharray=\"60 20 12 20\"",
    }
}

/// Draws equal marks at points, pt.
pub(crate) fn marks(svg: &mut Svg, places: &[(f64, f64)], mark: Mark) {
    let Mark { shape: kind, colour, size, rim } = mark;
    let (_, filled) = shape(kind, (0.0, 0.0), size);
    let path: String = places.iter().map(|&place| shape(kind, place, size).0).collect();
    let width = if filled { 0.0 } else { 1.0 };
    if rim {
        svg.line(&path, PAPER, width + 2.0, " stroke-linejoin=\"round\"");
    }
    if filled {
        svg.fill(&path, colour, "");
    } else {
        svg.line(&path, colour, width, "");
    }
}

fn line(svg: &mut Svg, path: &str, stroke: &Stroke) {
    svg.line(path, stroke.colour, stroke.width, dashes(stroke.dash));
}

fn draw_layer(svg: &mut Svg, layer: &Layer, layout: &Layout) {
    let [left, top, right, bottom] = layout.frame;
    let on_chart = |point: &(f64, f64)| layout.chart.x.holds(point.0) && layout.chart.y.holds(point.1);
    match layer {
        Layer::Line { points, stroke } => {
            let path = polyline(points.iter().map(|&point| layout.at(point)), layout.frame);
            line(svg, &path, stroke);
        }
        Layer::Steps { points, stroke } => {
            let corners = points
                .iter()
                .enumerate()
                .flat_map(|(i, &(x, y))| [(x, if i == 0 { y } else { points[i - 1].1 }), (x, y)]);
            line(svg, &polyline(corners.map(|point| layout.at(point)), layout.frame), stroke);
        }
        Layer::Dots { points, colour, size } => {
            let places = points.iter().filter(|point| on_chart(point)).map(|&point| layout.at(point));
            svg.line(&dots(places), colour, *size, " stroke-linecap=\"round\"");
        }
        Layer::Marks { points, mark } => {
            let places: Vec<_> =
                points.iter().filter(|point| on_chart(point)).map(|&point| layout.at(point)).collect();
            marks(svg, &places, *mark);
        }
        Layer::Band { x, y, colour, opacity } => {
            // A value without a position on a logarithmic axis is placed before its beginning.
            let across = |x: f64| layout.at((x, f64::NAN)).0.max(left).min(right);
            let up = |y: f64| layout.at((f64::NAN, y)).1.min(bottom).max(top);
            let rect = [across(x.0), up(y.1), across(x.1), up(y.0)];
            if rect[0] < rect[2] && rect[1] < rect[3] {
                svg.fill(&rectangle(rect), colour, &format!("{}{CRISP}", opaque(*opacity)));
            }
        }
        Layer::Map { edges, values, colours } => {
            let cells = values.iter().map(|&value| viridis(colours.fraction(value)));
            for (colour, path) in map(edges, cells, layout) {
                svg.fill(&path, &colour, CRISP);
            }
        }
        Layer::Cells { edges, colours } => {
            for (colour, path) in map(edges, colours.iter().map(|&colour| colour.to_owned()), layout) {
                svg.fill(&path, &colour, CRISP);
            }
        }
        Layer::Upright { x, stroke } if layout.chart.x.holds(*x) => {
            let (at, _) = layout.at((*x, f64::NAN));
            line(svg, &polyline([(at, top), (at, bottom)].into_iter(), layout.frame), stroke);
        }
        Layer::Level { y, stroke } if layout.chart.y.holds(*y) => {
            let (_, at) = layout.at((f64::NAN, *y));
            line(svg, &polyline([(left, at), (right, at)].into_iter(), layout.frame), stroke);
        }
        Layer::Upright { .. } | Layer::Level { .. } | Layer::Name { .. } => {}
        Layer::Text { at, text, stand } if on_chart(at) => {
            let font = match stand {
                Stand::Over => Font { halo: true, ..Font::new(SMALL, Anchor::Middle) },
                Stand::Right => Font { halo: true, ..Font::new(SMALL, Anchor::Start) },
                Stand::Cell => Font::new(TINY, Anchor::Middle),
            };
            svg.text(text, layout.at(*at), font);
        }
        Layer::Text { .. } => {}
    }
}

/// The attribute for an opacity.
pub(crate) fn opaque(opacity: f64) -> String {
    if opacity < 1.0 { format!(" fill-opacity=\"{opacity}\"") } else { String::new() }
}

/// Dots at points, pt: at most one per rectangle of 0.2 by 0.5 pt.
fn dots(places: impl Iterator<Item = (f64, f64)>) -> String {
    let cells: BTreeSet<(i64, i64)> =
        places.map(|(x, y)| ((5.0 * x).round() as i64, (2.0 * y).round() as i64)).collect();
    let mut path = String::new();
    let mut before: Option<(i64, i64)> = None;
    for (x, y) in cells {
        let at = (2 * x, 5 * y);
        let _ = match before {
            None => write!(path, "M{} {}h0", at.0, at.1),
            Some((x, y)) => write!(path, "m{} {}h0", at.0 - x, at.1 - y),
        };
        before = Some(at);
    }
    path
}

/// Draws the cells of a map, grouped by colour.
fn map(
    edges: &[Vec<f64>; 2],
    colours: impl Iterator<Item = String>,
    layout: &Layout,
) -> BTreeMap<String, String> {
    let [left, top, right, bottom] = layout.frame;
    let across: Vec<f64> = edges[0].iter().map(|&x| layout.at((x, f64::NAN)).0.clamp(left, right)).collect();
    let up: Vec<f64> = edges[1].iter().map(|&y| layout.at((f64::NAN, y)).1.clamp(top, bottom)).collect();
    let columns = across.len().saturating_sub(1).max(1);
    let mut paths: BTreeMap<String, String> = BTreeMap::new();
    for (i, colour) in colours.enumerate() {
        let (column, row) = (i % columns, i / columns);
        if let (Some([left, right]), Some([bottom, top])) =
            (across.get(column..column + 2), up.get(row..row + 2))
        {
            *paths.entry(colour).or_default() += &rectangle([*left, *top, *right, *bottom]);
        }
    }
    paths
}

fn draw_frame(svg: &mut Svg, layout: &Layout) {
    let [left, top, right, bottom] = layout.frame.map(units);
    let mut path = String::new();
    let lengths = [units(TICK), units(0.5 * TICK)];
    let all = |side: usize| {
        let long = layout.ticks[side].iter().map(move |(value, _)| (*value, lengths[0]));
        long.chain(layout.minor[side].iter().map(move |value| (*value, lengths[1])))
    };
    for (value, length) in all(0).filter(|_| layout.chart.x.names.is_empty()) {
        let at = units(layout.at((value, f64::NAN)).0);
        let _ = write!(path, "M{at} {bottom}v-{length}");
        if layout.chart.x.second.is_none() {
            let _ = write!(path, "M{at} {top}v{length}");
        }
    }
    if let Some(axis) = &layout.chart.x.second {
        for (value, _) in &layout.second {
            let at = units(layout.frame[0] + (layout.frame[2] - layout.frame[0]) * axis.fraction(*value));
            let _ = write!(path, "M{at} {top}v{}", lengths[0]);
        }
    }
    for (value, length) in all(1).filter(|_| layout.chart.y.names.is_empty()) {
        let at = units(layout.at((f64::NAN, value)).1);
        let _ = write!(path, "M{left} {at}h{length}M{right} {at}h-{length}");
    }
    if let Some(bar) = &layout.bar {
        let [from, _, to, _] = bar.rect;
        for i in 0..BAR {
            let [below, above] = [i, i + 1]
                .map(|edge| bar.rect[3] - (bar.rect[3] - bar.rect[1]) * f64::from(edge) / f64::from(BAR));
            let colour = viridis((f64::from(i) + 0.5) / f64::from(BAR));
            svg.fill(&rectangle([from, above, to, below]), &colour, CRISP);
        }
        path += &rectangle(bar.rect);
        for (value, _) in &bar.ticks {
            let at = units(bar.rect[3] - (bar.rect[3] - bar.rect[1]) * bar.colours.fraction(*value));
            let _ = write!(path, "M{} {at}h{}", units(to), lengths[0]);
        }
    }
    path += &rectangle(layout.frame);
    svg.line(&path, BLACK, FRAME, "");
}

/// Draws labels beside the frame in the order of their points, moved apart.
fn names(svg: &mut Svg, layout: &Layout) {
    let [left, top, right, bottom] = layout.frame;
    let mut all: Vec<((f64, f64), &str, Option<Mark>)> = Vec::new();
    for layer in &layout.chart.layers {
        if let Layer::Name { at, text, mark } = layer {
            let (x, y) = layout.at(*at);
            all.push(((x.clamp(left, right), y.clamp(top, bottom)), text, *mark));
        }
    }
    all.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    let wanted: Vec<f64> = all.iter().map(|(at, ..)| at.1).collect();
    for (((x, y), text, mark), place) in all.iter().zip(spread_out(&wanted, 1.2 * TINY, [top, bottom])) {
        let from = right + LEADER - 8.0;
        let path = polyline([(*x, *y), (from, place)].into_iter(), unbounded());
        svg.line(&path, GREY, 0.3, "");
        if let Some(mark) = mark {
            marks(svg, &[(from + 3.0, place)], *mark);
        }
        svg.text(text, (right + LEADER, place), Font::new(TINY, Anchor::Start));
    }
}

/// Draws labels beside their lines, each with a leader.
pub(crate) fn direct_labels(svg: &mut Svg, names: &[DirectLabel]) {
    for DirectLabel { text, rect, leader, stroke } in names {
        svg.line(&polyline(leader.iter().copied(), unbounded()), stroke.colour, 0.5, "");
        marks(svg, &leader[..1], Mark::new(Shape::Disc, stroke.colour, 2.6));
        let font = Font { halo: true, ..Font::new(SMALL, Anchor::Middle) };
        for (i, line) in text.iter().enumerate() {
            let down = (i as f64 + 0.5) * SMALL + i as f64 * (LINE - 1.0) * SMALL;
            svg.text(line, (0.5 * (rect[0] + rect[2]), rect[1] + down), font);
        }
    }
}

const fn unbounded() -> Rect {
    [-1e6, -1e6, 1e6, 1e6]
}

/// Positions at least `step` apart that stay as close as possible to the wanted ones (ascending), within the
/// two ends if there is room.
fn spread_out(wanted: &[f64], step: f64, [top, bottom]: [f64; 2]) -> Vec<f64> {
    let mut places = wanted.to_vec();
    for i in 1..places.len() {
        places[i] = places[i].max(places[i - 1] + step);
    }
    let mut limit = bottom;
    for place in places.iter_mut().rev() {
        *place = place.min(limit);
        limit = *place - step;
    }
    let mut least = top;
    for place in &mut places {
        *place = place.max(least);
        least = *place + step;
    }
    places
}

/// The key of a colour in a legend: an area at a place, pt.
pub(crate) fn area(svg: &mut Svg, rect: Rect, colour: Colour, opacity: f64) {
    svg.fill(&rectangle(rect), colour, &opaque(opacity));
}

/// A short line in a legend.
pub(crate) fn sample(svg: &mut Svg, from: (f64, f64), length: f64, stroke: Stroke) {
    line(svg, &polyline([from, (from.0 + length, from.1)].into_iter(), unbounded()), &stroke);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_names_are_moved_apart_and_stay_between_the_ends() {
        let found = spread_out(&[10.0, 10.0, 10.0, 49.0, 49.0], 8.0, [0.0, 50.0]);
        assert_eq!(found, [10.0, 18.0, 26.0, 42.0, 50.0]);
        assert_eq!(spread_out(&[5.0, 30.0], 8.0, [0.0, 50.0]), [5.0, 30.0]);
        // Without room they extend beyond the lower end.
        assert_eq!(spread_out(&[5.0; 4], 8.0, [0.0, 16.0]), [0.0, 8.0, 16.0, 24.0]);
    }

    #[test]
    fn contract_dots_that_cover_one_another_are_drawn_once() {
        let places = [(1.0, 1.0), (1.05, 1.1), (1.0, 1.0), (3.0, 4.0)];
        assert_eq!(dots(places.into_iter()), "M10 10h0m20 30h0");
    }
}
