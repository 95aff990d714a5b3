//! The data of Figure 4: the motions of the SSVI NES over the frequencies around a resonance. Runs give the regime at each frequency; the
//! ends of periodic motions and their bifurcations are computed exactly along branches.

use super::family::Family;
use super::plan::{Plan, stiffness};
use crate::rows::of_each;
use crate::{Error, Progress, Silent};
use retune_dynamics::periodic::branches::{Control, Plan as BranchPlan};
use retune_dynamics::periodic::{Branch, End, EventKind, branches};
use retune_dynamics::poincare::Periods;
use retune_dynamics::record::coordinates;
use retune_dynamics::regime::periodic_label;
use retune_dynamics::{
    Kind, Orbit, Parameter, Record, Regime, Stretch, attractor, classify, continuation, follow, resumed,
};
use retune_model::Scene;
use retune_report::cells;
use retune_report::table::Table;

/// The starts of motions: from rest, from the frequency below, from the frequency above.
pub const STARTS: [&str; 3] = ["rest", "up", "down"];
/// Periods that are drawn, and by which motions are first compared.
const RECORD: usize = 120;
/// Periods to settle in, from rest and from the previous frequency. With a linear damper the transient has decayed after twenty.
const SETTLE: [usize; 2] = [400, 150];
/// Runs at each frequency: the record, the orbit from rest, both sweeps.
pub const RUNS: usize = 4;

/// The motions at one stiffness over the frequencies around its resonance.
pub struct Motions {
    /// Frequencies, rad/s.
    pub omega: Vec<f64>,
    /// The regime of each motion from rest.
    pub regimes: Vec<Regime>,
    /// From rest; continued upwards; continued downwards.
    pub orbits: [Vec<Orbit>; 3],
    /// Frequencies at which there is more than one motion.
    pub coexisting: Vec<Coexisting>,
}

/// Motions that exist at the same frequency.
pub struct Coexisting {
    pub index: usize,
    /// Each motion once, with the first of [`STARTS`] that leads to it.
    pub motions: Vec<(usize, Regime)>,
}

impl Motions {
    /// Computes all motions of `scene` at the plan's ratios to the frequency `natural`.
    pub fn compute(plan: &Plan, scene: &Scene, natural: f64, bar: &dyn Progress) -> Result<Self, Error> {
        let omega: Vec<f64> = plan.file.motions.values().into_iter().map(|ratio| ratio * natural).collect();
        let down: Vec<f64> = omega.iter().rev().copied().collect();
        let settings = plan.settings();
        let records = of_each(&omega, bar, |&value| {
            Ok(follow(&Parameter::Omega.at(*scene, value)?, None, Stretch::default(), &settings)?)
        })?;
        let sweep = |values: &[f64]| {
            let periods = Periods { settle: SETTLE[1], record: RECORD };
            continuation(scene, Parameter::Omega, values, periods, &settings, || bar.inc(1))
        };
        let (up, back) = rayon::join(|| sweep(&omega), || sweep(&down));
        let mut back = back?;
        back.reverse();
        let periods = Periods { settle: SETTLE[0], record: RECORD };
        let rest = of_each(&omega, bar, |value| {
            Ok(continuation(scene, Parameter::Omega, &[*value], periods, &settings, || ())?)
        })?;
        let orbits = [rest.concat(), up?, back];
        let indices: Vec<usize> = (0..omega.len()).collect();
        let differ = |&index: &usize| coexisting(plan, scene, index, &records[index], &orbits);
        let coexisting = of_each(&indices, &Silent, differ)?.into_iter().flatten().collect();
        Ok(Self { omega, regimes: records.iter().map(classify).collect(), orbits, coexisting })
    }

    /// Ranges of frequencies with the same regime: `(label, first, last)`.
    pub fn windows(&self) -> Vec<(String, usize, usize)> {
        let mut found: Vec<(String, usize, usize)> = Vec::new();
        for (i, regime) in self.regimes.iter().enumerate() {
            let label = regime.label();
            match found.last_mut() {
                Some((last, _, to)) if *last == label => *to = i,
                _ => found.push((label, i, i)),
            }
        }
        found
    }

    /// Frequencies with a motion of this kind from rest.
    pub fn count(&self, kind: Kind) -> usize {
        self.regimes.iter().filter(|regime| regime.kind == kind).count()
    }
}

/// The motions at a frequency, if there are several. Where its three orbits differ, each is continued for as long as the record from rest,
/// so that transients have decayed, and compared again.
fn coexisting(
    plan: &Plan,
    scene: &Scene,
    index: usize,
    rest: &Record,
    orbits: &[Vec<Orbit>; 3],
) -> Result<Option<Coexisting>, Error> {
    let [here, ..] = orbits.each_ref().map(|orbits| &orbits[index]);
    let scene = Parameter::Omega.at(*scene, here.value)?;
    let stretches = orbits.each_ref().map(|orbits| {
        orbits[index].samples.iter().map(|y| coordinates(&scene, y)).collect::<Vec<[f64; 4]>>()
    });
    if attractor::motions(&stretches.each_ref().map(Vec::as_slice)) == [0, 0, 0] {
        return Ok(None);
    }
    let follow_on = |orbit: &Orbit| -> Result<Record, Error> {
        let last = orbit.samples.last().copied().unwrap_or_default();
        Ok(follow(&scene, Some(resumed(&scene, last)?), Stretch::default(), &plan.settings())?)
    };
    let records = [rest.clone(), follow_on(&orbits[1][index])?, follow_on(&orbits[2][index])?];
    let settled = records.each_ref().map(|record| &record.samples[record.settle..]);
    let first = attractor::motions(&settled);
    let motions: Vec<(usize, Regime)> = (0..records.len())
        .filter(|&start| first[start] == start)
        .map(|start| (start, classify(&records[start])))
        .collect();
    Ok((motions.len() > 1).then_some(Coexisting { index, motions }))
}

/// For branches: the most frequencies at which runs are started, and the starts at each besides the one from rest.
const SAMPLES: usize = 61;
const OTHERS: usize = 4;
/// The narrowest regime listed, as a share of the range: a step of the figure.
const NARROW: f64 = 1.0 / 200.0;

/// A range of frequencies over which a branch has stable motions with the same label.
struct Part {
    label: String,
    /// The two frequencies, ascending, and the event at each.
    ends: [(f64, &'static str); 2],
    /// Whether a run from rest ends on it.
    rest: bool,
}

/// The table of the ranges of periodic motions.
pub fn begins(plan: &Plan, all: &[(Family, Motions)]) -> Result<Table, Error> {
    let found = of_each(all, &Silent, |(family, motions)| {
        let range = [motions.omega[0], motions.omega[motions.omega.len() - 1]];
        let samples = SAMPLES.min(motions.omega.len());
        let wanted =
            BranchPlan { samples, starts: OTHERS, passes: 1, ..BranchPlan::over(Parameter::Omega, range) };
        Ok(branches(&family.scenes[1], wanted, &plan.settings(), Control::default())?)
    })?;
    let mut table = Table::headed(
        "k1, N/m | motion | from ω, rad/s | to ω, rad/s | begins by | ends by | reached from rest",
    );
    for ((family, _), found) in all.iter().zip(found) {
        let [from, to] = found.plan.range;
        let parts = found.branches.iter().enumerate().flat_map(|(number, branch)| {
            let rest = found.on(number).filter(|(_, one)| one.from_rest).map(|(sample, _)| sample.value);
            stable_parts(branch, &rest.collect::<Vec<f64>>())
        });
        for Part { label, ends: [begin, end], rest } in merged(parts.collect()) {
            if end.0 - begin.0 >= NARROW * (to - from) {
                table.push(cells![
                    stiffness(family.k1),
                    label,
                    format!("{:.6}", begin.0),
                    format!("{:.6}", end.0),
                    begin.1,
                    end.1,
                    if rest { "yes" } else { "no" },
                ]);
            }
        }
    }
    Ok(table)
}

/// Joins parts with the same label that overlap or meet, sorted by frequency: those of a closed branch on either side of its first motion,
/// or of a branch found from several motions.
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

/// The parts of a branch with stable motions of one label; `from_rest` are the frequencies at which runs from rest end on it.
fn stable_parts(branch: &Branch, from_rest: &[f64]) -> Vec<Part> {
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
        let stable_after = branch.is_stable_after(place);
        let ends = !stable_after || event(place).is_some_and(|event| event.kind == EventKind::Grazing);
        if let (Some(begin), true) = (first, ends) {
            // At a grazing rounding decides whether the impact counts, so the motion in the middle labels the part.
            let orbit = &branch.points[usize::midpoint(begin, place)];
            let struck = |wall: char| orbit.seen.impacts.matches(wall).count() as f64;
            let label = periodic_label(orbit.periods, ['S', 'O'].map(struck));
            let mut ends = [at(begin), at(place)];
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            let rest = from_rest.iter().any(|value| (ends[0].0..=ends[1].0).contains(value));
            found.push(Part { label, ends, rest });
            first = None;
        }
        if stable_after && first.is_none() {
            first = Some(place);
        }
    }
    found
}
