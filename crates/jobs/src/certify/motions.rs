//! The motions of a design besides those from rest, over the band and the stiffnesses of its objective, at the design's force and at larger
//! ones.

use super::certificate::{Irregular, MISSED, Margin, Motions, Other, SHARE};
use crate::amount::Amount;
use rayon::prelude::*;
use retune_dynamics::Error;
use retune_dynamics::periodic::branches::Plan;
use retune_dynamics::periodic::worst::width_missed;
use retune_dynamics::periodic::{Branches, Control, branches};
use retune_model::{Measure, NonNegative, Parameter, Scene};
use retune_optim::{Evaluation, Goal, Limit, Limits, PerLimit, Stiffnesses, Unusable};
use retune_solver::Settings;
use retune_study::Margins;

/// Runs from rest over a band, and other starts for each: the defaults of `retune branches`.
const SAMPLES: usize = 31;
const STARTS: usize = 16;
/// Other starts for each with [`Effort::Few`].
const FEW: usize = 2;
/// A further force at which motions are searched for, above that of the needed margin, so that margins can be compared.
const MORE: f64 = 1.2;
/// At larger forces motions are followed only above this share of the value from rest.
const FOLLOWED: f64 = 0.8;
/// A motion counts if its value exceeds that of the runs from rest by this factor.
pub(super) const NOTABLE: f64 = 1.05;

/// How motions are searched for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Effort {
    /// Along branches, at the design's force and at larger ones for these margins.
    Whole(Margins),
    /// From a few starts, at the design's force only.
    Few,
}

pub(super) struct Coexisting {
    pub motions: Motions,
    /// None where the force has no amplitude, or was not raised.
    pub margin: Option<Margin>,
    /// The largest values of all motions at the design's force.
    pub reached: PerLimit<f64>,
}

/// A band and a stiffness of a term of the objective, over which motions are searched for.
pub(super) struct Place {
    pub scene: Scene,
    goal: Goal,
    band: [f64; 2],
    starts: usize,
    pub from_rest: f64,
}

/// The motions at a place for a multiple of the force.
pub(super) struct AtForce {
    pub times: f64,
    pub from_rest: f64,
    pub branches: Branches,
}

/// Finds the coexisting motions, and the largest value of every measure over all. None where there are none to find: without walls, without
/// a force, or with a force without a period.
pub(super) fn coexisting(
    scene: &Scene,
    own: &Evaluation,
    goal: &Goal,
    settings: &Settings,
    effort: Effort,
) -> Result<Option<Coexisting>, Unusable> {
    let strikes = scene.damper.is_some_and(|damper| damper.contact.is_some());
    // Without a force all motions end at rest.
    let is_forced = scene.forcing.amplitude().is_some_and(|(_, size)| size.get() > 0.0);
    if !strikes || scene.forcing.is_transient() || !is_forced {
        return Ok(None);
    }
    let places = places(scene, own, goal, settings)?;
    if places.iter().any(|place| place.band[0] == 0.0) {
        return Ok(None);
    }
    let measure = goal.objective.quantity();
    let needed = match effort {
        Effort::Whole(needed) if scene.forcing.amplitude().is_some_and(|(_, force)| force.get() > 0.0) => {
            Some(needed)
        }
        _ => None,
    };
    let at_force = |times: f64| {
        let all: Result<Vec<_>, Unusable> =
            places.par_iter().map(|place| place.at(times, settings, effort)).collect();
        all
    };
    let first = 1.0 + needed.map_or(0.0, |needed| needed.force);
    let (mut here, more) = if first > 1.0 {
        let (here, more) = rayon::join(|| at_force(1.0), || at_force(first));
        (here?, more?)
    } else {
        (at_force(1.0)?, Vec::new())
    };
    let is_safe = |(place, found): (&Place, &AtForce)| {
        found.branches.largest(measure).is_none_or(|one| one.value <= NOTABLE * place.from_rest)
    };
    let mut margin = needed
        .filter(|_| places.iter().zip(&here).all(is_safe))
        .map(|needed| Margin::new(&needed, &scene.forcing));
    if let Some(margin) = &mut margin {
        let mut there = margin.lower(&places, &more, measure, settings)?;
        if margin.other.is_none() && first < MORE {
            margin.safe_to = MORE;
            margin.forces.push(MORE);
            there.extend(margin.lower(&places, &at_force(MORE)?, measure, settings)?);
        }
        there.iter().for_each(|(i, seed)| here[*i].branches.adopt(seed));
    }
    let mut reached = own.reached;
    let mut all = Vec::new();
    for (place, AtForce { branches, .. }) in places.iter().zip(&here) {
        let kinds: Vec<_> = [measure].into_iter().chain(Measure::ALL).collect();
        let found = retune_dynamics::periodic::Motions::of(branches, &kinds);
        for (measure, largest) in Measure::ALL.into_iter().zip(found.largest.iter().skip(1)) {
            let limit = Limit::Of(measure);
            let value = largest.as_ref().map_or(0.0, |largest| largest.value);
            reached.set(limit, f64::max(reached.get(limit), value));
        }
        all.push(place.motions(measure, &found, effort));
    }
    let mut k1_of: Vec<f64> = places.iter().map(|place| place.scene.primary.stiffness.get()).collect();
    k1_of.sort_by(f64::total_cmp);
    k1_of.dedup();
    let most = all.into_iter().max_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    Ok(most.map(|most| Coexisting { motions: Motions { k1_of, ..most }, margin, reached }))
}

/// The places of all terms; a range of stiffnesses gives its ends and the stiffness of the worst run.
fn places(scene: &Scene, own: &Evaluation, goal: &Goal, settings: &Settings) -> Result<Vec<Place>, Unusable> {
    let terms = goal.objective.terms();
    let worst = own.worst_run(*scene, goal);
    let mut places = Vec::new();
    for (_, term) in &terms {
        let alone = Goal { objective: (*term).clone(), limits: Limits::default(), ..goal.clone() };
        let from_rest =
            if terms.len() == 1 { own.value } else { alone.evaluate(scene, settings, f64::INFINITY)?.value };
        let own_k1 = scene.primary.stiffness.get();
        let k1 = match &term.k1 {
            None => vec![own_k1],
            Some(Stiffnesses::Set(set)) => set.iter().map(|k1| k1.get()).collect(),
            Some(Stiffnesses::Range(range)) => {
                vec![range.from.get(), worst.primary.stiffness.get(), range.to.get()]
            }
        };
        let losses = term.scenes(scene)?;
        for (scene, k1) in losses.iter().flat_map(|scene| k1.iter().map(move |k1| (scene, *k1))) {
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
    pub fn plan(&self) -> Plan {
        Plan { samples: SAMPLES, starts: self.starts, ..Plan::over(Parameter::Omega, self.band) }
    }

    /// The plan at the design's force.
    fn own_plan(&self, effort: Effort) -> Plan {
        match effort {
            Effort::Whole(_) => Plan { passes: 1, ..self.plan() },
            Effort::Few => {
                let none = Some((self.goal.objective.quantity(), f64::INFINITY));
                Plan { starts: self.starts.min(FEW), least: none, ..self.plan() }
            }
        }
    }

    fn at(&self, times: f64, settings: &Settings, effort: Effort) -> Result<AtForce, Unusable> {
        let scene = with_force(&self.scene, times)?;
        // A steady motion whose damper reaches a wall has no value: the value extrapolated linearly is used instead.
        let power = if self.goal.objective.quantity() == Measure::Energy { 2 } else { 1 };
        let linear = self.from_rest * times.powi(power);
        let from_rest = if times == 1.0 {
            self.from_rest
        } else {
            self.goal.evaluate(&scene, settings, f64::INFINITY).map_or(linear, |found| found.value)
        };
        // At larger forces only motions with large values matter: smaller ones are not followed, and irregular windows are not sampled.
        let plan = if times == 1.0 {
            self.own_plan(effort)
        } else {
            Plan { least: Some((self.goal.objective.quantity(), FOLLOWED * from_rest)), ..self.plan() }
        };
        let branches = branches(&scene, plan, settings, Control::default())?;
        Ok(AtForce { times, from_rest, branches })
    }

    fn motions(
        &self,
        quantity: Measure,
        found: &retune_dynamics::periodic::Motions,
        effort: Effort,
    ) -> Motions {
        let [from, to] = self.band;
        let irregular = found.irregular.iter().map(|([from, to], value)| Irregular {
            from: *from,
            to: *to,
            value: Amount::new(quantity, *value),
        });
        let starts = self.own_plan(effort).others();
        Motions {
            from,
            to,
            k1: self.scene.primary.stiffness.get(),
            k1_of: Vec::new(),
            members_not_looked_at: self
                .goal
                .objective
                .terms()
                .iter()
                .any(|(_, term)| term.ensemble.is_some()),
            samples: SAMPLES,
            starts,
            width_missed: (to - from) * width_missed(starts, SHARE, MISSED),
            from_rest: self.from_rest,
            covered: found.covered,
            largest: found
                .largest
                .first()
                .and_then(Option::as_ref)
                .map(|largest| Other::new(quantity, largest)),
            irregular: irregular.collect(),
        }
    }
}

pub(super) fn with_force(scene: &Scene, times: f64) -> Result<Scene, Unusable> {
    match scene.forcing.amplitude() {
        Some((parameter, own)) if times != 1.0 => {
            Ok(parameter.at(*scene, times * own.get()).map_err(Error::from)?)
        }
        _ => Ok(*scene),
    }
}
