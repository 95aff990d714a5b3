//! Several quantities over one common abscissa, each in its own panel, stacked.

use crate::axis::{Axis, Scale};
use crate::canvas::{figure, line};
use crate::colour::BLUE;
use crate::frame::Frame;

/// A quantity.
pub struct Panel {
    label: String,
    scale: Scale,
    values: Vec<f64>,
}

impl Panel {
    /// A quantity with its label and unit.
    pub fn new(label: String, scale: Scale, values: Vec<f64>) -> Self {
        Self { label, scale, values }
    }
}

/// Height of the first panel, and of each of the others, px.
const HEIGHTS: [i32; 2] = [420, 260];

/// Draws each of `panels` over `x`, which has as many values as each of them.
///
/// # Errors
/// The drawing library's.
pub fn panels(x_label: &str, x: &[f64], panels: &[Panel], caption: &[String]) -> Result<String, String> {
    let x_axis = Axis::exact(x_label.to_owned(), Scale::Linear, x);
    let (top, gap, foot) = (40, 36, 150);
    let mut frames_top = Vec::new();
    let mut next = top;
    for i in 0..panels.len() {
        let height = if i == 0 { HEIGHTS[0] } else { HEIGHTS[1] };
        frames_top.push((next, next + height));
        next += height + gap;
    }
    figure((next - gap + foot) as u32, caption, |canvas| {
        for (i, (panel, (top, bottom))) in panels.iter().zip(&frames_top).enumerate() {
            let y_axis = Axis::around(panel.label.clone(), panel.scale, &panel.values);
            let frame = Frame { x: &x_axis, y: &y_axis, left: 270, right: 1560, top: *top, bottom: *bottom };
            frame.draw(canvas, i + 1 == panels.len())?;
            let points = x.iter().zip(&panel.values).filter(|(_, v)| v.is_finite());
            let points: Vec<_> = points.map(|(x, value)| frame.pixel(*x, *value)).collect();
            line(canvas, &points, 5, &BLUE)?;
        }
        Ok(())
    })
}
