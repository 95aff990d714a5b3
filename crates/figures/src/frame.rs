//! A frame with two axes, their ticks and labels.

use crate::axis::Axis;
use crate::canvas::{Canvas, Drawn, TEXT, TICK, line, text, upright};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

/// A rectangle of the canvas with two axes.
pub struct Frame<'a> {
    /// The abscissa.
    pub x: &'a Axis,
    /// The ordinate.
    pub y: &'a Axis,
    /// Left edge, px.
    pub left: i32,
    /// Right edge, px.
    pub right: i32,
    /// Top edge, px.
    pub top: i32,
    /// Bottom edge, px.
    pub bottom: i32,
}

impl Frame<'_> {
    /// The pixel of a point.
    pub fn pixel(&self, x: f64, y: f64) -> (i32, i32) {
        let across = f64::from(self.right - self.left) * self.x.share(x);
        let up = f64::from(self.bottom - self.top) * self.y.share(y);
        (self.left + across.round() as i32, self.bottom - up.round() as i32)
    }

    /// Draws the frame with ticks; the labels of the x axis and of its ticks only where `with_x_labels`.
    ///
    /// # Errors
    /// The drawing library's.
    pub fn draw(&self, canvas: &Canvas, with_x_labels: bool) -> Drawn {
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
