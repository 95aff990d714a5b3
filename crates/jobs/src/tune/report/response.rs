//! The response over frequency: how broad the tuning is.

use super::findings::{Compared, Findings};
use super::numbers::{HERTZ, amount, four, frequency};
use crate::amount::label;
use crate::summary::baseline;
use crate::tune::band::{at, first, term_value};
use maud::{Markup, html};
use rayon::prelude::*;
use retune_model::{Measure, Scene};
use retune_optim::Objective;
use retune_report::colour::{BLACK, BLUE, GREY, VERMILION};
use retune_report::document::{Block, Section};
use retune_report::html::{figure, link};
use retune_report::{
    Axis, Chart, Dash, Drawing, Key, Layer, Mark, Scale, Shape, Sheet, Stroke, Width, drawing,
};
use retune_solver::{Ask, extremes};

/// The names and strokes of the curves.
fn lines(findings: &Findings) -> [(&'static str, Stroke); 3] {
    [
        ("no damper", Stroke::new(BLACK, 1.1, Dash::Short)),
        (baseline(&findings.study.scene), Stroke::new(BLUE, 1.1, Dash::Long)),
        ("tuned", Stroke::new(VERMILION, 1.4, Dash::Solid)),
    ]
}
/// Ratio of the largest values of two curves above which the smaller would be squashed on a linear scale.
const SQUASHED: f64 = 10.0;

/// A quantity that is drawn against the frequency.
struct Curve<'a> {
    name: &'static str,
    label: String,
    unit: &'static str,
    values: &'a [Vec<f64>; 3],
    /// The frequency, rad/s, of the largest value that the objective covers, and that value.
    worst: [f64; 2],
}

impl<'a> Curve<'a> {
    /// The minimised quantity.
    fn objective(findings: &Findings, curves: &'a Curves) -> Self {
        let quantity = findings.quantity();
        Self {
            name: quantity.name(),
            label: label(quantity),
            unit: quantity.unit(),
            values: &curves.value,
            worst: [findings.worst_omega(), findings.evaluation.worst.largest],
        }
    }

    fn displacement(findings: &Findings, curves: &'a Curves) -> Self {
        let needs = findings.optimum.needs.as_ref().map(|needs| needs.damper.0.own);
        let place = needs.map(|own| own.get(Measure::Displacement)).filter(|need| need.value.is_finite());
        let (omega, there) = (findings.worst_omega(), findings.response.structure.displacement.value);
        Self {
            name: "Displacement amplitude",
            label: "|x1|, mm".to_owned(),
            unit: "mm",
            values: &curves.displacement,
            worst: place.map_or([omega, 1e3 * there], |need| [need.omega, 1e3 * need.value]),
        }
    }
}

pub fn section(findings: &Findings, compared: &Compared) -> Section {
    let curves = Curves::new(findings);
    let names = lines(findings).map(|(name, _)| name);
    let body = html! {
        (words(findings, compared, &curves))
        (figure(&picture(findings, &curves, Curve::objective(findings, &curves)), html! {
            (findings.quantity().name()) " against the frequency of the force: " (names[0]) ", " (names[1]) ", " (names[2]) ". "
            @if curves.is_objective { (link("band.csv")) } @else { "Outside of the dotted line nothing was asked of the search." }
        }))
        (figure(&picture(findings, &curves, Curve::displacement(findings, &curves)), html! {
            "Largest displacement |x1| of the structure, from " (four(findings.study.window.t0.get())) " to "
            (four(findings.study.window.end.get())) " s of a run from rest."
        }))
    };
    ("response", "Response over frequency", vec![Block::Elements(body)])
}

fn words(findings: &Findings, compared: &Compared, curves: &Curves) -> Markup {
    let quantity = findings.quantity();
    let worst = |of: &Result<retune_optim::Evaluation, retune_optim::Unusable>| {
        of.as_ref().map_or_else(|_| "none".to_owned(), |of| amount(of.value, quantity))
    };
    let omega = findings.worst_omega();
    if curves.is_objective {
        return html! { p {
            "The objective is the worst over this band: " (worst(&compared.none)) " without a damper, " (worst(&compared.study))
            " with " (baseline(&findings.study.scene)) ", " (amount(findings.evaluation.value, quantity)) " with the tuned one, at " (frequency(omega)) "."
        } };
    }
    let top = curves.value.each_ref().map(|curve| Curves::largest(curve));
    html! { p {
        "The search looked at ω = " (frequency(omega)) " alone, and the band here is outside of its objective: ± " (100.0 * ABOUT)
        " % of the natural frequency about it, for the reader to see how sharp the tuning is. In this band the largest " (quantity.name()) " is "
        (amount(top[0], quantity)) " without a damper, " (amount(top[1], quantity)) " with " (baseline(&findings.study.scene)) ", and " (amount(top[2], quantity)) " with the tuned one."
    } }
}

fn picture(findings: &Findings, curves: &Curves, curve: Curve<'_>) -> Drawing {
    let Curve { name, label, unit, values, worst: [omega, worst] } = curve;
    let lines = lines(findings);
    let top = values.each_ref().map(|curve| Curves::largest(curve));
    let (high, low) = (
        top.into_iter().fold(0.0, f64::max),
        top.into_iter().filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min),
    );
    let log = high > SQUASHED * low;
    let range = (curves.omega.first().copied().unwrap_or(0.0), curves.omega.last().copied().unwrap_or(1.0));
    let y = if log {
        Axis::around(&*label, Scale::Log, values.iter().flatten().copied())
    } else {
        Axis::from_zero(&*label, [high])
    };
    let mut layers = Vec::new();
    if !curves.is_objective {
        layers.push(Layer::Upright { x: omega, stroke: Stroke::new(GREY, 1.0, Dash::Dots) });
    }
    for (curve, (_, stroke)) in values.iter().zip(lines) {
        let points = curves.omega.iter().copied().zip(curve.iter().copied());
        layers.push(Layer::line(points, stroke));
    }
    let mark = Mark { rim: true, ..Mark::new(Shape::Disc, VERMILION, 5.0) };
    layers.push(Layer::Marks { points: vec![(omega, worst)], mark });
    let mut legend: Vec<(Key, String)> =
        lines.iter().map(|(name, stroke)| (Key::Line(*stroke), (*name).to_owned())).collect();
    let what = if curves.is_objective { "worst" } else { "tuned for" };
    legend.push((Key::Mark(mark), format!("{what}: {} {unit} at {} rad/s", four(worst), four(omega))));
    let chart =
        Chart::of(Axis::linear("ω, rad/s", range).with_second("frequency, Hz", HERTZ), y, layers, 210.0);
    let peaks: Vec<String> =
        lines.iter().zip(top).map(|((line, _), top)| format!("{line} {} {unit}", four(top))).collect();
    drawing(&Sheet {
        description: format!(
            "{name} against ω from {} to {} rad/s on a {} scale. Highest points: {}.",
            four(range.0),
            four(range.1),
            if log { "logarithmic" } else { "linear" },
            peaks.join(", ")
        ),
        width: Width::Page,
        legend,
        ..Sheet::of(format!("{name} against the frequency of the force"), vec![chart])
    })
}

/// Half the width of the band about a single frequency, as a share of the natural frequency.
pub const ABOUT: f64 = 0.2;
/// Number of equal steps over the band.
const POINTS: i32 = 100;
/// Number of further frequencies on each side, each at half the distance of the one before from the single frequency.
const CLOSER: i32 = 10;

/// Curves of the three scenes of [`Findings::scenes`]. Values that are not finite are missing.
pub struct Curves {
    /// rad/s, ascending.
    pub omega: Vec<f64>,
    /// The minimised quantity, in its unit.
    pub value: [Vec<f64>; 3],
    /// The largest displacement |x1| of the structure in the window of a run, mm.
    pub displacement: [Vec<f64>; 3],
    /// Whether the objective covers all these frequencies, or a single one.
    pub is_objective: bool,
}

impl Curves {
    pub fn new(findings: &Findings) -> Self {
        let band = findings.band.as_ref().filter(|rows| !rows.is_empty());
        let (omega, value) = match band {
            Some(rows) => {
                let value = [0, 1, 2].map(|scene| rows.iter().map(|row| row.1[scene]).collect());
                (rows.iter().map(|row| row.0).collect(), value)
            }
            None => around_single(findings),
        };
        let displacement = displacements(findings, &omega);
        Self { omega, value, displacement, is_objective: band.is_some() }
    }

    /// The largest finite value of a curve; 0 without any.
    pub fn largest(curve: &[f64]) -> f64 {
        curve.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max)
    }
}

fn around_single(findings: &Findings) -> (Vec<f64>, [Vec<f64>; 3]) {
    let objective = findings.study.objective();
    let term = first(&objective).cloned().unwrap_or_default();
    // One run a frequency, of the nominal scene.
    let single = Objective { omega: None, ensemble: None, k1: None, restitution: None, ..term };
    let omega = frequencies(findings);
    let value = |(scene, omega): (Scene, f64)| {
        at(omega, scene).map_or(f64::NAN, |scene| term_value(findings.study, scene, &single))
    };
    let scenes = findings.scenes();
    let asked: Vec<(Scene, f64)> =
        scenes.iter().flat_map(|scene| omega.iter().map(|omega| (*scene, *omega))).collect();
    let found: Vec<f64> = asked.into_par_iter().map(value).collect();
    let of = |scene: usize| found[scene * omega.len()..(scene + 1) * omega.len()].to_vec();
    (omega.clone(), [of(0), of(1), of(2)])
}

/// The amplitude of the structure at each frequency, mm.
fn displacements(findings: &Findings, omega: &[f64]) -> [Vec<f64>; 3] {
    let (window, settings) = (findings.study.window.window(), findings.study.solver.settings());
    let ask = Ask { measure: Measure::Displacement, ..Ask::default() };
    let value = |scene: Scene, omega: f64| {
        let run = at(omega, scene).and_then(|scene| extremes(&scene, window, &settings, ask).ok());
        run.map_or(f64::NAN, |run| 1e3 * run.largest.value)
    };
    findings.scenes().map(|scene| omega.par_iter().map(|omega| value(scene, *omega)).collect())
}

fn frequencies(findings: &Findings) -> Vec<f64> {
    let middle = findings.worst_omega();
    let half = ABOUT * findings.worst.primary.natural_frequency();
    let even = (-POINTS / 2..=POINTS / 2).map(|i| 2.0 * f64::from(i) / f64::from(POINTS));
    let near = (1..=CLOSER).map(|i| 0.5_f64.powi(i)).flat_map(|share| [-share, share]);
    let mut all: Vec<f64> =
        even.chain(near).map(|share| middle + share * half).filter(|omega| *omega > 0.0).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
