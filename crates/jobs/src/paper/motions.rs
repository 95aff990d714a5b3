//! The data of Figure 4: the motions of the SSVI NES over the frequencies around a resonance.

use super::plan::Plan;
use crate::Error;
use crate::Progress;
use rayon::prelude::*;
use retune_dynamics::poincare::Periods;
use retune_dynamics::record::coordinates;
use retune_dynamics::{
    Kind, Orbit, Parameter, Record, Regime, Stretch, attractor, classify, continuation, follow,
    independent_orbits, resumed,
};
use retune_model::Scene;

/// The starts of motions: from rest, from the frequency below, from the frequency above.
pub const STARTS: [&str; 3] = ["rest", "up", "down"];
/// Periods that are drawn, and from which motions are first compared.
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
    /// Index of the frequency.
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
        let record = |&value: &f64| -> Result<Record, retune_dynamics::Error> {
            let record = follow(&Parameter::Omega.at(*scene, value)?, None, Stretch::default(), &settings)?;
            bar.inc(1);
            Ok(record)
        };
        let records: Vec<Result<Record, retune_dynamics::Error>> = omega.par_iter().map(record).collect();
        let records = records.into_iter().collect::<Result<Vec<_>, _>>()?;
        let sweep = |values: &[f64]| {
            let periods = Periods { settle: SETTLE[1], record: RECORD };
            continuation(scene, Parameter::Omega, values, periods, &settings, || bar.inc(1))
        };
        let (up, back) = rayon::join(|| sweep(&omega), || sweep(&down));
        let mut back = back?;
        back.reverse();
        let periods = Periods { settle: SETTLE[0], record: RECORD };
        let rest = independent_orbits(scene, Parameter::Omega, &omega, periods, &settings, || bar.inc(1))?;
        let orbits = [rest, up?, back];
        let indices: Vec<usize> = (0..omega.len()).collect();
        let found: Vec<Result<Option<Coexisting>, Error>> = indices
            .par_iter()
            .map(|&index| coexisting(plan, scene, index, &records[index], &orbits))
            .collect();
        let coexisting = found.into_iter().filter_map(Result::transpose).collect::<Result<_, _>>()?;
        Ok(Self { omega, regimes: records.iter().map(classify).collect(), orbits, coexisting })
    }

    /// Neighbouring frequencies with the same name: `(label, first, last)`.
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

/// Where the three orbits of a frequency differ, each is continued for as long as the record from rest, and compared again:
/// transients have then decayed.
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
