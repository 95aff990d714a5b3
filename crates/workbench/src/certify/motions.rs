//! The motions of a design beside those from rest, over the band of its objective and for every stiffness of it: at its own force, and at more force,
//! from where they are followed back.

use super::certificate::{Another, Irregular, MISSED, Margin, Motions, Other, ParameterError, SHARE};
use crate::amount::Amount;
use rayon::prelude::*;
use retune_dynamics::Error;
use retune_dynamics::periodic::branches::{Plan, SPACINGS, equations};
use retune_dynamics::periodic::worst::{quantity, width_missed};
use retune_dynamics::periodic::{Branches, Onset, Seed, Watch, branches, onset};
use retune_model::{Measure, NonNegative, Parameter, Scene, Source};
use retune_optim::{Evaluation, Goal, Limit, Limits, PerLimit, Stiffnesses, Unusable};
use retune_solver::Settings;
use retune_study::Margins;

/// Runs from rest over a band, and other starts for each: as `retune branches` has them if not told otherwise.
const SAMPLES: usize = 31;
const STARTS: usize = 16;
/// A force at which motions are looked for beside that of the margin that is needed, so that margins can be compared.
const MORE: f64 = 1.2;
/// A motion counts that has by this factor more than the runs from rest.
const MUCH: f64 = 1.05;
/// How far forces are followed down, as a share of the own: below it, for where a motion begins says how a parameter moves that.
const DOWN: f64 = 0.9;
/// The parameters whose errors are tried.
const PARAMETERS: [Parameter; 8] = [
    Parameter::K1,
    Parameter::C1,
    Parameter::M2,
    Parameter::K2,
    Parameter::C2,
    Parameter::D,
    Parameter::C,
    Parameter::R,
];

/// What was found.
pub(super) struct Found {
    pub motions: Motions,
    /// None where the force has no amplitude.
    pub margin: Option<Margin>,
    /// The largest values of all motions at the design's own force.
    pub reached: PerLimit<f64>,
}

/// Where motions are looked for: a band and a stiffness of a term of the objective.
struct Place {
    scene: Scene,
    goal: Goal,
    band: [f64; 2],
    starts: usize,
    /// The value of the runs from rest.
    from_rest: f64,
}

/// The motions at a place for a force.
struct AtForce {
    times: f64,
    from_rest: f64,
    branches: Branches,
}

/// Finds them, with the largest value of every measure over all. None where there is nothing to find: the force has no period, or the damper strikes nothing.
///
/// # Errors
/// A scene in the band cannot be run.
pub(super) fn coexisting(
    scene: &Scene,
    own: &Evaluation,
    goal: &Goal,
    settings: &Settings,
    needed: Margins,
) -> Result<Option<Found>, Unusable> {
    let strikes = scene.damper.is_some_and(|damper| damper.contact.is_some());
    if !strikes || matches!(scene.forcing.source, Source::Decay(_)) {
        return Ok(None);
    }
    let places = places(scene, own, goal, settings)?;
    if places.iter().any(|place| place.band[0] == 0.0) {
        return Ok(None);
    }
    let measure = goal.objective.quantity();
    let force = Parameter::P.of(scene).filter(|force| *force > 0.0);
    let look = |times: f64| {
        let all: Result<Vec<_>, Unusable> =
            places.par_iter().map(|place| place.at(times, settings)).collect();
        all
    };
    let first = 1.0 + needed.force;
    let (mut here, more) = if force.is_some() && first > 1.0 {
        let (here, more) = rayon::join(|| look(1.0), || look(first));
        (here?, more?)
    } else {
        (look(1.0)?, Vec::new())
    };
    let is_safe = |(place, found): (&Place, &AtForce)| {
        found.branches.largest(quantity(measure)).is_none_or(|one| one.value <= MUCH * place.from_rest)
    };
    let mut margin = force.filter(|_| places.iter().zip(&here).all(is_safe)).map(|_| Margin::new(&needed));
    if let Some(margin) = &mut margin {
        let mut there = margin.lower(&places, &more, measure, settings)?;
        if margin.other.is_none() && first < MORE {
            margin.safe_to = MORE;
            margin.forces.push(MORE);
            there.extend(margin.lower(&places, &look(MORE)?, measure, settings)?);
        }
        there.iter().for_each(|(i, seed)| here[*i].branches.adopt(seed));
    }
    let mut reached = own.reached;
    let mut all = Vec::new();
    for (place, AtForce { branches, .. }) in places.iter().zip(&here) {
        let kinds: Vec<_> = [measure].iter().chain(&Measure::ALL).map(|measure| quantity(*measure)).collect();
        let found = retune_dynamics::periodic::Motions::of(branches, &kinds);
        for (measure, largest) in Measure::ALL.into_iter().zip(found.largest.iter().skip(1)) {
            let limit = Limit::Of(measure);
            let value = largest.as_ref().map_or(0.0, |largest| largest.value);
            reached.set(limit, f64::max(reached.get(limit), value));
        }
        all.push(place.motions(measure, &found));
    }
    let mut k1_of: Vec<f64> = places.iter().map(|place| place.scene.primary.stiffness.get()).collect();
    k1_of.sort_by(f64::total_cmp);
    k1_of.dedup();
    let most = all.into_iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    Ok(most.map(|most| Found { motions: Motions { k1_of, ..most }, margin, reached }))
}

/// The places of all terms. Of a range of stiffnesses, its ends and that of the worst run.
fn places(scene: &Scene, own: &Evaluation, goal: &Goal, settings: &Settings) -> Result<Vec<Place>, Unusable> {
    let terms = goal.objective.terms();
    let worst = own.worst_run(*scene, goal);
    let mut places = Vec::new();
    for (_, term) in &terms {
        let alone = Goal { objective: (*term).clone(), limits: Limits::default(), ..goal.clone() };
        let from_rest = if terms.len() == 1 {
            own.energy
        } else {
            alone.evaluate(scene, settings, f64::INFINITY)?.energy
        };
        let own_k1 = scene.primary.stiffness.get();
        let k1 = match &term.k1 {
            None => vec![own_k1],
            Some(Stiffnesses::Set(set)) => set.iter().map(|k1| k1.get()).collect(),
            Some(Stiffnesses::Range(range)) => {
                vec![range.from.get(), worst.primary.stiffness.get(), range.to.get()]
            }
        };
        for k1 in k1 {
            let mut scene = *scene;
            scene.primary.stiffness = NonNegative::new(k1).map_err(Unusable::Stiffness)?;
            let omega = scene.forcing.frequency.get();
            let band = term.omega.map_or([omega; 2], |band| {
                let band = band.of(&scene.primary);
                [band.from, band.to]
            });
            let starts = term.starts.unwrap_or(STARTS);
            places.push(Place { scene, goal: alone.clone(), band, starts, from_rest });
        }
    }
    Ok(places)
}

impl Place {
    fn plan(&self) -> Plan {
        Plan { samples: SAMPLES, starts: self.starts, ..Plan::over(Parameter::Omega, self.band) }
    }

    /// The motions for a multiple of the force.
    fn at(&self, times: f64, settings: &Settings) -> Result<AtForce, Unusable> {
        let scene = with_force(&self.scene, times)?;
        let from_rest = if times == 1.0 {
            self.from_rest
        } else {
            self.goal.evaluate(&scene, settings, f64::INFINITY)?.energy
        };
        // Irregular windows are sampled densely at the own force alone: runs there take longest.
        let plan = Plan { looks: if times == 1.0 { SPACINGS.len() } else { 0 }, ..self.plan() };
        let branches = branches(&scene, plan, settings, Watch::default())?;
        Ok(AtForce { times, from_rest, branches })
    }

    /// Follows the motions that have much more at a larger force back: lowers the margin to where the first of them begins, and gives those that are
    /// there at the own force.
    fn lower(
        &self,
        found: &AtForce,
        measure: Measure,
        settings: &Settings,
        margin: &mut Margin,
    ) -> Result<Vec<Seed>, Unusable> {
        let of = quantity(measure);
        let own = Parameter::P.of(&self.scene).unwrap_or_default();
        let errors = 0.01 * margin.needed_percent;
        // As a power of the force between the two that are known.
        let power = (found.from_rest / self.from_rest).ln() / found.times.ln();
        let much = move |times: f64| MUCH * self.from_rest * times.powf(power);
        let counts = |orbit: &retune_dynamics::periodic::Orbit| of(&orbit.seen) > much(orbit.value / own);
        let k1 = self.scene.primary.stiffness.get();
        let largest = found.branches.largest(of);
        if let Some(one) = largest.filter(|one| one.orbit.is_none() && one.value > much(found.times)) {
            // It cannot be followed: it may begin anywhere above the force that was looked at before.
            let before =
                margin.forces.iter().copied().filter(|times| *times < found.times).fold(1.0, f64::max);
            let value = Amount::new(measure, one.value);
            let other = Other { value, omega: one.at, k1, periods: None, impacts: String::new() };
            margin.lower_to(before, other);
        }
        let scene = with_force(&self.scene, found.times)?;
        let shooting = equations(&scene, &self.plan(), settings)?;
        let seeds = found.branches.seeds(&shooting, |orbit| of(&orbit.seen) > much(found.times));
        let other = |onset: &Onset| Other {
            value: Amount::new(measure, of(&onset.orbit.seen)),
            omega: onset.omega,
            k1,
            periods: Some(onset.orbit.periods),
            impacts: onset.orbit.seen.impacts.clone(),
        };
        let begins = |seeds: &[Seed]| onset(seeds, Parameter::P, DOWN * own, &counts);
        let onsets: Vec<Option<Onset>> = seeds.par_iter().map(|seeds| begins(seeds)).collect();
        let mut there = Vec::new();
        for (seeds, onset) in seeds.iter().zip(onsets) {
            let Some(onset) = onset else { continue };
            margin.lower_to(onset.value / own, other(&onset));
            if onset.value <= own {
                there.extend(seeds.iter().filter_map(|seed| seed.moved(Parameter::P, own)));
                continue;
            }
            for parameter in PARAMETERS {
                let Some(value) = parameter.of(&self.scene).filter(|value| *value > 0.0) else { continue };
                let at = |error: &f64| {
                    let moved: Vec<Seed> = seeds
                        .par_iter()
                        .filter_map(|seed| seed.moved(parameter, value * (1.0 + error)))
                        .collect();
                    let onset = begins(&moved).filter(|moved| moved.value <= own)?;
                    Some((*error, onset))
                };
                for (error, moved) in [-errors, errors].iter().filter_map(at) {
                    // The force at which it begins falls all but evenly over so small an error.
                    let share = (onset.value - own) / (onset.value - moved.value);
                    margin.add(parameter.symbol(), 100.0 * error * share, other(&moved));
                }
            }
        }
        Ok(there)
    }

    fn motions(&self, quantity: Measure, found: &retune_dynamics::periodic::Motions) -> Motions {
        let [from, to] = self.band;
        let irregular = found.irregular.iter().map(|([from, to], value)| Irregular {
            from: *from,
            to: *to,
            value: Amount::new(quantity, *value),
        });
        let starts = self.plan().others();
        Motions {
            from,
            to,
            k1: self.scene.primary.stiffness.get(),
            k1_of: Vec::new(),
            samples: SAMPLES,
            starts,
            width_missed: (to - from) * width_missed(starts, SHARE, MISSED),
            from_rest: self.from_rest,
            covered: found.covered,
            largest: found
                .largest
                .first()
                .and_then(Option::as_ref)
                .map(|largest| Another::new(quantity, largest)),
            irregular: irregular.collect(),
        }
    }
}

impl Margin {
    /// Before any motion is found.
    fn new(needed: &Margins) -> Self {
        Self {
            needed_force: 1.0 + needed.force,
            forces: vec![1.0 + needed.force],
            safe_to: 1.0 + needed.force,
            other: None,
            needed_percent: 100.0 * needed.errors,
            parameters: Vec::new(),
        }
    }

    /// Lowers it by what is found at more force; gives the motions that are there at the own force, each with the number of its place.
    fn lower(
        &mut self,
        places: &[Place],
        found: &[AtForce],
        measure: Measure,
        settings: &Settings,
    ) -> Result<Vec<(usize, Seed)>, Unusable> {
        let mut there = Vec::new();
        for (i, (place, found)) in places.iter().zip(found).enumerate() {
            there.extend(place.lower(found, measure, settings, self)?.into_iter().map(|seed| (i, seed)));
        }
        Ok(there)
    }

    /// A motion that begins at a multiple of the force.
    fn lower_to(&mut self, times: f64, other: Other) {
        if times < self.safe_to {
            (self.safe_to, self.other) = (times, Some(other));
        }
    }

    /// A motion that an error of a parameter brings; the least error of each is kept.
    fn add(&mut self, parameter: &'static str, percent: f64, other: Other) {
        let known = self.parameters.iter().position(|one| one.parameter == parameter);
        let one = ParameterError { parameter, percent, other };
        match known {
            None => self.parameters.push(one),
            Some(i) if percent.abs() < self.parameters[i].percent.abs() => self.parameters[i] = one,
            Some(_) => {}
        }
    }
}

fn with_force(scene: &Scene, times: f64) -> Result<Scene, Unusable> {
    let force = Parameter::P.of(scene).unwrap_or_default();
    if times == 1.0 { Ok(*scene) } else { Ok(Parameter::P.at(*scene, times * force).map_err(Error::from)?) }
}
