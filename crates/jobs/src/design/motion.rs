//! The motions of all candidates under a shock or a record.

use super::candidate::{Candidate, What};
use super::comparison::Comparison;
use crate::pages::made_by;
use rayon::prelude::*;
use retune_report::{Axis, Chart, Drawing, Key, Layer, Scale, Sheet, Stroke, Width, drawing};
use retune_solver::{Rows, Window, trajectory};

/// Points of a curve, besides its events.
const POINTS: f64 = 1500.0;
const MM: f64 = 1e3;

/// Time, s, and displacement of the structure, mm.
type Curve = Vec<(f64, f64)>;

/// The motion of a candidate from rest to the end of its run; none where it cannot be followed.
fn curve(of: &Candidate) -> Curve {
    let Window { to, .. } = of.study.window.window();
    let (window, rows) = (Window { from: 0.0, to }, Rows { interval: to / POINTS, events: true });
    let mut points = Curve::new();
    let mut keep = |row: &retune_solver::Sample| points.push((row.t, MM * row.state[0]));
    match trajectory(&of.study.scene, window, &of.study.solver.settings(), rows, &mut keep) {
        Ok(()) => points,
        Err(_) => Curve::new(),
    }
}

/// The displacement of the structure with each candidate against time.
pub(super) fn picture(compared: &Comparison, line: impl Fn(What) -> Stroke) -> Drawing {
    let all: Vec<&Candidate> = compared.all().collect();
    let curves: Vec<Curve> = all.par_iter().map(|of| curve(of)).collect();
    let end = compared.none.study.window.window().to;
    let values = curves.iter().flatten().map(|(_, x)| *x);
    let y = Axis::around("displacement of the structure, mm", Scale::Linear, values);
    let layers =
        all.iter().zip(&curves).map(|(of, points)| Layer::line(points.iter().copied(), line(of.what)));
    let chart = Chart::of(Axis::linear("t, s", (0.0, end)), y, layers.collect(), 240.0);
    drawing(&Sheet {
        description: "The displacement of the structure against time, alone and with each damper.".to_owned(),
        width: Width::Page,
        legend: all.iter().map(|of| (Key::Line(line(of.what)), of.what.name().to_owned())).collect(),
        caption: vec![made_by(None)],
        ..Sheet::of("All candidates in time", vec![chart])
    })
}
