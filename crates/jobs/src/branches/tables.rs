//! The tables of `branches`.

use crate::Error;
use crate::branches::basins::STARTS;
use crate::branches::found::Found;
use retune_dynamics::periodic::{Onset, Orbit};
use retune_store::Directory;
use retune_study::joined;
use serde_json::{Value, json};

/// A row for each motion of each branch.
pub const BRANCHES: &str = "branches.csv";
/// A row for each event.
pub const BIFURCATIONS: &str = "bifurcations.csv";
/// A row for each motion on which runs settle, at each sample.
pub const ATTRACTORS: &str = "attractors.csv";
/// The states from which the motions of the branches are followed.
pub const STATES: &str = "states.csv";

/// Writes them.
///
/// # Errors
/// A file cannot be written.
pub fn write(found: &Found, directory: &Directory) -> Result<(), Error> {
    let symbol = found.branches.plan.parameter.symbol();
    let mut points =
        format!("branch,place,{symbol},periods,impacts,stable,E1max,x1max,stroke,contact_force,multiplier\n");
    let mut states = "branch,place,segment,x1,v1,x2,v2\n".to_owned();
    let mut events =
        format!("branch,place,kind,{symbol},periods,impacts,E1max,re1,im1,re2,im2,re3,im3,re4,im4\n");
    for (number, branch) in found.branches.branches.iter().enumerate() {
        for (place, orbit) in branch.points.iter().enumerate() {
            points += &format!(
                "{number},{place},{},{},{},{},{}\n",
                head(orbit),
                u8::from(orbit.is_stable()),
                values(orbit),
                orbit.seen.force,
                orbit.multipliers[0].norm(),
            );
            for (segment, y) in orbit.states.iter().enumerate() {
                states += &format!("{number},{place},{segment},{}\n", joined(y, ","));
            }
        }
        for event in &branch.events {
            let orbit = &event.orbit;
            let multipliers: Vec<f64> = orbit.multipliers.iter().flat_map(|m| [m.re, m.im]).collect();
            events += &format!(
                "{number},{},{},{},{},{}\n",
                event.place,
                event.kind.name(),
                head(orbit),
                orbit.seen.e1_max,
                joined(&multipliers, ",")
            );
        }
    }
    let mut attractors = format!(
        "{symbol},start,motion,branch,periods,impacts,starts_of,starts,from_rest,E1max,x1,v1,x2,v2\n"
    );
    for sample in &found.branches.samples {
        let (value, all) = (sample.value, sample.starts);
        let number = sample.number.map(|number| number.to_string()).unwrap_or_default();
        for one in &sample.attractors {
            let Orbit { periods, seen, states, .. } = &one.orbit;
            attractors += &format!(
                "{value},{number},periodic,{},{periods},{},{all},{},{},{},{}\n",
                one.branch.map(|branch| branch.to_string()).unwrap_or_default(),
                seen.impacts,
                one.starts,
                u8::from(one.from_rest),
                seen.e1_max,
                joined(&states[0], ",")
            );
        }
        if !sample.irregular.is_empty() {
            let most = sample.irregular.iter().map(|seen| seen.e1_max).fold(0.0, f64::max);
            attractors += &format!(
                "{value},{number},irregular,,,,{all},{},{},{most},,,,\n",
                sample.irregular.len(),
                u8::from(sample.rest_is_irregular)
            );
        }
    }
    directory.write(BRANCHES, &points)?;
    directory.write(STATES, &states)?;
    directory.write(BIFURCATIONS, &events)?;
    directory.write(ATTRACTORS, &attractors)?;
    if let Some(basins) = &found.basins {
        directory.write(STARTS, &crate::branches::basins::table(basins))?;
    }
    Ok(directory.write_json("branches.json", &summary(found))?)
}

/// The parameter's value, the periods and the impacts.
fn head(orbit: &Orbit) -> String {
    format!("{},{},{}", orbit.value, orbit.periods, orbit.seen.impacts)
}

fn values(orbit: &Orbit) -> String {
    let seen = &orbit.seen;
    joined(&[seen.e1_max, seen.displacement, seen.stroke], ",")
}

/// The answer as data.
pub fn summary(found: &Found) -> Value {
    let [stable, irregular] = found.branches.stable_and_irregular();
    let branches: Vec<Value> = found
        .branches
        .branches
        .iter()
        .zip(&found.largest)
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
                    "E1max": orbit.seen.e1_max,
                    "impacts": orbit.seen.impacts,
                })),
            })
        })
        .collect();
    json!({
        "study": found.study.name(),
        "plan": crate::branches::options::plan_json(&found.branches.plan),
        "stable": stable,
        "irregular": irregular,
        "branches": branches,
        "margin": found.margin.as_ref().map(|margin| json!({
            "P": margin.own,
            "tried": margin.tried,
            "birth": margin.birth.as_ref().map(|Onset { value, omega, orbit }| json!({
                "P": value,
                "omega": omega,
                "E1max": orbit.seen.e1_max,
                "impacts": orbit.seen.impacts,
            })),
        })),
    })
}
