//! The writer of SVG. All lengths are given in points, and written in tenths of a point without a decimal.

use crate::colour::{BLACK, Colour, PAPER, style};
use crate::text::{escape, markup};
use std::fmt::Write;

/// Units of a drawing in a point.
const UNITS: f64 = 10.0;
/// Pixels per point on a screen, unless the page sets another size.
const PIXELS: f64 = 2.4;

/// A length or coordinate in units.
pub(crate) fn units(points: f64) -> i64 {
    (UNITS * points).round() as i64
}

/// Which end of a text is at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Font {
    /// Its size, pt.
    pub size: f64,
    pub anchor: Anchor,
    /// Whether it is read from the bottom upwards.
    pub turned: bool,
    /// Whether it has a rim in the paper's colour, so that lines behind do not cross it.
    pub halo: bool,
}

impl Font {
    pub const fn new(size: f64, anchor: Anchor) -> Self {
        Self { size, anchor, turned: false, halo: false }
    }
}

/// A drawing.
#[derive(Default)]
pub(crate) struct Svg {
    body: String,
}

impl Svg {
    /// A filled path.
    pub fn fill(&mut self, path: &str, colour: &str, attributes: &str) {
        if !path.is_empty() {
            let _ = writeln!(self.body, "<path d=\"{path}\" fill=\"{colour}\"{attributes}/>");
        }
    }

    /// A stroked path; each of the further `attributes` begins with a space.
    pub fn line(&mut self, path: &str, colour: Colour, width: f64, attributes: &str) {
        if !path.is_empty() {
            let _ = writeln!(
                self.body,
                "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{}\"{attributes}/>",
                units(width)
            );
        }
    }

    /// A line of text, centred vertically on its lower-case letters.
    pub fn text(&mut self, text: &str, (x, y): (f64, f64), font: Font) {
        // The height of a letter is some 0.7 of the size.
        let down = 0.35 * font.size;
        let (at, turned) = if font.turned {
            let at = [units(x + down), units(y)];
            (at, format!(" transform=\"rotate(-90 {} {})\"", at[0], at[1]))
        } else {
            ([units(x), units(y + down)], String::new())
        };
        let anchor = match font.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let halo = if font.halo {
            format!(
                " stroke=\"{PAPER}\" stroke-width=\"{}\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                units(2.0)
            )
        } else {
            String::new()
        };
        // Some viewers drop a space at the beginning of an element, as after an index, unless told to preserve it.
        let spaces = if text.contains(' ') { " xml:space=\"preserve\"" } else { "" };
        let (size, text) = (units(font.size), markup(text));
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" font-size=\"{size}\"{anchor}{turned}{halo}{spaces}>{text}</text>",
            at[0], at[1]
        );
    }

    /// The whole document, with a title and a description for those who cannot see it.
    pub fn document(&self, (width, height): (f64, f64), title: &str, description: &str) -> String {
        // One page may hold several figures, and one figure in several widths.
        let id = hash(&format!("{title}\n{description}\n{width} {height}\n{}", self.body));
        let [title, description] = [title, description].map(escape);
        let (w, h) = (units(width), units(height));
        let [px_w, px_h] = [width, height].map(|points| (PIXELS * points).round());
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"figure\" role=\"img\" aria-labelledby=\"t{id} d{id}\" \
             viewBox=\"0 0 {w} {h}\" width=\"{px_w}\" height=\"{px_h}\" font-family=\"Helvetica, Arial, sans-serif\" fill=\"{BLACK}\">\n\
             <title id=\"t{id}\">{title}</title>\n<desc id=\"d{id}\">{description}</desc>\n{}\
             <path d=\"M0 0h{w}v{h}h-{w}z\" fill=\"{PAPER}\"/>\n{}</svg>\n",
            style(),
            self.body
        )
    }
}

/// FNV-1a in 32 bits (G. Fowler, L. C. Noll, K.-P. Vo).
fn hash(text: &str) -> String {
    let mix = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    format!("{:08x}", text.bytes().fold(0x811c_9dc5, mix))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_hash_of_published_texts() {
        assert_eq!([hash(""), hash("a"), hash("foobar")], ["811c9dc5", "e40c292c", "bf9cf968"]);
    }
}
