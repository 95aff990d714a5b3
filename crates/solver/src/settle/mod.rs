//! Settled motions: a run is followed until its state returns after some periods of the force, with only a small drift left.
//!
//! Read [`settled`], then `blocks` (the run in blocks of some periods), `section` (its states once per period) and `recurrence`
//! (whether they return).

mod blocks;
mod recurrence;
mod section;

pub use recurrence::Settle;

use crate::energy_bound;
use crate::error::SolverError;
use crate::extremes::{Ask, Extremes};
use crate::hybrid::contact_free::ContactFree;
use crate::observe::displacement_range::DisplacementRange;
use crate::observe::observer::Unobserved;
use crate::response::Extreme;
use crate::run::follow_coupled;
use crate::settings::{Method, Settings, Window};
use blocks::Blocks;
use retune_model::{Bare, Coupled, Scene};

/// The largest E1 once the motion has settled: over the last of the first blocks, counted from t = 0, that agree as `settle`
/// says. A scene whose damper provably stays off both walls is answered in closed form.
///
/// Stroke and force are the largest from the block that contains the time [`Ask::walls`] on; those of the settled motion always
/// count.
///
/// [`Extremes::settled`] is false for a motion that has not settled by the end of `window`; its E1max is then that of all blocks
/// that begin in the window (of the last block, if none does).
///
/// [`Ask::cutoff`] is not used: a motion may leave a large energy behind and settle at a small one.
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
    let closed = |e1_max: f64, stroke: f64| Extremes {
        e1_max: Extreme { value: e1_max, time: window.to },
        stroke,
        force: 0.0,
        settled: true,
    };
    let Some(damper) = &scene.damper else {
        return Ok(closed(Bare::new(&scene.primary, &scene.forcing).steady(omega).e1_max, 0.0));
    };
    let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
    let steady = system.steady(omega);
    let free = ContactFree::new(&system, window.to, settings.max_steps);
    if settings.method == Method::Hybrid && free.clears_walls() && steady.e1_max.is_finite() {
        let Some(from) = ask.walls else { return Ok(closed(steady.e1_max, 0.0)) };
        let mut range = DisplacementRange::new(&system, from);
        let watched = Window { from: from.min(window.to), ..window };
        follow_coupled(&system, watched, settings, &mut Unobserved, &mut range)?;
        let [transient, _] = range.stroke_and_force();
        return Ok(closed(steady.e1_max, steady.stroke().max(transient)));
    }
    let mut blocks = Blocks::new(&system, window.from, settle, settings, ask);
    let whole = Window { from: 0.0, ..window };
    follow_coupled(&system, whole, settings, &mut Unobserved, &mut blocks)?;
    let seen = blocks.verdict();
    energy_bound::energy(scene, whole, settings, seen.e1_max)?;
    Ok(seen)
}
