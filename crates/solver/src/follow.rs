//! Which loop follows a scene under which method.

use crate::free::Free;
use crate::hybrid::{Hybrid, Motion, Phase};
use crate::observe::Observer;
use crate::onestep::{OneStep, Run};
use crate::settings::{Method, Settings, SolverError, Window, Work};
use crate::system::System;
use crate::{dop853::Dop853, euler::Euler, ode23::Ode23, ode23s::Ode23s, ode45::Ode45, rk4::Rk4};
use nalgebra::{Const, DimMin};
use retune_model::{Bare, Coupled};

/// The state at the end of a run, and what it cost.
type Followed<const N: usize> = Result<([f64; N], Work), SolverError>;

/// Follows the bare structure from rest at `start` (s) on: `before` sees the motion to the window, `observer` that inside it.
pub fn follow_bare(
    system: &Bare,
    start: f64,
    window: Window,
    settings: &Settings,
    before: &mut impl Observer<2>,
    observer: &mut impl Observer<2>,
) -> Followed<2> {
    if settings.method != Method::Hybrid {
        return general(system, start, system.rest(), window, settings, before, observer);
    }
    let mut free = Free::new(system, window.to, settings.max_steps).started(start);
    if window.from > start {
        free.propagate(window.from, before)?;
    }
    free.propagate(window.to, observer)?;
    Ok((free.state(), free.work))
}

/// Follows a structure and its damper from rest at `start` (s) on: `before` sees the motion to the window, `observer` that inside
/// it.
#[inline(always)]
pub fn follow_coupled(
    system: &Coupled,
    start: f64,
    window: Window,
    settings: &Settings,
    before: &mut impl Observer<4>,
    observer: &mut impl Observer<4>,
) -> Followed<4> {
    if settings.method != Method::Hybrid {
        return general(system, start, system.rest(), window, settings, before, observer);
    }
    let mut hybrid = Hybrid::new(system, settings.rtol, window.to, settings.max_steps);
    let rest = Motion { t: start, y: system.rest(), phase: Phase::Flight };
    let middle = if window.from > start { hybrid.propagate(rest, window.from, before)? } else { rest };
    let end = hybrid.propagate(middle, window.to, observer)?;
    Ok((end.y, hybrid.work))
}

fn general<S: System<N>, const N: usize>(
    system: &S,
    start: f64,
    rest: [f64; N],
    window: Window,
    settings: &Settings,
    before: &mut impl Observer<N>,
    observer: &mut impl Observer<N>,
) -> Followed<N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let longest = settings.longest_step(window.to);
    let mut run = Run::new(system, settings, start, rest, longest);
    let follow = match settings.method {
        Method::Hybrid | Method::Dop853 => one_step::<Dop853, _, _, _, N>,
        Method::Ode23s => one_step::<Ode23s, _, _, _, N>,
        Method::Ode45 => one_step::<Ode45, _, _, _, N>,
        Method::Ode23 => one_step::<Ode23, _, _, _, N>,
        Method::Rk4 => one_step::<Rk4, _, _, _, N>,
        Method::Euler => one_step::<Euler, _, _, _, N>,
    };
    follow(&mut run, window, before, observer)?;
    Ok((run.state(), run.work))
}

fn one_step<M: OneStep<N>, S: System<N>, B: Observer<N>, O: Observer<N>, const N: usize>(
    run: &mut Run<'_, S, N>,
    window: Window,
    before: &mut B,
    observer: &mut O,
) -> Result<(), SolverError> {
    run.integrate::<M>(window.from, before)?;
    run.integrate::<M>(window.to, observer)
}
