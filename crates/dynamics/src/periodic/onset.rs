//! The value of a parameter from which a motion exists. At several frequencies the motion is followed down along the parameter to the
//! bifurcation beyond which it is not stable; the least of these values is where its branch along ω begins.

use super::branches::Branches;
use super::orbit::Orbit;
use super::shooting::Shooting;
use super::trace::{Branch, trace};
use retune_model::{Parameter, Scene};

/// Number of motions of a branch from which the parameter is changed.
const SEEDS: usize = 7;
/// The unit of the parameter on the way, as a share of its value: steps are at most a fiftieth of this.
const SPAN: f64 = 0.5;
/// Number of refinements by a parabola through the three lowest values.
const PARABOLAS: usize = 3;

/// A motion at a frequency, which is the value of its orbit.
#[derive(Clone, Debug)]
pub struct Seed {
    shooting: Shooting,
    /// The motion.
    pub orbit: Orbit,
}

/// Where a motion begins.
#[derive(Clone, Debug)]
pub struct Onset {
    /// The value of the parameter.
    pub value: f64,
    /// The frequency, rad/s.
    pub omega: f64,
    /// The motion there; its value is that of the parameter.
    pub orbit: Orbit,
}

impl Branches {
    /// Some stable motions along ω for which `counts` is true, of each branch that has any, and each such motion whose branch is not known.
    pub fn seeds(&self, shooting: &Shooting, counts: impl Fn(&Orbit) -> bool) -> Vec<Vec<Seed>> {
        let seed =
            |orbit: &Orbit| Seed { shooting: shooting.of_periods(orbit.periods), orbit: orbit.clone() };
        let of_branches = self.branches.iter().map(|branch| branch.seeds(&counts));
        let alone =
            self.samples.iter().flat_map(|sample| &sample.attractors).filter(|one| one.branch.is_none());
        let alone = alone.map(|one| &one.orbit).filter(|orbit| counts(orbit)).map(|orbit| vec![seed(orbit)]);
        of_branches.chain(alone).filter(|seeds| !seeds.is_empty()).collect()
    }

    /// Follows the branch of a motion of the scene, unless it is on a known one.
    pub fn adopt(&mut self, seed: &Seed) {
        let Seed { shooting, orbit } = seed;
        let motion = shooting.correct_at_value(&shooting.unknowns(&orbit.states, orbit.value));
        if let Some(motion) = motion
            && self.holds(shooting, &motion).is_none()
        {
            self.follow(shooting, &motion, &|| true);
        }
    }
}

impl Branch {
    /// Some of its stable motions for which `counts` is true, in the order of their ω.
    pub fn seeds(&self, counts: impl Fn(&Orbit) -> bool) -> Vec<Seed> {
        let stable = (0..self.points.len()).filter(|i| self.is_stable_at(*i)).map(|i| &self.points[i]);
        let all: Vec<&Orbit> = stable.filter(|orbit| counts(orbit)).collect();
        let last = all.len().saturating_sub(1);
        let mut places: Vec<usize> = (0..SEEDS).map(|i| i * last / (SEEDS - 1)).collect();
        places.dedup();
        let some = places.into_iter().filter_map(|i| all.get(i));
        let seed = |orbit: &&Orbit| Seed { shooting: self.shooting.clone(), orbit: (*orbit).clone() };
        let mut seeds: Vec<Seed> = some.map(seed).collect();
        seeds.sort_by(|a, b| a.orbit.value.total_cmp(&b.orbit.value));
        seeds
    }
}

impl Seed {
    /// The scene of the motion.
    pub(super) fn scene(&self) -> &Scene {
        &self.shooting.forced.scene
    }

    /// The stable motion that this one becomes as a parameter other than ω changes to a value; none if it vanishes before.
    pub fn moved(&self, parameter: Parameter, to: f64) -> Option<Self> {
        let points = self.along(parameter, to)?;
        let end = points.into_iter().find(|orbit| orbit.value == to && orbit.is_stable())?;
        let mut shooting = self.shooting.clone();
        shooting.forced.scene = parameter.at(shooting.forced.scene, to).ok()?;
        Some(Self { shooting, orbit: Orbit { value: self.orbit.value, ..end } })
    }

    /// The stable motions as a parameter changes towards a value, also beyond a fold.
    fn along(&self, parameter: Parameter, to: f64) -> Option<Vec<Orbit>> {
        let from = parameter.of(&self.shooting.forced.scene).filter(|from| *from > 0.0)?;
        let along = self.shooting.along(self.orbit.value, parameter, SPAN * from).ok()?;
        let start = along.correct_at_value(&along.unknowns(&self.orbit.states, from))?;
        let branch = trace(&along, &start, [from.min(to), from.max(to)], &|| true)?;
        let stable = (0..branch.points.len()).filter(|i| branch.is_stable_at(*i));
        Some(stable.map(|i| branch.points[i].clone()).collect())
    }

    /// The least value of a parameter, down to `to`, at which it exists and `counts` is true.
    fn onset(
        &self,
        parameter: Parameter,
        to: f64,
        counts: &(dyn Fn(&Orbit) -> bool + Sync),
    ) -> Option<Onset> {
        let points = self.along(parameter, to)?.into_iter().filter(counts);
        let orbit = points.min_by(|a, b| a.value.total_cmp(&b.value))?;
        Some(Onset { value: orbit.value, omega: self.orbit.value, orbit })
    }

    /// The motion at another frequency.
    fn at(&self, omega: f64) -> Option<Self> {
        let Self { shooting, orbit } = self;
        let motion = shooting.correct_at_value(&shooting.unknowns(&orbit.states, omega))?;
        Some(Self { orbit: Orbit::of(shooting, &motion).ok()?, shooting: shooting.clone() })
    }
}

/// The least value of a parameter, from that of the scene down to `to`, at which motions of a branch along ω exist and `counts` is true.
/// The value of the motions passed to `counts` is that of the parameter.
pub fn onset(
    seeds: &[Seed],
    parameter: Parameter,
    to: f64,
    counts: &(dyn Fn(&Orbit) -> bool + Sync),
) -> Option<Onset> {
    let mut all: Vec<(Onset, &Seed)> =
        seeds.iter().filter_map(|seed| Some((seed.onset(parameter, to, counts)?, seed))).collect();
    for _ in 0..PARABOLAS {
        let Some(least) = (0..all.len()).min_by(|a, b| all[*a].0.value.total_cmp(&all[*b].0.value)) else {
            break;
        };
        let Some(omega) = least.checked_sub(1).and_then(|first| lowest(all.get(first..first + 3)?)) else {
            break;
        };
        let seed = all[least].1;
        let Some(next) = seed.at(omega).and_then(|seed| seed.onset(parameter, to, counts)) else { break };
        if !(next.value > to && next.value < all[least].0.value) {
            break;
        }
        let place = least + usize::from(next.omega > all[least].0.omega);
        all.insert(place, (next, seed));
    }
    all.into_iter().map(|(onset, _)| onset).min_by(|a, b| a.value.total_cmp(&b.value))
}

/// The frequency at which the parabola through three values is lowest.
fn lowest(three: &[(Onset, &Seed)]) -> Option<f64> {
    let [(x, a), (y, b), (z, c)] = [0, 1, 2].map(|i| (three[i].0.omega, three[i].0.value));
    let [left, right] = [(b - a) / (y - x), (c - b) / (z - y)];
    let omega = 0.5 * (x + y) - 0.5 * left * (z - x) / (right - left);
    (right > left && omega > x && omega < z && omega != y).then_some(omega)
}
