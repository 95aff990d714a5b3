//! Curves of error against cost of a table of runs, the cost of a level of accuracy, and their charts.

use crate::Any;
use crate::panel::{Line, WIDTHS, look, panel, shade, sheet};
use crate::reference::Reference;
use crate::runs::Row;
use crate::scenes::Case;
use retune_report::colour::{Colour, GREEN, GREY, ORANGE, PURPLE, SKY};
use retune_report::{Axis, Shape};
use retune_solver::Method;
use std::path::Path;

/// The error that is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    E1max,
    State,
}

impl Measure {
    pub const fn name(self) -> &'static str {
        match self {
            Measure::E1max => "E1max",
            Measure::State => "the final state",
        }
    }
}

/// A method on a scene with its cheapest treatment of contacts, from the tightest setting to the loosest. The error at a setting is the
/// largest up to there, so that an accidentally small error does not count.
#[derive(Clone)]
pub struct Curve<'a> {
    /// Name of the method, with its program unless it is Retune's.
    pub name: String,
    pub contacts: &'static str,
    /// Error, and the run.
    pub points: Vec<(f64, &'a Row)>,
    /// Runs that failed.
    pub failed: usize,
}

impl Curve<'_> {
    pub fn program(&self) -> &str {
        self.name.split_once(' ').map_or("retune", |(program, _)| program)
    }

    /// Whether its right-hand side is interpreted, so that its time does not reflect the method.
    pub fn is_interpreted(&self) -> bool {
        ["Octave", "SciPy"].contains(&self.program())
    }

    /// Least time at which the error stays below a level, s, and the setting.
    pub fn cost_at(&self, level: f64) -> Option<(f64, f64)> {
        self.points
            .iter()
            .filter(|(error, _)| *error <= level)
            .filter_map(|(_, row)| Some((row.cost(true)?, row.setting)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Names of the default method and the paper's method.
const HYBRID: &str = "hybrid";
const PAPERS: &str = "ode23s";

/// Errors below this are rounding, even where two references agree better.
const FLOOR: f64 = 1e-13;

/// Smallest error that is distinguished from zero.
const ROUNDING: f64 = 1e-15;

fn curve<'a>(rows: &[&'a Row], measure: Measure) -> Option<Curve<'a>> {
    let first = rows.first()?;
    let mut sorted = rows.to_vec();
    sorted.sort_by(|a, b| a.setting.total_cmp(&b.setting));
    let mut worst = ROUNDING;
    let mut points = Vec::new();
    for row in &sorted {
        let error = row.errors[measure as usize];
        if row.found.is_ok() && error.is_finite() {
            worst = worst.max(error);
            points.push((worst, *row));
        }
    }
    let failed = sorted.iter().filter(|r| r.found.is_err()).count();
    Some(Curve { name: first.name(), contacts: first.contacts, points, failed })
}

/// Rank of a curve: the tightest of three error levels that it reaches, and the cost there; smaller is better.
pub fn rank(curve: &Curve<'_>) -> (usize, f64) {
    [1e-6, 1e-4, 1e-2]
        .into_iter()
        .enumerate()
        .find_map(|(i, level)| Some((i, curve.cost_at(level)?.0)))
        .unwrap_or((9, f64::INFINITY))
}

/// The curves of a scene, one for each method.
pub fn curves<'a>(rows: &'a [Row], case: &Case, measure: Measure) -> Vec<Curve<'a>> {
    let of_case = || rows.iter().filter(|r| r.scene == case.name);
    let mut names: Vec<String> = Vec::new();
    for row in of_case() {
        if !names.contains(&row.name()) {
            names.push(row.name());
        }
    }
    let best = |name: &String| {
        ["exact", "located", "stepped"]
            .into_iter()
            .filter_map(|way| {
                let rows: Vec<_> = of_case().filter(|r| r.name() == *name && r.contacts == way).collect();
                curve(&rows, measure)
            })
            .min_by(|a, b| {
                let (a, b) = (rank(a), rank(b));
                a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
            })
    };
    names.iter().filter_map(best).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    Time,
    Evaluations,
}

/// Colour by program and mark by method; the hybrid and the paper's method are emphasised.
fn style(name: &str) -> (Colour, f64, Shape) {
    let thin = |colour, shape| (colour, WIDTHS[0], shape);
    match name {
        "rk4" => thin(GREEN, Shape::Disc),
        "euler" => thin(GREEN, Shape::Square),
        "Octave ode23s" => (ORANGE, WIDTHS[1], Shape::Disc),
        _ if name.starts_with("differential-equations") => thin(PURPLE, Shape::Disc),
        _ if name.starts_with("ivp") => thin(PURPLE, Shape::Square),
        _ if name.starts_with("diffsol") => thin(PURPLE, Shape::Triangle),
        _ if name.starts_with("Octave") => thin(ORANGE, Shape::Square),
        _ if name.starts_with("SUNDIALS") => thin(ORANGE, Shape::Triangle),
        _ if name.starts_with("Moreau-Jean") => thin(SKY, Shape::Square),
        _ => Method::ALL
            .into_iter()
            .find(|method| method.name() == name)
            .map_or_else(|| thin(GREY, Shape::Disc), look),
    }
}

/// Retune's methods, both of Octave's, and the best method of every other program on the scene.
fn shown<'a>(all: Vec<Curve<'a>>) -> Vec<Curve<'a>> {
    let mut kept: Vec<Curve<'a>> = Vec::new();
    for curve in all {
        let program = curve.program();
        let rival = kept.iter().position(|k| k.program() == program);
        match rival {
            Some(i) if program != "retune" && program != "Octave" => {
                if rank(&curve) < rank(&kept[i]) {
                    kept[i] = curve;
                }
            }
            _ => kept.push(curve),
        }
    }
    // The most important lines are drawn last, on top.
    kept.sort_by(|a, b| style(&a.name).1.total_cmp(&style(&b.name).1));
    kept
}

/// Most lines of a panel: more cannot be told apart.
const MAX_LINES: usize = 6;

/// The curves of a scene in two panels: Retune's methods, and the hybrid beside other programs. Each panel keeps the best curves, and
/// always the hybrid and the paper's method.
fn panels<'a>(all: Vec<Curve<'a>>) -> [Vec<Curve<'a>>; 2] {
    let others: Vec<Curve<'a>> =
        all.iter().filter(|curve| curve.name == HYBRID || curve.program() != "retune").cloned().collect();
    let own = all.into_iter().filter(|curve| curve.program() == "retune").collect();
    [own, others].map(|mut curves: Vec<Curve<'a>>| {
        while curves.len() > MAX_LINES {
            let key = |curve: &Curve<'_>| match curve.name.as_str() {
                HYBRID | PAPERS => (0, 0.0),
                _ => rank(curve),
            };
            let order = |a: &Curve<'_>, b: &Curve<'_>| {
                let (a, b) = (key(a), key(b));
                a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
            };
            let worst = (0..curves.len()).max_by(|&a, &b| order(&curves[a], &curves[b]));
            worst.map(|worst| curves.remove(worst));
        }
        curves
    })
}

fn line(curve: &Curve<'_>, cost: Cost) -> Line {
    let way = if curve.contacts == "stepped" { ", stepped" } else { "" };
    let failed = if curve.failed > 0 { format!(" ({} failed)", curve.failed) } else { String::new() };
    let name = format!("{}{way}{failed}", curve.name.replace("differential-equations", "diff-eq"));
    let scale = if cost == Cost::Time { 1e3 } else { 1.0 };
    let points = curve
        .points
        .iter()
        .filter_map(|(error, row)| Some((*error, row.cost(cost == Cost::Time)? * scale)))
        .filter(|p| p.1 > 0.0)
        .collect();
    Line::new(&name, points, style(&curve.name))
}

/// Two panels for each scene: error on the horizontal axis, cost on the vertical axis.
pub fn work_precision(
    path: &Path,
    scenes: &[(&Case, &Reference)],
    rows: &[Row],
    measure: Measure,
    cost: Cost,
) -> Any<()> {
    let (what, unit, range) = match cost {
        Cost::Time => ("time of a run", ", ms", (1e-2, 1e5)),
        Cost::Evaluations => ("evaluations of the right-hand side", "", (1e1, 1e7)),
    };
    let error = measure.name();
    let panels = scenes.iter().flat_map(|(case, reference)| {
        let mut all = curves(rows, case, measure);
        all.retain(|curve| cost == Cost::Evaluations || !curve.is_interpreted());
        let floor = reference.uncertainty[measure as usize].max(FLOOR);
        ["Retune", "others"].into_iter().zip(panels(shown(all))).map(move |(whose, curves)| {
            let mut panel = panel(
                &format!("{} (T = {} s): {whose}", case.label, case.to),
                Axis::log(format!("relative error of {error}"), (1e-15, 1e1)),
                Axis::log(format!("{what}{unit}"), range),
                curves.iter().map(|curve| line(curve, cost)).collect(),
                165.0,
            );
            shade(&mut panel, floor);
            panel
        })
    });
    let title = format!("Error of {error} against {what}: lower left is better");
    let key = "Vermilion: Retune's hybrid. Black: the paper's ode23s. Blue, green: Retune's other methods, adaptive and of fixed step. \
               Purple: Rust crates. Orange: CVODE, compiled from C, and GNU Octave. Light blue: the time stepper of Moreau and Jean. Grey: SciPy.";
    let note = "Left Retune's methods, right the hybrid beside of every other program the method that served the scene best; of more than six the \
                best six, with hybrid and ode23s. Contacts are located unless it says stepped. \
                Hollow squares on the frame: points beyond it. Shaded: below the uncertainty of the reference, at least 1e-13. All runs, failures \
                with their reason: runs.csv.";
    sheet(path, &title, &[key, note], 2, panels.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::{Found, Timing};

    fn row(setting: f64, seconds: f64, error: f64) -> Row {
        let time = Timing { least: seconds, spread: 0.0 };
        let found =
            Found { e1_max: 1.0, final_state: [0.0; 4], touches: None, impacts: 0, evaluations: 1, time };
        Row {
            scene: "a",
            program: "retune".into(),
            method: "m".into(),
            contacts: "located",
            setting,
            found: if error.is_nan() { Err("failed".into()) } else { Ok(found) },
            errors: [error, f64::NAN, f64::NAN],
            expected_impacts: 0,
        }
    }

    #[test]
    fn contract_a_panel_has_the_best_six_with_the_hybrid_and_the_papers_method() {
        let names = ["ode23s", "hybrid", "ode45", "ode23", "dop853", "rk4", "euler"];
        let rows: Vec<Row> = names
            .iter()
            .enumerate()
            .map(|(i, name)| Row { method: (*name).into(), ..row(1e-9, 10.0 - i as f64, 1e-9) })
            .collect();
        let all: Vec<Curve<'_>> = rows.iter().filter_map(|row| curve(&[row], Measure::E1max)).collect();
        let [own, others] = panels(all);
        let of = |curves: &[Curve<'_>]| curves.iter().map(|curve| curve.name.clone()).collect::<Vec<_>>();
        assert_eq!(
            of(&own),
            ["ode23s", "hybrid", "ode23", "dop853", "rk4", "euler"],
            "ode45 is the slowest of the others"
        );
        assert_eq!(of(&others), ["hybrid"]);
    }

    #[test]
    fn contract_a_lucky_run_does_not_count_and_a_failed_one_is_counted() {
        let rows = [
            row(1e-3, 1.0, 1e-9), // accidentally small
            row(1e-4, 2.0, 1e-4),
            row(1e-5, 3.0, 1e-5),
            row(1e-6, 9.0, f64::NAN),
        ];
        let curve = curve(&rows.iter().collect::<Vec<_>>(), Measure::E1max).expect("runs");
        assert_eq!(curve.failed, 1);
        assert_eq!(curve.points.iter().map(|p| p.0).collect::<Vec<_>>(), [1e-5, 1e-4, 1e-4]);
        assert_eq!(curve.cost_at(1e-3), Some((1.0, 1e-3)));
        assert_eq!(curve.cost_at(2e-5), Some((3.0, 1e-5)));
        assert_eq!(curve.cost_at(1e-7), None);
    }
}
