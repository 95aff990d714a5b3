//! The band of a tuned damper: the objective against ω without a damper, with the damper of the study, and with the tuned one.

use super::log::BAND;
use crate::Error;
use crate::amount::{self, measured};
use crate::summary::{MadeBy, baseline};
use rayon::prelude::*;
use retune_model::{Measure, NonNegative, Scene};
use retune_optim::{Band, Goal, Objective, Response};
use retune_report::colour::{BLACK, BLUE, VERMILION};
use retune_report::table::{Cell, Column, Table};
use retune_report::{Axis, Chart, Dash, Key, Layer, Sheet, Stroke, svg};
use retune_store::Directory;
use retune_study::{Study, short};

/// Number of frequencies of the curves if each is a closed form.
const FINE: usize = 601;
/// Factor on the number of the search's samples if each frequency is a run.
const FINER: usize = 4;

/// A frequency, rad/s, and the quantity without a damper, with the study's damper and with the tuned one; NaN where there is no value.
pub(crate) type Rows = Vec<(f64, [f64; 3])>;

/// The scenes of every comparison, in the order of `band.csv`: no damper, the study's damper, the tuned damper.
pub(crate) fn compared(study: &Study, tuned: Scene) -> [Scene; 3] {
    [Scene { damper: None, ..tuned }, study.scene, tuned]
}

/// Writes `band.csv` and `band.svg`, and returns their rows, if the objective has a band; `tuned` is the scene with the tuned damper.
/// Missing values (a steady motion that reaches a wall, a run that fails) are empty fields and gaps.
pub(super) fn write(study: &Study, tuned: Scene, results: &Directory) -> Result<Option<Rows>, Error> {
    let objective = study.objective();
    let Some((term, band)) = first(&objective).and_then(|term| Some((term, term.omega?.of(&tuned.primary))))
    else {
        return Ok(None);
    };
    let samples = if term.response == Response::Steady {
        FINE.max(band.samples)
    } else {
        FINER * (band.samples - 1) + 1
    };
    let fine = Band { samples, ..band };
    let scenes = compared(study, tuned);
    let worst = scenes.map(|scene| term_value(study, scene, term));
    let single = Objective { omega: None, ..term.clone() };
    let rows: Rows = (0..samples)
        .into_par_iter()
        .map(|i| {
            let omega = fine.at(i);
            let term_value =
                |scene| at(omega, scene).map_or(f64::NAN, |scene| term_value(study, scene, &single));
            (omega, scenes.map(term_value))
        })
        .collect();

    let unit = study.quantity().unit();
    let values = columns(study.quantity()).map(|name| Column::new(name, unit));
    let mut table = Table::new([Column::new("omega", "rad/s")].into_iter().chain(values));
    for (omega, values) in &rows {
        table.push([Cell::Number(*omega)].into_iter().chain(values.map(Cell::finite)).collect());
    }
    results.write(BAND, &table.csv())?;
    results.write("band.svg", &picture(study, &rows, worst))?;
    Ok(Some(rows))
}

pub(crate) fn columns(quantity: Measure) -> [String; 3] {
    ["none", "study", "tuned"].map(|of| format!("{}_{of}", quantity.name()))
}

/// The scene at another frequency, rad/s.
pub(crate) fn at(omega: f64, mut scene: Scene) -> Option<Scene> {
    scene.forcing.frequency = NonNegative::new(omega).ok()?;
    Some(scene)
}

/// The value of a term for a scene, regardless of limits; NaN if it cannot be computed.
pub(crate) fn term_value(study: &Study, scene: Scene, term: &Objective) -> f64 {
    let goal = Goal { objective: term.clone(), ..study.window.window().into() };
    let value = goal.evaluate(&scene, &study.solver.settings(), f64::INFINITY);
    value.map_or(f64::NAN, |found| found.value)
}

pub(crate) fn first(objective: &Objective) -> Option<&Objective> {
    objective.terms().first().map(|(_, term)| *term)
}

/// The quantity of a scene at the scene's frequency, as in `band.csv`; NaN if it has none.
pub fn at_own_frequency(study: &Study, scene: Scene) -> f64 {
    let objective = study.objective();
    first(&objective)
        .map_or(f64::NAN, |term| term_value(study, scene, &Objective { omega: None, ..term.clone() }))
}

/// Whether the objective covers frequencies that are not drawn: with several k1 and a relative band each k1 has its own band, and the
/// figure shows only one.
fn covers_more_than_drawn(term: &Objective) -> bool {
    term.k1.is_some() && term.omega.is_some_and(|band| band.relative)
}

/// The largest value of a curve; NaN where it has none.
fn drawn(rows: &[(f64, [f64; 3])], curve: usize) -> f64 {
    rows.iter().map(|row| row.1[curve]).filter(|value| value.is_finite()).fold(f64::NAN, f64::max)
}

fn picture(study: &Study, rows: &[(f64, [f64; 3])], worst: [f64; 3]) -> String {
    let lines: [(&str, Stroke); 3] = [
        ("no damper", Stroke::new(BLACK, 1.1, Dash::Short)),
        (baseline(&study.scene), Stroke::new(BLUE, 1.1, Dash::Long)),
        ("tuned for the band", Stroke::new(VERMILION, 1.3, Dash::Solid)),
    ];
    let quantity = study.quantity();
    let name = quantity.name();
    let largest = |value: f64| match value.is_finite() {
        true => format!(": {}", measured(value, quantity)),
        false => String::new(),
    };
    let all = |of: [f64; 3]| -> Vec<String> {
        (0..3).map(|i| format!("{}{}", lines[i].0, largest(of[i]))).collect()
    };
    let objective = study.objective();
    let is_beyond = first(&objective).is_some_and(covers_more_than_drawn);
    let mut caption = vec![MadeBy::new(study).to_string()];
    if is_beyond {
        let worst = all(worst).join("; ");
        caption.insert(
            0,
            format!(
                "Each curve is named with its largest value here. Over every k1, each over its own band: {worst}."
            ),
        );
    }
    let words = all(if is_beyond { [0, 1, 2].map(|i| drawn(rows, i)) } else { worst });
    let layers = lines.iter().enumerate().map(|(i, &(_, stroke))| {
        let points = rows.iter().map(|(omega, energies)| (*omega, energies[i]));
        Layer::line(points, stroke)
    });
    let (first, last) = (rows[0].0, rows[rows.len() - 1].0);
    let chart = Chart::of(
        Axis::linear("ω, rad/s", (first, last)),
        Axis::from_zero(amount::label(quantity), rows.iter().flat_map(|row| row.1)),
        layers.collect(),
        160.0,
    );
    svg(&Sheet {
        description: format!(
            "{name} against ω from {} to {} rad/s. The worst of each curve: {}.",
            short(first),
            short(last),
            words.join("; ")
        ),
        legend: lines.iter().map(|(_, stroke)| Key::Line(*stroke)).zip(words).collect(),
        caption,
        ..Sheet::of(format!("{name} over the band"), vec![chart])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's damper peaks at 850 J where it is drawn and at 1051 J with another k1 beyond: the legend names what is drawn.
    #[test]
    fn regress_the_legend_names_what_is_drawn() {
        let study = |relative: bool| {
            let text = format!(
                r#"{{ "scene": {{ "primary": {{ "m1": 1000, "c1": 452, "k1": 39500 }}, "forcing": {{ "P": 800, "omega": 6.28 }},
                    "damper": {{ "m2": 60, "k2": 215, "c2": 232 }} }}, "window": {{ "t0": 50, "T": 100 }},
                    "optimize": {{ "vary": ["k2", "c2"], "objective": {{ "omega": {{ "from": {}, "to": {}, "samples": 9, "relative": {relative} }},
                    "k1": {{ "set": [20000, 39500] }}, "response": "steady" }} }} }}"#,
                if relative { "0.8" } else { "5" },
                if relative { "1.25" } else { "8" },
            );
            retune_study::read::from_text(&text, "robust.json").expect("a study")
        };
        let rows = [(5.0, [400.0, 300.0, f64::NAN]), (6.0, [1500.0, 850.0, f64::NAN])];
        let page = |relative| picture(&study(relative), &rows, [1570.0, 1051.0, f64::NAN]);
        // The words of a figure, whatever lines they stand on.
        let plain = |text: &str| {
            let parts = text.split('<').map(|part| part.split_once('>').map_or(part, |(_, words)| words));
            parts.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
        };
        let (own, one) = (plain(&page(true)), plain(&page(false)));
        assert!(own.contains(": 850 J") && own.contains("Over every k 1") && own.contains("1051 J"), "{own}");
        assert!(one.contains(": 1051 J") && !one.contains("850 J") && !one.contains("Over every k"), "{one}");
    }
}
