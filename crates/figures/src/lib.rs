//! Figures for print: SVG with a frame, ticks inside, labelled axes with units and a caption that says what made it.
//!
//! Everything is drawn on a canvas of [`WIDTH`] by a height of the figure's own, in pixels fine enough for curves; a viewer
//! scales it. `plotters` only writes the SVG: the frame, its ticks and its text are laid out here, alike in all figures.

mod axis;
mod colour;
mod heat_map;
mod panels;
pub mod sheet;

pub use axis::{Scale, scale_for};
pub use heat_map::{Mark, Nodes, heat_map};
pub use panels::{Panel, panels};

use axis::Axis;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width of every figure, px.
const WIDTH: u32 = 1600;
/// Size of text, px.
const TEXT: i32 = 44;
/// Size of the caption, px.
const SMALL: i32 = 32;
/// Length of a tick, px.
const TICK: i32 = 14;
/// Height of a line of the caption, px.
const CAPTION_LINE: i32 = 42;

/// Where things are drawn.
type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Why a figure cannot be drawn, in the drawing library's words.
type Drawn = Result<(), String>;

/// A figure of `height` px, drawn by `draw`, with `caption` below it; as SVG text.
fn figure(height: u32, caption: &[String], draw: impl FnOnce(&Canvas) -> Drawn) -> Result<String, String> {
    let mut svg = String::new();
    let foot = CAPTION_LINE * caption.len() as i32 + 20;
    {
        let canvas = SVGBackend::with_string(&mut svg, (WIDTH, height + foot as u32)).into_drawing_area();
        canvas.fill(&WHITE).map_err(|error| error.to_string())?;
        draw(&canvas)?;
        for (i, line) in caption.iter().enumerate() {
            let place = (30, height as i32 + CAPTION_LINE * i as i32 + CAPTION_LINE / 2);
            text(&canvas, line, place, SMALL, HPos::Left, &BLACK.mix(0.7))?;
        }
        canvas.present().map_err(|error| error.to_string())?;
    }
    // Cells meet edge to edge: blended edges would show as a grid of pale lines.
    let svg = svg.replace("<rect ", "<rect shape-rendering=\"crispEdges\" ");
    Ok(with_subscripts(&svg) + "\n")
}

/// Sets `_{...}` in the text of an SVG as a subscript.
fn with_subscripts(svg: &str) -> String {
    let mut parts = svg.split("_{");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once('}') {
            Some((low, rest)) => {
                out += &format!(
                    "<tspan dy=\"9\" font-size=\"70%\">{low}</tspan><tspan dy=\"-9\">&#8203;</tspan>{rest}"
                );
            }
            None => out += part,
        }
    }
    out
}

/// A rectangle of the canvas with two axes.
struct Frame<'a> {
    x: &'a Axis,
    y: &'a Axis,
    /// Left, right, top and bottom, px.
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

impl Frame<'_> {
    /// The pixel of a point.
    fn pixel(&self, x: f64, y: f64) -> (i32, i32) {
        let across = f64::from(self.right - self.left) * self.x.share(x);
        let up = f64::from(self.bottom - self.top) * self.y.share(y);
        (self.left + across.round() as i32, self.bottom - up.round() as i32)
    }

    /// Draws the frame with ticks; tick labels and the label of the x axis only where asked for.
    fn draw(&self, canvas: &Canvas, with_x_labels: bool) -> Drawn {
        let (left, right, top, bottom) = (self.left, self.right, self.top, self.bottom);
        for (value, label) in self.x.ticks((right - left) / 180) {
            let (x, _) = self.pixel(value, f64::NAN);
            line(canvas, &[(x, bottom), (x, bottom - TICK)], 3, &BLACK)?;
            line(canvas, &[(x, top), (x, top + TICK)], 3, &BLACK)?;
            if with_x_labels {
                text(canvas, &label, (x, bottom + 38), TEXT, HPos::Center, &BLACK)?;
            }
        }
        for (value, label) in self.y.ticks(3 + (bottom - top) / 250) {
            let (_, y) = self.pixel(f64::NAN, value);
            line(canvas, &[(left, y), (left + TICK, y)], 3, &BLACK)?;
            line(canvas, &[(right, y), (right - TICK, y)], 3, &BLACK)?;
            text(canvas, &label, (left - 16, y), TEXT, HPos::Right, &BLACK)?;
        }
        if with_x_labels {
            text(canvas, self.x.label(), ((left + right) / 2, bottom + 100), TEXT, HPos::Center, &BLACK)?;
        }
        upright(canvas, self.y.label(), (50, (top + bottom) / 2))?;
        line(canvas, &[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], 3, &BLACK)
    }
}

/// A line of text, its vertical middle at `place`.
fn text(
    canvas: &Canvas,
    words: &str,
    place: (i32, i32),
    size: i32,
    anchor: HPos,
    colour: &impl Color,
) -> Drawn {
    let style =
        TextStyle::from(("sans-serif", size).into_font()).color(colour).pos(Pos::new(anchor, VPos::Center));
    canvas.draw_text(words, &style, place).map_err(|error| error.to_string())
}

/// Text read from below, its middle at `place`.
fn upright(canvas: &Canvas, words: &str, place: (i32, i32)) -> Drawn {
    let font = ("sans-serif", TEXT).into_font().transform(FontTransform::Rotate270);
    let style = TextStyle::from(font).color(&BLACK).pos(Pos::new(HPos::Center, VPos::Center));
    canvas.draw_text(words, &style, place).map_err(|error| error.to_string())
}

/// A line through `points`.
fn line(canvas: &Canvas, points: &[(i32, i32)], width: u32, colour: &impl Color) -> Drawn {
    let path = PathElement::new(points.to_vec(), colour.stroke_width(width));
    canvas.draw(&path).map_err(|error| error.to_string())
}
