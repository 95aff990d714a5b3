//! Direct labels: names beside lines instead of a legend. Each is placed where it touches no line, as near as possible to its own, with a
//! leader.
//!
//! The frame is rasterised into cells of [`CELL`] pt, each with a bit for every line that passes through it, so that the cost of testing a
//! position does not depend on the number of points of a line.

use crate::chart::{Key, Layer, Stroke};
use crate::layout::{LINE, Layout, SMALL};
use crate::path::{Rect, clip};
use crate::text::ems;

/// Most lines that are labelled directly.
const MAX_LINES: usize = 6;
/// Side of a cell, pt.
const CELL: f64 = 1.0;
/// Most points along a line at which a label is tried.
const MAX_CANDIDATES: usize = 96;
/// Candidate distances of a label from its line, pt.
const OFFSETS: [f64; 7] = [3.0, 7.0, 13.0, 21.0, 31.0, 45.0, 65.0];
/// Least distance of a label from the frame, pt.
const PADDING: f64 = 2.0;
/// Everything but the labelled lines: marks, rules, texts.
const OBSTACLE_BIT: u32 = 1 << MAX_LINES;
/// Labels already placed, with their leaders.
const LABEL_BIT: u32 = OBSTACLE_BIT << 1;

/// A label beside its line.
#[derive(Clone, Debug)]
pub(crate) struct DirectLabel {
    /// The lines of its text.
    pub text: Vec<String>,
    /// The rectangle of the text.
    pub rect: Rect,
    /// From the line to the label.
    pub leader: [(f64, f64); 2],
    pub stroke: Stroke,
}

/// Places a label beside every line of a legend, in the order of `keys`; none if one does not fit, or if there are no lines or too many.
pub(crate) fn place_labels(layout: &Layout, keys: &[(Key, String)]) -> Option<Vec<DirectLabel>> {
    let named: Vec<(Stroke, &str)> = keys.iter().filter_map(line).collect();
    if named.is_empty() || named.len() > MAX_LINES {
        return None;
    }
    let mut grid = Grid::new(layout.frame);
    let mut paths = vec![Vec::new(); named.len()];
    for layer in &layout.chart.layers {
        draw(&mut grid, &mut paths, layer, &named, layout)?;
    }
    // The lines with the least room first.
    let mut order: Vec<usize> = (0..named.len()).collect();
    order.sort_by_key(|&i| paths[i].len());
    let mut all: Vec<Option<DirectLabel>> = vec![None; named.len()];
    for i in order {
        let found = grid.place(&paths[i], i, named[i])?;
        grid.fill(found.rect, LABEL_BIT);
        grid.segment(found.leader, LABEL_BIT);
        all[i] = Some(found);
    }
    all.into_iter().collect()
}

/// The stroke and the name of a line in a legend.
pub(crate) fn line((key, text): &(Key, String)) -> Option<(Stroke, &str)> {
    match key {
        Key::Line(stroke) => Some((*stroke, text)),
        _ => None,
    }
}

/// Rasterises a layer into the grid and collects the points of labelled lines; none if the layer covers the frame.
fn draw(
    grid: &mut Grid,
    paths: &mut [Vec<(f64, f64)>],
    layer: &Layer,
    named: &[(Stroke, &str)],
    layout: &Layout,
) -> Option<()> {
    let [left, top, right, bottom] = layout.frame;
    let mut draw_path = |points: &mut dyn Iterator<Item = (f64, f64)>, stroke: &Stroke| {
        let index = named.iter().position(|(of, _)| same_style(of, stroke));
        let points: Vec<(f64, f64)> = points.collect();
        for ends in points.windows(2).filter_map(|pair| clip(layout.frame, pair[0], pair[1])) {
            grid.segment(ends, index.map_or(OBSTACLE_BIT, |index| 1 << index));
            if let Some(index) = index {
                paths[index].extend(along(ends));
            }
        }
    };
    match layer {
        Layer::Line { points, stroke } => {
            draw_path(&mut points.iter().map(|&point| layout.at(point)), stroke);
        }
        Layer::Steps { points, stroke } => {
            let corner = |pair: &[(f64, f64)]| [(pair[1].0, pair[0].1), pair[1]];
            let all = points.first().copied().into_iter().chain(points.windows(2).flat_map(corner));
            draw_path(&mut all.map(|point| layout.at(point)), stroke);
        }
        Layer::Upright { x, stroke } => {
            let at = layout.at((*x, f64::NAN)).0;
            draw_path(&mut [(at, top), (at, bottom)].into_iter(), stroke);
        }
        Layer::Level { y, stroke } => {
            let at = layout.at((f64::NAN, *y)).1;
            draw_path(&mut [(left, at), (right, at)].into_iter(), stroke);
        }
        Layer::Marks { points, mark } => {
            let half = 0.5 * mark.size + 1.0;
            for (x, y) in points.iter().map(|&point| layout.at(point)) {
                grid.fill([x - half, y - half, x + half, y + half], OBSTACLE_BIT);
            }
        }
        Layer::Dots { points, size, .. } => {
            for (x, y) in points.iter().map(|&point| layout.at(point)) {
                grid.fill([x - size, y - size, x + size, y + size], OBSTACLE_BIT);
            }
        }
        Layer::Text { at, text, .. } => {
            let ((x, y), half) = (layout.at(*at), 0.5 * SMALL * ems(text));
            grid.fill([x - half, y - SMALL, x + half, y + SMALL], OBSTACLE_BIT);
        }
        Layer::Band { .. } => {}
        Layer::Map { .. } | Layer::Cells { .. } | Layer::Name { .. } => return None,
    }
    Some(())
}

fn same_style(a: &Stroke, b: &Stroke) -> bool {
    a.colour == b.colour && a.dash == b.dash && a.width == b.width
}

/// The points of a segment, half a cell apart.
fn along([from, to]: [(f64, f64); 2]) -> impl Iterator<Item = (f64, f64)> {
    let steps = (2.0 * (to.0 - from.0).hypot(to.1 - from.1) / CELL).ceil().max(1.0);
    let at = move |i: usize| {
        let fraction = i as f64 / steps;
        (from.0 + fraction * (to.0 - from.0), from.1 + fraction * (to.1 - from.1))
    };
    (0..=steps as usize).map(at)
}

/// The raster of a frame: one set of bits per cell.
struct Grid {
    frame: Rect,
    columns: usize,
    rows: usize,
    cells: Vec<u32>,
}

impl Grid {
    fn new(frame: Rect) -> Self {
        let cells = |length: f64| (length / CELL).ceil().max(1.0) as usize;
        let (columns, rows) = (cells(frame[2] - frame[0]), cells(frame[3] - frame[1]));
        Self { frame, columns, rows, cells: vec![0; columns * rows] }
    }

    /// The cells of a rectangle, as ranges of columns and rows.
    fn range(&self, [left, top, right, bottom]: Rect) -> [std::ops::Range<usize>; 2] {
        let cell = |v: f64, from: f64, count: usize| (((v - from) / CELL).max(0.0) as usize).min(count);
        let [x, y] = [self.frame[0], self.frame[1]];
        let columns = cell(left, x, self.columns)..cell(right + CELL, x, self.columns);
        [columns, cell(top, y, self.rows)..cell(bottom + CELL, y, self.rows)]
    }

    fn fill(&mut self, rect: Rect, bits: u32) {
        let [columns, rows] = self.range(rect);
        for row in rows {
            for cell in &mut self.cells[row * self.columns..][columns.clone()] {
                *cell |= bits;
            }
        }
    }

    /// The cell of a point, if it is in the frame.
    fn cell(&self, (x, y): (f64, f64)) -> Option<usize> {
        let [mut columns, mut rows] = self.range([x, y, x, y]);
        Some(rows.next()? * self.columns + columns.next()?)
    }

    fn segment(&mut self, ends: [(f64, f64); 2], bits: u32) {
        for point in along(ends) {
            if let Some(cell) = self.cell(point) {
                self.cells[cell] |= bits;
            }
        }
    }

    /// Whether a segment crosses none of the bits, apart from the surroundings of its first point.
    fn is_free(&self, ends: [(f64, f64); 2], bits: u32) -> bool {
        let beginning = |(x, y): (f64, f64)| (x - ends[0].0).hypot(y - ends[0].1) < 1.5 * CELL;
        let is_free = |point| self.cell(point).is_none_or(|cell| self.cells[cell] & bits == 0);
        along(ends).filter(|point| !beginning(*point)).all(is_free)
    }

    /// The best position of a line's label: near its line, far from others, preferably on the right.
    fn place(
        &self,
        path: &[(f64, f64)],
        index: usize,
        (stroke, text): (Stroke, &str),
    ) -> Option<DirectLabel> {
        let counts = [Counts::new(self, !0), Counts::new(self, !(1 << index))];
        let found =
            line_breaks(text).into_iter().map(|lines| self.place_lines(path, index, stroke, lines, &counts));
        found.flatten().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
    }

    /// Like [`Self::place`] for a text broken into lines; also returns the cost. `counts` are for all bits, and for all but those of its
    /// own line.
    fn place_lines(
        &self,
        path: &[(f64, f64)],
        index: usize,
        stroke: Stroke,
        text: Vec<String>,
        [all, foreign]: &[Counts<'_>; 2],
    ) -> Option<(f64, DirectLabel)> {
        let width = text.iter().map(|line| SMALL * ems(line)).fold(0.0, f64::max);
        let height = SMALL + LINE * SMALL * (text.len() - 1) as f64;
        let (half, other_bits) = ((0.5 * width, 0.5 * height), !(1 << index));
        let [left, top, right, bottom] = self.frame;
        let mut best: Option<(f64, DirectLabel)> = None;
        for &(x, y) in path.iter().step_by(path.len().div_ceil(MAX_CANDIDATES).max(1)) {
            // Where lines coincide, a label would be ambiguous.
            if foreign.within(expanded([x, y, x, y], 1.0)) > 0 {
                continue;
            }
            let across =
                x.clamp(left + PADDING + half.0, (right - PADDING - half.0).max(left + PADDING + half.0));
            let above = |offset: f64, sign: f64| (across, y + sign * (offset + half.1));
            let beside = |offset: f64, sign: f64| (x + sign * (offset + half.0), y);
            let oblique = |offset: f64, right: f64, down: f64| {
                (x + right * (0.7 * offset + half.0), y + down * (0.7 * offset + half.1))
            };
            let sides = |offset| {
                let straight =
                    [above(offset, -1.0), above(offset, 1.0), beside(offset, 1.0), beside(offset, -1.0)];
                let corners = [(1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (-1.0, 1.0)];
                straight.into_iter().chain(corners.map(|(right, down)| oblique(offset, right, down)))
            };
            for (offset, (cx, cy)) in
                OFFSETS.into_iter().flat_map(|offset| sides(offset).map(move |middle| (offset, middle)))
            {
                let rect = [cx - half.0, cy - half.1, cx + half.0, cy + half.1];
                let fits = rect[0] >= left + PADDING && rect[2] <= right - PADDING;
                let fits = fits && rect[1] >= top + PADDING && rect[3] <= bottom - PADDING;
                let leader = [(x, y), (x.clamp(rect[0], rect[2]), y.clamp(rect[1], rect[3]))];
                if !fits || all.within(expanded(rect, 1.0)) > 0 || !self.is_free(leader, LABEL_BIT) {
                    continue;
                }
                let crosses = f64::from(u8::from(!self.is_free(leader, other_bits)));
                let crowded = |by: f64| f64::from(u8::from(foreign.within(expanded(rect, by)) > 0));
                let crowded = 8.0 * crowded(4.0) + 4.0 * crowded(8.0);
                let cost = offset + 20.0 * crosses + crowded + 6.0 * (right - x) / (right - left);
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    best = Some((cost, DirectLabel { text: text.clone(), rect, leader, stroke }));
                }
            }
        }
        best
    }
}

/// A summed-area table of the cells that have any of some bits: the count in a rectangle follows from its four corners.
struct Counts<'a> {
    grid: &'a Grid,
    sums: Vec<u32>,
}

impl<'a> Counts<'a> {
    fn new(grid: &'a Grid, bits: u32) -> Self {
        let width = grid.columns + 1;
        let mut sums = vec![0; width];
        for row in grid.cells.chunks_exact(grid.columns) {
            let mut on_the_left = 0;
            sums.push(0);
            for cell in row {
                on_the_left += u32::from(cell & bits != 0);
                sums.push(on_the_left + sums[sums.len() - width]);
            }
        }
        Self { grid, sums }
    }

    /// The number of such cells in a rectangle, pt.
    fn within(&self, rect: Rect) -> u32 {
        let [columns, rows] = self.grid.range(rect);
        if columns.is_empty() || rows.is_empty() {
            return 0;
        }
        let sums = |column: usize, row: usize| self.sums[row * (self.grid.columns + 1) + column];
        let [left, right] =
            [columns.start, columns.end].map(|column| (sums(column, rows.start), sums(column, rows.end)));
        right.1 + left.0 - right.0 - left.1
    }
}

/// A text on one line, and, if it has several words, broken into the two lines that are narrowest.
fn line_breaks(text: &str) -> Vec<Vec<String>> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let breaks = 1..words.len();
    let two = breaks.map(|at| [words[..at].join(" "), words[at..].join(" ")].to_vec());
    let width = |lines: &Vec<String>| lines.iter().map(|line| ems(line)).fold(0.0, f64::max);
    let narrow = two.min_by(|a, b| width(a).total_cmp(&width(b)));
    std::iter::once(vec![text.to_owned()]).chain(narrow).collect()
}

fn expanded([left, top, right, bottom]: Rect, by: f64) -> Rect {
    [left - by, top - by, right + by, bottom + by]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{BLACK, BLUE, ORANGE};
    use crate::layout::{Margins, layout};
    use crate::{Axis, Chart, Dash};

    /// Resonance curves of some damping ratios with their legend.
    fn curves(dampings: &[f64]) -> (Chart, Vec<(Key, String)>) {
        let looks = [(BLACK, Dash::Short), (BLUE, Dash::Long), (ORANGE, Dash::Solid), (BLUE, Dash::Dots)];
        let (mut layers, mut legend) = (Vec::new(), Vec::new());
        for (i, zeta) in dampings.iter().enumerate() {
            let (colour, dash) = looks[i % looks.len()];
            let stroke = Stroke::new(colour, 1.0 + i as f64, dash);
            let value = |r: f64| (r, 1.0 / ((1.0 - r * r).powi(2) + (2.0 * zeta * r).powi(2)).sqrt());
            layers.push(Layer::line((0..=400).map(|k| value(0.5 + 0.0025 * f64::from(k))), stroke));
            legend.push((Key::Line(stroke), format!("damping ratio {zeta}")));
        }
        let y = Axis::linear("amplification", (0.0, 11.0));
        (Chart::of(Axis::linear("ratio", (0.5, 1.5)), y, layers, 170.0), legend)
    }

    fn inside([left, top, right, bottom]: Rect, (x, y): (f64, f64)) -> bool {
        (left..=right).contains(&x) && (top..=bottom).contains(&y)
    }

    fn meets(a: Rect, b: Rect) -> bool {
        a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
    }

    #[test]
    fn contract_names_meet_no_line_and_no_other_name_and_each_leads_to_its_own_line() {
        for dampings in [&[0.05, 0.1, 0.2][..], &[0.05], &[0.05, 0.07, 0.1, 0.15]] {
            let (chart, legend) = curves(dampings);
            let laid = layout(&chart, [3.0, 3.0, 238.0, 173.0], true, Margins::default());
            let names = place_labels(&laid, &legend).expect("room for all");
            assert_eq!(names.len(), dampings.len());
            for (i, name) in names.iter().enumerate() {
                assert_eq!(name.text.join(" "), legend[i].1);
                assert!(names[..i].iter().all(|other| !meets(name.rect, other.rect)), "{names:?}");
                for (k, layer) in chart.layers.iter().enumerate() {
                    let Layer::Line { points, .. } = layer else { panic!("{layer:?}") };
                    let places: Vec<(f64, f64)> = points.iter().map(|&point| laid.at(point)).collect();
                    assert!(
                        !places.iter().any(|&place| inside(name.rect, place)),
                        "{:?} on line {k}",
                        name.text
                    );
                    let (x, y) = name.leader[0];
                    let off = places.windows(2).map(|pair| {
                        let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
                        let fraction = ((x - pair[0].0) * dx + (y - pair[0].1) * dy) / (dx * dx + dy * dy);
                        let fraction = fraction.clamp(0.0, 1.0);
                        (x - pair[0].0 - fraction * dx).hypot(y - pair[0].1 - fraction * dy)
                    });
                    let off = off.fold(f64::INFINITY, f64::min);
                    assert!(if k == i { off < 0.1 } else { off > 0.7 }, "{:?} to line {k}: {off}", name.text);
                }
            }
        }
    }

    #[test]
    fn contract_lines_that_cannot_be_told_apart_or_are_too_many_keep_their_legend() {
        let cell = [3.0, 3.0, 238.0, 173.0];
        let found = |dampings: &[f64]| {
            let (chart, legend) = curves(dampings);
            place_labels(&layout(&chart, cell, true, Margins::default()), &legend).map(|names| names.len())
        };
        assert_eq!(found(&[0.1, 0.1]), None);
        assert_eq!(found(&[0.05, 0.06, 0.08, 0.1, 0.15, 0.2, 0.3]), None);
        assert_eq!(found(&[]), None);
    }
}
