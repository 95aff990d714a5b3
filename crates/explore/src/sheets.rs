//! The page's figures as SVG files, in the style of all results.

use crate::forcing::{curve, forced};
use crate::refused::Refused;
use crate::response::{CURVES, Curve, Stale, allowed, bare, parts};
use crate::thin::Thin;
use retune_jobs::amount::{self, measured};
use retune_jobs::summary::MadeBy;
use retune_model::Measure;
use retune_report::colour::{BLACK, BLUE, GREEN, GREY, PURPLE, VERMILION};
use retune_report::{Axis, Chart, Dash, Key, Layer, Scale, Sheet, Stroke, Width};
use retune_solver::Window;
use retune_study::{Study, design_words, hertz_and_rpm};

/// Columns that the curves of the motion are thinned to.
const COLUMNS: usize = 900;
/// Opacity of the area that a limit forbids.
const FORBIDDEN: f64 = 0.25;
/// A limit is drawn if it is at most this many times the largest value.
const NEAR: f64 = 3.0;
const NOW: Stroke = Stroke::new(VERMILION, 1.2, Dash::Solid);
const NONE: Stroke = Stroke::new(BLACK, 1.1, Dash::Short);
const PINNED: [(&str, Stroke); 2] =
    [("A", Stroke::new(BLUE, 1.1, Dash::Solid)), ("B", Stroke::new(GREEN, 1.1, Dash::Solid))];

/// The motion in the window: displacement, relative displacement with the walls, E1, contact forces.
///
/// # Errors
/// The run fails.
pub fn motion(study: &Study) -> Result<Sheet, Refused> {
    let Window { from, to } = study.window.window();
    let (series, _) = crate::motion::series(study, [from, to], COLUMNS)?;
    let points = |column: usize| -> Vec<(f64, f64)> {
        series.t.iter().copied().zip(series.columns[column].iter().copied()).collect()
    };
    let line = |column, colour| Layer::Line {
        points: points(column),
        stroke: Stroke::new(colour, 0.8, Dash::Solid),
    };
    let chart = |label: &str, lines: &[(usize, &'static str)], height: f64| {
        let values = lines.iter().flat_map(|(column, _)| series.columns[*column].iter().copied());
        Chart {
            title: String::new(),
            x: Axis::linear("t, s", (from, to)),
            y: Axis::around(label, Scale::Linear, values),
            layers: lines.iter().map(|(column, colour)| line(*column, colour)).collect(),
            height,
        }
    };
    let mut charts = vec![chart("x1, m", &[(0, BLUE)], 90.0)];
    if study.scene.damper.is_some() {
        charts.push(chart("x2 - x1, m", &[(1, VERMILION)], 90.0));
    }
    charts.push(chart("E1, J", &[(2, BLUE)], 90.0));
    if study.scene.damper.is_some_and(|damper| damper.contact.is_some()) {
        charts.push(chart("contact force, N", &[(3, VERMILION), (4, PURPLE)], 90.0));
    }
    if let Some(forcing) = forced(&study.scene.forcing) {
        let label = ["name", "unit"].map(|field| forcing[field].as_str().unwrap_or_default().to_owned());
        let Thin { t, columns: [values] } = curve(&study.scene.forcing, [from, to], COLUMNS);
        let y = Axis::around(label.join(", "), Scale::Linear, values.iter().copied());
        let line = Layer::line(t.into_iter().zip(values), Stroke::new(GREY, 0.8, Dash::Solid));
        charts.push(Chart::of(Axis::linear("t, s", (from, to)), y, vec![line], 90.0));
    }
    if let Some(last) = charts.last_mut() {
        last.height = 115.0; // includes the numbers of the abscissa
    }
    Ok(Sheet {
        title: "Motion".to_owned(),
        description: format!(
            "Displacement, energy, contact forces and what moves the structure over time. {}",
            words(study)
        ),
        width: Width::Page,
        charts,
        columns: 1,
        stacked: true,
        legend: Vec::new(),
        caption: vec![words(study), MadeBy::new(study).to_string()],
    })
}

/// The response over the band, without a damper, and of the pinned designs A and B.
///
/// # Errors
/// The work has become stale.
pub fn response(
    study: &Study,
    pins: &[Option<Study>; 2],
    quantity: Measure,
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<Sheet, Stale> {
    let pins: Vec<((&str, Stroke), &Study)> =
        PINNED.into_iter().zip(pins).filter_map(|(name, pin)| Some((name, pin.as_ref()?))).collect();
    let mut shown = vec![(NONE, "no damper".to_owned(), bare(study))];
    shown.extend(pins.iter().map(|((name, stroke), pin)| (*stroke, (*name).to_owned(), (*pin).clone())));
    shown.push((NOW, "this damper".to_owned(), study.clone()));
    shown.retain(|(.., study)| Curve::of(study, quantity).is_there());
    let curve = |study: &Study| -> Result<Vec<(f64, f64)>, Stale> {
        let [omega, values] = Curve::of(study, quantity).over(CURVES[1], is_stale)?;
        Ok(omega.into_iter().zip(values).collect())
    };
    let curves =
        shown.iter().map(|(_, _, study)| curve(study)).collect::<Result<Vec<Vec<(f64, f64)>>, Stale>>()?;
    let top =
        curves.iter().flatten().map(|point| point.1).filter(|value| value.is_finite()).fold(0.0, f64::max);
    let lines =
        shown.iter().zip(curves).map(|((stroke, ..), points)| Layer::Line { points, stroke: *stroke });
    let cursor =
        Layer::Upright { x: study.scene.forcing.frequency.get(), stroke: Stroke::new(GREY, 0.8, Dash::Dots) };
    let band = crate::response::band(study);
    let name = quantity.name();
    let limit = allowed(study, quantity);
    let forbidden = limit.map(forbidden);
    let designs = pins.iter().map(|((name, _), pin)| format!("{name}: {}", words(pin)));
    let lines_of = shown.iter().map(|(stroke, words, _)| (Key::Line(*stroke), words.clone()));
    let of_limit = limit
        .map(|limit| (Key::Area(GREY, FORBIDDEN), format!("above the limit, {}", measured(limit, quantity))));
    let legend = lines_of.chain(of_limit).collect();
    let caption = [covered(study, quantity), words(study)]
        .into_iter()
        .chain(designs)
        .chain([MadeBy::new(study).to_string()]);
    Ok(Sheet {
        title: format!("{name} over frequency"),
        description: format!("{name} over the band, with the damper and without. {}", words(study)),
        width: Width::Column,
        charts: vec![Chart {
            title: String::new(),
            x: Axis::linear("ω, rad/s", (band.from, band.to))
                .with_second("frequency, Hz", hertz_and_rpm(1.0)[0]),
            y: Axis::linear(amount::label(quantity), (0.0, height(top, limit))),
            layers: forbidden.into_iter().chain(lines).chain([cursor]).collect(),
            height: 180.0,
        }],
        columns: 1,
        stacked: false,
        legend,
        caption: caption.collect(),
    })
}

/// The area that a limit forbids.
fn forbidden(limit: f64) -> Layer {
    let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
    Layer::Band { x: everywhere, y: (limit, f64::INFINITY), colour: GREY, opacity: FORBIDDEN }
}

/// The upper end of the ordinate: shows the largest value, and a limit not far above it.
fn height(top: f64, limit: Option<f64>) -> f64 {
    let near = limit.filter(|limit| *limit < NEAR * top).unwrap_or(0.0);
    if top > 0.0 { 1.06 * top.max(near) } else { 1.0 }
}

/// Describes what the curves show and what the limit covers.
fn covered(study: &Study, quantity: Measure) -> String {
    let [own, limited] = parts(study, quantity);
    let limit = allowed(study, quantity).map_or(String::new(), |_| format!("; the limit is on it {limited}"));
    let words = quantity.words();
    let words = words.strip_prefix("the ").unwrap_or(words);
    format!("The {words}, {own}{limit}.")
}

/// The damper in words.
pub fn words(study: &Study) -> String {
    match study.scene.damper {
        None => "No damper.".to_owned(),
        Some(damper) => format!("{}.", design_words(&retune_model::Design::of(&damper), 4)),
    }
}
