//! Panels of lines, each with its name beside the frame, as charts of `retune_report`.

use crate::Any;
use retune_report::colour::{BLACK, BLUE, Colour, GREEN, GREY, VERMILION};
use retune_report::{Axis, Chart, Dash, Layer, Mark, Shape, Sheet, Stroke, Width, svg};
use retune_solver::Method;
use std::fs;
use std::path::Path;

/// Widths of lines, pt, from the least important to the most important.
pub const WIDTHS: [f64; 4] = [0.5, 0.8, 1.1, 1.5];

/// Colour, width and mark of one of Retune's methods, the same on every sheet of the atlas.
pub const fn look(method: Method) -> (Colour, f64, Shape) {
    match method {
        Method::Hybrid => (VERMILION, WIDTHS[3], Shape::Disc),
        Method::Ode23s => (BLACK, WIDTHS[2], Shape::Disc),
        Method::Ode45 => (BLUE, WIDTHS[1], Shape::Disc),
        Method::Ode23 => (BLUE, WIDTHS[1], Shape::Square),
        Method::Dop853 => (BLUE, WIDTHS[1], Shape::Triangle),
        Method::Rk4 => (GREEN, WIDTHS[1], Shape::Disc),
        Method::Euler => (GREEN, WIDTHS[1], Shape::Square),
    }
}

/// A line with its name.
pub struct Line {
    /// Its name; an empty one is not written.
    pub name: String,
    /// Its points; those beyond the axes are drawn as hollow squares on the frame.
    pub points: Vec<(f64, f64)>,
    pub colour: Colour,
    /// Its width, pt; zero draws points alone.
    pub width: f64,
    pub shape: Option<Shape>,
}

impl Line {
    /// A line with marks.
    pub fn new(name: &str, points: Vec<(f64, f64)>, (colour, width, shape): (Colour, f64, Shape)) -> Self {
        Self { name: name.to_owned(), points, colour, width, shape: Some(shape) }
    }
}

/// A panel, `height` pt high; `lines` are in ascending importance.
pub fn panel(title: &str, x: Axis, y: Axis, lines: Vec<Line>, height: f64) -> Chart {
    let mut layers = Vec::new();
    let mut names = Vec::new();
    for Line { name, points, colour, width, shape } in lines {
        let ends = [x.range(), y.range()];
        let held = |p: (f64, f64)| (p.0.clamp(ends[0].0, ends[0].1), p.1.clamp(ends[1].0, ends[1].1));
        let finite = points.into_iter().filter(|p| p.0.is_finite() && p.1.is_finite());
        let points: Vec<(f64, f64)> = finite.collect();
        let size = match shape {
            Some(Shape::Ring) => 4.6,
            _ if width > 1.0 => 3.6,
            _ => 3.0,
        };
        let mark = shape.map(|shape| Mark::new(shape, colour, size));
        if let (Some(&at), false) = (points.iter().max_by(|a, b| a.0.total_cmp(&b.0)), name.is_empty()) {
            names.push(Layer::Name { at: held(at), text: name, mark });
        }
        if width > 0.0 {
            layers.push(Layer::Line {
                points: points.clone(),
                stroke: Stroke::new(colour, width, Dash::Solid),
            });
        }
        if let Some(mark) = mark {
            let beyond: Vec<(f64, f64)> =
                points.iter().filter(|p| held(**p) != **p).map(|p| held(*p)).collect();
            layers.push(Layer::Marks { points, mark });
            if !beyond.is_empty() {
                layers.push(Layer::Marks { points: beyond, mark: Mark::new(Shape::Frame, colour, 4.6) });
            }
        }
    }
    layers.extend(names);
    Chart { title: title.to_owned(), x, y, layers, height }
}

/// Shades a panel where `x` is at most `floor`: such errors are meaningless.
pub fn shade(panel: &mut Chart, floor: f64) {
    let (x, y) = ((panel.x.range().0, floor), (f64::NEG_INFINITY, f64::INFINITY));
    panel.layers.insert(0, Layer::Band { x, y, colour: GREY, opacity: 0.18 });
}

/// Writes a figure of panels with notes below them.
pub fn sheet(path: &Path, title: &str, notes: &[&str], columns: usize, panels: Vec<Chart>) -> Any<()> {
    let width = if columns == 1 { Width::Column } else { Width::Page };
    let caption: Vec<String> =
        std::iter::once(format!("{title}.")).chain(notes.iter().map(|&note| note.to_owned())).collect();
    let figure = Sheet {
        title: title.to_owned(),
        description: notes.join(" "),
        width,
        charts: panels,
        columns,
        stacked: false,
        legend: Vec::new(),
        caption,
    };
    fs::write(path, svg(&figure))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_points_beyond_the_axes_are_hollow_on_the_frame_and_a_name_stands_at_the_last() {
        let points = vec![(1e-20, 5.0), (0.1, f64::NAN), (10.0, 1e9)];
        let line = Line::new("a", points, look(Method::Hybrid));
        let (x, y) = (Axis::log("x", (1e-15, 1.0)), Axis::log("y", (1.0, 100.0)));
        let chart = panel("", x, y, vec![line], 100.0);
        let Layer::Marks { points, mark } = &chart.layers[2] else { panic!("{:?}", chart.layers) };
        assert_eq!((&points[..], mark.shape), (&[(1e-15, 5.0), (1.0, 100.0)][..], Shape::Frame));
        let Some(Layer::Name { at, .. }) = chart.layers.last() else { panic!("{:?}", chart.layers) };
        assert_eq!(*at, (1.0, 100.0));
    }
}
