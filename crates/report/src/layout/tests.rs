use super::*;
use crate::axis::Scale;

/// Numbers between 0 and 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn axis(&mut self, label: &str) -> Axis {
        let size = 10_f64.powf(16.0 * self.next() - 8.0);
        if self.next() < 0.5 {
            return Axis::log(label, (size, size * 10_f64.powf(0.1 + 12.0 * self.next())));
        }
        let from = size * (4.0 * self.next() - 2.0);
        Axis::linear(label, (from, from + size))
    }
}

fn chart(x: Axis, y: Axis, map: Option<Axis>) -> Chart {
    let cells = |axis: &Axis| vec![axis.range.0, axis.range.1];
    let edges = [cells(&x), cells(&y)];
    let layers = map.map(|colours| Layer::Map { edges, values: vec![1.0], colours }).into_iter().collect();
    Chart { title: "A title".to_owned(), x, y, layers, height: 150.0 }
}

#[test]
fn contract_no_label_meets_another_or_the_frame_or_leaves_the_cell() {
    let mut random = Random(7);
    for i in 0..300 {
        let (x, y) = (random.axis("abscissa, unit"), random.axis("worst E1max, J"));
        let map = (i % 3 == 0).then(|| random.axis("E1max, J"));
        let x = if i % 4 == 0 { x.with_second("abscissa, other unit", 0.159) } else { x };
        let chart = chart(x, y, map);
        let cell = [3.0, 5.0, 241.0, 5.0 + 110.0 + 120.0 * random.next()];
        let found = layout(&chart, cell, true, Margins::default());
        let rects: Vec<(Rect, &str)> =
            found.labels.iter().map(|label| (label.rect(), label.text.as_str())).collect();
        let apart = |a: Rect, b: Rect| a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
        for (k, (rect, text)) in rects.iter().enumerate() {
            assert!(apart(*rect, found.frame), "{text} in the frame: {:?}, {:?}", chart.x, chart.y);
            let within = rect[0] >= cell[0] && rect[1] >= cell[1] && rect[2] <= cell[2] && rect[3] <= cell[3];
            // A number at the very beginning of the abscissa may stand under the label of the ordinate.
            assert!(within, "{text} leaves the cell: {rect:?}");
            for (other, words) in &rects[..k] {
                assert!(apart(*rect, *other), "{text} on {words}: {:?}, {:?}", chart.x, chart.y);
            }
        }
        assert!(found.frame[2] - found.frame[0] > 80.0, "{:?}", found.frame);
        for ticks in &found.ticks {
            assert!((2..=9).contains(&ticks.len()), "{ticks:?}");
        }
    }
}

#[test]
fn exact_points_lie_where_the_axes_say() {
    let chart = chart(Axis::linear("x", (0.0, 10.0)), Axis::log("y", (1.0, 100.0)), None);
    let found = layout(&chart, [0.0, 0.0, 200.0, 100.0], true, Margins::default());
    let [left, top, right, bottom] = found.frame;
    let (x, y) = found.at((2.5, 10.0));
    assert!((x - (left + 0.25 * (right - left))).abs() < 1e-9);
    assert!((y - 0.5 * (top + bottom)).abs() < 1e-9);
}

#[test]
fn contract_margins_are_as_wide_as_asked_and_an_abscissa_without_labels_has_none() {
    let chart = chart(Axis::linear("x", (0.0, 10.0)), Axis::linear("y", (0.0, 1.0)), None);
    let least = Margins { left: 70.0, right: 33.0, ..Margins::default() };
    let found = layout(&chart, [0.0, 0.0, 200.0, 100.0], false, least);
    assert_eq!((found.frame[0], found.frame[2]), (70.0, 167.0));
    assert!(found.labels.iter().all(|label| label.text != "x"));
    let below = found.labels.iter().filter(|label| label.at.1 > found.frame[3] && label.side == 0);
    assert_eq!(below.count(), 0);
}

#[test]
fn contract_names_stand_above_in_their_lines() {
    let names = vec![(0.0, "one\ntwo".to_owned()), (1.0, "three".to_owned())];
    let chart = chart(Axis::of_names((-0.5, 1.5), names), Axis::new("y", Scale::Linear, (0.0, 1.0)), None);
    let found = layout(&chart, [0.0, 0.0, 200.0, 100.0], true, Margins::default());
    let height = |text: &str| found.labels.iter().find(|label| label.text == text).expect("a label").at.1;
    assert!(height("one") < height("two") && height("two") == height("three"));
    assert!(height("three") < found.frame[1]);
}

/// 2π rad/s are one hertz.
#[test]
fn exact_a_second_scale_has_its_ticks_where_the_first_has_the_same_values() {
    let hertz = 0.5 / std::f64::consts::PI;
    let chart = chart(
        Axis::linear("ω, rad/s", (5.0, 8.0)).with_second("f, Hz", hertz),
        Axis::linear("y", (0.0, 1.0)),
        None,
    );
    let found = layout(&chart, [0.0, 0.0, 241.0, 150.0], true, Margins::default());
    assert!(found.second.len() >= 3, "{:?}", found.second);
    for (value, text) in &found.second {
        let label = found.labels.iter().find(|label| label.text == *text && label.at.1 < found.frame[1]);
        let (at, _) = found.at((value / hertz, 0.0));
        assert!(label.is_some_and(|label| (label.at.0 - at).abs() < 1e-9), "{text}");
    }
}
