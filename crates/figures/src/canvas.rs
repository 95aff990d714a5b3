//! The canvas of a figure: its size, its caption, lines and text on it.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width of every figure, px.
pub const WIDTH: u32 = 1600;
/// Size of text, px.
pub const TEXT: i32 = 44;
/// Size of the caption, px.
pub const SMALL: i32 = 32;
/// Length of a tick, px.
pub const TICK: i32 = 14;
/// Height of a line of the caption, px.
pub const CAPTION_LINE: i32 = 42;

/// A drawing area, coordinates in px.
pub type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The result of drawing; the error is the message of the drawing library.
pub type Drawn = Result<(), String>;

/// The SVG text of a figure of `height` px, drawn by `draw`, with the lines of `caption` below it.
///
/// # Errors
/// The drawing library's.
pub fn figure(
    height: u32,
    caption: &[String],
    draw: impl FnOnce(&Canvas) -> Drawn,
) -> Result<String, String> {
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
pub fn with_subscripts(svg: &str) -> String {
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

/// A line of text, its vertical middle at `place`.
///
/// # Errors
/// The drawing library's.
pub fn text(
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

/// Text rotated by 90°, read from the bottom upwards, its middle at `place`.
///
/// # Errors
/// The drawing library's.
pub fn upright(canvas: &Canvas, words: &str, place: (i32, i32)) -> Drawn {
    let font = ("sans-serif", TEXT).into_font().transform(FontTransform::Rotate270);
    let style = TextStyle::from(font).color(&BLACK).pos(Pos::new(HPos::Center, VPos::Center));
    canvas.draw_text(words, &style, place).map_err(|error| error.to_string())
}

/// A line through `points`.
///
/// # Errors
/// The drawing library's.
pub fn line(canvas: &Canvas, points: &[(i32, i32)], width: u32, colour: &impl Color) -> Drawn {
    let path = PathElement::new(points.to_vec(), colour.stroke_width(width));
    canvas.draw(&path).map_err(|error| error.to_string())
}
