//! Settled motions: a run is followed until its state recurs after some periods of the force, with only a small drift left.
//!
//! Read [`settled`], then `blocks`: the run in blocks of some periods. `crate::recurrence` says whether its states return.

mod blocks;

use crate::energy_bound;
use crate::error::SolverError;
use crate::extremes::{Ask, Extremes, bare_values};
use crate::observe::largest_values::LargestValues;
use crate::observe::observer::Unobserved;
use crate::plan::{Plan, Request};
use crate::recurrence::test::Settle;
use crate::response::Extreme;
use crate::run::Follow;
use crate::settings::{Settings, Window};
use blocks::Blocks;
use retune_model::{Bare, Coupled, PerMeasure, Scene, Steady};

/// The largest value of [`Ask::measure`] once the motion has settled: over the last of the first blocks, counted from t = 0, that agree as
/// `settle` says. A scene whose damper provably stays off both walls is computed in closed form.
///
/// The additional values are the largest from the block that contains the time of [`Ask::also`] on; those of the settled motion always
/// count.
///
/// [`Extremes::settled`] is false for a motion that has not settled by the end of `window`; its value is then that of all blocks
/// that begin in the window (of the last block, if none does).
///
/// [`Ask::cutoff`] is not used: a motion may have a large value in its transient and settle at a small one.
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
    if scene.forcing.history().is_some() {
        return Err(SolverError::NoPeriod { t: 0.0 });
    }
    let omega = scene.forcing.frequency.get();
    let closed = |steady: Steady, structure: &Bare, before: PerMeasure<f64>| {
        let of = |measure| steady.largest(structure, omega, measure);
        let chosen = ask.also.map(|also| also.measures).unwrap_or_default();
        let mut reached = before;
        chosen.chosen().for_each(|measure| reached.set(measure, before.get(measure).max(of(measure))));
        Extremes { largest: Extreme { value: of(ask.measure), time: window.to }, reached, settled: true }
    };
    let early = ask.also.filter(|also| also.from < window.to);
    let Some(damper) = &scene.damper else {
        // Without a damper the settled motion is the steady one, whichever the method.
        let system = Bare::new(&scene.primary, &scene.forcing).with_phase(ask.phase);
        let before = early.map(|also| bare_values(&system, also, window.to, settings)).transpose()?;
        return Ok(closed(system.steady(omega), &system, before.unwrap_or_default()));
    };
    let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
    let plan = Plan::of(&system, settings, Request::Settled);
    if plan == Plan::Closed {
        let steady = system.steady(omega);
        let Some(also) = early else { return Ok(closed(steady, system.bare(), PerMeasure::default())) };
        let mut seen = LargestValues::new(&system, also.measures);
        let watched = Window { from: also.from, ..window };
        let plan = Plan::of(&system, settings, Request::Motion);
        system.follow(plan, watched, settings, &mut Unobserved, &mut seen)?;
        return Ok(closed(steady, system.bare(), seen.values()));
    }
    let mut blocks = Blocks::new(&system, window.from, settle, settings, ask);
    let whole = Window { from: 0.0, ..window };
    system.follow(plan, whole, settings, &mut Unobserved, &mut blocks)?;
    let seen = blocks.result();
    let largest = energy_bound::check_largest(scene, whole, settings, ask.measure, seen.largest)?;
    Ok(Extremes { largest, ..seen })
}
