//! The sensitivity of the value to small errors, from the certificate.

use super::findings::Findings;
use super::numbers::{amount, digits, four};
use crate::amount::label;
use crate::certify::Walls;
use maud::html;
use retune_model::Measure;
use retune_report::colour::{BLACK, BLUE, SKY, VERMILION};
use retune_report::document::{Block, Section};
use retune_report::html::{Table, figure, link};
use retune_report::{
    Axis, Chart, Dash, Drawing, Key, Layer, Mark, Shape, Sheet, Stroke, Width, drawing, scale_for,
};

/// Height of a bar, pt, and half of it as a share of the distance between two.
const ROW: f64 = 17.0;
const HALF: f64 = 0.32;

pub fn section(findings: &Findings) -> Section {
    let near = &findings.measured().neighbourhood;
    let quantity = findings.quantity();
    let name = quantity.name();
    let article = if name.starts_with(['E', 'a', 'x']) { "an" } else { "a" };
    let value_text = |value: f64| value_text(value, quantity);
    let body = html! {
        p {
            "Of " (near.members) " designs whose k1, k2, c2, D and C are off by at most " (digits(100.0 * near.errors, 3))
            " %, nine in ten have " (article) " " (name) " from " (value_text(near.low)) " to " (value_text(near.high)) ", and half have less than "
            (value_text(near.median)) ". The design itself has " (value_text(findings.optimum.certificate.value.value)) "."
        }
        (figure(&picture(findings), html! {
            "The largest " (name) " with one parameter off by at most 1 %, and the neighbours' spread. " (link(crate::certify::FILE))
        }))
        (table(findings).markup())
        @if let Some(walls) = &findings.optimum.certificate.walls { (walls_table(findings, walls).markup()) }
    };
    ("sensitivity", "Sensitivity to small errors", vec![Block::Elements(body)])
}

/// A value in words; infinite means that the design cannot be computed.
fn value_text(value: f64, quantity: Measure) -> String {
    if value.is_finite() { amount(value, quantity) } else { "no value (it cannot be computed)".to_owned() }
}

fn table(findings: &Findings) -> Table {
    let certificate = &findings.optimum.certificate;
    let (name, unit) = (findings.quantity().name(), findings.quantity().unit());
    let head = format!(
        "parameter | value | change for 1 % more, {unit} | largest within 1 %, {unit} | at, % | against the design, %"
    );
    let mut table = Table::new(format!("{name} with one parameter off"), &head);
    for one in &certificate.measured.sensitivity {
        let sign = |value: f64, text: String| if value > 0.0 { format!("+{text}") } else { text };
        let percent = 100.0 * (one.worst / certificate.value.value - 1.0);
        table.row([
            one.parameter.to_owned(),
            four(one.value),
            sign(one.slope_per_percent, digits(one.slope_per_percent, 3)),
            four(one.worst),
            sign(one.worst_at_percent, digits(one.worst_at_percent, 3)),
            sign(percent, digits(percent, 3)),
        ]);
    }
    table
}

fn walls_table(findings: &Findings, walls: &Walls) -> Table {
    let own = findings.optimum.certificate.value.value;
    let quantity = findings.quantity();
    let head = format!("walls | {} | worst at ω, rad/s | against the design, %", label(quantity));
    let title =
        format!("{} with other walls: e is the restitution at every speed, K the stiffness", quantity.name());
    let mut table = Table::new(title, &head);
    for one in walls.all() {
        let (place, found) = (one.place(), &one.found);
        let percent = 100.0 * (found.value / own - 1.0);
        let sign = if percent > 0.0 && percent.is_finite() { "+" } else { "" };
        let value = if found.value.is_finite() { four(found.value) } else { "no value".to_owned() };
        table.row([place, value, four(found.omega), format!("{sign}{}", digits(percent, 3))]);
    }
    table
}

fn picture(findings: &Findings) -> Drawing {
    let (certificate, quantity) = (&findings.optimum.certificate, findings.quantity());
    let name = quantity.name();
    let (own, near) = (certificate.value.value, &certificate.measured.neighbourhood);
    let bars = &certificate.measured.sensitivity;
    let place = |i: usize| -(i as f64);
    let bar = |i: usize, ends: (f64, f64), colour| Layer::Band {
        x: ends,
        y: (place(i) - HALF, place(i) + HALF),
        colour,
        opacity: 1.0,
    };
    let mut layers = Vec::new();
    let mut names = Vec::new();
    for (i, one) in bars.iter().enumerate() {
        let worst = if one.worst.is_nan() { f64::INFINITY } else { one.worst };
        layers.push(bar(i, (own.min(worst), own.max(worst)), VERMILION));
        let sign = if one.worst_at_percent > 0.0 { "+" } else { "" };
        names.push((place(i), format!("{} {sign}{} %", one.parameter, digits(one.worst_at_percent, 3))));
    }
    let last = bars.len();
    layers.push(bar(last, (near.low, near.high), SKY));
    names.push((place(last), "neighbours".to_owned()));
    let median = Mark { rim: true, ..Mark::new(Shape::Disc, BLUE, 4.5) };
    layers.push(Layer::Marks { points: vec![(near.median, place(last))], mark: median });
    let rule = Stroke::new(BLACK, 1.1, Dash::Short);
    layers.push(Layer::Upright { x: own, stroke: rule });
    let values: Vec<f64> =
        bars.iter().map(|one| one.worst).chain([own, near.low, near.median, near.high]).collect();
    let chart = Chart::of(
        Axis::around(label(quantity), scale_for(&values), values.iter().copied()),
        Axis::of_names((place(last) - 0.7, 0.7), names),
        layers,
        ROW * (last as f64 + 1.4) + 30.0,
    );
    let entries: Vec<String> =
        bars.iter().map(|one| format!("{} {}", one.parameter, amount(one.worst, quantity))).collect();
    drawing(&Sheet {
        description: format!(
            "A bar for each parameter from the design's {name}, {}, to the largest: {}. Neighbours: {} to {}.",
            amount(own, quantity),
            entries.join(", "),
            four(near.low),
            amount(near.high, quantity)
        ),
        width: Width::Page,
        legend: vec![
            (Key::Line(rule), "the design".to_owned()),
            (Key::Area(VERMILION, 1.0), "largest within 1 % of one parameter".to_owned()),
            (
                Key::Area(SKY, 1.0),
                format!("90 % of the neighbours within {} %", digits(100.0 * near.errors, 3)),
            ),
            (Key::Mark(median), "their median".to_owned()),
        ],
        ..Sheet::of(format!("{name} with one parameter off by at most 1 %"), vec![chart])
    })
}
