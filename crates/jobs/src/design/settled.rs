//! Moves the window of a candidate to where its transients have decayed.

use super::resonance::about_resonance;
use retune_model::{NonNegative, Positive, Scene};
use retune_study::{Span, Study};
use std::f64::consts::TAU;

/// Most periods of the forcing to wait until a motion has settled: more would take minutes.
const SETTLED: f64 = 1000.0;
/// A motion has not settled if its goal grows by more than this share when the window begins twice as late.
const GROWTH: f64 = 0.01;

/// The study with its window moved, at equal length, to where the slowest transient of `scene` without walls has decayed, unless it has by
/// t0; at most `most` periods of the force. With a small stroke or mass of the damper the motion builds up from rest for hundreds of
/// periods and would be measured too early.
pub(super) fn settling(study: &Study, scene: &Scene, most: f64) -> Study {
    if !settles_late(study, scene) {
        return study.clone();
    }
    let period = TAU / scene.forcing.frequency.get();
    let settled = Span::settled(scene).map_or(f64::INFINITY, |span| span.t0.get());
    beginning_at(study, settled.min(most * period))
}

/// The study by which a candidate is evaluated. A damper that strikes its walls may damp less than one without walls. If the structure
/// alone decays slowly, the window is moved until the goal no longer grows, over the band and at its worst place.
pub(super) fn settled(study: &Study) -> Study {
    let mut current = settling(study, &study.scene, SETTLED);
    let bare = Scene { damper: None, ..study.scene };
    if study.scene.damper.is_none_or(|damper| damper.contact.is_none()) || !settles_late(&current, &bare) {
        return current;
    }
    let most = SETTLED * TAU / study.scene.forcing.frequency.get();
    let mut found = worst(&current);
    while 2.0 * current.window.t0.get() <= most {
        let Some((value, place)) = found else { break };
        let later = beginning_at(&current, 2.0 * current.window.t0.get());
        let next = worst(&later);
        let grows = |from: f64, to: f64| to > (1.0 + GROWTH) * from;
        let grows_there =
            || at(&current, &place).zip(at(&later, &place)).is_some_and(|(from, to)| grows(from, to));
        if !next.is_some_and(|(next, _)| grows(value, next)) && !grows_there() {
            break;
        }
        (current, found) = (later, next);
    }
    current
}

/// The goal of a study, and the scene of its worst run; none where there is no value.
fn worst(study: &Study) -> Option<(f64, Scene)> {
    let worst = |study: &Study| {
        let goal = study.goal();
        let found = goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY).ok()?;
        Some((found.value, found.worst_run(study.scene, &goal)))
    };
    let (all, narrow) = (worst(study)?, about_resonance(study).and_then(|narrow| worst(&narrow)));
    Some(narrow.filter(|narrow| narrow.0 > all.0).unwrap_or(all))
}

/// The goal in one run.
fn at(study: &Study, scene: &Scene) -> Option<f64> {
    let mut goal = study.goal();
    goal.objective.for_each_term(&mut |term| (term.omega, term.k1) = (None, None));
    Some(goal.evaluate(scene, &study.solver.settings(), f64::INFINITY).ok()?.value)
}

/// The study with its window, at equal length, and its limits starting at t0, s.
fn beginning_at(study: &Study, t0: f64) -> Study {
    let mut study = study.clone();
    let length = study.window.end.get() - study.window.t0.get();
    if let (Ok(t0), Ok(end)) = (NonNegative::new(t0), Positive::new(t0 + length)) {
        study.window = Span { t0, end };
        if let Some(from) = study.optimize.as_mut().and_then(|optimize| optimize.limits.from.as_mut()) {
            *from = t0; // limits apply to the same motion as the objective
        }
    }
    study
}

/// Whether transients of a scene reach into the window of a study.
pub(super) fn settles_late(study: &Study, scene: &Scene) -> bool {
    (Study { scene: *scene, ..study.clone() }).unsettled().is_some()
}
