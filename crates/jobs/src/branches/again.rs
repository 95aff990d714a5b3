//! The tables of `branches`, computed again: motions from their states, what runs settle on, where starts end.

use crate::Error;
use crate::again::{Row, Source, broken, each_row};
use crate::branches::motions::most_irregular;
use crate::branches::options::plan_of;
use crate::branches::tables::{ATTRACTORS, STARTS, STATES};
use crate::columns::STATE;
use crate::resolved::{Resolved, SEVERAL};
use retune_dynamics::periodic::Plane;
use retune_dynamics::periodic::branches::{Plan, sample};
use retune_dynamics::periodic::forced::settings_of;
use retune_dynamics::periodic::seen::seen;
use retune_model::{Measure, Scene};
use retune_study::Study;
use std::collections::BTreeMap;
use std::path::Path;

/// A motion: the numbers of its branch and of its place there.
type Motion = (String, String);

/// A row of one of the tables.
///
/// # Errors
/// The input of the results cannot be read.
pub(super) fn again(place: &Path, name: &str) -> Result<Source, Error> {
    let resolved = Resolved::read(place)?;
    let refuse = |problem: &str| broken(place, SEVERAL, problem);
    let plan = plan_of(&resolved.plan).ok_or_else(|| refuse("its plan cannot be read"))?;
    let (_, study) = resolved.studies()?.into_iter().next().ok_or_else(|| refuse("it names no study"))?;
    if name == STARTS {
        let value =
            resolved.plan["basins"].as_f64().ok_or_else(|| refuse("`basins` is no number in its plan"))?;
        let plane = Plane::new(&study.scene, plan, &study.solver.settings(), value, None)?;
        return Ok(Source::new(move |row| Some(vec![start(&plane, row)])));
    }
    if name == ATTRACTORS {
        return Ok(Source::new(move |row| Some(vec![("E1max".to_owned(), attractor(&study, plan, row)?)])));
    }
    let mut states: BTreeMap<Motion, Vec<[f64; 4]>> = BTreeMap::new();
    each_row(&place.join(STATES), |_, row| {
        let state = STATE.map(|(name, _)| row.number(name));
        states.entry(motion(row)).or_default().push(state);
    })?;
    Ok(Source::new(move |row| {
        Some(vec![("E1max".to_owned(), orbit(&study, plan, states.get(&motion(row))?, row)?)])
    }))
}

fn motion(row: Row) -> Motion {
    (row.text("branch").to_owned(), row.text("place").to_owned())
}

/// The number of the motion on which a start of the plane ends; NaN of none.
fn start(plane: &Plane, row: Row) -> (String, f64) {
    let start = ["x1", "v1"].map(|name| row.number(name));
    let end = plane.end(start).map_or(f64::INFINITY, |end| end.map_or(f64::NAN, |number| number as f64));
    ("motion".to_owned(), end)
}

/// E1max of a motion on a branch.
fn orbit(study: &Study, plan: Plan, states: &[[f64; 4]], row: Row) -> Option<f64> {
    let scene = at(study, plan, row)?;
    let periods = row.text("periods").parse().ok()?;
    let settings = settings_of(&study.solver.settings());
    Some(seen(&scene, &settings, periods, states).map_or(f64::INFINITY, |seen| seen.largest(Measure::Energy)))
}

/// E1max of what runs settle on.
fn attractor(study: &Study, plan: Plan, row: Row) -> Option<f64> {
    let value = row.number(plan.parameter.symbol());
    let number = row.text("start").parse().ok();
    // Beside that from rest.
    let others = row.text("starts_of").parse::<usize>().ok()?.checked_sub(1)?;
    let plan = Plan { starts: others, ..plan };
    let Ok(found) = sample(&study.scene, plan, &study.solver.settings(), value, number) else {
        return Some(f64::INFINITY);
    };
    if row.text("motion") != "periodic" {
        return Some(most_irregular(&found));
    }
    let own = found.attractors.iter().find(|one| {
        one.orbit.seen.impacts == row.text("impacts")
            && one.starts.to_string() == row.text("starts")
            && one.orbit.periods.to_string() == row.text("periods")
    });
    Some(own.map_or(f64::INFINITY, |own| own.orbit.seen.largest(Measure::Energy)))
}

fn at(study: &Study, plan: Plan, row: Row) -> Option<Scene> {
    let parameter = plan.parameter;
    parameter.at(study.scene, row.number(parameter.symbol())).ok()
}
