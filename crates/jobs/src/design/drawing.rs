//! The damper to scale: where it may move relative to the structure, and where its walls are, in mm.

use super::candidate::Candidate;
use retune_model::Measure;
use retune_report::colour::{BLACK, BLUE, GREEN, GREY};
use retune_report::{
    Axis, Chart, Dash, Drawing, Layer, Mark, Shape, Sheet, Stand, Stroke, Width, drawing as draw,
};
use retune_study::rounded;

const MM: f64 = 1e3;

pub(super) fn drawing(of: &Candidate) -> Drawing {
    let stroke = MM * of.value(Measure::Stroke);
    let begin = MM * of.from_rest.get(Measure::Stroke).value;
    let motion = MM * of.value(Measure::Displacement);
    let walls = of
        .damper()
        .filter(|damper| damper.contact.is_some())
        .map(|damper| [-MM * damper.rest_distance.get(), MM * damper.clearance.get()]);
    // Relative to the damper at rest; a wall that is far out of reach is not drawn.
    let reach = 1.3 * begin.max(stroke).max(motion).max(1e-9);
    let near = |wall: f64| wall.abs() <= 1.6 * reach;
    let ends = walls.map_or([-reach, reach], |[left, right]| {
        [
            if near(left) { 1.15 * left.min(-0.5 * reach) } else { -reach },
            if near(right) { 1.15 * right.max(0.5 * reach) } else { reach },
        ]
    });
    let ends = [ends[0].min(-reach), ends[1].max(reach)];
    let far = f64::INFINITY;
    let bar =
        |half: f64, y: (f64, f64), colour, opacity| Layer::Band { x: (-half, half), y, colour, opacity };
    let text = |at: (f64, f64), text: String| Layer::Text { at, text, stand: Stand::Over };
    let mut layers = Vec::new();
    if let Some([left, right]) = walls {
        for (wall, x) in [(left, (-far, left)), (right, (right, far))] {
            if near(wall) {
                layers.push(Layer::Band { x, y: (0.0, 3.0), colour: GREY, opacity: 0.5 });
                layers.push(Layer::Upright { x: wall, stroke: Stroke::solid(BLACK) });
            }
        }
        let name = |wall: f64, symbol: &str| {
            format!(
                "{symbol} = {} mm{}",
                rounded(wall.abs(), 4),
                if near(wall) { "" } else { ", beyond this figure" }
            )
        };
        layers.push(text(
            (0.5 * (ends[0] + ends[1]), 0.35),
            format!("{}; {}", name(left, "D"), name(right, "C")),
        ));
    }
    layers.push(bar(begin, (2.05, 2.15), BLUE, 0.35));
    layers.push(bar(stroke, (2.0, 2.2), BLUE, 0.9));
    layers.push(text(
        (0.0, 2.55),
        format!("± {} mm, from rest on ± {} mm", rounded(stroke, 4), rounded(begin, 4)),
    ));
    layers.push(bar(motion, (1.0, 1.2), GREEN, 0.9));
    layers.push(text((0.0, 1.55), format!("± {} mm", rounded(motion, 4))));
    layers.push(Layer::Upright { x: 0.0, stroke: Stroke::new(BLACK, 0.7, Dash::Dots) });
    layers.push(Layer::Marks { points: vec![(0.0, 2.1)], mark: Mark::new(Shape::Square, BLACK, 5.0) });
    let y = Axis::of_names((0.0, 3.0), vec![(2.1, "damper".to_owned()), (1.1, "structure".to_owned())]);
    let chart = Chart::of(Axis::linear("distance from rest, mm", (ends[0], ends[1])), y, layers, 150.0);
    let sheet = Sheet::of("The damper to scale", vec![chart]);
    let description =
        format!("Stroke ± {} mm, the structure moves by ± {} mm.", rounded(stroke, 4), rounded(motion, 4));
    draw(&Sheet { description, width: Width::Page, ..sheet })
}
