//! A chart as data: two axes, and layers from back to front.

use crate::axis::Axis;
use crate::colour::Colour;

/// How a line is interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    Solid,
    /// Long dashes.
    Long,
    /// Short dashes.
    Short,
    /// Dots.
    Dots,
    /// Dashes and dots in turn.
    DashDot,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Its width, pt.
    pub width: f64,
    /// Its dashes.
    pub dash: Dash,
}

impl Stroke {
    /// A solid line of the usual width.
    pub const fn solid(colour: Colour) -> Self {
        Self::new(colour, 1.1, Dash::Solid)
    }

    /// A line of a width in pt with dashes.
    pub const fn new(colour: Colour, width: f64, dash: Dash) -> Self {
        Self { colour, width, dash }
    }
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    Disc,
    /// A ring.
    Ring,
    /// A filled square.
    Square,
    /// An empty square.
    Frame,
    /// A filled triangle.
    Triangle,
    /// A cross.
    Cross,
}

/// How a point is marked.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// Its shape.
    pub shape: Shape,
    /// Its colour.
    pub colour: Colour,
    /// Its diameter, pt.
    pub size: f64,
    /// Whether it has a rim in the colour of the paper, which sets it off from what is behind it.
    pub rim: bool,
}

impl Mark {
    /// A mark without a rim.
    pub const fn new(shape: Shape, colour: Colour, size: f64) -> Self {
        Self { shape, colour, size, rim: false }
    }
}

/// A layer of a chart. What lies beyond the axes is cut off.
#[derive(Clone, Debug)]
pub enum Layer {
    /// A line through points; values that are not finite break it.
    Line {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Its look.
        stroke: Stroke,
    },
    /// A line that keeps the height of a point until the next one.
    Steps {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Its look.
        stroke: Stroke,
    },
    /// Many dots, of which those that cover one another are drawn once.
    Dots {
        /// Their points.
        points: Vec<(f64, f64)>,
        /// Their colour.
        colour: Colour,
        /// Their diameter, pt.
        size: f64,
    },
    /// Points that are marked one by one.
    Marks {
        /// The points.
        points: Vec<(f64, f64)>,
        /// Their look.
        mark: Mark,
    },
    /// A filled rectangle; infinite ends reach to the frame.
    Band {
        /// Its left and right end.
        x: (f64, f64),
        /// Its lower and upper end.
        y: (f64, f64),
        /// Its colour.
        colour: Colour,
        /// Its opacity, 0 to 1.
        opacity: f64,
    },
    /// A coloured cell for each value: the index of the first side varies fastest.
    Map {
        /// The edges of the cells along both axes.
        edges: [Vec<f64>; 2],
        /// The values; those that are not finite are grey.
        values: Vec<f64>,
        /// What the colours mean.
        colours: Axis,
    },
    /// A vertical line over the whole height.
    Upright {
        /// Its abscissa.
        x: f64,
        /// Its look.
        stroke: Stroke,
    },
    /// A horizontal line over the whole width.
    Level {
        /// Its ordinate.
        y: f64,
        /// Its look.
        stroke: Stroke,
    },
    /// A text on the chart.
    Text {
        /// Its place.
        at: (f64, f64),
        /// Its words.
        text: String,
        /// How it stands there.
        stand: Stand,
    },
    /// A name on the right of the frame for a line that ends at a place. Names are moved apart, each with a thin line to its place.
    Name {
        /// The place.
        at: (f64, f64),
        /// The name.
        text: String,
        /// The mark before it, if any.
        mark: Option<Mark>,
    },
}

impl Layer {
    /// A line through points.
    pub fn line(points: impl IntoIterator<Item = (f64, f64)>, stroke: Stroke) -> Self {
        Self::Line { points: points.into_iter().collect(), stroke }
    }
}

/// How a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stand {
    /// About it, with a rim in the colour of the paper, so that lines behind do not cross it.
    Over,
    /// On its right, with a rim.
    Right,
    /// About it and small, in a coloured cell.
    Cell,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The title above it.
    pub title: String,
    /// The abscissa.
    pub x: Axis,
    /// The ordinate.
    pub y: Axis,
    /// The layers, from back to front.
    pub layers: Vec<Layer>,
    /// Its height with title and labels, pt.
    pub height: f64,
}

impl Chart {
    /// A chart without a title.
    pub fn of(x: Axis, y: Axis, layers: Vec<Layer>, height: f64) -> Self {
        Self { title: String::new(), x, y, layers, height }
    }
}

/// The symbol of an entry in a legend.
#[derive(Clone, Copy, Debug)]
pub enum Key {
    /// A line.
    Line(Stroke),
    /// A line with a mark.
    Marked(Stroke, Mark),
    /// A mark.
    Mark(Mark),
    /// An area: its colour and opacity.
    Area(Colour, f64),
    /// No symbol: the text is the heading of a row of entries.
    Heading,
}
