//! A panel of a chart: axes with SI units, lines, and each line's name at its end. Colours of M. Okabe and K. Ito (2008), which
//! colour-blind readers can distinguish; markers distinguish lines of the same colour.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use retune_solver::Method;
use std::error::Error;
use std::path::Path;

/// The result of drawing.
pub type Drawn = Result<(), Box<dyn Error>>;
/// A part of a picture.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Black.
pub const INK: RGBColor = RGBColor(0, 0, 0);
/// Vermilion.
pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
/// Blue.
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
/// Bluish green.
pub const GREEN: RGBColor = RGBColor(0, 130, 95);
/// Orange, darkened until it can be read as text.
pub const ORANGE: RGBColor = RGBColor(190, 128, 0);
/// Reddish purple, darkened likewise.
pub const PURPLE: RGBColor = RGBColor(170, 80, 130);
/// Grey.
pub const GREY: RGBColor = RGBColor(115, 115, 115);

/// Shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A filled disc.
    Disc,
    /// A ring.
    Ring,
    /// A filled square.
    Square,
    /// A triangle.
    Triangle,
    /// A cross.
    Cross,
    /// None.
    Nothing,
}

/// Colour, width in px and marker of one of Retune's methods, the same on every sheet of the atlas.
pub fn look(method: Method) -> (RGBColor, u32, Marker) {
    match method {
        Method::Hybrid => (VERMILION, 4, Marker::Disc),
        Method::Ode23s => (INK, 3, Marker::Disc),
        Method::Ode45 => (BLUE, 2, Marker::Disc),
        Method::Ode23 => (BLUE, 2, Marker::Square),
        Method::Dop853 => (BLUE, 2, Marker::Triangle),
        Method::Rk4 => (GREEN, 2, Marker::Disc),
        Method::Euler => (GREEN, 2, Marker::Square),
    }
}

/// A line with its name.
pub struct Line {
    /// Its name; an empty one is not written.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Its colour.
    pub colour: RGBColor,
    /// Its width, px; zero draws points alone.
    pub width: u32,
    /// Its points' shape.
    pub marker: Marker,
}

/// An axis.
pub struct Axis {
    /// Quantity and unit.
    pub title: String,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Whether it is divided by decades.
    pub log: bool,
}

impl Axis {
    /// A logarithmic axis.
    pub fn log(title: &str, low: f64, high: f64) -> Self {
        Self { title: title.into(), low, high, log: true }
    }

    /// A linear axis.
    pub fn linear(title: &str, low: f64, high: f64) -> Self {
        Self { title: title.into(), low, high, log: false }
    }

    /// Where a value lies, from 0 to 1; values beyond the ends lie on them.
    fn place(&self, v: f64) -> f64 {
        let share = if self.log {
            (v.max(f64::MIN_POSITIVE) / self.low).log10() / (self.high / self.low).log10()
        } else {
            (v - self.low) / (self.high - self.low)
        };
        share.clamp(0.0, 1.0)
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        if self.log {
            let (low, high) = (self.low.log10().ceil() as i32, self.high.log10().floor() as i32);
            let every = ((high - low + 6) / 7).max(1);
            return (low..=high)
                .filter(|k| (k - low) % every == 0)
                .map(|k| (10f64.powi(k), power(k)))
                .collect();
        }
        let rough = (self.high - self.low) / 5.0;
        let decade = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|s| *s >= rough).unwrap_or(rough);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        let digits = usize::try_from(-(step.log10().floor() as i32)).unwrap_or(0);
        (first..=last).map(|k| k as f64 * step).map(|v| (v, format!("{v:.digits$}"))).collect()
    }
}

/// `10⁻³`; one and ten as they are.
pub fn power(k: i32) -> String {
    match k {
        0 => "1".into(),
        1 => "10".into(),
        _ => {
            let digits = |c: char| match c {
                '-' => '⁻',
                '1' => '¹',
                '2' => '²',
                '3' => '³',
                c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
            };
            format!("10{}", k.to_string().chars().map(digits).collect::<String>())
        }
    }
}

/// A panel.
pub struct Panel {
    /// Its heading.
    pub caption: String,
    /// Across.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// Its lines, the most important last.
    pub lines: Vec<Line>,
}

/// Margins of the axes, px: left, right (for names), top, bottom.
const MARGIN: [i32; 4] = [78, 196, 40, 56];
/// Height of a name, px.
const NAME: i32 = 17;

/// A picture of equal panels under a heading of one or more lines.
///
/// # Errors
/// A file that cannot be written.
pub fn sheet(path: &Path, heading: &[&str], columns: usize, size: (u32, u32), panels: &[Panel]) -> Drawn {
    let rows = panels.len().div_ceil(columns);
    let top = 18 + 26 * heading.len() as u32;
    let root =
        SVGBackend::new(path, (columns as u32 * size.0, rows as u32 * size.1 + top)).into_drawing_area();
    root.fill(&WHITE)?;
    for (i, line) in heading.iter().enumerate() {
        let font = ("sans-serif", if i == 0 { 21 } else { 17 }).into_font();
        let font = if i == 0 { font.style(FontStyle::Bold) } else { font };
        root.draw(&Text::new(*line, (20, 14 + 26 * i as i32), font))?;
    }
    let (_, below) = root.split_vertically(top);
    for (area, panel) in below.split_evenly((rows, columns)).iter().zip(panels) {
        draw(area, panel)?;
    }
    root.present()?;
    Ok(())
}

fn draw(area: &Area<'_>, panel: &Panel) -> Drawn {
    let (width, height) = area.dim_in_pixel();
    let [left, right, top, bottom] = MARGIN;
    let (w, h) = (width as i32 - left - right, height as i32 - top - bottom);
    let at = |(x, y): (f64, f64)| {
        (
            left + (panel.x.place(x) * f64::from(w)).round() as i32,
            top + h - (panel.y.place(y) * f64::from(h)).round() as i32,
        )
    };
    let text = |size: i32, h: HPos, v: VPos| ("sans-serif", size).into_font().color(&INK).pos(Pos::new(h, v));
    area.draw(&Text::new(
        panel.caption.as_str(),
        (left, top - 22),
        ("sans-serif", 18).into_font().style(FontStyle::Bold),
    ))?;
    let light = RGBColor(228, 228, 228);
    for (v, label) in panel.x.ticks() {
        let (x, _) = at((v, panel.y.low));
        area.draw(&PathElement::new(vec![(x, top), (x, top + h)], light))?;
        area.draw(&Text::new(label, (x, top + h + 8), text(15, HPos::Center, VPos::Top)))?;
    }
    for (v, label) in panel.y.ticks() {
        let (_, y) = at((panel.x.low, v));
        area.draw(&PathElement::new(vec![(left, y), (left + w, y)], light))?;
        area.draw(&Text::new(label, (left - 8, y), text(15, HPos::Right, VPos::Center)))?;
    }
    area.draw(&PathElement::new(
        vec![(left, top), (left, top + h), (left + w, top + h)],
        INK.stroke_width(1),
    ))?;
    area.draw(&Text::new(
        panel.x.title.as_str(),
        (left + w / 2, top + h + 32),
        text(15, HPos::Center, VPos::Top),
    ))?;
    let turned = ("sans-serif", 15).into_font().transform(FontTransform::Rotate270).color(&INK);
    area.draw(&Text::new(
        panel.y.title.as_str(),
        (12, top + h / 2),
        turned.pos(Pos::new(HPos::Center, VPos::Top)),
    ))?;
    let mut names = Vec::new();
    for line in &panel.lines {
        let points: Vec<(i32, i32)> =
            line.points.iter().filter(|p| p.0.is_finite() && p.1.is_finite()).map(|&p| at(p)).collect();
        if line.width > 0 {
            area.draw(&PathElement::new(points.clone(), line.colour.stroke_width(line.width)))?;
        }
        for &p in &points {
            mark(area, p, line)?;
        }
        if let (Some(&end), false) = (points.iter().max_by_key(|p| p.0), line.name.is_empty()) {
            names.push((end, line));
        }
    }
    write_names(area, names, left + w + 26, (top, top + h))
}

fn mark(area: &Area<'_>, (x, y): (i32, i32), line: &Line) -> Drawn {
    let r = 3 + i32::from(line.width > 2);
    let fill = line.colour.filled();
    match line.marker {
        Marker::Disc => area.draw(&Circle::new((x, y), r, fill))?,
        Marker::Ring => area.draw(&Circle::new((x, y), r + 2, line.colour))?,
        Marker::Square => area.draw(&Rectangle::new([(x - r, y - r), (x + r, y + r)], fill))?,
        Marker::Triangle => area.draw(&TriangleMarker::new((x, y), r + 2, fill))?,
        Marker::Cross => area.draw(&Cross::new((x, y), r, line.colour.stroke_width(2)))?,
        Marker::Nothing => {}
    }
    Ok(())
}

/// Names beside the axes in the order of the lines' ends, moved apart, each with a thin line to its end and its marker.
fn write_names(
    area: &Area<'_>,
    mut names: Vec<((i32, i32), &Line)>,
    x: i32,
    (top, bottom): (i32, i32),
) -> Drawn {
    names.sort_by_key(|(end, _)| end.1);
    let mut places: Vec<i32> = names.iter().map(|(end, _)| end.1).collect();
    for i in 1..places.len() {
        places[i] = places[i].max(places[i - 1] + NAME);
    }
    let mut limit = bottom;
    for place in places.iter_mut().rev() {
        *place = (*place).min(limit);
        limit = *place - NAME;
    }
    let mut least = top - 6;
    for place in &mut places {
        *place = (*place).max(least);
        least = *place + NAME;
    }
    for ((end, line), y) in names.into_iter().zip(places) {
        area.draw(&PathElement::new(vec![end, (x - 6, y)], line.colour.mix(0.35)))?;
        mark(area, (x, y), line)?;
        let font = ("sans-serif", 14).into_font();
        let font = if line.width > 2 { font.style(FontStyle::Bold) } else { font };
        area.draw(&Text::new(
            line.name.as_str(),
            (x + 9, y),
            font.color(&line.colour).pos(Pos::new(HPos::Left, VPos::Center)),
        ))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_axes_place_values_and_label_decades() {
        let axis = Axis::log("x", 1e-4, 1e4);
        assert!((axis.place(1.0) - 0.5).abs() < 1e-12);
        assert_eq!((axis.place(1e-9), axis.place(1e9)), (0.0, 1.0));
        let labels: Vec<String> = axis.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(labels, ["10⁻⁴", "10⁻²", "1", "10²", "10⁴"]);
        let ticks: Vec<String> = Axis::linear("y", 0.0, 100.0).ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(ticks, ["0", "20", "40", "60", "80", "100"]);
    }
}
