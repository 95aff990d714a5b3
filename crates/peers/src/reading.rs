//! What the chart says, in words and numbers.

use crate::own::shortest_of;
use crate::record::{Found, Row};
use crate::scenes::{Case, Numbers, TMD, scene};
use retune_model::{Coupled, Drive};
use retune_solver::observe::Peak;
use retune_solver::{Hybrid, Motion, Phase, Settings, Window, e1_max};
use std::error::Error;
use std::fmt::Write;

/// The reference of a scene and how far it can be trusted.
pub struct Reference {
    /// The hybrid at rtol 1e-13.
    pub found: Found,
    /// How far the hybrid at 1e-12 is from it.
    pub looser: [f64; 3],
    /// How far DOP853 with located contacts at 1e-13 is from it.
    pub independent: [f64; 3],
    /// Rate at which neighbouring motions part, 1/s.
    pub parting: Option<f64>,
}

/// Cost of a scene under the smallest exact model and under the full contact model.
pub struct Saving {
    /// Scene.
    pub label: &'static str,
    /// Times, s: smallest, full.
    pub seconds: [f64; 2],
    /// E1max, J: smallest, full.
    pub e1_max: [f64; 2],
}

/// Measures the savings. The full model of the bare structure has a damper that nothing holds, out of reach of both walls.
///
/// # Errors
/// A run that failed.
pub fn savings(cases: &[Case]) -> Result<Vec<Saving>, Box<dyn Error>> {
    let free = scene(Numbers { k2: 0.0, c2: 0.0, d: 1e3, c: 1e3, ..TMD })?;
    let settings = Settings { rtol: 1e-9, ..Settings::default() };
    cases
        .iter()
        .map(|case| {
            let smallest =
                || e1_max(&case.scene, Window { from: 0.0, to: case.to }, &settings, f64::INFINITY);
            let damper = case.scene.damper.or(free.damper).ok_or("no damper")?;
            let full = || {
                let system = Coupled::new(&case.scene.primary, &case.scene.forcing, &damper);
                let mut peak = Peak::new(
                    |drive: Drive, y: &[f64; 4]| system.primary_energy_rates(drive, y),
                    f64::INFINITY,
                );
                let start = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
                Hybrid::new(&system, settings.rtol, case.to, settings.max_steps)
                    .propagate(start, case.to, &mut peak)
                    .map(|_| peak.record())
            };
            Ok(Saving {
                label: case.label,
                e1_max: [smallest()?.value, full()?.value],
                seconds: [shortest_of(smallest), shortest_of(full)],
            })
        })
        .collect()
}

/// A method on a scene: its cheapest way to meet contacts, from the tightest setting to the loosest, with the error that no
/// tighter setting exceeded (a lucky run does not count).
pub struct Curve<'a> {
    /// Name of the method.
    pub name: String,
    /// Its way to meet contacts.
    pub contacts: &'static str,
    /// Error, and the run.
    pub points: Vec<(f64, &'a Row)>,
    /// Runs that failed.
    pub failed: usize,
}

impl Curve<'_> {
    /// Least cost at which the error stays below a level, and the setting.
    pub fn cost_at(&self, level: f64, in_time: bool) -> Option<(f64, f64)> {
        self.points
            .iter()
            .filter(|(error, _)| *error <= level)
            .filter_map(|(_, row)| Some((row.cost(in_time)?, row.setting)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

fn curve<'a>(rows: &[&'a Row]) -> Option<Curve<'a>> {
    let first = rows.first()?;
    let mut sorted = rows.to_vec();
    sorted.sort_by(|a, b| a.setting.total_cmp(&b.setting));
    let mut worst = 0.0_f64;
    let mut points = Vec::new();
    for row in &sorted {
        if row.found.is_ok() && row.errors[0].is_finite() {
            worst = worst.max(row.errors[0]);
            points.push((worst.max(1e-15), *row));
        }
    }
    let failed = sorted.iter().filter(|r| r.found.is_err()).count();
    Some(Curve { name: first.name(), contacts: first.contacts, points, failed })
}

/// The curves of a scene.
pub fn curves<'a>(rows: &'a [Row], case: &Case) -> Vec<Curve<'a>> {
    let mut names: Vec<String> = Vec::new();
    let of_case = || rows.iter().filter(|r| r.scene == case.name);
    of_case().for_each(|r| {
        if !names.contains(&r.name()) {
            names.push(r.name());
        }
    });
    let rank = |c: &Curve<'_>| {
        let cost = [1e-6, 1e-4, 1e-2].into_iter().position(|level| c.cost_at(level, true).is_some());
        let level = cost.map_or(1.0, |i| [1e-6, 1e-4, 1e-2][i]);
        (cost.unwrap_or(9), c.cost_at(level, true).map_or(f64::INFINITY, |c| c.0))
    };
    names
        .iter()
        .filter_map(|name| {
            ["exact", "located", "stepped"]
                .into_iter()
                .filter_map(|way| {
                    curve(&of_case().filter(|r| r.name() == *name && r.contacts == way).collect::<Vec<_>>())
                })
                .min_by(|a, b| rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal))
        })
        .collect()
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.3} ms", s * 1e3),
        s if s < 1.0 => format!("{:.1} ms", s * 1e3),
        s => format!("{s:.1} s"),
    }
}

/// The text of `results/accuracy/README.md`.
pub fn text(cases: &[Case], references: &[Reference], rows: &[Row], savings: &[Saving]) -> String {
    let mut out = String::from(
        "# Speed against accuracy\n\nWritten by `just accuracy` from `runs.csv`; failures stay in that table with their reason. \
         An error counts only if no tighter setting of the same method exceeds it. Each method is shown with the way to meet \
         contacts (located or stepped over) that serves it better. Retune's times contain the search for E1max, those of the \
         Rust peers do not. Evaluations: right-hand sides and Jacobians; of the hybrid, with one more for each step. \
         SciPy and SUNDIALS ran out of process (`just accuracy-external`); CVODE's E1max was not located (its states are in the table). \
         GNU Octave's script has not been run yet.\n\n\
         ![time](time.svg)\n![evaluations](evaluations.svg)\n\n## The reference\n\nThe hybrid at rtol 1e-13. `hybrid` is how far its \
         run at 1e-12 is from it, `DOP853` how far another method, DOP853 with located contacts at 1e-13, is: the larger is the \
         reference's uncertainty. Neighbouring motions part (or meet, below zero) at the rate given, so the whole run is predictable.\n\n\
         | scene | T, s | E1max, J | impacts | parting rate, 1/s | E1max: hybrid, DOP853 | final state: hybrid, DOP853 | impact times, s: DOP853 |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for (case, r) in cases.iter().zip(references) {
        let parting = r.parting.map_or(String::from("-"), |rate| format!("{rate:+.3}"));
        let ([a, b, _], [c, d, e]) = (r.looser, r.independent);
        let _ = writeln!(
            out,
            "| {} | {} | {:.9} | {} | {parting} | {a:.0e}, {c:.0e} | {b:.0e}, {d:.0e} | {e:.0e} |",
            case.label, case.to, r.found.e1_max, r.found.impacts
        );
    }
    for level in [1e-3, 1e-6, 1e-9] {
        cheapest(&mut out, cases, rows, level);
    }
    defaults(&mut out, cases, rows);
    out += "\n## No more model than a scene needs\n\nE1max to rtol 1e-9 under the smallest model that is exact for the scene, and under the full contact model.\n\n\
        ![models](models.svg)\n\n| scene | smallest | full | saving | difference of E1max |\n| --- | --- | --- | --- | --- |\n";
    for s in savings {
        let [small, full] = s.seconds;
        let difference = (s.e1_max[0] / s.e1_max[1] - 1.0).abs();
        let _ = writeln!(
            out,
            "| {} | {} | {} | {:.1} × | {difference:.0e} |",
            s.label,
            time(small),
            time(full),
            full / small
        );
    }
    out
}

fn cheapest(out: &mut String, cases: &[Case], rows: &[Row], level: f64) {
    let _ = writeln!(
        out,
        "\n## Who reaches a relative error of E1max of {level:.0e}, and for what\n\nTime, with the factor over the hybrid's; the five cheapest, then the paper's method.\n"
    );
    for case in cases {
        let curves = curves(rows, case);
        let mut costs: Vec<_> = curves.iter().filter_map(|c| Some((c.cost_at(level, true)?.0, c))).collect();
        costs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(&(hybrid, _)) = costs.iter().find(|c| c.1.name == "hybrid") else { continue };
        let show =
            |(cost, c): &(f64, &Curve<'_>)| format!("{} {} ({:.1} ×)", c.name, time(*cost), cost / hybrid);
        let mut list: Vec<String> = costs.iter().take(5).map(show).collect();
        for paper in ["ode23s", "Octave ode23s"] {
            match costs.iter().find(|c| c.1.name == paper) {
                Some(c) if !costs.iter().take(5).any(|c| c.1.name == paper) => list.push(show(c)),
                Some(_) => {}
                None if !curves.iter().any(|c| c.name == paper) => {}
                None => list.push(format!("{paper} never, as far as it was run")),
            }
        }
        let _ = writeln!(out, "- {}: {}.", case.label, list.join(", "));
    }
}

fn defaults(out: &mut String, cases: &[Case], rows: &[Row]) {
    *out += "\n## Which tolerance follows\n\nThe loosest decade of the hybrid's rtol whose error of E1max stays below the level on all scenes.\n\n\
        | stage | error allowed | rtol | longest run of the scenes |\n| --- | --- | --- | --- |\n";
    for (stage, level) in [("grid", 1e-4), ("refinement", 1e-6), ("certificate", 1e-9)] {
        let mut rtol = 1.0_f64;
        let mut longest = 0.0_f64;
        let all: Vec<_> = cases.iter().map(|case| curves(rows, case)).collect();
        let hybrids = || all.iter().flatten().filter(|c| c.name == "hybrid");
        for curve in hybrids() {
            let loosest =
                curve.points.iter().filter(|p| p.0 <= level).map(|p| p.1.setting).fold(0.0, f64::max);
            rtol = rtol.min(loosest);
        }
        for curve in hybrids() {
            let of = curve
                .points
                .iter()
                .filter(|p| p.1.setting <= 1.01 * rtol)
                .filter_map(|p| Some((p.1.setting, p.1.cost(true)?)));
            longest = longest.max(of.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |p| p.1));
        }
        let _ = writeln!(out, "| {stage} | {level:.0e} | {rtol:.0e} | {} |", time(longest));
    }
}
