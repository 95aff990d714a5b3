//! The measurements behind a certificate.

use super::certificate::{
    Certificate, FINER, Kept, Measured, Motion, Near, Neighbourhood, Run, Sensitivity, Verdict, WorstRun,
};
use super::motions::{Effort, coexisting};
use crate::Error;
use crate::amount::Amount;
use rayon::prelude::*;
use retune_dynamics::{Stretch, classify, follow};
use retune_model::{Damper, Measure, Parameter, Scene, Source};
use retune_optim::{
    Ensemble, Evaluation, Goal, Limits, Objective, PerLimit, Place, Response, Statistic, Stiffnesses,
    Unusable,
};
use retune_solver::{Ask, Method, Settings, Settle, Window, extremes, settled};
use retune_study::Study;

/// Relative errors of a parameter at which its sensitivity is evaluated.
const ERRORS: [f64; 6] = [-0.01, -0.005, -0.0025, 0.0025, 0.005, 0.01];
/// The neighbourhood: designs whose k1, k2, c2, D and C are off by at most a thousandth.
const NEIGHBOURS: Ensemble =
    Ensemble { members: 64, phases: false, errors: 1e-3, seed: 0, statistic: Statistic::Mean };
/// The convergence study: the default method at three tolerances, and two methods that share nothing with it but the equations.
const CONVERGENCE: [(Method, f64); 5] = [
    (Method::Hybrid, 1e-8),
    (Method::Hybrid, 1e-10),
    (Method::Hybrid, 1e-12),
    (Method::Dop853, 1e-12),
    (Method::Ode45, 1e-10),
];
/// Displacement of the structure, m, below which the absolute tolerance of methods that step in time is reduced in proportion.
const SMALL: f64 = 1e-3;
/// Phase shift of the force between rigid walls, rad, per unit of the relative tolerance that it stands in for.
const PHASE_SHIFT: f64 = 1e-3;
/// For steady motions by methods that step in time: shortest and longest run, s; its length in times of the slowest decay; the criterion
/// for settling.
const LONG: [f64; 2] = [2000.0, 5e4];
const DECAYS: f64 = 40.0;
const STEADY: Settle = Settle { periods: 10, blocks: 3, tolerance: 1e-9 };

/// Which designs are run from starts other than rest.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum OtherStarts {
    Always,
    /// Those whose verdict may depend on them.
    WhereTheyDecide,
    /// Those whose verdict may depend on them, with few starts and at the design's force only.
    FewWhereTheyDecide,
}

/// The parameters that are inexact in a built design.
fn inexact() -> impl Iterator<Item = Parameter> {
    use Parameter::{C, C1, C2, D, K1, K2, Lambda, M1, M2, Omega, R, Restitution};
    let bodies = [M1, C1, K1, M2, K2, C2, D, C, R].into_iter();
    bodies.chain(Parameter::AMPLITUDES).chain([Omega, Lambda, Restitution])
}

pub(super) fn measure(study: &Study, damper: &Damper, others: OtherStarts) -> Result<Certificate, Error> {
    let (goal, settings) = (study.goal(), study.solver.settings());
    let (own, known) = goal.known(&study.scene, &settings)?;
    let outcome = |scene: &Scene| Outcome::of(goal.evaluate_following(scene, &settings, &known));
    let mut near = Vec::new();
    let sensitivity = sensitivities(study, &goal, outcome, &mut near);
    let neighbourhood = neighbourhood(&study.scene, outcome, &mut near);
    let convergence = convergence(&own.worst, &goal, &settings)?;
    let finer = finer(&goal).map(|goal| {
        let found = Outcome::of(goal.evaluate(&study.scene, &settings, f64::INFINITY));
        near.push(Near {
            at: format!("with {FINER} times the samples"),
            neighbour: false,
            reached: found.reached,
        });
        found.energy
    });
    let motion = match own.worst.scene.forcing.source {
        Source::Decay(_) => Motion::without_period("free decay", "dies out"),
        Source::History(_) if goal.objective.is_stationary() => {
            Motion::without_period("stationary", "is random, and goes on")
        }
        Source::History(_) => Motion::without_period("transient", "dies out"),
        _ => Motion::new(&classify(&follow(&own.worst.scene, None, Stretch::default(), &settings)?)),
    };
    let Place { largest, scene, phase, .. } = own.worst;
    let quantity = study.quantity();
    let worst_run = WorstRun {
        value: Amount::new(quantity, largest),
        omega: scene.forcing.frequency.get(),
        k1: scene.primary.stiffness.get(),
        phase,
    };
    let limits = Kept::new(&goal.limits, &own.reached, &near);
    let mut measured = Measured {
        has_walls: damper.contact.is_some(),
        worst_run,
        convergence,
        finer,
        motion,
        motions: None,
        margin: None,
        sensitivity,
        neighbourhood,
        limits,
    };
    let so_far = measured.judged(Amount::new(quantity, own.value)).verdict;
    let effort = match others {
        OtherStarts::FewWhereTheyDecide => Effort::Few,
        _ => Effort::Whole(study.certificate),
    };
    let decide = matches!(so_far, Some(Verdict::Robust | Verdict::Edge));
    if (decide || others == OtherStarts::Always)
        && let Some(found) = coexisting(&study.scene, &own, &goal, &settings, effort)?
    {
        let at = "on a motion from another start".to_owned();
        near.push(Near { at, neighbour: false, reached: found.reached });
        (measured.motions, measured.margin) = (Some(found.motions), found.margin);
        measured.limits = Kept::new(&goal.limits, &own.reached, &near);
    }
    Ok(Certificate::new(study, damper, &own, measured))
}

/// The goal with [`FINER`] times the samples of its frequency bands and stiffness ranges; none if nothing is sampled.
fn finer(goal: &Goal) -> Option<Goal> {
    let (mut goal, mut any) = (goal.clone(), false);
    goal.objective.for_each_term(&mut |term| {
        let band = term.omega.as_mut().filter(|_| term.response != Response::Steady);
        let band = band.map(|band| &mut band.samples);
        let range = match &mut term.k1 {
            Some(Stiffnesses::Range(range)) => Some(&mut range.samples),
            _ => None,
        };
        for samples in band.into_iter().chain(range) {
            *samples = FINER * (*samples - 1) + 1;
            any = true;
        }
    });
    any.then_some(goal)
}

/// The largest displacement of the structure as a share of [`SMALL`], at most 1. The absolute tolerance of methods that step in time is
/// scaled by it; otherwise a motion of nanometres would count as unpredictable.
fn smallness(scene: &Scene, window: Window, settings: &Settings) -> f64 {
    let ask = Ask { measure: Measure::Displacement, ..Ask::default() };
    let whole = Window { from: 0.0, ..window };
    let largest = extremes(scene, whole, settings, ask).map_or(SMALL, |found| found.largest.value);
    if largest > 0.0 { (largest / SMALL).min(1.0) } else { 1.0 }
}

/// The value of the worst run by every method of the convergence study; infinite where one that steps in time cannot finish it.
fn convergence(worst: &Place, goal: &Goal, settings: &Settings) -> Result<Vec<Run>, Unusable> {
    let (response, settle) =
        goal.term(worst.term).map_or((Response::Steady, STEADY), |term| (term.response, term.settle));
    let quantity = goal.objective.quantity();
    let walls = worst.scene.damper.and_then(|damper| damper.contact);
    let rigid = walls.is_some_and(|walls| walls.rigid().is_some());
    let small = smallness(&worst.scene, goal.window, settings);
    let decay = worst.scene.slowest_decay();
    let long = if decay > 0.0 { (DECAYS / decay).clamp(LONG[0], LONG[1]) } else { LONG[0] };
    let run = |&(method, rtol): &(Method, f64)| {
        let settings = Settings { method, rtol, atol: 0.01 * rtol * small, ..*settings };
        // Between rigid walls there is no tolerance to vary: a tiny phase shift of the force shows instead whether the motion is
        // predictable.
        let phase_shift = if rigid { PHASE_SHIFT * rtol } else { 0.0 };
        let ask = Ask { measure: quantity, phase: worst.phase + phase_shift, ..Ask::default() };
        if goal.objective.is_stationary() {
            let value = goal.evaluate(&worst.scene, &settings, f64::INFINITY)?.value;
            return Ok(Run { method, rtol, value: Amount::new(quantity, value) });
        }
        let found = match response {
            Response::Window => extremes(&worst.scene, goal.window, &settings, ask),
            Response::Settled => settled(&worst.scene, goal.window, settle, &settings, ask),
            Response::Motions => {
                let term = goal.term(worst.term).cloned().unwrap_or_default();
                let objective =
                    Objective { omega: None, k1: None, restitution: None, ensemble: None, ..term };
                let nominal = Goal { objective, limits: Limits::default(), ..goal.clone() };
                let value = nominal.evaluate(&worst.scene, &settings, f64::INFINITY)?.value;
                return Ok(Run { method, rtol, value: Amount::new(quantity, value) });
            }
            Response::Steady => settled(&worst.scene, Window { from: 0.0, to: long }, STEADY, &settings, ask),
        };
        // Methods that step in time may fail on the stiffest scenes, or where the motion takes too long to become steady.
        let value = match found {
            Err(_) if method != Method::Hybrid => f64::INFINITY,
            Ok(found) if response == Response::Steady && !found.settled => f64::INFINITY,
            found => found?.largest.value,
        };
        Ok(Run { method, rtol, value: Amount::new(quantity, value) })
    };
    // Only the default method follows motions and rigid walls; for a stationary motion the tolerance is that of an integral.
    let default_only = response == Response::Motions || goal.objective.is_stationary() || rigid;
    let other = |method: Method| !default_only || method == Method::Hybrid;
    CONVERGENCE.par_iter().filter(|(method, _)| other(*method)).map(run).collect()
}

/// The objective with each parameter slightly off; parameters that are zero have no relative error. The limited quantities go to `near`.
fn sensitivities(
    study: &Study,
    goal: &Goal,
    outcome: impl Fn(&Scene) -> Outcome + Sync,
    near: &mut Vec<Near>,
) -> Vec<Sensitivity> {
    let single = goal.objective.terms().iter().any(|(_, term)| term.omega.is_none());
    let tried = inexact().filter(|parameter| single || *parameter != Parameter::Omega);
    let known: Vec<(Parameter, f64)> = tried
        .filter_map(|parameter| Some((parameter, parameter.of(&study.scene)?)))
        .filter(|(parameter, value)| {
            *value != 0.0 && !(*parameter == Parameter::Restitution && *value == 1.0)
        })
        .collect();
    let off: Vec<(Parameter, f64, f64)> = known
        .iter()
        .flat_map(|&(parameter, value)| {
            // No restitution is above 1.
            let most = if parameter == Parameter::Restitution { 1.0 } else { f64::INFINITY };
            ERRORS.map(|error| (parameter, error, (value * (1.0 + error)).min(most)))
        })
        .collect();
    let at = |&(parameter, _, value): &(Parameter, f64, f64)| {
        parameter.at(study.scene, value).map_or(Outcome::NOTHING, |scene| outcome(&scene))
    };
    let found: Vec<Outcome> = off.par_iter().map(at).collect();
    near.extend(off.iter().zip(&found).map(|((name, error, _), found)| Near {
        at: format!("with {name} off by {:+} %", 100.0 * error),
        neighbour: false,
        reached: found.reached,
    }));
    let energies: Vec<f64> = found.iter().map(|found| found.energy).collect();
    let read = |(&(parameter, value), energies): (&(Parameter, f64), &[f64])| {
        Sensitivity::new(parameter.symbol(), value, &ERRORS, energies)
    };
    known.iter().zip(energies.chunks(ERRORS.len())).map(read).collect()
}

/// The objective of the neighbours. Their limited quantities go to `near`.
fn neighbourhood(
    scene: &Scene,
    outcome: impl Fn(&Scene) -> Outcome + Sync,
    near: &mut Vec<Near>,
) -> Neighbourhood {
    let member = |i: u32| {
        let scene = NEIGHBOURS.member(scene, i);
        scene.map_or(Outcome::NOTHING, |(scene, _)| outcome(&scene))
    };
    let found: Vec<Outcome> = (0..NEIGHBOURS.members).into_par_iter().map(member).collect();
    let at = format!("for a design within {} %", 100.0 * NEIGHBOURS.errors);
    near.extend(found.iter().map(|found| Near { at: at.clone(), neighbour: true, reached: found.reached }));
    Neighbourhood::new(NEIGHBOURS.errors, found.iter().map(|found| found.energy).collect())
}

/// The evaluation of a scene.
struct Outcome {
    /// The value of the objective; infinite where it cannot be computed.
    energy: f64,
    reached: PerLimit<f64>,
}

impl Outcome {
    const NOTHING: Self = Self { energy: f64::INFINITY, reached: PerLimit::all(0.0) };

    fn of(found: Result<Evaluation, Unusable>) -> Self {
        found.map_or(Self::NOTHING, |found| Self { energy: found.value, reached: found.reached })
    }
}
