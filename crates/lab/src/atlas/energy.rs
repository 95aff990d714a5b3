//! Drift of the mechanical energy over 1,000 impacts without any loss: no damping, no force.

use crate::panel::{Line, look, panel, sheet};
use crate::runs::{self, Touches, ways};
use crate::scenes::{Numbers, SSVI};
use crate::{Any, decades};
use retune_report::Axis;
use retune_solver::{Contacts, Method, Settings};
use std::fmt::Write;
use std::path::Path;

/// Impacts.
pub const IMPACTS: u64 = 1000;
/// Time limit, s: a method that has not reached the impacts by then has lost energy.
const TIME_LIMIT: f64 = 1000.0;
/// The damper's initial speed, m/s.
const SPEED: f64 = 4.0;

/// The drift of the energy.
pub struct Drift {
    pub settings: Settings,
    /// Tolerance, or step (s).
    pub setting: f64,
    /// Number of impacts until the end.
    pub impacts: u64,
    /// Relative change of the true mechanical energy, or the error of the run.
    pub change: Result<f64, String>,
}

/// Follows the two-sided SSVI without damping or force, from an initial speed of the damper towards a wall, through its impacts.
pub fn drift(method: Method, contacts: Contacts, setting: f64) -> Drift {
    let system = Numbers { c1: 0.0, c2: 0.0, p: 0.0, ..SSVI }.coupled();
    let settings = Settings { max_steps: 48_000_000, ..runs::settings(method, contacts, setting) };
    let start = [0.0, 0.0, SSVI.d, SPEED];
    let mut seen = Touches { count: 0, enough: IMPACTS };
    let end = runs::follow(&system, start, TIME_LIMIT, &settings, &mut seen);
    let change = end
        .map(|y| system.total_energy(&y) / system.total_energy(&start) - 1.0)
        .map_err(|error| error.to_string());
    Drift { settings, setting, impacts: seen.count, change }
}

/// Methods with their settings.
fn compared() -> Vec<(Method, Vec<f64>)> {
    let steps = || vec![1e-2, 3e-3, 1e-3, 3e-4, 1e-4];
    vec![
        (Method::Ode23, decades(2, 7)),
        (Method::Ode45, decades(2, 10)),
        (Method::Dop853, decades(2, 12)),
        (Method::Rk4, steps()),
        (Method::Euler, steps()),
        (Method::Ode23s, decades(2, 7)),
        (Method::Hybrid, decades(2, 12)),
    ]
}

/// The table, and its chart.
pub fn table(chart: &Path) -> Any<String> {
    let mut all = Vec::new();
    for (method, settings) in compared() {
        for &(contacts, _) in ways(method) {
            all.extend(settings.iter().map(|&setting| drift(method, contacts, setting)));
        }
    }
    let mut text = String::from("method,contacts,rtol_or_step_s,impacts,energy_change,failure\n");
    for d in &all {
        let (change, said) = match &d.change {
            Ok(change) => (format!("{change:.2e}"), String::new()),
            Err(said) => (String::new(), said.replace(',', ";")),
        };
        let (name, way) = (d.settings.method.name(), runs::way(&d.settings));
        writeln!(text, "{name},{way},{:e},{},{change},{said}", d.setting, d.impacts)?;
    }
    draw(chart, &all)?;
    Ok(text)
}

fn draw(path: &Path, all: &[Drift]) -> Any<()> {
    let one = |fixed: bool, contacts: Contacts, title: &str| {
        let lines = compared()
            .into_iter()
            .filter(|(method, _)| method.has_fixed_step() == fixed)
            .map(|(method, _)| {
                let of: Vec<&Drift> = all
                    .iter()
                    .filter(|d| d.settings.method == method)
                    .filter(|d| method == Method::Hybrid || d.settings.contacts == contacts)
                    .collect();
                let change = |d: &&Drift| Some((d.setting, *d.change.as_ref().ok()?));
                let points: Vec<(f64, f64)> = of.iter().filter_map(change).collect();
                let gains = points.iter().filter(|point| point.1 > 0.0).count();
                let how = match gains {
                    _ if points.len() < of.len() => ", blows up",
                    0 => ", loses",
                    all if all == of.len() => ", gains",
                    _ => ", loses or gains",
                };
                let points = points.into_iter().map(|(setting, change)| (setting, change.abs())).collect();
                Line::new(&format!("{}{how}", method.name()), points, look(method))
            })
            .collect();
        let x = if fixed {
            Axis::log("step, s", (1e-5, 1e-1))
        } else {
            Axis::log("relative tolerance of a step", (1e-13, 1e-1))
        };
        let y = Axis::log("relative change of the energy", (1e-12, 1e3));
        panel(title, x, y, lines, 165.0)
    };
    let panels = vec![
        one(false, Contacts::Located, "contacts located"),
        one(false, Contacts::Stepped, "contacts stepped over"),
        one(true, Contacts::Stepped, "fixed step, stepped over"),
    ];
    let note =
        "No damping, no force: every change is the method's error. Runs that blew up are in energy.csv.";
    sheet(path, "Change of the energy over 1,000 lossless impacts", &[note], 2, panels)
}
