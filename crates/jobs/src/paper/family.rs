//! The responses at one stiffness of the structure, and the peaks of their curves: the data of Figures 3 to 5.

use super::plan::Plan;
use crate::{Error, Progress};
use retune_dynamics::{Parameter, Point, independent};
use retune_model::Scene;

/// The responses at one stiffness over all frequencies: without damper, with SSVI NES, with TMD.
pub struct Family {
    /// Stiffness, N/m.
    pub k1: f64,
    /// Natural frequency, rad/s.
    pub natural: f64,
    /// Half the width of the resonance without damper, rad/s.
    pub half_width: f64,
    /// Without damper, with SSVI NES, with TMD.
    pub points: [Vec<Point>; 3],
    pub scenes: [Scene; 3],
}

#[derive(Clone, Copy)]
pub struct Peak {
    /// Frequency, rad/s.
    pub omega: f64,
    /// Energy, J.
    pub energy: f64,
}

impl Family {
    pub fn compute(plan: &Plan, k1: f64, bar: &dyn Progress) -> Result<Self, Error> {
        let scenes = plan.scenes(k1)?;
        let omega = plan.file.omega.values();
        let curve = |scene| -> Result<Vec<Point>, Error> {
            let settings = plan.settings();
            Ok(independent(scene, Parameter::Omega, &omega, plan.window(), &settings, || bar.inc(1))?)
        };
        let points = [curve(&scenes[0])?, curve(&scenes[1])?, curve(&scenes[2])?];
        let primary = scenes[0].primary;
        let (natural, half_width) = (primary.natural_frequency(), primary.half_power_half_width());
        Ok(Self { k1, natural, half_width, points, scenes })
    }

    pub fn all(plan: &Plan, what: &'static str) -> Result<Vec<Self>, Error> {
        let bar = plan.watch.progress(what, (3 * plan.file.k1.len() * plan.file.omega.points) as u64);
        let families = plan.file.k1.iter().map(|&k1| Self::compute(plan, k1, &*bar)).collect();
        bar.finish();
        families
    }

    pub fn highest(&self, scene: usize) -> Peak {
        let best = self.points[scene].iter().max_by(|a, b| a.e1_max.total_cmp(&b.e1_max));
        best.map_or(Peak { omega: f64::NAN, energy: f64::NAN }, |p| Peak { omega: p.value, energy: p.e1_max })
    }

    /// Pairs of points of two curves at the frequencies within a distance of resonance, rad/s.
    pub fn near<'a>(
        &self,
        one: &'a [Point],
        other: &'a [Point],
        within: f64,
    ) -> impl Iterator<Item = (&'a Point, &'a Point)> {
        let natural = self.natural;
        one.iter().zip(other).filter(move |(point, _)| (point.value - natural).abs() <= within)
    }

    /// The share of the frequencies within the width c1/m1 of resonance at which a curve is below another, and that width, rad/s.
    pub fn share_below(&self, scene: usize, other: usize) -> (f64, f64) {
        let width = 2.0 * self.half_width;
        let pairs = self.near(&self.points[scene], &self.points[other], width);
        (share(pairs, |one, two| one.e1_max < two.e1_max), width)
    }

    /// The largest ratio of the energies with and without a damper within the width c1/m1 of resonance (`energy`), and its frequency.
    pub fn most_added(&self, scene: usize) -> Peak {
        self.near(&self.points[scene], &self.points[0], 2.0 * self.half_width)
            .map(|(with, without)| Peak { omega: with.value, energy: with.e1_max / without.e1_max })
            .max_by(|a, b| a.energy.total_cmp(&b.energy))
            .unwrap_or(Peak { omega: f64::NAN, energy: f64::NAN })
    }

    /// Number of maxima of a curve: points above both neighbours.
    pub fn maxima(&self, scene: usize) -> usize {
        let higher = |three: &&[Point]| three[1].e1_max > three[0].e1_max.max(three[2].e1_max);
        self.points[scene].windows(3).filter(higher).count()
    }

    /// Peaks of a curve: maxima of its running median over [`SMOOTH`] frequencies with a dip of `depth` (a share) between them.
    /// The median removes the scatter from one frequency to the next where the motion is chaotic.
    pub fn humps(&self, scene: usize, depth: f64) -> Vec<Peak> {
        let median = |part: &[Point]| {
            let mut energies: Vec<f64> = part.iter().map(|p| p.e1_max).collect();
            energies.sort_by(f64::total_cmp);
            Peak { omega: part[part.len() / 2].value, energy: energies[energies.len() / 2] }
        };
        let mut humps: Vec<Peak> = Vec::new();
        let mut dip = f64::INFINITY;
        let mut rising = true;
        for here in self.points[scene].windows(SMOOTH).map(median) {
            match humps.last_mut() {
                Some(_) if !rising && here.energy > dip / (1.0 - depth) => {
                    humps.push(here);
                    (rising, dip) = (true, f64::INFINITY);
                }
                Some(hump) if rising && here.energy > hump.energy => *hump = here,
                Some(hump) if here.energy < (1.0 - depth) * hump.energy => {
                    rising = false;
                    dip = dip.min(here.energy);
                }
                Some(_) => {}
                None => humps.push(here),
            }
        }
        humps
    }
}

/// The share of pairs of points for which `holds` is true.
pub fn share<'a>(
    pairs: impl Iterator<Item = (&'a Point, &'a Point)>,
    holds: impl Fn(&Point, &Point) -> bool,
) -> f64 {
    let all: Vec<bool> = pairs.map(|(one, other)| holds(one, other)).collect();
    all.iter().filter(|holds| **holds).count() as f64 / all.len().max(1) as f64
}

/// Number of frequencies in the running median of [`Family::humps`]: in the paper's study 0.09 rad/s, a fifth of the half-power
/// width c1/m1 = 0.452 rad/s of the structure's resonance. A narrower maximum is not a resonant peak.
pub const SMOOTH: usize = 9;
