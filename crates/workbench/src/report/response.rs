//! The response over frequency: how far the tuning reaches.

use super::curves::{ABOUT, Curves};
use super::findings::{Compared, Findings};
use super::html::{Section, figure, link};
use super::numbers::{HERTZ, four, frequency};
use crate::summary::whose;
use maud::{Markup, html};
use retune_figures::colour::{BLACK, BLUE, GREY, VERMILION};
use retune_figures::{
    Axis, Chart, Dash, Drawing, Key, Layer, Mark, Scale, Shape, Sheet, Stroke, Width, drawing,
};

/// The curves and their looks.
fn lines(findings: &Findings) -> [(&'static str, Stroke); 3] {
    [
        ("no damper", Stroke::new(BLACK, 1.1, Dash::Short)),
        (whose(&findings.study.scene), Stroke::new(BLUE, 1.1, Dash::Long)),
        ("tuned", Stroke::new(VERMILION, 1.4, Dash::Solid)),
    ]
}
/// Ratio of the largest values of two curves above which the smaller would be squashed on a linear scale.
const SQUASHED: f64 = 10.0;

/// A quantity that is drawn against the frequency.
struct Curve {
    name: &'static str,
    label: &'static str,
    unit: &'static str,
    values: fn(&Curves) -> &[Vec<f64>; 3],
    worst: fn(&Findings) -> f64,
}

impl Curve {
    const ENERGY: Self = Self {
        name: "E1max",
        label: "E1max, J",
        unit: "J",
        values: |curves| &curves.energy,
        worst: |findings| findings.evaluation.worst.e1_max,
    };
    const DISPLACEMENT: Self = Self {
        name: "Displacement amplitude",
        label: "|x1|, mm",
        unit: "mm",
        values: |curves| &curves.displacement,
        worst: |findings| 1e3 * findings.response.structure.displacement.value,
    };
}

/// The section.
pub fn section(findings: &Findings, compared: &Compared) -> Section {
    let curves = Curves::new(findings);
    let names = lines(findings).map(|(name, _)| name);
    let body = html! {
        (words(findings, compared, &curves))
        (figure(&picture(findings, &curves, Curve::ENERGY), html! {
            "E1max against the frequency of the force: " (names[0]) ", " (names[1]) ", " (names[2]) ". "
            @if curves.is_objective { (link("band.csv")) } @else { "Outside of the dotted line nothing was asked of the search." }
        }))
        (figure(&picture(findings, &curves, Curve::DISPLACEMENT), html! {
            "Largest displacement |x1| of the structure, from " (four(findings.study.window.t0.get())) " to "
            (four(findings.study.window.end.get())) " s of a run from rest."
        }))
    };
    Section { id: "response", title: "Response over frequency", body }
}

fn words(findings: &Findings, compared: &Compared, curves: &Curves) -> Markup {
    let worst = |of: &Result<retune_optim::Evaluation, retune_optim::Unusable>| {
        of.as_ref().map_or_else(|_| "none".to_owned(), |of| format!("{} J", four(of.energy)))
    };
    let omega = findings.worst_omega();
    if curves.is_objective {
        return html! { p {
            "The objective is the worst over this band: " (worst(&compared.none)) " without a damper, " (worst(&compared.study))
            " with " (whose(&findings.study.scene)) ", " (four(findings.evaluation.energy)) " J with the tuned one, at " (frequency(omega)) "."
        } };
    }
    let top = curves.energy.each_ref().map(|curve| Curves::largest(curve));
    html! { p {
        "The search looked at ω = " (frequency(omega)) " alone, and the band here is outside of its objective: ± " (100.0 * ABOUT)
        " % of the natural frequency about it, for the reader to see how sharp the tuning is. In this band the largest E1max is "
        (four(top[0])) " J without a damper, " (four(top[1])) " J with " (whose(&findings.study.scene)) ", and " (four(top[2])) " J with the tuned one."
    } }
}

fn picture(findings: &Findings, curves: &Curves, curve: Curve) -> Drawing {
    let Curve { name, label, unit, values, worst } = curve;
    let lines = lines(findings);
    let (values, worst) = (values(curves), worst(findings));
    let omega = findings.worst_omega();
    let top = values.each_ref().map(|curve| Curves::largest(curve));
    let (high, low) = (
        top.into_iter().fold(0.0, f64::max),
        top.into_iter().filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min),
    );
    let log = high > SQUASHED * low;
    let range = (curves.omega.first().copied().unwrap_or(0.0), curves.omega.last().copied().unwrap_or(1.0));
    let y = if log {
        Axis::around(label, Scale::Log, values.iter().flatten().copied())
    } else {
        Axis::linear(label, (0.0, if high > 0.0 { 1.06 * high } else { 1.0 }))
    };
    let mut layers = Vec::new();
    if !curves.is_objective {
        layers.push(Layer::Upright { x: omega, stroke: Stroke::new(GREY, 1.0, Dash::Dots) });
    }
    for (curve, (_, stroke)) in values.iter().zip(lines) {
        let points = curves.omega.iter().copied().zip(curve.iter().copied()).collect();
        layers.push(Layer::Line { points, stroke });
    }
    let mark = Mark { rim: true, ..Mark::new(Shape::Disc, VERMILION, 5.0) };
    layers.push(Layer::Marks { points: vec![(omega, worst)], mark });
    let mut legend: Vec<(Key, String)> =
        lines.iter().map(|(name, stroke)| (Key::Line(*stroke), (*name).to_owned())).collect();
    legend.push((
        Key::Mark(mark),
        format!(
            "{}: {} {unit} at {} rad/s",
            if curves.is_objective { "worst" } else { "tuned for" },
            four(worst),
            four(omega)
        ),
    ));
    let chart = Chart {
        title: String::new(),
        x: Axis::linear("ω, rad/s", range).with_second("frequency, Hz", HERTZ),
        y,
        layers,
        height: 210.0,
    };
    let said: Vec<String> =
        lines.iter().zip(top).map(|((line, _), top)| format!("{line} {} {unit}", four(top))).collect();
    drawing(&Sheet {
        title: format!("{name} against the frequency of the force"),
        description: format!(
            "{name} against ω from {} to {} rad/s on a {} scale. Highest points: {}.",
            four(range.0),
            four(range.1),
            if log { "logarithmic" } else { "linear" },
            said.join(", ")
        ),
        width: Width::Page,
        charts: vec![chart],
        columns: 1,
        stacked: false,
        legend,
        caption: Vec::new(),
    })
}
