//! Figures for print as SVG text: a frame with ticks inside, axes labelled with their units, and a caption that says what made it.
//!
//! Three kinds of figure: [`sheet::sheet`] arranges charts of lines, dots and bands in rows and columns below one legend; [`heat_map()`]
//! colours a grid of values; [`panels()`] stacks several quantities over one abscissa. Sizes are in px, and a viewer scales them:
//! a figure is 1600 px wide. `plotters` writes the SVG of maps and panels; frames, ticks and text are laid out here, the same
//! way in all of them.
//!
//! ```
//! use retune_figures::sheet::{BLUE, Chart, Key, Layer, sheet};
//!
//! // The amplification of an oscillator with 5 % damping over the frequency ratio.
//! let ratios = (0..=100).map(|i| 0.02 * f64::from(i));
//! let points = ratios.map(|r| (r, 1.0 / ((1.0 - r * r).powi(2) + (0.1 * r).powi(2)).sqrt())).collect();
//! let chart = Chart {
//!     title: "Response at 5 % damping".to_owned(),
//!     labels: ["ω/ω₁".to_owned(), "amplification".to_owned()],
//!     ranges: [(0.0, 2.0), (0.0, 12.0)],
//!     log: false,
//!     layers: vec![Layer::Line { points, colour: BLUE, width: 4.0, dash: "" }],
//! };
//! let drawing = sheet(&[chart], 1, 600.0, &[(Key::Line(BLUE, ""), "linear")]);
//! assert!(drawing.wide.starts_with("<svg ") && drawing.wide.contains(">Response at 5 % damping</text>"));
//! ```

mod axis;
mod canvas;
mod colour;
mod frame;
mod heat_map;
mod panels;
pub mod sheet;

pub use axis::{Scale, scale_for};
pub use heat_map::{Mark, Nodes, heat_map};
pub use panels::{Panel, panels};
