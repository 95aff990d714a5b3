//! A chart as data: its axes and its layers, with the colours that they are drawn in.

/// Black. The colours below are those of M. Okabe and K. Ito's palette (2008).
pub const BLACK: &str = "#000000";
/// Orange.
pub const ORANGE: &str = "#E69F00";
/// Sky blue.
pub const SKY: &str = "#56B4E9";
/// Bluish green.
pub const GREEN: &str = "#009E73";
/// Blue.
pub const BLUE: &str = "#0072B2";
/// Vermilion.
pub const VERMILION: &str = "#D55E00";
/// Reddish purple; pale, the pink of the paper's bilateral zones.
pub const PURPLE: &str = "#CC79A7";

/// Yellow.
pub const YELLOW: &str = "#F0E442";
/// For points of less interest.
pub const GREY: &str = "#B8B8B8";

/// A layer of a chart.
pub enum Layer {
    /// A line through points; values that are not finite break it.
    Line {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Its colour.
        colour: &'static str,
        /// Its width, px.
        width: f64,
        /// `stroke-dasharray` of SVG: lengths of dashes and gaps, px; empty for a solid line.
        dash: &'static str,
    },
    /// Dots; one at most for each pixel.
    Dots {
        /// Their points.
        points: Vec<(f64, f64)>,
        /// Their colour.
        colour: &'static str,
        /// Their diameter, px.
        size: f64,
    },
    /// A pale background between two abscissas, over a share of the height.
    Band {
        /// Its left end.
        from: f64,
        /// Its right end.
        to: f64,
        /// Its colour.
        colour: &'static str,
        /// Its opacity, 0 to 1.
        opacity: f64,
        /// Its lower and upper end, as shares of the height.
        height: (f64, f64),
    },
    /// A vertical line over the whole height.
    Upright {
        /// Its abscissa.
        x: f64,
    },
    /// A label.
    Words {
        /// The abscissa of its middle.
        x: f64,
        /// Its place as a share of the height.
        share: f64,
        /// Its text.
        text: String,
    },
}

/// A chart.
pub struct Chart {
    /// The title above it.
    pub title: String,
    /// The labels of abscissa and ordinate, with units.
    pub labels: [String; 2],
    /// The ranges of abscissa and ordinate.
    pub ranges: [(f64, f64); 2],
    /// Whether its ordinate is logarithmic.
    pub log: bool,
    /// The layers, from back to front.
    pub layers: Vec<Layer>,
}
