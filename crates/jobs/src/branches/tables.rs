//! The tables of `branches`, and its answer as data.

use crate::branches::motions::{Motions, most_irregular};
use crate::columns;
use retune_dynamics::periodic::Attractor;
use retune_dynamics::periodic::{Basins, Onset, Orbit};
use retune_model::Measure;
use retune_report::cells;
use retune_report::table::{Cell, Table};
use serde_json::{Value, json};

/// A row for each motion of each branch.
pub const BRANCHES: &str = "branches.csv";
/// A row for each event.
pub const BIFURCATIONS: &str = "bifurcations.csv";
/// A row for each motion on which runs settle, at each sample.
pub const ATTRACTORS: &str = "attractors.csv";
/// The states from which the motions of the branches are followed.
pub const STATES: &str = "states.csv";
/// A row for each start of a plane: the number of the motion on which it ends.
pub const STARTS: &str = "starts.csv";

/// All of them, each with the name of its file.
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
    let over = motions.over().symbol();
    let first = ["branch", "place", over, "periods", "impacts", "stable"];
    let values = ["E1max", "x1max", "stroke", "contact_force", "multiplier"];
    let mut table = columns::table(&[&first[..], &values].concat());
    for (number, place, orbit) in points(motions) {
        let Orbit { value, periods, seen, multipliers, .. } = orbit;
        let first = cells![number, place, *value, *periods, seen.impacts.as_str(), orbit.is_stable()];
        let multiplier = multipliers[0].norm();
        let values = cells![
            seen.largest(Measure::Energy),
            seen.largest(Measure::Displacement),
            seen.largest(Measure::Stroke),
            seen.largest(Measure::ContactForce),
            multiplier
        ];
        table.push([first, values].concat());
    }
    table
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
            let reached = cells![seen.impacts.as_str(), seen.largest(Measure::Energy)];
            let multipliers = multipliers.iter().flat_map(|m| cells![m.re, m.im]).collect();
            table.push([place, reached, multipliers].concat());
        }
    }
    table
}

fn attractors(motions: &Motions) -> Table {
    let motion = ["motion", "branch", "periods", "impacts"];
    let starts = ["starts_of", "starts", "from_rest", "E1max", "x1", "v1", "x2", "v2"];
    let mut table = columns::table(&[&[motions.over().symbol(), "start"], &motion[..], &starts].concat());
    for sample in &motions.branches.samples {
        let place = cells![sample.value, sample.number];
        for Attractor { branch, orbit, starts, from_rest } in &sample.attractors {
            let Orbit { periods, seen, states, .. } = orbit;
            let motion = cells!["periodic", *branch, *periods, seen.impacts.as_str()];
            let starts = cells![sample.starts, *starts, *from_rest, seen.largest(Measure::Energy)];
            table.push([place.clone(), motion, starts, states[0].map(Cell::from).to_vec()].concat());
        }
        if !sample.irregular.is_empty() {
            let motion = [cells!["irregular"], vec![Cell::Empty; 3]].concat();
            let (starts, rest) = (sample.irregular.len(), sample.rest_is_irregular);
            let starts = cells![sample.starts, starts, rest, most_irregular(sample)];
            table.push([place, motion, starts, vec![Cell::Empty; 4]].concat());
        }
    }
    table
}

fn starts(basins: &Basins) -> Table {
    let mut table = columns::table(&["x1", "v1", "motion"]);
    for ([x1, v1], end) in basins.starts() {
        table.push(cells![x1, v1, end]);
    }
    table
}

/// The answer as data.
pub fn summary(motions: &Motions) -> Value {
    let [stable, irregular] = motions.branches.stable_and_irregular();
    let branches: Vec<Value> = motions
        .branches
        .branches
        .iter()
        .zip(&motions.largest)
        .map(|(branch, most)| {
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
                    "E1max": orbit.seen.largest(Measure::Energy),
                    "impacts": orbit.seen.impacts,
                })),
            })
        })
        .collect();
    json!({
        "study": motions.study.name(),
        "plan": crate::branches::options::plan_json(&motions.branches.plan),
        "stable": stable,
        "irregular": irregular,
        "branches": branches,
        "margin": motions.margin.as_ref().map(|margin| json!({
            "P": margin.own,
            "tried": margin.tried,
            "birth": margin.birth.as_ref().map(|Onset { value, omega, orbit }| json!({
                "P": value,
                "omega": omega,
                "E1max": orbit.seen.largest(Measure::Energy),
                "impacts": orbit.seen.impacts,
            })),
        })),
    })
}
