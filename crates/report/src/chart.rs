//! A chart as data: two axes, and layers from back to front.

use crate::axis::{Axis, Scale, scale_for};
use crate::colour::{BLACK, CATEGORIES, Colour, NOTHING, OTHERS};

/// How a line is interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "their names say what they are")]
pub enum Dash {
    Solid,
    Long,
    Short,
    Dots,
    DashDot,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "their names say what they are")]
pub struct Stroke {
    pub colour: Colour,
    /// Its width, pt.
    pub width: f64,
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
#[expect(missing_docs, reason = "their names say what they are")]
pub enum Shape {
    Disc,
    Ring,
    Square,
    Frame,
    Triangle,
    Cross,
}

/// How a point is marked.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "their names say what they are")]
pub struct Mark {
    pub shape: Shape,
    pub colour: Colour,
    /// Its diameter, pt.
    pub size: f64,
    /// Whether it has a rim in the paper's colour, which separates it from what is behind.
    pub rim: bool,
}

impl Mark {
    /// A mark without a rim.
    pub const fn new(shape: Shape, colour: Colour, size: f64) -> Self {
        Self { shape, colour, size, rim: false }
    }
}

/// A layer of a chart, clipped to the axes.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "their names say what they are")]
pub enum Layer {
    /// A line through points; values that are not finite break it.
    Line {
        points: Vec<(f64, f64)>,
        stroke: Stroke,
    },
    /// A step function: each value is held until the next point.
    Steps {
        points: Vec<(f64, f64)>,
        stroke: Stroke,
    },
    /// Many dots of one diameter, pt. Dots that cover each other are drawn once.
    Dots {
        points: Vec<(f64, f64)>,
        colour: Colour,
        size: f64,
    },
    /// Points that are marked one by one.
    Marks {
        points: Vec<(f64, f64)>,
        mark: Mark,
    },
    /// A filled rectangle; infinite ends reach to the frame.
    Band {
        x: (f64, f64),
        y: (f64, f64),
        colour: Colour,
        opacity: f64,
    },
    /// One coloured cell per value, between edges along both axes; the index along the first axis varies fastest. Non-finite values are
    /// grey; `colours` is the colour scale.
    Map {
        edges: [Vec<f64>; 2],
        values: Vec<f64>,
        colours: Axis,
    },
    /// One cell per entry of `colours`, between edges as in a [`Layer::Map`].
    Cells {
        edges: [Vec<f64>; 2],
        colours: Vec<Colour>,
    },
    /// A vertical line over the whole height.
    Upright {
        x: f64,
        stroke: Stroke,
    },
    /// A horizontal line over the whole width.
    Level {
        y: f64,
        stroke: Stroke,
    },
    Text {
        at: (f64, f64),
        text: String,
        stand: Stand,
    },
    /// A label right of the frame for a line that ends at a point. Labels are moved apart, each with a leader to its point.
    Name {
        at: (f64, f64),
        text: String,
        mark: Option<Mark>,
    },
}

impl Layer {
    /// A line through points.
    pub fn line(points: impl IntoIterator<Item = (f64, f64)>, stroke: Stroke) -> Self {
        Self::Line { points: points.into_iter().collect(), stroke }
    }
}

/// How a text is placed at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stand {
    /// Centred, with a rim in the paper's colour, so that lines behind do not cross it.
    Over,
    /// To the right of it, with a rim.
    Right,
    /// Centred and small, in a coloured cell.
    Cell,
}

/// A chart.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "their names say what they are")]
pub struct Chart {
    pub title: String,
    pub x: Axis,
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
#[expect(missing_docs, reason = "their names say what they are")]
pub enum Key {
    Line(Stroke),
    Marked(Stroke, Mark),
    Mark(Mark),
    /// An area: its colour and opacity.
    Area(Colour, f64),
    /// No symbol: the text is the heading of a row of entries.
    Heading,
}

/// A side of the grid.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// The label of the axis.
    pub label: String,
    /// Its scale.
    pub scale: Scale,
    /// Its values, ascending.
    pub values: Vec<f64>,
}

/// A place on the map with its entry in the legend.
#[derive(Clone, Debug)]
pub struct Place {
    /// The place. Outside the axes it is not drawn, and the legend says so.
    pub at: (f64, f64),
    /// Its meaning.
    pub label: String,
}

/// Shapes of the places, in their order.
const MARKS: [Mark; 3] = [
    Mark { rim: true, ..Mark::new(Shape::Frame, BLACK, 10.0) },
    Mark { rim: true, ..Mark::new(Shape::Disc, BLACK, 4.5) },
    Mark { rim: true, ..Mark::new(Shape::Cross, BLACK, 7.0) },
];

/// The chart of `values` over the two `sides`, with its legend; the index along the first side varies fastest. `quantity` is their label
/// with its unit. Non-finite values are grey.
pub fn heat_map(
    sides: &[Nodes; 2],
    values: &[f64],
    quantity: &str,
    places: &[Place],
) -> (Chart, Vec<(Key, String)>) {
    let colours = Axis::exact(quantity, scale_for(values), values.iter().copied());
    let edges = sides.each_ref().map(edges);
    map(sides, Layer::Map { edges, values: values.to_vec(), colours }, places)
}

/// Like [`heat_map`], for categories: each cell has the index of its name, or none. The legend lists `names`, those beyond the colours as
/// one entry, and `none` if some cell has none.
pub fn category_map(
    sides: &[Nodes; 2],
    of: &[Option<usize>],
    names: &[String],
    none: &str,
    places: &[Place],
) -> (Chart, Vec<(Key, String)>) {
    let colour = |of: &Option<usize>| of.map_or(NOTHING, |i| CATEGORIES.get(i).copied().unwrap_or(OTHERS));
    let edges = sides.each_ref().map(edges);
    let cells = Layer::Cells { edges, colours: of.iter().map(colour).collect() };
    let mut legend: Vec<(Key, String)> =
        CATEGORIES.iter().zip(names).map(|(colour, name)| (Key::Area(colour, 1.0), name.clone())).collect();
    if let Some(more @ 1..) = names.len().checked_sub(CATEGORIES.len()) {
        let words = if more == 1 { "one more".to_owned() } else { format!("{more} more, not told apart") };
        legend.push((Key::Area(OTHERS, 1.0), words));
    }
    if of.contains(&None) {
        legend.push((Key::Area(NOTHING, 1.0), none.to_owned()));
    }
    let (chart, marked) = map(sides, cells, places);
    (chart, [legend, marked].concat())
}

/// A chart of cells over two sides, and the legend of its marked places.
fn map(sides: &[Nodes; 2], cells: Layer, places: &[Place]) -> (Chart, Vec<(Key, String)>) {
    let axis = |side: &Nodes| {
        let edges = edges(side);
        Axis::new(side.label.as_str(), side.scale, (edges[0], edges[edges.len() - 1]))
    };
    let [x, y] = sides.each_ref().map(axis);
    let mut layers = vec![cells];
    let mut legend = Vec::new();
    for (place, mark) in places.iter().zip(MARKS.into_iter().cycle()) {
        let inside = x.holds(place.at.0) && y.holds(place.at.1);
        let off = if inside { "" } else { " (off the map)" };
        legend.push((Key::Mark(mark), format!("{}{off}", place.label)));
        layers.push(Layer::Marks { points: vec![place.at], mark });
    }
    (Chart { title: String::new(), x, y, layers, height: 190.0 }, legend)
}

/// The edges of the cells around the nodes: halfway to the next node, on the scale of the side.
fn edges(side: &Nodes) -> Vec<f64> {
    let to = |v: f64| if side.scale == Scale::Log { v.ln() } else { v };
    let from = |v: f64| if side.scale == Scale::Log { v.exp() } else { v };
    let nodes: Vec<f64> = side.values.iter().map(|&v| to(v)).collect();
    let Some(first) = nodes.first() else { return vec![0.0, 1.0] };
    let half_first = nodes.get(1).map_or(0.5, |second| 0.5 * (second - first));
    let mut edges = vec![from(first - half_first)];
    for (i, node) in nodes.iter().enumerate() {
        let half = nodes.get(i + 1).map_or_else(|| node - to(edges[i]), |next| 0.5 * (next - node));
        edges.push(from(node + half));
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_map_of_categories_names_each_colour_that_it_has() {
        let side = |n: usize| Nodes {
            label: String::new(),
            scale: Scale::Linear,
            values: (0..n).map(|i| i as f64).collect(),
        };
        let names: Vec<String> = (0..8).map(|i| format!("motion {i}")).collect();
        let ends = [Some(0), Some(1), Some(7), Some(6), None, Some(5)];
        let (chart, legend) = category_map(&[side(3), side(2)], &ends, &names, "none of these", &[]);
        let Layer::Cells { colours, .. } = &chart.layers[0] else { panic!("{:?}", chart.layers) };
        assert_eq!(colours, &[CATEGORIES[0], CATEGORIES[1], OTHERS, OTHERS, NOTHING, CATEGORIES[5]]);
        let words: Vec<&str> = legend.iter().map(|(_, words)| words.as_str()).collect();
        assert_eq!(words[..2], ["motion 0", "motion 1"]);
        assert_eq!(words[6..], ["2 more, not told apart", "none of these"]);
        let (_, plain) = category_map(&[side(3), side(2)], &ends[..2], &names[..2], "none of these", &[]);
        assert_eq!(plain.len(), 2);
    }

    #[test]
    fn exact_edges_lie_halfway_on_the_scale() {
        let nodes = |scale, values: &[f64]| Nodes { label: String::new(), scale, values: values.to_vec() };
        assert_eq!(edges(&nodes(Scale::Linear, &[1.0, 2.0, 4.0])), [0.5, 1.5, 3.0, 5.0]);
        let log = edges(&nodes(Scale::Log, &[1.0, 100.0]));
        assert!(log.iter().zip([0.1, 10.0, 1000.0]).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{log:?}");
        assert_eq!(edges(&nodes(Scale::Linear, &[3.0])), [2.5, 3.5]);
    }
}
