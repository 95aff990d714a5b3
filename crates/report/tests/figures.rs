//! Whole figures: that they are XML, say what they are, show what the data say, and are the same every time.

use retune_report::colour::{BLACK, BLUE, GREEN, VERMILION};
use retune_report::{
    Axis, Chart, Dash, Key, Layer, Mark, Nodes, Place, Scale, Shape, Sheet, Stand, Stroke, Width, drawing,
    heat_map, svg,
};
use roxmltree::{Document, Node};

const FRAME: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// A sheet with every kind of layer and key, and with text that XML must escape.
fn everything() -> Sheet {
    let points: Vec<(f64, f64)> = (1..200).map(|i| (f64::from(i), f64::from(i * i % 97) - 5.0)).collect();
    let mark = Mark { rim: true, ..Mark::new(Shape::Triangle, VERMILION, 5.0) };
    let stroke = Stroke::new(BLUE, 1.0, Dash::DashDot);
    let layers = vec![
        Layer::Band { x: (20.0, 40.0), y: FRAME, colour: GREEN, opacity: 0.3 },
        Layer::Line { points: points.clone(), stroke },
        Layer::Steps { points: points.clone(), stroke: Stroke::solid(BLACK) },
        Layer::Dots { points: points.clone(), colour: BLUE, size: 1.0 },
        Layer::Marks { points, mark },
        Layer::Upright { x: 50.0, stroke },
        Layer::Level { y: 50.0, stroke },
        Layer::Text { at: (60.0, 50.0), text: "a < b & \"c\"".to_owned(), stand: Stand::Over },
        Layer::Name { at: (190.0, 1.0), text: "E1max".to_owned(), mark: Some(mark) },
    ];
    let chart = |scale| Chart {
        title: "k1 & <others>".to_owned(),
        x: Axis::linear("ω, rad/s", (0.0, 150.0)),
        y: Axis::new("E1max, J", scale, (0.5, 60.0)),
        layers: layers.clone(),
        height: 150.0,
    };
    Sheet {
        title: "A title & more".to_owned(),
        description: "What <can> be seen".to_owned(),
        width: Width::Page,
        charts: vec![chart(Scale::Linear), chart(Scale::Log), chart(Scale::Linear)],
        columns: 2,
        stacked: false,
        legend: vec![
            (Key::Heading, "lines:".to_owned()),
            (Key::Line(stroke), "one".to_owned()),
            (Key::Marked(stroke, mark), "two".to_owned()),
            (Key::Heading, "others:".to_owned()),
            (Key::Mark(mark), "three".to_owned()),
            (Key::Area(GREEN, 0.3), "four words that are rather long ".repeat(6)),
        ],
        caption: vec!["A caption of many words ".repeat(20)],
    }
}

fn child<'a>(root: Node<'a, 'a>, name: &str) -> Node<'a, 'a> {
    root.children().find(|node| node.has_tag_name(name)).unwrap_or_else(|| panic!("no <{name}>"))
}

/// Pairs of numbers of a path that begin a subpath or end a step, absolute, in units; `a`rcs are not understood.
fn corners(path: &str) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    let spaced = path.replace('-', " -");
    for part in spaced.split_inclusive(|c: char| c.is_ascii_alphabetic()).scan('M', |command, part| {
        let next = part.chars().last().filter(char::is_ascii_alphabetic);
        let numbers = part.trim_end_matches(|c: char| c.is_ascii_alphabetic()).to_owned();
        let own = std::mem::replace(command, next.unwrap_or(' '));
        Some((own, numbers))
    }) {
        let (command, numbers) = part;
        let numbers: Vec<f64> = numbers.split_whitespace().map(|n| n.parse().expect("a number")).collect();
        let (x, y) = all.last().copied().unwrap_or_default();
        match command {
            'M' if !numbers.is_empty() => all.push((numbers[0], numbers[1])),
            'h' => all.push((x + numbers[0], y)),
            'v' => all.push((x, y + numbers[0])),
            'm' | 'l' => {
                for step in numbers.chunks_exact(2) {
                    let (x, y) = all[all.len() - 1];
                    all.push((x + step[0], y + step[1]));
                }
            }
            _ => {}
        }
    }
    all
}

#[test]
fn contract_figures_are_xml_with_a_title_and_a_description() {
    let sheet = everything();
    let figure = drawing(&sheet);
    let narrow = figure.narrow.expect("a narrow version of a page");
    let mut ids = Vec::new();
    for (text, width) in [(&figure.wide, 5100.0), (&narrow, 2410.0)] {
        let document = Document::parse(text).expect("XML");
        let root = document.root_element();
        assert_eq!(child(root, "title").text(), Some("A title & more"));
        assert_eq!(child(root, "desc").text(), Some("What <can> be seen"));
        let named = ["title", "desc"].map(|name| child(root, name).attribute("id").expect("an id"));
        assert_eq!(root.attribute("role"), Some("img"));
        assert_eq!(root.attribute("aria-labelledby"), Some(named.join(" ").as_str()));
        assert!(root.attribute("viewBox").expect("a view").starts_with(&format!("0 0 {width} ")));
        ids.extend(named.map(str::to_owned));
        let words = |text: &str| document.descendants().any(|node| node.text() == Some(text));
        assert!(words("a < b & \"c\"") && words(" & <others>"), "escaped once");
        assert!(!text.contains("NaN") && !text.contains("inf"));
        for sign in ["http:", "url(", "href", "<script", "@import"] {
            assert!(!text.replace("xmlns=\"http://www.w3.org/2000/svg\"", "").contains(sign), "{sign}");
        }
    }
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), 4, "both versions may stand in one page");
    assert_eq!(svg(&sheet), svg(&everything()), "the same bytes");
    assert_eq!(svg(&sheet), figure.wide);
}

#[test]
fn contract_no_text_is_smaller_than_seven_points_and_none_leaves_the_figure() {
    let text = svg(&everything());
    let document = Document::parse(&text).expect("XML");
    let view = document.root_element().attribute("viewBox").expect("a view").to_owned();
    let view: Vec<f64> = view.split(' ').map(|n| n.parse().expect("a number")).collect();
    let texts: Vec<Node> = document.descendants().filter(|node| node.has_tag_name("text")).collect();
    assert!(texts.len() > 40, "{}", texts.len());
    for node in texts {
        let number = |name: &str| node.attribute(name).expect(name).parse::<f64>().expect("a number");
        assert!(number("font-size") >= 70.0);
        assert!((0.0..=view[2]).contains(&number("x")) && (0.0..=view[3]).contains(&number("y")));
    }
}

#[test]
fn contract_nothing_is_drawn_beyond_the_frame() {
    let wild = vec![(-50.0, 3.0), (5.0, 900.0), (8.0, -900.0), (9.0, 5.0), (1e9, 5.0)];
    let stroke = Stroke::solid(VERMILION);
    let chart = Chart {
        title: String::new(),
        x: Axis::linear("x", (0.0, 10.0)),
        y: Axis::linear("y", (0.0, 10.0)),
        layers: vec![
            Layer::Line { points: wild.clone(), stroke },
            Layer::Steps { points: wild.clone(), stroke },
            Layer::Dots { points: wild.clone(), colour: VERMILION, size: 1.0 },
            Layer::Band { x: (-5.0, 3.0), y: (5.0, 1e12), colour: VERMILION, opacity: 1.0 },
            Layer::Upright { x: 11.0, stroke },
            Layer::Level { y: -1.0, stroke },
            Layer::Text { at: (20.0, 5.0), text: "beyond".to_owned(), stand: Stand::Right },
        ],
        height: 100.0,
    };
    let sheet = Sheet { charts: vec![chart], columns: 1, legend: Vec::new(), ..everything() };
    let text = svg(&sheet);
    assert!(!text.contains("beyond"));
    let document = Document::parse(&text).expect("XML");
    let with = |name: &str, colour: &str| {
        let own = document.descendants().filter(|n| n.attribute(name) == Some(colour));
        own.flat_map(|n| corners(n.attribute("d").expect("a path"))).collect::<Vec<_>>()
    };
    // The frame is the last thing of the black path.
    let black = with("stroke", BLACK);
    let frame = &black[black.len() - 4..];
    let (left, right) = (frame[0].0, frame[1].0);
    let (top, bottom) = (frame[1].1, frame[2].1);
    assert!(right - left > 3000.0 && bottom - top > 500.0, "{frame:?}");
    let drawn = [with("stroke", VERMILION), with("fill", VERMILION)].concat();
    assert!(drawn.len() > 12, "{drawn:?}");
    for (x, y) in drawn {
        assert!((left..=right).contains(&x) && (top..=bottom).contains(&y), "({x}, {y}): {frame:?}");
    }
}

#[test]
fn exact_cells_of_a_map_have_the_colours_of_their_values() {
    let side = |label: &str, values: &[f64]| Nodes {
        label: label.to_owned(),
        scale: Scale::Linear,
        values: values.to_vec(),
    };
    let sides = [side("k2", &[1.0, 2.0, 3.0]), side("c2", &[10.0, 20.0])];
    let values = [5.0, 6.0, f64::INFINITY, 9.0, f64::NAN, 7.0];
    let places = [
        Place { at: (2.0, 10.0), label: "found".to_owned() },
        Place { at: (2.0, 99.0), label: "lost".to_owned() },
    ];
    let (chart, legend) = heat_map(&sides, &values, "E1max, J", &places);
    assert_eq!(
        legend.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>(),
        ["found", "lost (off the map)"]
    );
    let text = svg(&Sheet { charts: vec![chart], columns: 1, legend, width: Width::Column, ..everything() });
    let document = Document::parse(&text).expect("XML");
    let cells = |colour: &str| {
        let own = document.descendants().filter(|n| n.attribute("fill") == Some(colour));
        own.flat_map(|n| {
            n.attribute("d").expect("a path").split('M').skip(1).map(|d| corners(&format!("M{d}")))
        })
        .collect::<Vec<_>>()
    };
    // Grey where there is no value: the third cell of the first row and the second of the second.
    let grey = cells("#C8C8C8");
    assert_eq!(grey.len(), 2);
    let width = grey[0][1].0 - grey[0][0].0;
    assert!((grey[1][0].0 + width - grey[0][0].0).abs() <= 1.0, "the next is one column to the left");
    assert_eq!(grey[1][2].1, grey[0][0].1, "and one row above");
    // 5 is the least and 9 the largest of the finite values; 7 lies in the middle of viridis.
    let left = |colour: &str| cells(colour).first().map(|cell| (cell[0].0 - grey[0][0].0) / width);
    assert_eq!(left("#440154").map(f64::round), Some(-2.0));
    assert_eq!(left("#FDE725").map(f64::round), Some(-2.0));
    let middle = document
        .descendants()
        .filter(|n| n.attribute("fill").is_some_and(|c| c.starts_with("#2191") || c.starts_with("#2192")));
    assert!(middle.count() >= 1, "7 J has the middle colour");
}

#[test]
fn contract_stacked_charts_label_their_common_abscissa_once() {
    let chart = |label: &str| Chart {
        title: String::new(),
        x: Axis::linear("iteration", (0.0, 40.0)),
        y: Axis::linear(label, (0.0, 1.0)),
        layers: Vec::new(),
        height: 70.0,
    };
    let sheet = |stacked| Sheet {
        charts: vec![chart("a"), chart("b"), chart("c")],
        columns: 1,
        stacked,
        legend: Vec::new(),
        ..everything()
    };
    let count = |stacked| svg(&sheet(stacked)).matches(">iteration</text>").count();
    assert_eq!([count(true), count(false)], [1, 3]);
}
