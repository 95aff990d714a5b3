//! Figures for print as SVG text.
//!
//! A [`Sheet`] is a figure as data: [`Chart`]s in rows and columns below one legend. A chart has two [`Axis`] and [`Layer`]s from back to
//! front: lines, dots, bands, maps, marks, rules, labels. [`svg()`] lays it out and writes it. There is one algorithm for ticks, one for
//! margins, one for direct labels (which replace the legend where all fit), one palette ([`colour`]), and one style of subscripts: `E1max`,
//! `k2` and `c2` in any text get a subscript, `10⁻³` a superscript.
//!
//! All lengths are points. A figure is one column of a journal wide (85 mm) or its page (180 mm), and text has 8 pt there (names beside
//! lines 7). Every figure has a title and a description for screen readers, is self-contained, and follows the reader's dark mode. The same
//! data give the same bytes.
//!
//! ```
//! use retune_report::colour::BLUE;
//! use retune_report::{Axis, Chart, Key, Layer, Sheet, Stroke, svg};
//!
//! // The amplification of an oscillator with 5 % damping over the frequency ratio.
//! let ratios = (0..=100).map(|i| 0.02 * f64::from(i));
//! let points = ratios.map(|r| (r, 1.0 / ((1.0 - r * r).powi(2) + (0.1 * r).powi(2)).sqrt()));
//! let chart = Chart {
//!     title: "Response at 5 % damping".to_owned(),
//!     x: Axis::linear("ω/ω₁", (0.0, 2.0)),
//!     y: Axis::linear("amplification", (0.0, 12.0)),
//!     layers: vec![Layer::line(points, Stroke::solid(BLUE))],
//!     height: 150.0,
//! };
//! let figure = svg(&Sheet {
//!     description: "The amplification rises from 1 to 10 at resonance and falls again.".to_owned(),
//!     legend: vec![(Key::Line(Stroke::solid(BLUE)), "linear".to_owned())],
//!     ..Sheet::of("Frequency response", vec![chart])
//! });
//! assert!(figure.starts_with("<svg ") && figure.contains(">Response at 5 % damping</text>"));
//! assert!(figure.contains("ω/ω<tspan dy=\"0.28em\" font-size=\"72%\">1</tspan></text>"));
//! ```

mod axis;
mod chart;
pub mod colour;
mod direct;
pub mod document;
mod draw;
pub mod html;
mod layout;
mod path;
mod sheet;
mod svg;
pub mod table;
mod text;
mod ticks;

pub use axis::{Axis, Scale, scale_for};
pub use chart::{Chart, Dash, Key, Layer, Mark, Nodes, Place, Shape, Stand, Stroke, category_map, heat_map};
pub use sheet::{Drawing, Sheet, Width, drawing, svg};
pub use ticks::ten_to;
