//! Time saved by the smallest exact model of a scene against the full contact model, with equal results.

use crate::Any;
use crate::records::{Record, number, records};
use crate::runs::timed;
use crate::scenes::{Case, Numbers, SSVI, TMD};
use retune_model::{Coupled, Scene};
use retune_report::colour::{BLUE, Colour, VERMILION};
use retune_report::{Axis, Chart, Key, Layer, Sheet, Stand, Width, svg};
use retune_solver::observe::{PrimaryEnergy, RunningMaximum, Unobserved};
use retune_solver::{Hybrid, Motion, Phase, SceneKind, Settings, Window, e1_max, simulate};
use std::fs;
use std::path::Path;

/// Cost of a scene under the smallest exact model and under the full contact model.
pub struct Saving {
    pub label: String,
    /// The smallest exact model, in words.
    pub model: String,
    /// Times, s: smallest, full.
    pub seconds: [f64; 2],
    /// E1max, J: smallest, full.
    pub e1_max: [f64; 2],
}

/// The scenes of the comparison over their whole runs, and four over the window of the paper's studies, after the transient.
fn subjects(cases: &[Case]) -> Vec<(&'static str, Scene, Window)> {
    let late = [
        ("no damper, 50 to 100 s", TMD.bare_scene()),
        ("TMD, 50 to 100 s", TMD.scene()),
        ("damper out of reach, 50 to 100 s", Numbers { d: 5.0, c: 5.0, ..SSVI }.scene()),
        ("SSVI, two-sided, 50 to 100 s", SSVI.scene()),
    ];
    let late = late.map(|(label, scene)| (label, scene, Window { from: 50.0, to: 100.0 }));
    cases.iter().map(|c| (c.label, c.scene, Window { from: 0.0, to: c.to })).chain(late).collect()
}

/// Measures the savings. The full model of the bare structure has a damper without spring and dashpot, out of reach of both walls.
pub fn savings(cases: &[Case]) -> Any<Vec<Saving>> {
    let free = Numbers { k2: 0.0, c2: 0.0, d: 1e3, c: 1e3, ..TMD }.damper();
    let settings = Settings::default();
    let measure = |(label, scene, window): (&'static str, Scene, Window)| -> Any<Saving> {
        let smallest = || e1_max(&scene, window, &settings, f64::INFINITY);
        let damper = scene.damper.unwrap_or(free);
        let full = || {
            let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
            let mut peak = RunningMaximum::new(PrimaryEnergy::new(&system), f64::INFINITY);
            let start = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
            let mut hybrid = Hybrid::new(&system, settings.rtol, window.to, settings.max_steps);
            let begin = if window.from > 0.0 {
                hybrid.propagate(start, window.from, &mut Unobserved)?
            } else {
                start
            };
            hybrid.propagate(begin, window.to, &mut peak).map(|_| peak.record())
        };
        let model = match simulate(&scene, window, &settings)?.scene {
            SceneKind::Bare => "one degree of freedom, closed form",
            SceneKind::Linear => "two degrees of freedom, closed form",
            SceneKind::Contact => "needs the contact model",
        };
        Ok(Saving {
            label: label.to_owned(),
            model: model.to_owned(),
            e1_max: [smallest()?.value, full()?.value],
            seconds: [timed(smallest).least, timed(full).least],
        })
    };
    subjects(cases).into_iter().map(measure).collect()
}

/// The table.
pub fn csv(savings: &[Saving]) -> String {
    let line = |s: &Saving| {
        let [seconds, e1_max] = [s.seconds.map(|t| format!("{t:.3e}")), s.e1_max.map(|e| format!("{e:?}"))];
        let texts = [&s.label, &s.model].map(|text| text.replace(',', ";"));
        format!("{},{},{}\n", texts.join(","), seconds.join(","), e1_max.join(","))
    };
    let rows: String = savings.iter().map(line).collect();
    format!("scene,model,seconds,seconds_of_full_model,E1max,E1max_of_full_model\n{rows}")
}

/// Reads a table written by [`csv`].
pub fn parse(table: &str) -> Vec<Saving> {
    let of = |row: &Record<'_>| {
        let pair = |name: &str| [number(row, name), number(row, &format!("{name}_of_full_model"))];
        let text = |name: &str| row[name].replace(';', ",");
        Saving { label: text("scene"), model: text("model"), seconds: pair("seconds"), e1_max: pair("E1max") }
    };
    records(table).iter().map(of).collect()
}

/// Time of each scene under the smallest exact model and under the full one.
pub fn chart(path: &Path, savings: &[Saving]) -> Any<()> {
    const COLOURS: [Colour; 2] = [VERMILION, BLUE];
    let longest = 1e6 * savings.iter().flat_map(|s| s.seconds).fold(0.0, f64::max);
    let mut layers = Vec::new();
    for (i, s) in savings.iter().enumerate() {
        for (j, (seconds, model)) in
            s.seconds.into_iter().zip([s.model.as_str(), "full contact model"]).enumerate()
        {
            let (time, middle) = (1e6 * seconds, -(i as f64) + 0.2 - 0.4 * j as f64);
            let y = (middle - 0.17, middle + 0.17);
            layers.push(Layer::Band { x: (0.0, time), y, colour: COLOURS[j], opacity: 1.0 });
            let at = (time + 0.015 * longest, middle);
            layers.push(Layer::Text { at, text: format!("{time:.1}  {model}"), stand: Stand::Right });
        }
    }
    let names = savings.iter().enumerate().map(|(i, s)| (-(i as f64), s.label.clone())).collect();
    let count = savings.len() as f64;
    let chart = Chart {
        title: String::new(),
        x: Axis::linear("time of one E1max, µs", (0.0, 1.9 * longest)),
        y: Axis::of_names((0.5 - count, 0.5), names),
        layers,
        height: 30.0 + 24.0 * count,
    };
    let key = |j: usize, words: &str| (Key::Area(COLOURS[j], 1.0), words.to_owned());
    fs::write(
        path,
        svg(&Sheet {
            title: "Time of one E1max: the smallest model that is exact, and the full contact model"
                .to_owned(),
            description: "Two bars for each scene, with the time in microseconds.".to_owned(),
            width: Width::Page,
            charts: vec![chart],
            columns: 1,
            stacked: false,
            legend: vec![key(0, "the smallest model that is exact"), key(1, "the full contact model")],
            caption: Vec::new(),
        }),
    )?;
    Ok(())
}
