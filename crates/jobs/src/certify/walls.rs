//! The value of a design between other walls than those of its study: walls that lose more or less, softer ones and stiffer ones.

use super::certificate::{AtRestitution, AtStiffness, Certificate, Found, Walls};
use crate::Error;
use rayon::prelude::*;
use retune_model::{Contact, Damper, Loss, Measure, Parameter, Scene};
use retune_optim::{Goal, Limits, Response, Unusable};
use retune_study::Study;

/// Restitutions, each the same at every speed; the first is that of walls that lose nothing.
const RESTITUTIONS: [f64; 5] = [1.0, 0.9, 0.8, 0.7, 0.6];
/// Multiples of the stiffness K of both walls.
const FACTORS: [f64; 2] = [0.5, 2.0];

/// The design of a certificate between other walls; none where it touches none, or its steady motion has a value only away from them.
pub(super) fn other_walls(study: &Study, certificate: &Certificate) -> Option<Walls> {
    let (scene, goal) = (&study.scene, study.goal());
    scene.damper?.contact?;
    if goal.objective.is_steady() || !(certificate.strikes() || touches(study)) {
        return None;
    }
    // Each with a loss in place of those that the objective has, or with the study's own.
    let mut with_loss = goal.clone();
    with_loss.objective.for_each_term(&mut |term| term.restitution = None);
    let settings = study.solver.settings();
    let found = |goal: &Goal, scene: Result<Scene, Unusable>| {
        let found = scene.and_then(|scene| goal.evaluate(&scene, &settings, f64::INFINITY));
        Found::new(found.map_err(Error::from), !goal.limits.is_empty())
    };
    let at = |&restitution: &f64| AtRestitution {
        restitution,
        found: found(&with_loss, with_restitution(*scene, restitution)),
    };
    let stiffness = Parameter::Q.of(scene); // K is proportional to q; rigid walls have none
    let softer = |&factor: &f64| {
        let scene = with(*scene, Parameter::Q, factor * stiffness?);
        Some(AtStiffness { factor, found: found(&goal, scene) })
    };
    let (restitutions, stiffness) = rayon::join(
        || RESTITUTIONS.par_iter().map(at).collect(),
        || FACTORS.par_iter().filter_map(softer).collect(),
    );
    Some(Walls::new(study, certificate.value, &certificate.sensitivity, restitutions, stiffness))
}

/// Whether the damper touches a wall in a run from rest over the band of the objective; said to, where that cannot be told.
fn touches(study: &Study) -> bool {
    let mut goal = Goal { limits: Limits::default(), peaks: false, ..study.goal() };
    goal.window.from = 0.0;
    goal.objective.for_each_term(&mut |term| {
        (term.quantity, term.response) = (Measure::ContactForce, Response::Window);
        term.restitution = None; // what touches nothing loses nothing
    });
    let found = goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY);
    !found.is_ok_and(|found| found.worst.largest <= 0.0)
}

/// A scene whose contacts have a restitution, whatever their loss was.
fn with_restitution(mut scene: Scene, restitution: f64) -> Result<Scene, Unusable> {
    if let Some(Damper { contact: Some(Contact::Hertz(surfaces)), .. }) = &mut scene.damper {
        (surfaces.loss, surfaces.loss_obstacle) = (Loss::default(), None);
    }
    with(scene, Parameter::Restitution, restitution)
}

fn with(mut scene: Scene, parameter: Parameter, value: f64) -> Result<Scene, Unusable> {
    parameter.set(&mut scene, value).map_err(|source| Unusable::Value { parameter, source })?;
    Ok(scene)
}
