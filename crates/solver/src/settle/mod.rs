//! Settled motions: a run is followed until its state returns after some periods of the force, with only a small drift left.
//!
//! Read [`settled`], then `blocks`: the run in blocks of some periods. `crate::recurrence` says whether its states return.

mod blocks;

use crate::energy_bound;
use crate::error::SolverError;
use crate::extremes::{Ask, Extremes};
use crate::hybrid::contact_free::clears_walls;
use crate::observe::displacement_range::DisplacementRange;
use crate::observe::observer::Unobserved;
use crate::recurrence::test::Settle;
use crate::response::Extreme;
use crate::run::follow_coupled;
use crate::settings::{Method, Settings, Window};
use blocks::Blocks;
use retune_model::{Bare, Coupled, Scene, Steady};

/// The largest value of [`Ask::measure`] once the motion has settled: over the last of the first blocks, counted from t = 0, that agree as `settle`
/// says. A scene whose damper provably stays off both walls is answered in closed form.
///
/// Stroke and force are the largest from the block that contains the time [`Ask::walls`] on; those of the settled motion always
/// count.
///
/// [`Extremes::settled`] is false for a motion that has not settled by the end of `window`; its value is then that of all blocks
/// that begin in the window (of the last block, if none does).
///
/// [`Ask::cutoff`] is not used: a motion may leave a large value behind and settle at a small one.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn settled(
    scene: &Scene,
    window: Window,
    settle: Settle,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let omega = scene.forcing.frequency.get();
    let closed = |largest: f64, stroke: f64| Extremes {
        largest: Extreme { value: largest, time: window.to },
        stroke,
        force: 0.0,
        settled: true,
    };
    let Some(damper) = &scene.damper else {
        let system = Bare::new(&scene.primary, &scene.forcing);
        return Ok(closed(system.steady(omega).largest(&system, omega, ask.measure), 0.0));
    };
    let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
    if let Some(steady) = in_closed_form(&system, settings) {
        let largest = steady.largest(system.bare(), omega, ask.measure);
        let Some(from) = ask.walls else { return Ok(closed(largest, 0.0)) };
        let mut range = DisplacementRange::new(&system, from, f64::INFINITY);
        let watched = Window { from: from.min(window.to), ..window };
        follow_coupled(&system, watched, settings, &mut Unobserved, &mut range)?;
        return Ok(closed(largest, steady.stroke().max(range.stroke().value)));
    }
    let mut blocks = Blocks::new(&system, window.from, settle, settings, ask);
    let whole = Window { from: 0.0, ..window };
    follow_coupled(&system, whole, settings, &mut Unobserved, &mut blocks)?;
    let seen = blocks.verdict();
    let largest = energy_bound::largest(scene, whole, settings, ask.measure, seen.largest)?;
    Ok(Extremes { largest, ..seen })
}

/// The steady motion, if the damper provably stays off both walls.
pub(crate) fn in_closed_form(system: &Coupled, settings: &Settings) -> Option<Steady> {
    let steady = system.steady(system.bare().frequency());
    (settings.method == Method::Hybrid && clears_walls(system) && steady.e1_max.is_finite()).then_some(steady)
}
