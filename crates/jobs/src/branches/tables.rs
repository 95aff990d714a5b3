//! The tables of `branches`, the functions that recompute their rows, and the answer as data.

use crate::Error;
use crate::branches::motions::{Motions, Settled, energy, settled};
use crate::branches::options::{plan_json, plan_of};
use crate::columns::{self, STATE};
use crate::recompute::{Row, Source, broken, each_row};
use crate::resolved::{Resolved, SEVERAL};
use retune_dynamics::periodic::branches::{Plan, sample};
use retune_dynamics::periodic::forced::settings_of;
use retune_dynamics::periodic::seen::seen;
use retune_dynamics::periodic::{Basins, Onset, Orbit, Plane};
use retune_model::Measure;
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_study::Study;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// A row for each motion of each branch.
pub const BRANCHES: &str = "branches.csv";
/// A row for each event.
pub const BIFURCATIONS: &str = "bifurcations.csv";
/// A row for each motion on which runs settle at each sample.
pub const ATTRACTORS: &str = "attractors.csv";
/// The states from which the motions of the branches are followed.
pub const STATES: &str = "states.csv";
/// A row for each start of a plane: the number of the motion on which it ends.
pub const STARTS: &str = "starts.csv";

pub fn tables(motions: &Motions) -> Vec<(&'static str, Table)> {
    let mut all = vec![
        (BRANCHES, branches(motions)),
        (STATES, states(motions)),
        (BIFURCATIONS, bifurcations(motions)),
        (ATTRACTORS, attractors(motions)),
    ];
    all.extend(motions.basins.as_ref().map(|basins| (STARTS, starts(basins))));
    all
}

fn branches(motions: &Motions) -> Table {
    let values = [Measure::Energy, Measure::Displacement, Measure::Stroke, Measure::ContactForce];
    let names = [
        &["branch", "place", motions.over().symbol(), "periods", "impacts", "stable"],
        &values.map(Measure::name)[..],
        &["multiplier"],
    ];
    let row = |(number, place, orbit): (usize, usize, &Orbit)| {
        let Orbit { value, periods, seen, multipliers, .. } = orbit;
        let first = cells![number, place, *value, *periods, seen.impacts.as_str(), orbit.is_stable()];
        let values = values.map(|measure| Cell::from(seen.largest(measure)));
        [first, values.into(), cells![multipliers[0].norm()]].concat()
    };
    columns::table(&names.concat()).with(points(motions).map(row))
}

fn states(motions: &Motions) -> Table {
    let mut table = columns::table(&["branch", "place", "segment", "x1", "v1", "x2", "v2"]);
    for (number, place, orbit) in points(motions) {
        for (segment, &[x1, v1, x2, v2]) in orbit.states.iter().enumerate() {
            table.push(cells![number, place, segment, x1, v1, x2, v2]);
        }
    }
    table
}

/// The motions of the branches, each with the number of its branch and its place there.
fn points(motions: &Motions) -> impl Iterator<Item = (usize, usize, &Orbit)> {
    let branches = motions.branches.branches.iter().enumerate();
    branches.flat_map(|(number, branch)| {
        branch.points.iter().enumerate().map(move |(place, orbit)| (number, place, orbit))
    })
}

/// A row for each event, with its multipliers.
pub fn bifurcations(motions: &Motions) -> Table {
    let first = ["branch", "place", "kind", motions.over().symbol(), "periods", "impacts", "E1max"];
    let multipliers = ["re1", "im1", "re2", "im2", "re3", "im3", "re4", "im4"];
    let mut table = columns::table(&[&first[..], &multipliers].concat());
    for (number, branch) in motions.branches.branches.iter().enumerate() {
        for event in &branch.events {
            let Orbit { value, periods, seen, multipliers, .. } = &event.orbit;
            let place = cells![number, event.place, event.kind.name(), *value, *periods];
            let reached = cells![seen.impacts.as_str(), energy(&event.orbit)];
            let multipliers = multipliers.iter().flat_map(|m| cells![m.re, m.im]).collect();
            table.push([place, reached, multipliers].concat());
        }
    }
    table
}

fn attractors(motions: &Motions) -> Table {
    let motion = ["start", "motion", "branch", "periods", "impacts"];
    let starts = ["starts_of", "starts", "from_rest", "E1max", "x1", "v1", "x2", "v2"];
    let row = |Settled { sample, on, branch, starts, from_rest, energy }: Settled| {
        let kind = if on.is_some() { "periodic" } else { "irregular" };
        let place = cells![sample.value, sample.number, kind, branch, on.map(|orbit| orbit.periods)];
        let impacts = cells![on.map(|orbit| orbit.seen.impacts.as_str())];
        let starts = cells![sample.starts, starts, from_rest, energy];
        let state = (0..STATE.len()).map(|i| on.map(|orbit| orbit.states[0][i]).into());
        [place, impacts, starts, state.collect()].concat()
    };
    columns::table(&[&[motions.over().symbol()], &motion[..], &starts].concat())
        .with(settled(motions).map(row))
}

fn starts(basins: &Basins) -> Table {
    let rows = basins.starts().map(|([x1, v1], end)| cells![x1, v1, end]);
    columns::table(&["x1", "v1", "motion"]).with(rows)
}

/// The answer as data.
pub fn summary(motions: &Motions) -> Value {
    let [stable, irregular] = motions.branches.stable_and_irregular();
    let branches = motions.branches.branches.iter().zip(&motions.largest).map(|(branch, most)| {
        let events = branch.events.iter().map(|event| {
            json!({ "kind": event.kind.name(), "value": event.orbit.value, "impacts": event.orbit.seen.impacts })
        });
        json!({
            "periods": branch.shooting.periods,
            "ends": branch.ends.map(|end| end.words()),
            "points": branch.points.len(),
            "events": events.collect::<Vec<_>>(),
            "largest_stable": most.as_ref().map(|orbit| json!({
                "value": orbit.value,
                "E1max": energy(orbit),
                "impacts": orbit.seen.impacts,
            })),
        })
    });
    json!({
        "study": motions.study.name(),
        "plan": plan_json(&motions.branches.plan),
        "stable": stable,
        "irregular": irregular,
        "branches": branches.collect::<Vec<_>>(),
        "margin": motions.margin.as_ref().map(|margin| json!({
            margin.amplitude.symbol(): margin.own,
            "tried": margin.tried,
            "birth": margin.birth.as_ref().map(|Onset { value, omega, orbit }| json!({
                margin.amplitude.symbol(): value,
                "omega": omega,
                "E1max": energy(orbit),
                "impacts": orbit.seen.impacts,
            })),
        })),
    })
}

/// Recomputes rows of one of the tables: motions from their states, the outcomes of runs, the ends of starts.
///
/// # Errors
/// The input of the results cannot be read.
pub(super) fn recompute(place: &Path, name: &str) -> Result<Source, Error> {
    let (plan_values, study) = Resolved::one(place)?;
    let refuse = |problem: &str| broken(place, SEVERAL, problem);
    let plan = plan_of(&plan_values).ok_or_else(|| refuse("its plan cannot be read"))?;
    if name == STARTS {
        let value =
            plan_values["basins"].as_f64().ok_or_else(|| refuse("`basins` is no number in its plan"))?;
        let plane = Plane::new(&study.scene, plan, &study.solver.settings(), value, None)?;
        return Ok(Source::new(move |row| Some(vec![("motion".to_owned(), start(&plane, row))])));
    }
    if name == ATTRACTORS {
        return Ok(Source::new(move |row| Some(vec![("E1max".to_owned(), attractor(&study, plan, row)?)])));
    }
    let motion = |row: Row| ["branch", "place"].map(|name| row.text(name).to_owned());
    let mut states: BTreeMap<[String; 2], Vec<[f64; 4]>> = BTreeMap::new();
    each_row(&place.join(STATES), |_, row| {
        states.entry(motion(row)).or_default().push(STATE.map(|(name, _)| row.number(name)));
    })?;
    Ok(Source::new(move |row| {
        Some(vec![("E1max".to_owned(), orbit(&study, plan, states.get(&motion(row))?, row)?)])
    }))
}

/// The number of the motion on which a start of the plane ends; NaN for none of them, infinite where the run fails.
fn start(plane: &Plane, row: Row) -> f64 {
    let end = plane.end(["x1", "v1"].map(|name| row.number(name)));
    end.map_or(f64::INFINITY, |end| end.map_or(f64::NAN, |number| number as f64))
}

/// E1max of a motion on a branch.
fn orbit(study: &Study, plan: Plan, states: &[[f64; 4]], row: Row) -> Option<f64> {
    let scene = plan.parameter.at(study.scene, row.number(plan.parameter.symbol())).ok()?;
    let periods = row.text("periods").parse().ok()?;
    let found = seen(&scene, &settings_of(&study.solver.settings()), periods, states);
    Some(found.map_or(f64::INFINITY, |seen| seen.largest(Measure::Energy)))
}

/// E1max of the motion on which runs settle.
fn attractor(study: &Study, plan: Plan, row: Row) -> Option<f64> {
    // The start from rest is not counted here.
    let other_starts = row.text("starts_of").parse::<usize>().ok()?.checked_sub(1)?;
    let (plan, value) = (Plan { starts: other_starts, ..plan }, row.number(plan.parameter.symbol()));
    let found = sample(&study.scene, plan, &study.solver.settings(), value, row.text("start").parse().ok());
    let mut all = found.iter().flat_map(Settled::of);
    let matching = all.find(|Settled { on, starts, .. }| match on {
        None => row.text("motion") != "periodic",
        Some(orbit) => {
            let fields = [orbit.seen.impacts.clone(), starts.to_string(), orbit.periods.to_string()];
            fields == ["impacts", "starts", "periods"].map(|name| row.text(name))
        }
    });
    Some(matching.map_or(f64::INFINITY, |matching| matching.energy))
}
