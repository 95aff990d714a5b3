//! The motions of a design beside those from rest, over the band of its objective.

use super::certificate::{Another, Irregular, Motions};
use crate::amount::Amount;
use retune_dynamics::Error;
use retune_dynamics::periodic::branches::Plan;
use retune_dynamics::periodic::motions;
use retune_dynamics::periodic::worst::quantity;
use retune_model::{Measure, Parameter, Scene, Source};
use retune_optim::{Evaluation, Goal, Limit, PerLimit};
use retune_solver::Settings;

/// Frequencies at which runs are started, and starts at each beside that from rest: as `retune branches` has them if not told otherwise, so
/// that an isola an eighth of the band wide, on which a fifth of the starts end, is missed once in 10⁶.
const SAMPLES: usize = 31;
const STARTS: usize = 16;

/// Finds the motions at the stiffness of the worst run, with the largest value of every measure over all. None where there is nothing to
/// find: the force has no period, or the damper strikes nothing.
///
/// # Errors
/// A scene in the band cannot be run.
pub(super) fn coexisting(
    scene: &Scene,
    own: &Evaluation,
    goal: &Goal,
    settings: &Settings,
) -> Result<Option<(Motions, PerLimit<f64>)>, Error> {
    let strikes = scene.damper.is_some_and(|damper| damper.contact.is_some());
    let watched = goal.objective.quantity();
    if matches!(scene.forcing.source, Source::Decay(_)) || !strikes {
        return Ok(None);
    }
    let scene = own.worst_run(*scene, goal);
    let omega = scene.forcing.frequency.get();
    if omega == 0.0 {
        return Ok(None);
    }
    let term = goal.term(own.worst.term);
    let band = term.and_then(|term| term.omega).map(|band| band.of(&scene.primary));
    let [from, to] = band.map_or([omega; 2], |band| [band.from, band.to]);
    let samples = if from == to { 1 } else { SAMPLES };
    let starts = term.and_then(|term| term.starts).unwrap_or(STARTS);
    let plan = Plan { samples, starts, ..Plan::over(Parameter::Omega, [from, to]) };
    let kinds: Vec<_> = [watched].iter().chain(&Measure::ALL).map(|measure| quantity(*measure)).collect();
    let found = motions(&scene, plan, settings, &kinds)?;
    let mut reached = own.reached;
    for (measure, largest) in Measure::ALL.into_iter().zip(found.largest.iter().skip(1)) {
        reached.set(Limit::Of(measure), largest.as_ref().map_or(0.0, |largest| largest.value));
    }
    let irregular = found.irregular.iter().map(|([from, to], value)| Irregular {
        from: *from,
        to: *to,
        value: Amount::new(watched, *value),
    });
    let seen = Motions {
        from,
        to,
        k1: scene.primary.stiffness.get(),
        samples,
        starts,
        covered: found.covered,
        largest: found.largest.first().and_then(Option::as_ref).map(|largest| Another::new(watched, largest)),
        irregular: irregular.collect(),
    };
    Ok(Some((seen, reached)))
}
