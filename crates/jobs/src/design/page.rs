//! The page of a design: the answer, all candidates over the band or in the run, the damper to scale, the requirements.

use super::answer::{build, findings, is_reported, rows};
use super::candidate::{Candidate, What};
use super::comparison::Comparison;
use super::motion;
use super::requirements::{Constraint, Requirements};
use super::words::{asked, parameters, radians, sized, tuning};
use crate::pages::made_by;
use crate::tune::band::at;
use rayon::prelude::*;
use retune_model::{Bare, Coupled, Measure, NonNegative, PerMeasure, unit};
use retune_optim::Limit;
use retune_report::colour::{BLACK, BLUE, GREEN, GREY, VERMILION};
use retune_report::document::{Block, Document, Section};
use retune_report::{
    Axis, Chart, Dash, Drawing, Key, Layer, Mark, Scale, Shape, Sheet, Stand, Stroke, Width, drawing,
};
use retune_solver::{Also, Ask, extremes};
use retune_study::rounded;

pub(super) fn page(requirements: &Requirements, compared: &Comparison) -> Document {
    let transient = compared.none.is_transient();
    let names: Vec<&str> = compared.all().map(|of| of.what.name()).collect();
    let head: Vec<String> =
        std::iter::once(if transient { "largest" } else { "largest over the band, where" })
            .chain(names)
            .map(str::to_owned)
            .collect();
    let rows: Vec<Vec<String>> = rows(requirements, compared);
    let reported = |measure: &Measure| is_reported(requirements, compared, *measure);
    let meant = |measure: Measure| format!("{} is {}", measure.name().replace('_', " "), measure.words());
    let meaning: Vec<String> = compared.measures().filter(reported).map(meant).collect();
    let damper = |of: &Candidate| {
        let row = [of.what.name().to_owned(), parameters(of), tuning(of, requirements)];
        row.to_vec()
    };
    let answer = build(requirements, compared).into_iter().map(|line| Block::words(line.trim().to_owned()));
    let sure = findings(requirements, compared);
    let mut opening: Vec<Block> = answer.collect();
    opening.extend(asked(requirements).into_iter().map(Block::words));
    let limits: Vec<Vec<String>> = compared
        .costs
        .iter()
        .map(|cost| {
            let allowed = sized(requirements.allowed(cost.constraint), cost.constraint.unit());
            let value =
                |of: Option<&Candidate>| of.map_or("-".to_owned(), |of| sized(of.goal, compared.goal.unit()));
            let candidates =
                [Some(&compared.tmd), Some(&cost.tmd), compared.ssvi.as_ref(), cost.ssvi.as_ref()];
            [format!("{} at most {allowed}", cost.constraint.name())]
                .into_iter()
                .chain(candidates.map(value))
                .collect()
        })
        .collect();
    let mut compare = vec![
        Block::table(
            if transient {
                "The largest value of each quantity"
            } else {
                "The largest value of each quantity in the steady motion, and its frequency"
            },
            head,
            rows,
        ),
        Block::words(format!("{}.", meaning.join("; "))),
        Block::table(
            "The dampers",
            ["damper", "parameters", "alone, on a rigid support"],
            compared.dampers().map(damper).collect(),
        ),
    ];
    if !limits.is_empty() {
        let goal = compared.goal.name();
        let head = [
            "limit".to_owned(),
            format!("{goal} of the TMD"),
            "without it".to_owned(),
            format!("{goal} of the SSVI NES"),
            "without it".to_owned(),
        ];
        compare.push(Block::table("What each limit costs", head, limits));
    }
    let chosen = compared.chosen().unwrap_or(&compared.tmd);
    let kind = if chosen.what == What::Ssvi { "The SSVI NES in its cavity" } else { "The TMD" };
    Document {
        title: match compared.choice {
            Some(_) if compared.is_in_vain() => "Build no damper for this".to_owned(),
            Some(what) => format!("Build the {}", what.name()),
            None => "No damper was found that keeps the limits".to_owned(),
        },
        command: "retune design",
        opening,
        sections: vec![
            ("compare", "Comparison", compare),
            over(requirements, compared),
            (
                "damper",
                "The damper to scale",
                vec![Block::figure(
                    "damper.svg",
                    to_scale(chosen),
                    format!("{kind}: positions relative to the structure, in mm."),
                )],
            ),
            ("sure", "How sure, and what limits cost", vec![Block::List(sure)]),
            ("files", "Files", vec![Block::files(&["comparison.csv", "design.json", "answer.txt"])]),
        ],
    }
}

/// The candidates over the band, or their motions under a shock or a record.
fn over(requirements: &Requirements, compared: &Comparison) -> Section {
    let Some(band) = requirements.driving.band() else {
        let words = "The displacement of the structure with each candidate, from rest on.";
        let figure = Block::figure("motion.svg", motion::picture(compared, line), words);
        return ("motion", "The motion", vec![figure]);
    };
    let limited = Measure::ALL.into_iter().any(|measure| requirements.is_limited(measure));
    let grey = if limited { " Grey: what a limit forbids." } else { "" };
    let off = requirements.k1_error.map_or("", |_| ", the largest for every k1 that there may be");
    let words = format!("Each quantity against frequency, once the motion is steady{off}.{grey}");
    let figure = Block::figure("band.svg", curves(requirements, compared, band), words);
    ("band", "Over the band", vec![figure])
}

/// Number of frequencies of a curve in closed form, and of one from runs.
const FINE: usize = 401;
const RUNS: usize = 101;

const fn line(what: What) -> Stroke {
    match what {
        What::None => Stroke::new(BLACK, 0.9, Dash::Short),
        What::Tmd => Stroke::solid(BLUE),
        What::Ssvi => Stroke::new(VERMILION, 1.1, Dash::Long),
    }
}

/// A frequency, rad/s, and the quantities there, in SI units.
type Curve = Vec<(f64, PerMeasure<f64>)>;

/// Every quantity of a candidate in steady motion at frequencies of the band, rad/s, including those of its largest values; the largest
/// over all k1. NaN where a run fails.
fn curve(of: &Candidate, [from, to]: [f64; 2]) -> Curve {
    let study = &of.study;
    let closed = study.goal().objective.is_steady();
    let points = if closed { FINE } else { RUNS };
    let even = (0..points).map(|i| from + (to - from) * i as f64 / (points - 1) as f64);
    let peaks = Measure::ALL.into_iter().map(|measure| of.steady.get(measure).omega);
    let mut all: Vec<f64> = even.chain(peaks.filter(|omega| (from..=to).contains(omega))).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let nominal = || vec![study.scene.primary.stiffness.get()];
    let stiffnesses = study.objective().k1.map_or_else(nominal, |k1| k1.samples());
    let none = PerMeasure::all(f64::NAN);
    let value = |omega: f64, k1: f64| {
        let Some(mut scene) = at(omega, study.scene) else { return none };
        let Ok(stiffness) = NonNegative::new(k1) else { return none };
        scene.primary.stiffness = stiffness;
        if closed {
            let bare = Bare::new(&scene.primary, &scene.forcing);
            let steady = scene.damper.map_or_else(
                || bare.steady(omega),
                |damper| Coupled::new(&scene.primary, &scene.forcing, &damper).steady(omega),
            );
            return PerMeasure(Measure::OF_RUN.map(|measure| steady.largest(&bare, omega, measure)));
        }
        let window = study.window.window();
        let also = Some(Also { measures: PerMeasure::EVERY, from: window.from });
        let run = extremes(&scene, window, &study.solver.settings(), Ask { also, ..Ask::default() });
        run.map_or(none, |run| run.reached)
    };
    let most = |omega: f64| {
        let values = stiffnesses.iter().map(|k1| value(omega, *k1));
        (omega, values.reduce(PerMeasure::max).unwrap_or(none))
    };
    all.into_par_iter().map(most).collect()
}

fn curves(requirements: &Requirements, compared: &Comparison, band: [f64; 2]) -> Drawing {
    let size = radians(requirements.frequencies);
    let curves: Vec<(What, Curve)> = compared.all().map(|of| (of.what, curve(of, band))).collect();
    let ends = band.map(|end| end / size);
    let strikes = compared.dampers().any(Candidate::strikes);
    let shown = Measure::ALL.into_iter().filter(|measure| !measure.is_of_walls() || strikes);
    let chart = |measure: Measure| {
        let all: Vec<f64> = curves
            .iter()
            .flat_map(|(_, points)| points.iter().map(|(_, values)| values.get(measure)))
            .collect();
        let largest = all.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
        let (name, number) = unit::readable(largest, measure.unit());
        let scale = if number == 0.0 { 1.0 } else { number / largest };
        let scaled: Vec<f64> = all.iter().map(|value| scale * value).filter(|value| *value > 0.0).collect();
        let label = format!("{}, {name}", measure.name().replace('_', " "));
        // Quantities of the walls are zero without contact, so their axis is linear.
        let of_walls = measure.is_of_walls();
        let y =
            if of_walls { Axis::from_zero(label, scaled) } else { Axis::around(label, Scale::Log, scaled) };
        let allowed = requirements.allowed(Constraint::Of(Limit::Of(measure)));
        let mut layers = Vec::new();
        if allowed.is_finite() {
            layers.push(Layer::Band {
                x: (f64::NEG_INFINITY, f64::INFINITY),
                y: (scale * allowed, f64::INFINITY),
                colour: GREY,
                opacity: 0.25,
            });
        }
        for (what, points) in &curves {
            let points = points.iter().map(|(omega, values)| (omega / size, scale * values.get(measure)));
            layers.push(Layer::line(points.filter(|(_, value)| of_walls || *value > 0.0), line(*what)));
        }
        Chart::of(
            Axis::linear(format!("frequency, {}", requirements.frequencies), (ends[0], ends[1])),
            y,
            layers,
            130.0,
        )
    };
    let charts: Vec<Chart> = shown.map(chart).collect();
    let legend = compared.all().map(|of| (Key::Line(line(of.what)), of.what.name().to_owned())).collect();
    let sheet = Sheet::of("All candidates over the band", charts);
    let description =
        "Each quantity against the frequency of the forcing, for the structure alone and with each damper."
            .to_owned();
    drawing(&Sheet {
        description,
        width: Width::Page,
        columns: 2,
        legend,
        caption: vec![made_by(None)],
        ..sheet
    })
}

const MM: f64 = 1e3;

fn to_scale(of: &Candidate) -> Drawing {
    let stroke = MM * of.value(Measure::Stroke);
    let begin = MM * of.most().get(Measure::Stroke).value;
    // Under a shock or record the whole run: motion before values count needs room, too.
    let most = if of.is_transient() { of.most() } else { &of.steady };
    let motion = MM * most.get(Measure::Displacement).value;
    let walls = of
        .damper()
        .filter(|damper| damper.contact.is_some())
        .map(|damper| [-MM * damper.rest_distance.get(), MM * damper.clearance.get()]);
    // Relative to the damper at rest; a wall far out of reach is not drawn.
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
    // The rest position, interrupted where there is text.
    for (from, to) in [(0.75, 1.4), (1.75, 2.4), (2.8, 3.0)] {
        layers.push(Layer::line([(0.0, from), (0.0, to)], Stroke::new(BLACK, 0.7, Dash::Dots)));
    }
    layers.push(Layer::Marks { points: vec![(0.0, 2.1)], mark: Mark::new(Shape::Square, BLACK, 5.0) });
    let y = Axis::of_names((0.0, 3.0), vec![(2.1, "damper".to_owned()), (1.1, "structure".to_owned())]);
    let chart = Chart::of(Axis::linear("distance from rest, mm", (ends[0], ends[1])), y, layers, 150.0);
    let sheet = Sheet::of("The damper to scale", vec![chart]);
    let description =
        format!("Stroke ± {} mm, the structure moves by ± {} mm.", rounded(stroke, 4), rounded(motion, 4));
    drawing(&Sheet { description, width: Width::Page, ..sheet })
}
