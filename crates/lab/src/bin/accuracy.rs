//! `just lab accuracy`: every method on every scene at every tolerance, into `results/accuracy/`; `just lab accuracy manifest` writes only its
//! manifest, and `just lab accuracy pictures` only the charts of its `runs.csv`, and the manifest.
#![allow(clippy::print_stderr)]

use retune_jobs::methods;
use retune_lab::curves::{Cost, Measure, work_precision};
use retune_lab::reference::{REFERENCE, Reference};
use retune_lab::runs::{self, Found, Row, csv, errors, parse};
use retune_lab::scenes::{Case, cases};
use retune_lab::{Any, decades, peers, savings, sealed, statistics, system, text};
use retune_model::Side;
use retune_solver::Method;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// A method's series of settings ends with the first whose runs together take longer than this.
const PATIENCE: Duration = Duration::from_millis(2000);

fn main() -> Any<()> {
    let folder = Path::new("results/accuracy");
    fs::create_dir_all(folder)?;
    let cases = cases();
    let seal = || {
        let plan = methods::plan(REFERENCE, runs::MOST_STEPS, std::iter::empty());
        sealed::seal(folder, &methods::ACCURACY, plan, cases.iter())
    };
    if std::env::args().nth(1).as_deref() == Some("manifest") {
        return seal();
    }
    let table = folder.join("runs.csv");
    let names: Vec<&'static str> = cases.iter().map(|case| case.name).collect();
    if std::env::args().nth(1).as_deref() == Some("pictures") {
        pictures(folder, &cases, &parse(&fs::read_to_string(&table)?, &names))?;
        return seal();
    }
    fs::write("tests/reference/external/scenes.json", scenes_json(&cases)?)?;
    let references = cases.iter().map(Reference::of).collect::<Result<Vec<_>, _>>()?;
    // `accuracy draw`: updates the runs of other programs and the pictures from the existing runs.
    let mut rows: Vec<Row> = if std::env::args().nth(1).as_deref() == Some("draw") {
        let outside = |row: &Row| ["Octave", "SciPy", "SUNDIALS"].iter().any(|p| row.program.starts_with(p));
        parse(&fs::read_to_string(&table)?, &names).into_iter().filter(|row| !outside(row)).collect()
    } else {
        let each = cases.iter().zip(&references);
        each.flat_map(|(case, reference)| {
            eprintln!("{}", case.name);
            [own_rows(case, &reference.found), peer_rows(case, &reference.found)].concat()
        })
        .collect()
    };
    for (case, reference) in cases.iter().zip(&references) {
        rows.extend(runs::external(Path::new("."), case, &reference.found)?);
    }
    fs::write(table, csv(&rows))?;
    let savings = savings::savings(&cases)?;
    fs::write(
        folder.join("README.md"),
        text::text(&cases, &references, &rows, &savings, &statistics::all()?),
    )?;
    pictures(folder, &cases, &rows)?;
    savings::chart(&folder.join("models.svg"), &savings)?;
    seal()
}

/// The charts of error against cost.
fn pictures(folder: &Path, cases: &[Case], rows: &[Row]) -> Any<()> {
    for (name, measure, cost) in [
        ("time", Measure::E1max, Cost::Time),
        ("evaluations", Measure::E1max, Cost::Evaluations),
        ("state", Measure::State, Cost::Time),
    ] {
        work_precision(&folder.join(format!("{name}.svg")), cases, rows, measure, cost)?;
    }
    Ok(())
}

fn row(
    case: &Case,
    reference: &Found,
    program: &str,
    method: &str,
    contacts: &'static str,
    setting: f64,
    found: Result<Found, String>,
) -> Row {
    let errors = found.as_ref().map_or([f64::NAN; 3], |f| errors(f, reference, case.omega()));
    Row {
        scene: case.name,
        program: program.to_string(),
        method: method.to_string(),
        contacts,
        setting,
        found,
        errors,
        expected_impacts: reference.impacts,
    }
}

fn own_rows(case: &Case, reference: &Found) -> Vec<Row> {
    let steps: Vec<f64> = (3..=10).map(|k| 10f64.powf(-f64::from(k) / 2.0)).collect();
    let mut rows = Vec::new();
    for method in Method::ALL {
        let values = match method {
            Method::Hybrid | Method::Dop853 => decades(2, 12),
            Method::Ode45 => decades(2, 11),
            Method::Ode23 | Method::Ode23s => decades(2, 8),
            Method::Rk4 | Method::Euler => steps.clone(),
        };
        for &(contacts, way) in runs::ways(method) {
            for &value in &values {
                let begun = Instant::now();
                let found = runs::run(case, &runs::settings(method, contacts, value), true);
                rows.push(row(case, reference, "retune", method.name(), way, value, found));
                if begun.elapsed() > PATIENCE {
                    break;
                }
            }
        }
    }
    rows
}

fn peer_rows(case: &Case, reference: &Found) -> Vec<Row> {
    let mut rows = Vec::new();
    for peer in &peers::PEERS {
        for (located, way) in [(true, "located"), (false, "stepped")] {
            for rtol in (3..=12).step_by(if located { 1 } else { 3 }).map(|k| 10f64.powi(-k)) {
                if rtol < 0.5 * peer.tightest {
                    break;
                }
                let begun = Instant::now();
                let found = peers::run(peer, case, located, rtol);
                rows.push(row(case, reference, peer.program, peer.method, way, rtol, found));
                if begun.elapsed() > PATIENCE {
                    break;
                }
            }
        }
    }
    rows
}

/// The scenes as plain numbers for other programs.
fn scenes_json(cases: &[Case]) -> Result<String, serde_json::Error> {
    let list: Vec<_> = cases
        .iter()
        .map(|case| {
            let (p, f) = (&case.scene.primary, &case.scene.forcing);
            let mut object = serde_json::json!({
                "scene": case.name, "T": case.to,
                "m1": p.mass.get(), "c1": p.damping.get(), "k1": p.stiffness.get(),
                "P": f.amplitude().map_or(0.0, |(_, amplitude)| amplitude.get()), "omega": f.frequency.get(),
            });
            let numbers = match case.scene.damper.zip(system(&case.scene)) {
                None => serde_json::json!({"m2": 1.0, "k2": 0.0, "c2": 0.0, "D": 1e6, "C": 1e6, "K1": 0.0, "K3": 0.0}),
                Some((d, system)) => serde_json::json!({
                    "m2": d.mass.get(), "k2": d.stiffness.get(), "c2": d.damping.get(),
                    "D": d.rest_distance.get(), "C": d.clearance.get(),
                    "K1": system.hertz(Side::Primary), "K3": system.hertz(Side::Obstacle),
                    "lambda": system.regularised_contact(Side::Primary).lambda(),
                    "restitution": system.restitution().or_else(|| {
                        system.regularised_contact(Side::Primary).restoring().map(|law| law.restitution())
                    }),
                    "rigid": system.is_rigid(),
                }),
            };
            if let (Some(all), serde_json::Value::Object(more)) = (object.as_object_mut(), numbers) {
                all.extend(more);
            }
            object
        })
        .collect();
    Ok(serde_json::to_string_pretty(&list)? + "\n")
}
