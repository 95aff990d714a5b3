//! The objective: how E1max, and the optimum that fminsearch reports, change with the tolerance and with ±0.1 % of the
//! parameters about Table 2's SSVI.

use crate::panel::{Line, WIDTHS, panel, sheet};
use crate::runs::settings;
use crate::scenes::{Numbers, SSVI};
use crate::{Any, decades};
use rayon::prelude::*;
use retune_optim::{DesignObjective, Minimum, Options, Parameter, minimize};
use retune_report::colour::{BLACK, BLUE, VERMILION};
use retune_report::{Axis, Shape};
use retune_solver::{Contacts, Method, Settings, Window, e1_max};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

/// The window of the paper's studies.
const WINDOW: Window = Window { from: 50.0, to: 100.0 };
/// Table 2's design: k2, c2, D, C.
const DESIGN: [f64; 4] = [SSVI.k2, SSVI.c2, SSVI.d, SSVI.c];

fn located(method: Method, rtol: f64) -> Settings {
    settings(method, Contacts::Located, rtol)
}

fn stepped(method: Method, rtol: f64) -> Settings {
    settings(method, Contacts::Stepped, rtol)
}

/// The optimum that fminsearch finds with these settings from a start.
fn optimum(settings: Settings, start: &[f64; 4]) -> Any<Minimum> {
    let varied = Parameter::PAPER.to_vec();
    let objective = DesignObjective::new(SSVI.scene(), SSVI.damper(), varied, WINDOW, settings);
    let value = |x: &[f64], cutoff: f64| objective.value(x, cutoff);
    Ok(minimize(value, start, Options::default(), |_| ControlFlow::Continue(()))?)
}

/// E1max over the whole run (0 to 100 s) and over the window (50 to 100 s), J.
fn both(numbers: Numbers, settings: &Settings) -> Any<[f64; 2]> {
    let whole = Window { from: 0.0, ..WINDOW };
    let of = |window| e1_max(&numbers.scene(), window, settings, f64::INFINITY);
    Ok([of(whole)?.value, of(WINDOW)?.value])
}

/// Table 2's SSVI with parameters changed by factors.
fn changed(factors: [f64; 4]) -> Numbers {
    let [k2, c2, d, c] = std::array::from_fn(|i| DESIGN[i] * factors[i]);
    Numbers { k2, c2, d, c, ..SSVI }
}

/// Settings that are compared, loosest first.
fn compared() -> Vec<(String, Settings)> {
    let hybrid = |rtol: f64| (format!("hybrid,{rtol:e}"), located(Method::Hybrid, rtol));
    let ode45 = |rtol: f64| (format!("ode45 stepped,{rtol:e}"), stepped(Method::Ode45, rtol));
    let ode23s = |rtol: f64| (format!("ode23s stepped,{rtol:e}"), stepped(Method::Ode23s, rtol));
    let (a, b, c) = (decades(2, 12), decades(3, 10), decades(3, 7));
    a.into_iter().map(hybrid).chain(b.into_iter().map(ode45)).chain(c.into_iter().map(ode23s)).collect()
}

/// The table of E1max, the table of optima, and the chart.
pub fn tables(chart: &Path) -> Any<[String; 2]> {
    let mut values = String::from("what,rtol,E1max_0_100_s_J,E1max_50_100_s_J\n");
    let mut lines: [Vec<(f64, f64)>; 3] = Default::default();
    let [truth, _] = both(SSVI, &located(Method::Hybrid, 1e-13))?;
    for (name, settings) in compared() {
        let [whole, window] = both(SSVI, &settings)?;
        writeln!(values, "{name},{whole:.8},{window:.8}")?;
        let line = match settings.method {
            Method::Hybrid => 2,
            Method::Ode23s => 1,
            _ => 0,
        };
        lines[line].push((settings.rtol, (whole - truth).abs().max(1e-12)));
    }
    let tight = located(Method::Hybrid, 1e-11);
    for (i, variable) in Parameter::PAPER.into_iter().enumerate() {
        for change in [-1e-3, 1e-3] {
            let mut factors = [1.0; 4];
            factors[i] += change;
            let [whole, window] = both(changed(factors), &tight)?;
            writeln!(values, "{variable} {:+.1} %,1e-11,{whole:.8},{window:.8}", 100.0 * change)?;
        }
    }
    let corner =
        |k: i32| changed(std::array::from_fn(|i| 1.0 + 1e-3 * f64::from(k / 3_i32.pow(i as u32) % 3 - 1)));
    let all = (0..81).map(|k| both(corner(k), &tight)).collect::<Result<Vec<_>, _>>()?;
    for (name, pick) in [("least", f64::min as fn(f64, f64) -> f64), ("largest", f64::max)] {
        let [a, b] = [0, 1].map(|i| all.iter().map(|v| v[i]).reduce(pick).unwrap_or(f64::NAN));
        writeln!(values, "{name} of 81 points within 0.1 %,1e-11,{a:.8},{b:.8}")?;
    }
    draw(chart, lines)?;
    Ok([values, optima()?])
}

/// The optima that fminsearch reports, and their energies under the tightest settings.
fn optima() -> Any<String> {
    let mut runs: Vec<(String, Settings, [f64; 4])> = Vec::new();
    for rtol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12] {
        runs.push((format!("hybrid {rtol:e}"), located(Method::Hybrid, rtol), DESIGN));
    }
    for rtol in [1e-3, 1e-4] {
        runs.push((format!("ode23s stepped {rtol:e}"), stepped(Method::Ode23s, rtol), DESIGN));
    }
    for (i, variable) in Parameter::PAPER.into_iter().enumerate() {
        for change in [-1e-3, 1e-3] {
            let mut start = DESIGN;
            start[i] *= 1.0 + change;
            let name = format!("hybrid 1e-10; start with {variable} {:+.1} %", 100.0 * change);
            runs.push((name, located(Method::Hybrid, 1e-10), start));
        }
    }
    let judge = |(name, settings, start): &(String, Settings, [f64; 4])| -> Result<String, String> {
        let best = optimum(*settings, start).map_err(|e| e.to_string())?;
        let [k2, c2, d, c] = best.x[..].try_into().map_err(|_| "four parameters")?;
        let worth = both(Numbers { k2, c2, d, c, ..SSVI }, &located(Method::Hybrid, 1e-12))
            .map_err(|e| e.to_string())?[1];
        let stop = format!("{:?}", best.stop);
        Ok(format!(
            "{name},{k2:.6},{c2:.6},{d:.8},{c:.8},{:.6},{worth:.6},{},{stop}\n",
            best.value, best.func_count
        ))
    };
    let lines = runs.par_iter().map(judge).collect::<Result<Vec<_>, _>>()?;
    Ok(String::from("run,k2,c2,D,C,reported_E1max_J,E1max_of_that_design_J,evaluations,stop\n")
        + &lines.concat())
}

/// E1max along a line of k2 within ±0.1 %, J.
fn scan(settings: &Settings) -> Vec<(f64, f64)> {
    let points: Vec<f64> = (-100..=100).map(|k| 1e-3 * f64::from(k)).collect();
    let value = |&percent: &f64| {
        let scene = changed([1.0 + 1e-2 * percent, 1.0, 1.0, 1.0]).scene();
        let found = e1_max(&scene, Window { from: 0.0, ..WINDOW }, settings, f64::INFINITY);
        (percent, found.map_or(f64::NAN, |peak| peak.value))
    };
    points.par_iter().map(value).collect()
}

fn draw(path: &Path, [ode45, ode23s, hybrid]: [Vec<(f64, f64)>; 3]) -> Any<()> {
    let [thin, normal, bold, boldest] = WIDTHS;
    let exact = Line {
        name: "hybrid, rtol 1e-10".to_owned(),
        points: scan(&located(Method::Hybrid, 1e-10)),
        colour: VERMILION,
        width: bold,
        shape: None,
    };
    let panels = vec![
        panel(
            "How far E1max is off",
            Axis::log("relative tolerance of a step", (1e-13, 1e-1)),
            Axis::log("error of E1max, J", (1e-10, 1e3)),
            vec![
                Line::new("ode45, stepped", ode45, (BLUE, normal, Shape::Disc)),
                Line::new("ode23s, stepped", ode23s, (BLACK, bold, Shape::Disc)),
                Line::new("hybrid", hybrid, (VERMILION, boldest, Shape::Disc)),
            ],
            165.0,
        ),
        panel(
            "E1max along k2, ±0.1 %",
            Axis::linear("change of k2, per cent", (-0.1, 0.1)),
            Axis::linear("E1max, J", (540.0, 680.0)),
            vec![
                Line::new(
                    "ode23s, rtol 1e-3",
                    scan(&stepped(Method::Ode23s, 1e-3)),
                    (BLACK, thin, Shape::Cross),
                ),
                Line::new(
                    "hybrid, rtol 1e-6",
                    scan(&located(Method::Hybrid, 1e-6)),
                    (BLUE, thin, Shape::Square),
                ),
                exact,
            ],
            165.0,
        ),
    ];
    let note = "Table 2's SSVI, largest E1 over 0 to 100 s.";
    sheet(path, "The objective against tolerance and parameters", &[note], 2, panels)
}
