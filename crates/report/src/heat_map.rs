//! A heat map: a coloured cell for each node of a grid, with a colour bar and the places that matter.

use crate::axis::{Axis, Scale, scale_for};
use crate::chart::{Chart, Key, Layer, Mark, Shape};
use crate::colour::BLACK;

/// A side of the grid.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "their names say it")]
pub struct Nodes {
    pub label: String,
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

/// The chart of `values` over the two `sides`, row by row: the index of the first side varies fastest. `quantity` is their label with
/// its unit. Values that are not finite are grey. The legend belongs to it.
pub fn heat_map(
    sides: &[Nodes; 2],
    values: &[f64],
    quantity: &str,
    places: &[Place],
) -> (Chart, Vec<(Key, String)>) {
    let edges = [edges(&sides[0]), edges(&sides[1])];
    let axis = |side: usize| {
        let ends = (edges[side][0], edges[side][edges[side].len() - 1]);
        Axis::new(sides[side].label.as_str(), sides[side].scale, ends)
    };
    let (x, y) = (axis(0), axis(1));
    let colours = Axis::exact(quantity, scale_for(values), values.iter().copied());
    let mut layers = vec![Layer::Map { edges: edges.clone(), values: values.to_vec(), colours }];
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
    fn exact_edges_lie_halfway_on_the_scale() {
        let nodes = |scale, values: &[f64]| Nodes { label: String::new(), scale, values: values.to_vec() };
        assert_eq!(edges(&nodes(Scale::Linear, &[1.0, 2.0, 4.0])), [0.5, 1.5, 3.0, 5.0]);
        let log = edges(&nodes(Scale::Log, &[1.0, 100.0]));
        assert!(log.iter().zip([0.1, 10.0, 1000.0]).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{log:?}");
        assert_eq!(edges(&nodes(Scale::Linear, &[3.0])), [2.5, 3.5]);
    }
}
