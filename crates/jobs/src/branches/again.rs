//! `branches`, computed again: motions from their states, what runs settle on.

use crate::Error;
use crate::branches::basins::STARTS;
use crate::branches::options::plan_of;
use crate::branches::tables::{ATTRACTORS, STATES};
use crate::resolved::Resolved;
use crate::verify::table::{Row, Sample};
use crate::verify::{Check, Report};
use retune_dynamics::periodic::Plane;
use retune_dynamics::periodic::branches::{Plan, sample};
use retune_dynamics::periodic::forced::settings_of;
use retune_dynamics::periodic::seen::seen;
use retune_study::Study;
use std::collections::BTreeMap;
use std::path::Path;

/// A motion: the numbers of its branch and of its place there.
type Motion = (String, String);

/// The results in a directory.
struct Results {
    study: Study,
    plan: Plan,
    states: BTreeMap<Motion, Vec<[f64; 4]>>,
}

/// Checks at most `most` rows of a table.
///
/// # Errors
/// A file cannot be read, as of all checks.
pub fn again(place: &Path, name: &str, most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let resolved = Resolved::read(place)?;
    let (Some(plan), Some((_, study))) = (plan_of(&resolved.plan), resolved.studies()?.into_iter().next())
    else {
        return report.fail(name, "is of no plan that can be read");
    };
    let table = Sample::read(&place.join(name), most)?;
    if name == STARTS {
        let Some(value) = resolved.plan["basins"].as_f64() else {
            return report.fail(name, "is of no value that can be read");
        };
        let plane = Plane::new(&study.scene, plan, &study.solver.settings(), value, None)?;
        let checks: Vec<Check> = table.rows().map(|row| start(&plane, row)).collect();
        return report.look(name, &table.of(checks.len()), &checks);
    }
    let mut results = Results { study, plan, states: BTreeMap::new() };
    if name != ATTRACTORS {
        for row in Sample::read(&place.join(STATES), usize::MAX)?.rows() {
            let state = ["x1", "v1", "x2", "v2"].map(|name| row.number(name));
            results.states.entry(motion(row)).or_default().push(state);
        }
    }
    let checks: Vec<Check> = table
        .rows()
        .map(|row| match name {
            ATTRACTORS => results.attractor(row),
            _ => results.orbit(row),
        })
        .map(|check| check.unwrap_or_else(Check::never))
        .collect();
    report.look(name, &table.of(checks.len()), &checks)
}

/// The number of the motion on which a start of the plane ends; -1 of none.
fn start<'a>(plane: &'a Plane, row: Row) -> Check<'a> {
    let start = ["x1", "v1"].map(|name| row.number(name));
    let number = |end: Option<usize>| end.map_or(-1.0, |number| number as f64);
    let again = move || plane.end(start).map_or(f64::INFINITY, number);
    let said = if row.text("motion").is_empty() { -1.0 } else { row.number("motion") };
    Check { said, again: Box::new(again) }
}

fn motion(row: Row) -> Motion {
    (row.text("branch").to_owned(), row.text("place").to_owned())
}

impl Results {
    /// E1max of a motion on a branch.
    fn orbit(&self, row: Row) -> Option<Check<'_>> {
        let states = self.states.get(&motion(row))?;
        let scene = self.scene(row)?;
        let periods = row.text("periods").parse().ok()?;
        let settings = settings_of(&self.study.solver.settings());
        let again =
            move || seen(&scene, &settings, periods, states).map_or(f64::INFINITY, |seen| seen.e1_max);
        Some(Check { said: row.number("E1max"), again: Box::new(again) })
    }

    /// E1max of what runs settle on.
    fn attractor(&self, row: Row) -> Option<Check<'_>> {
        let value = row.number(self.plan.parameter.symbol());
        let (is_periodic, impacts) = (row.text("motion") == "periodic", row.text("impacts").to_owned());
        let (starts, periods) = (row.text("starts").to_owned(), row.text("periods").to_owned());
        let number = row.text("start").parse().ok();
        // Beside that from rest.
        let others = row.text("starts_of").parse::<usize>().ok()?.checked_sub(1)?;
        let again = move || {
            let plan = Plan { starts: others, ..self.plan };
            let settings = self.study.solver.settings();
            let Ok(found) = sample(&self.study.scene, plan, &settings, value, number) else {
                return f64::INFINITY;
            };
            if !is_periodic {
                return found.irregular.iter().map(|seen| seen.e1_max).fold(0.0, f64::max);
            }
            let own = found.attractors.iter().find(|one| {
                let orbit = &one.orbit;
                orbit.seen.impacts == impacts
                    && one.starts.to_string() == starts
                    && orbit.periods.to_string() == periods
            });
            own.map_or(f64::INFINITY, |own| own.orbit.seen.e1_max)
        };
        Some(Check { said: row.number("E1max"), again: Box::new(again) })
    }

    fn scene(&self, row: Row) -> Option<retune_model::Scene> {
        let parameter = self.plan.parameter;
        parameter.at(self.study.scene, row.number(parameter.symbol())).ok()
    }
}
