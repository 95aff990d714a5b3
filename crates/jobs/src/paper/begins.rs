//! Figure 4: where its periodic regimes begin and end, and by which bifurcation. Runs name a regime at each frequency; on the branch of its
//! motions its ends are exact.

use super::family::Family;
use super::item::Grid;
use super::motions::Motions;
use super::plan::{Plan, stiffness};
use crate::Error;
use rayon::prelude::*;
use retune_dynamics::Parameter;
use retune_dynamics::periodic::branches::{Control, Plan as BranchPlan};
use retune_dynamics::periodic::{Branch, Branches, End, EventKind, branches};
use retune_dynamics::regime::periodic_label;

/// Frequencies at which runs are started, at most, and starts at each beside that from rest.
const SAMPLES: usize = 61;
const STARTS: usize = 4;
/// The narrowest regime that is listed, as a share of the frequencies: a step of the figure.
const NARROW: f64 = 1.0 / 200.0;

/// A range of frequencies over which one branch has stable motions of one name.
struct Part {
    label: String,
    /// The frequencies, ascending, and what happens at either.
    ends: [(f64, &'static str); 2],
    /// Whether a run from rest ends on it.
    rest: bool,
}

/// The table.
///
/// # Errors
/// A scene cannot be run.
pub fn begins(plan: &Plan, families: &[Family], all: &[Motions]) -> Result<Grid, Error> {
    let head =
        ["k1, N/m", "motion", "from ω, rad/s", "to ω, rad/s", "begins by", "ends by", "reached from rest"];
    let mut grid =
        Grid::new("Where periodic motions begin and end as the frequency rises, on their branches", &head);
    let found = families.par_iter().zip(all).map(|(family, motions)| {
        let range = [motions.omega[0], motions.omega[motions.omega.len() - 1]];
        let samples = SAMPLES.min(motions.omega.len());
        let asked =
            BranchPlan { samples, starts: STARTS, passes: 1, ..BranchPlan::over(Parameter::Omega, range) };
        branches(&plan.scenes(family.k1)?[1], asked, &plan.settings(), Control::default())
            .map_err(Error::from)
    });
    for (family, found) in families.iter().zip(found.collect::<Vec<Result<Branches, Error>>>()) {
        let found = found?;
        let [from, to] = found.plan.range;
        let mut all: Vec<Part> = Vec::new();
        for (number, branch) in found.branches.iter().enumerate() {
            for part in parts(branch) {
                let rest = |value: f64| part.ends[0].0 <= value && value <= part.ends[1].0;
                let rest = found.on(number).any(|(sample, one)| one.from_rest && rest(sample.value));
                all.push(Part { rest, ..part });
            }
        }
        let wide = |part: &&Part| part.ends[1].0 - part.ends[0].0 >= NARROW * (to - from);
        grid.rows.extend(merged(all).iter().filter(wide).map(|Part { label, ends: [begin, end], rest }| {
            vec![
                stiffness(family.k1),
                label.clone(),
                format!("{:.6}", begin.0),
                format!("{:.6}", end.0),
                begin.1.to_owned(),
                end.1.to_owned(),
                if *rest { "yes" } else { "no" }.to_owned(),
            ]
        }));
    }
    Ok(grid)
}

/// Parts of one name that overlap or meet, as one, by their first frequency: those of a closed branch on either side of its first motion, or of a
/// branch that was found from several motions.
fn merged(mut parts: Vec<Part>) -> Vec<Part> {
    parts.sort_by(|a, b| a.label.cmp(&b.label).then(a.ends[0].0.total_cmp(&b.ends[0].0)));
    let mut found: Vec<Part> = Vec::new();
    for part in parts {
        match found.last_mut() {
            Some(last) if last.label == part.label && part.ends[0].0 <= last.ends[1].0 => {
                last.rest |= part.rest;
                if part.ends[1].0 > last.ends[1].0 {
                    last.ends[1] = part.ends[1];
                }
            }
            _ => found.push(part),
        }
    }
    found.sort_by(|a, b| a.ends[0].0.total_cmp(&b.ends[0].0));
    found
}

/// The parts of a branch with stable motions of one name.
fn parts(branch: &Branch) -> Vec<Part> {
    let event = |place: usize| branch.events.iter().find(|event| event.place == place);
    let last = branch.points.len() - 1;
    let why = |place: usize| match event(place) {
        Some(event) => event.kind.name(),
        None => match branch.ends[usize::from(place == last)] {
            _ if place > 0 && place < last => "not located",
            End::Range => "the range",
            End::Halved => "period doubling",
            End::Closed => "goes on",
            End::Steps | End::Lost | End::Ended => "not followed farther",
        },
    };
    let at = |place: usize| (branch.points[place].value, why(place));
    let mut found = Vec::new();
    let mut first = None;
    for place in 0..branch.points.len() {
        let goes_on = branch.is_stable_after(place);
        let ends = !goes_on || event(place).is_some_and(|event| event.kind == EventKind::Grazing);
        if let (Some(begin), true) = (first, ends) {
            // At a grazing rounding decides whether the impact counts: the motion between the ends names the part.
            let orbit = &branch.points[usize::midpoint(begin, place)];
            let struck = |wall: char| orbit.seen.impacts.matches(wall).count() as f64;
            let label = periodic_label(orbit.periods, ['S', 'O'].map(struck));
            let mut ends = [at(begin), at(place)];
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            found.push(Part { label, ends, rest: false });
            first = None;
        }
        if goes_on && first.is_none() {
            first = Some(place);
        }
    }
    found
}
