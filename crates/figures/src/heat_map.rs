//! A heat map: a coloured cell for each node of a grid, with a colour bar.

use crate::axis::{Axis, Scale, scale_for};
use crate::canvas::{Canvas, Drawn, TEXT, TICK, figure, line, text, upright};
use crate::colour::{NOTHING, viridis};
use crate::frame::Frame;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

/// A side of the grid.
pub struct Nodes {
    /// The quantity with its unit.
    pub label: String,
    /// Its spacing.
    pub scale: Scale,
    /// Its values, ascending.
    pub values: Vec<f64>,
}

/// A point marked on the map.
pub enum Mark {
    /// A square on a node of the grid.
    Grid {
        /// Its coordinate along the first side.
        x: f64,
        /// Its coordinate along the second side.
        y: f64,
        /// Its entry in the legend.
        label: String,
    },
    /// A disc at any place. Outside the axes it is not drawn, and the legend says so.
    Optimum {
        /// Its coordinate along the first side.
        x: f64,
        /// Its coordinate along the second side.
        y: f64,
        /// Its entry in the legend.
        label: String,
    },
}

const HEIGHT: u32 = 1200;

/// Draws `values` over the two `sides`, row by row: the index of the first side varies fastest. `quantity` is their label with its
/// unit. Values that are not finite are grey.
///
/// # Errors
/// The drawing library's.
pub fn heat_map(
    sides: &[Nodes; 2],
    values: &[f64],
    quantity: &str,
    marks: &[Mark],
    caption: &[String],
) -> Result<String, String> {
    let edges = [edges(&sides[0]), edges(&sides[1])];
    let axis = |side: usize| {
        let (first, last) = (edges[side][0], edges[side][edges[side].len() - 1]);
        Axis::new(sides[side].label.clone(), sides[side].scale, first, last)
    };
    let (x, y) = (axis(0), axis(1));
    let frame = Frame { x: &x, y: &y, left: 240, right: 1230, top: 110, bottom: 1040 };
    let colours = Axis::exact(quantity.to_owned(), scale_for(values), values);
    figure(HEIGHT, caption, |canvas| {
        let columns = sides[0].values.len();
        for (i, &value) in values.iter().enumerate() {
            let (column, row) = (i % columns, i / columns);
            let corner = frame.pixel(edges[0][column], edges[1][row]);
            let (right, top) = frame.pixel(edges[0][column + 1], edges[1][row + 1]);
            let colour = if value.is_finite() { viridis(colours.share(value)) } else { NOTHING };
            cell(canvas, corner, (right, top), &colour)?;
        }
        frame.draw(canvas, true)?;
        colour_bar(canvas, &colours, &frame)?;
        marks.iter().enumerate().try_for_each(|(i, mark)| draw_mark(canvas, &frame, mark, i))
    })
}

fn cell(canvas: &Canvas, corner: (i32, i32), opposite: (i32, i32), colour: &impl Color) -> Drawn {
    canvas.draw(&Rectangle::new([corner, opposite], colour.filled())).map_err(|error| error.to_string())
}

/// The edges of the cells around the nodes: halfway to the next node, on the scale of the side.
fn edges(side: &Nodes) -> Vec<f64> {
    let to = |v: f64| if side.scale == Scale::Log { v.ln() } else { v };
    let from = |v: f64| if side.scale == Scale::Log { v.exp() } else { v };
    let nodes: Vec<f64> = side.values.iter().map(|&v| to(v)).collect();
    let half_first = nodes.get(1).map_or(0.5, |second| 0.5 * (second - nodes[0]));
    let mut edges = vec![from(nodes[0] - half_first)];
    for (i, node) in nodes.iter().enumerate() {
        let half = nodes.get(i + 1).map_or_else(|| node - to(edges[i]), |next| 0.5 * (next - node));
        edges.push(from(node + half));
    }
    edges
}

fn colour_bar(canvas: &Canvas, colours: &Axis, frame: &Frame) -> Drawn {
    let (left, right) = (frame.right + 50, frame.right + 100);
    let height = frame.bottom - frame.top;
    let bands = 128;
    for i in 0..bands {
        let [below, above] = [i, i + 1].map(|edge| frame.bottom - height * edge / bands);
        let colour = viridis((f64::from(i) + 0.5) / f64::from(bands));
        cell(canvas, (left, below), (right, above), &colour)?;
    }
    for (value, label) in colours.ticks(6) {
        let y = frame.bottom - (f64::from(height) * colours.share(value)).round() as i32;
        line(canvas, &[(right, y), (right + TICK, y)], 3, &BLACK)?;
        text(canvas, &label, (right + 24, y), TEXT, HPos::Left, &BLACK)?;
    }
    upright(canvas, colours.label(), (frame.right + 290, (frame.top + frame.bottom) / 2))?;
    let (top, bottom) = (frame.top, frame.bottom);
    line(canvas, &[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], 3, &BLACK)
}

/// Draws a mark on the surface, and its meaning above the frame.
fn draw_mark(canvas: &Canvas, frame: &Frame, mark: &Mark, number: usize) -> Drawn {
    let (Mark::Grid { x, y, label } | Mark::Optimum { x, y, label }) = mark;
    let inside = frame.x.holds(*x) && frame.y.holds(*y);
    let key = (frame.left + 20 + 640 * number as i32, 60);
    let places = if inside { vec![frame.pixel(*x, *y), key] } else { vec![key] };
    for place in places {
        symbol(canvas, mark, place)?;
    }
    let words = if inside { label.clone() } else { format!("{label} (off the map)") };
    text(canvas, &words, (key.0 + 40, key.1), TEXT - 4, HPos::Left, &BLACK)
}

/// White with a black rim: seen on every colour of the map.
fn symbol(canvas: &Canvas, mark: &Mark, (x, y): (i32, i32)) -> Drawn {
    let drawn = match mark {
        Mark::Grid { .. } => {
            let square = |half: i32| [(x - half, y - half), (x + half, y + half)];
            canvas
                .draw(&Rectangle::new(square(24), BLACK.filled()))
                .and_then(|()| canvas.draw(&Rectangle::new(square(19), WHITE.filled())))
        }
        Mark::Optimum { .. } => canvas
            .draw(&Circle::new((x, y), 15, WHITE.filled()))
            .and_then(|()| canvas.draw(&Circle::new((x, y), 11, BLACK.filled()))),
    };
    drawn.map_err(|error| error.to_string())
}
