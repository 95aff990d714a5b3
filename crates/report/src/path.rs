//! Paths: lines clipped to the frame and simplified by less than can be seen, and the shapes of marks.

use crate::chart::Shape;
use crate::svg::units;
use std::fmt::Write;

/// Lines are simplified on a grid of hundredths of a point.
const RESOLUTION: f64 = 100.0;
/// Largest distance of a line from a point that is left out, in these units. With rounding it stays below 0.13 pt, a third of a pixel on
/// a screen.
const TOLERANCE: f64 = 5.0;
/// Most consecutive points that are left out.
const MAX_SKIPPED: usize = 1000;

/// A rectangle: left, top, right, bottom, pt.
pub(crate) type Rect = [f64; 4];

fn inside([left, top, right, bottom]: Rect, (x, y): (f64, f64)) -> bool {
    (left..=right).contains(&x) && (top..=bottom).contains(&y)
}

/// The part of a segment within a rectangle (Y.-D. Liang and B. A. Barsky, 1984).
pub(crate) fn clip(
    [left, top, right, bottom]: Rect,
    a: (f64, f64),
    b: (f64, f64),
) -> Option<[(f64, f64); 2]> {
    if ![a.0, a.1, b.0, b.1].into_iter().all(f64::is_finite) {
        return None;
    }
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-dx, a.0 - left), (dx, right - a.0), (-dy, a.1 - top), (dy, bottom - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            from = from.max(q / p);
        } else {
            to = to.min(q / p);
        }
    }
    let at = |s: f64, end: (f64, f64)| if s == 0.0 || s == 1.0 { end } else { (a.0 + s * dx, a.1 + s * dy) };
    (from <= to).then(|| [at(from, a), at(to, b)])
}

/// The parts of a line within a rectangle; a point that is not finite breaks it.
fn runs(points: impl Iterator<Item = (f64, f64)>, frame: Rect) -> Vec<Vec<(f64, f64)>> {
    let mut all: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for point in points {
        if !(point.0.is_finite() && point.1.is_finite()) {
            before = None;
            continue;
        }
        match before {
            None if inside(frame, point) => all.push(vec![point]),
            None => {}
            Some(last) => {
                if let Some([from, to]) = clip(frame, last, point) {
                    match all.last_mut() {
                        Some(run) if run.last() == Some(&from) && inside(frame, last) => run.push(to),
                        _ => all.push(vec![from, to]),
                    }
                }
            }
        }
        before = Some(point);
    }
    all
}

/// Detects local extrema of either coordinate, which must be kept; of a level stretch, its end.
#[derive(Default)]
struct TurningPoints {
    heading: [i64; 2],
}

impl TurningPoints {
    /// Whether a coordinate has an extremum at `point`.
    fn at(&mut self, point: (i64, i64), next: (i64, i64)) -> bool {
        let moves = [(next.0 - point.0).signum(), (next.1 - point.1).signum()];
        let turns = (0..2).any(|i| moves[i] * self.heading[i] < 0);
        for (heading, sign) in self.heading.iter_mut().zip(moves).filter(|(_, sign)| *sign != 0) {
            *heading = sign;
        }
        turns
    }
}

/// Whether a point lies so near a line that it can be left out.
fn is_negligible(from: (i64, i64), to: (i64, i64), point: (i64, i64)) -> bool {
    let (dx, dy) = ((to.0 - from.0) as f64, (to.1 - from.1) as f64);
    let (px, py) = ((point.0 - from.0) as f64, (point.1 - from.1) as f64);
    let length = dx.hypot(dy);
    if length == 0.0 { px.hypot(py) <= TOLERANCE } else { (px * dy - py * dx).abs() <= TOLERANCE * length }
}

/// The points of a run that must be kept, in units of the drawing.
fn simplify(run: &[(f64, f64)]) -> Vec<(i64, i64)> {
    let fine = |v: f64| (RESOLUTION * v).round() as i64;
    let mut all: Vec<(i64, i64)> = run.iter().map(|&(x, y)| (fine(x), fine(y))).collect();
    all.dedup();
    let mut kept = vec![all[0]];
    let mut anchor = 0;
    let mut turns = TurningPoints::default();
    for i in 0..all.len() - 1 {
        let turn = turns.at(all[i], all[i + 1]);
        let near = || all[anchor + 1..=i].iter().all(|&p| is_negligible(all[anchor], all[i + 1], p));
        if i > 0 && (turn || i - anchor >= MAX_SKIPPED || !near()) {
            kept.push(all[i]);
            anchor = i;
        }
    }
    if all.len() > 1 {
        kept.push(all[all.len() - 1]);
    }
    let coarse = |v: i64| units(v as f64 / RESOLUTION);
    let mut kept: Vec<(i64, i64)> = kept.into_iter().map(|(x, y)| (coarse(x), coarse(y))).collect();
    kept.dedup();
    kept
}

/// A line through `points` (pt) within `frame`.
pub(crate) fn polyline(points: impl Iterator<Item = (f64, f64)>, frame: Rect) -> String {
    let mut path = String::new();
    for run in runs(points, frame) {
        let run = simplify(&run);
        let _ = write!(path, "M{} {}", run[0].0, run[0].1);
        // A single point is drawn as a line of zero length, whose round ends show as a dot.
        path += if run.len() == 1 { "h0" } else { "l" };
        for (i, pair) in run.windows(2).enumerate() {
            let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            let space = |n: i64, first: bool| if first || n < 0 { "" } else { " " };
            let _ = write!(path, "{}{dx}{}{dy}", space(dx, i == 0), space(dy, false));
        }
    }
    path
}

/// A rectangle with its edges rounded to whole units, so that neighbours share them.
pub(crate) fn rectangle([left, top, right, bottom]: Rect) -> String {
    let [left, top, right, bottom] = [left, top, right, bottom].map(units);
    format!("M{left} {top}h{}v{}h{}z", right - left, bottom - top, left - right)
}

/// The shape of a mark around a point (pt), and whether it is filled.
pub(crate) fn shape(shape: Shape, (x, y): (f64, f64), size: f64) -> (String, bool) {
    let r = 0.5 * size;
    let (cx, cy) = (units(x), units(y));
    let [r_disc, side, height] = [units(r), units(0.89 * r), units(1.1 * r)];
    let round = format!(
        "M{} {cy}a{r_disc} {r_disc} 0 1 0 {w} 0a{r_disc} {r_disc} 0 1 0-{w} 0z",
        cx - r_disc,
        w = 2 * r_disc
    );
    let square = format!("M{} {}h{w}v{w}h-{w}z", cx - side, cy - side, w = 2 * side);
    match shape {
        Shape::Disc => (round, true),
        Shape::Ring => (round, false),
        Shape::Square => (square, true),
        Shape::Frame => (square, false),
        Shape::Triangle => {
            (format!("M{} {}h{}l-{height}-{}z", cx - height, cy + side, 2 * height, side + height), true)
        }
        Shape::Cross => (format!("M{} {}l{w} {w}m0-{w}l-{w} {w}", cx - side, cy - side, w = 2 * side), false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = [0.0, 0.0, 100.0, 50.0];

    /// The runs of a path, in points.
    fn read(path: &str) -> Vec<Vec<(f64, f64)>> {
        let number = |text: &str| text.parse::<f64>().expect("a number") / 10.0;
        let run = |text: &str| {
            let (start, rest) = text.split_once(['l', 'h']).expect("a step");
            let (x, y) = start.split_once(' ').expect("two numbers");
            let mut all = vec![(number(x), number(y))];
            let spaced = rest.replace('-', " -");
            let steps: Vec<f64> = spaced.split_whitespace().map(number).collect();
            for step in steps.chunks_exact(2) {
                let (x, y) = all[all.len() - 1];
                let tenth = |v: f64| (10.0 * v).round() / 10.0;
                all.push((tenth(x + step[0]), tenth(y + step[1])));
            }
            all
        };
        path.split('M').skip(1).map(run).collect()
    }

    #[test]
    fn exact_a_line_is_cut_at_the_frame_and_enters_again() {
        let zigzag = [(-10.0, 25.0), (10.0, 25.0), (30.0, -15.0), (50.0, 25.0), (150.0, 25.0)];
        assert_eq!(
            read(&polyline(zigzag.into_iter(), FRAME)),
            [vec![(0.0, 25.0), (10.0, 25.0), (22.5, 0.0)], vec![(37.5, 0.0), (50.0, 25.0), (100.0, 25.0)]]
        );
        let across = [(-50.0, 25.0), (150.0, 25.0)];
        assert_eq!(read(&polyline(across.into_iter(), FRAME)), [[(0.0, 25.0), (100.0, 25.0)]]);
        let beside = [(-50.0, 40.0), (50.0, 200.0)];
        assert_eq!(polyline(beside.into_iter(), FRAME), "");
    }

    #[test]
    fn contract_a_line_breaks_where_there_is_no_value_and_a_lone_point_is_seen() {
        let nan = (f64::NAN, 1.0);
        let points = [(1.0, 1.0), nan, (5.0, 5.0), (6.0, 9.0), (f64::INFINITY, 2.0), (8.0, 8.0)];
        let found = polyline(points.into_iter(), FRAME);
        assert_eq!(found, "M10 10h0M50 50l10 40M80 80h0");
    }

    #[test]
    fn contract_thinning_keeps_every_extreme_and_moves_no_line_by_more_than_can_be_seen() {
        let wave = |x: f64| 25.0 + 20.0 * (x / 3.0).sin() * (1.0 - x / 130.0);
        let points: Vec<(f64, f64)> =
            (0..=10_000).map(|i| 0.01 * f64::from(i)).map(|x| (x, wave(x))).collect();
        let found = read(&polyline(points.iter().copied(), FRAME)).remove(0);
        assert!(found.len() < 160, "{}", found.len());
        for &(x, y) in &points {
            let i = found.partition_point(|p| p.0 < x).clamp(1, found.len() - 1);
            let (a, b) = (found[i - 1], found[i]);
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let off = ((x - a.0) * dy - (y - a.1) * dx).abs() / dx.hypot(dy);
            assert!(off < 0.13, "{off} at {x}");
        }
        for three in points.windows(3) {
            if (three[1].1 - three[0].1) * (three[2].1 - three[1].1) < 0.0 {
                let near =
                    found.iter().map(|p| (p.0 - three[1].0).abs().max(20.0 * (p.1 - three[1].1).abs()));
                assert!(near.fold(f64::INFINITY, f64::min) < 1.01, "{:?}", three[1]);
            }
        }
        // A spike of one point.
        let spike = (0..1000).map(|i| (0.1 * f64::from(i), if i == 500 { 40.0 } else { 10.0 }));
        assert_eq!(
            read(&polyline(spike, FRAME)),
            [[(0.0, 10.0), (49.9, 10.0), (50.0, 40.0), (50.1, 10.0), (99.9, 10.0)]]
        );
    }

    #[test]
    fn exact_neighbouring_rectangles_share_an_edge() {
        assert_eq!(rectangle([0.0, 0.0, 3.333, 1.0]), "M0 0h33v10h-33z");
        assert_eq!(rectangle([3.333, 0.0, 6.666, 1.0]), "M33 0h34v10h-34z");
    }
}
