//! Follows a motion by its [`Plan`]: the one place where a plan becomes a loop over time.

use crate::error::SolverError;
use crate::hybrid::contact_free::ContactFree;
use crate::hybrid::propagator::{Hybrid, Motion, Phase};
use crate::linear::flow::Flow;
use crate::linear::pieces::longest_step;
use crate::linear::reduced::Reduced;
use crate::methods::onestep::Run;
use crate::methods::{dop853::Dop853, euler::Euler, ode23::Ode23, ode23s::Ode23s, ode45::Ode45, rk4::Rk4};
use crate::observe::observer::Observer;
use crate::plan::{General, Plan, Planned, Request};
use crate::recurrence::repeats::follow_until_it_repeats;
use crate::response::Work;
use crate::settings::{Settings, Window};
use crate::system::{LinearSystem, System};
use nalgebra::{Const, DimMin};
use retune_model::{Bare, Coupled, Scene};

/// The state at the end of a run, and its work.
type Followed<const N: usize> = Result<([f64; N], Work), SolverError>;

/// A lower bound on the number of steps of a run of `seconds` (s) by the default method, unless it [`leaves_out_a_fast_part`]: its flight
/// steps. Contacts add to them.
pub fn least_steps(scene: &Scene, seconds: f64) -> f64 {
    let Scene { primary, forcing, damper } = scene;
    let bare = Bare::new(primary, forcing);
    let step = match damper {
        None => Flow::new(bare.linear(), seconds).step(),
        Some(damper) => Flow::new(Coupled::new(primary, forcing, damper).linear(), seconds).step(),
    };
    // Each piece of a record takes at least one step.
    let paced_step = longest_step(bare.sampled_force(), step);
    let paced = seconds.min(bare.paced_until());
    paced / paced_step + (seconds - paced) / step
}

/// Whether a run of `seconds` (s) by the default method leaves out a fast part of the motion (such as that of a strong dashpot) once it has
/// decayed, and continues its flight in longer steps.
pub fn leaves_out_a_fast_part(scene: &Scene, seconds: f64) -> bool {
    let Scene { primary, forcing, damper } = scene;
    let bare = Bare::new(primary, forcing);
    let paced = bare.sampled_force().filter(|_| seconds <= bare.paced_until());
    let longest = longest_step(paced, seconds);
    match damper {
        None => Reduced::of(&Flow::new(bare.linear(), longest), longest).is_some(),
        Some(damper) => {
            let linear = Coupled::new(primary, forcing, damper).linear();
            Reduced::of(&Flow::new(linear, longest), longest).is_some()
        }
    }
}

/// A system whose run from its start at t = 0 can be followed by any plan.
pub trait Follow<const N: usize>: Planned<N> {
    /// Follows the motion to the end of a window, or until it repeats where the plan allows this. `before` observes the motion before the
    /// window, `observer` the motion inside it. Returns the last state reached, and the work.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    fn follow(
        &self,
        plan: Plan,
        window: Window,
        settings: &Settings,
        before: &mut dyn Observer<N>,
        observer: &mut dyn Observer<N>,
    ) -> Followed<N> {
        self.follow_for(plan, window, settings, before, observer)
    }

    /// [`Self::follow`] compiled for this observer, which is a few per cent faster: for the runs of a search. Compiling the loops over time
    /// for every observer would make a build half as long again.
    ///
    /// # Errors
    /// As [`Self::follow`].
    fn follow_for(
        &self,
        plan: Plan,
        window: Window,
        settings: &Settings,
        before: &mut dyn Observer<N>,
        observer: &mut (impl Observer<N> + ?Sized),
    ) -> Followed<N>;
}

impl Follow<2> for Bare {
    fn follow_for(
        &self,
        plan: Plan,
        window: Window,
        settings: &Settings,
        before: &mut dyn Observer<2>,
        observer: &mut (impl Observer<2> + ?Sized),
    ) -> Followed<2> {
        match plan {
            Plan::General(method) => follow_general(method, self, window, settings, before, observer),
            _ => follow_free(self, window, settings, before, observer),
        }
    }
}

impl Follow<4> for Coupled {
    fn follow_for(
        &self,
        plan: Plan,
        window: Window,
        settings: &Settings,
        before: &mut dyn Observer<4>,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Followed<4> {
        match plan {
            Plan::General(_) if self.is_rigid() => Err(SolverError::RigidWalls { t: 0.0 }),
            Plan::General(method) => follow_general(method, self, window, settings, before, observer),
            Plan::Closed | Plan::Free => follow_free(self, window, settings, before, observer),
            Plan::UntilItRepeats(late) => {
                follow_until_it_repeats(self, window, late, settings, before, observer)
            }
            Plan::Hybrid => {
                let mut hybrid = Hybrid::new(self, settings.rtol, window.to, settings.max_steps);
                let start = Motion::start(self);
                let middle =
                    if window.from > 0.0 { hybrid.propagate(start, window.from, before)? } else { start };
                let end = hybrid.propagate_for(middle, window.to, observer, None)?;
                Ok((end.y, hybrid.work))
            }
        }
    }
}

/// Follows a system that has no walls or provably touches none.
fn follow_free<S: LinearSystem<N>, const N: usize>(
    system: &S,
    window: Window,
    settings: &Settings,
    before: &mut dyn Observer<N>,
    observer: &mut (impl Observer<N> + ?Sized),
) -> Followed<N> {
    let mut free = ContactFree::new(system, window.to, settings.max_steps);
    if window.from > 0.0 {
        free.propagate(window.from, before)?;
    }
    free.propagate(window.to, observer)?;
    Ok((free.state(), free.work))
}

/// Follows any system by a general method, whose loop calls observers by dynamic dispatch.
fn follow_general<S: LinearSystem<N>, const N: usize>(
    method: General,
    system: &S,
    window: Window,
    settings: &Settings,
    before: &mut dyn Observer<N>,
    mut observer: &mut (impl Observer<N> + ?Sized),
) -> Followed<N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let run = Run::new(system, settings, 0.0, system.start(), settings.longest_step(window.to));
    let run = follow_stretches(method, system, run, window.from, before)?;
    let run = follow_stretches(method, system, run, window.to, &mut observer)?;
    Ok((run.state(), run.work))
}

/// Continues a run to time `to` (s) by a general method. Its steps end where the force or its slope jumps, and no step evaluates the force
/// beyond.
fn follow_stretches<'a, S: LinearSystem<N>, const N: usize>(
    method: General,
    system: &'a S,
    mut run: Run<'a, S, N>,
    to: f64,
    observer: &mut dyn Observer<N>,
) -> Result<Run<'a, S, N>, SolverError>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    run.extend_budget(to);
    while let Some(stretch) = system.structure().stretch(run.time()) {
        observer.discontinuity();
        let during = system.during(stretch);
        let mut part = run.with_system(&during);
        method.follow(&mut part, stretch.to.min(to), observer)?;
        run = part.with_system(system);
        if stretch.to >= to || observer.satisfied() {
            return Ok(run);
        }
    }
    method.follow(&mut run, to, observer)?;
    Ok(run)
}

/// Follows a structure and its damper from any moment on, by the plan for its motion.
pub struct Follower<'a> {
    system: &'a Coupled,
    settings: Settings,
    propagator: Propagator<'a>,
}

enum Propagator<'a> {
    Exact(Box<Hybrid<'a>>),
    /// Without walls, in steps of at most this many seconds.
    Free(f64),
    Steps(General),
}

impl<'a> Follower<'a> {
    /// Prepares for stretches of at most `longest` seconds, each of which may take [`Settings::max_steps`] steps.
    pub fn new(system: &'a Coupled, settings: &Settings, longest: f64) -> Self {
        let propagator = match Plan::of(system, settings, Request::Motion) {
            Plan::General(method) => Propagator::Steps(method),
            Plan::Closed | Plan::Free => Propagator::Free(longest),
            Plan::Hybrid | Plan::UntilItRepeats(_) => {
                Propagator::Exact(Box::new(Hybrid::new(system, settings.rtol, longest, settings.max_steps)))
            }
        };
        Self { system, settings: *settings, propagator }
    }

    /// Follows the motion to time `to` (s) or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError`] with the time reached.
    pub fn propagate(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut dyn Observer<4>,
    ) -> Result<Motion, SolverError> {
        match &mut self.propagator {
            Propagator::Exact(hybrid) => {
                hybrid.work = Work::default();
                hybrid.propagate(from, to, observer)
            }
            Propagator::Free(longest) => {
                let mut free =
                    ContactFree::new(self.system, *longest, self.settings.max_steps).from(from.t, from.y);
                free.propagate(to, observer)?;
                Ok(Motion { t: to, y: free.state(), phase: Phase::Flight })
            }
            Propagator::Steps(_) if self.system.is_rigid() => Err(SolverError::RigidWalls { t: from.t }),
            Propagator::Steps(method) => {
                let longest = self.settings.longest_step(to - from.t);
                let run = Run::new(self.system, &self.settings, from.t, from.y, longest);
                let run = follow_stretches(*method, self.system, run, to, observer)?;
                Ok(Motion { t: run.time(), y: run.state(), phase: Phase::of(self.system, &run.state()) })
            }
        }
    }
}

impl General {
    /// Continues a run to time `to` (s).
    fn follow<S: System<N>, const N: usize>(
        self,
        run: &mut Run<'_, S, N>,
        to: f64,
        observer: &mut dyn Observer<N>,
    ) -> Result<(), SolverError>
    where
        Const<N>: DimMin<Const<N>, Output = Const<N>>,
    {
        match self {
            Self::Ode23s => run.integrate::<Ode23s>(to, observer),
            Self::Ode45 => run.integrate::<Ode45>(to, observer),
            Self::Ode23 => run.integrate::<Ode23>(to, observer),
            Self::Dop853 => run.integrate::<Dop853>(to, observer),
            Self::Rk4 => run.integrate::<Rk4>(to, observer),
            Self::Euler => run.integrate::<Euler>(to, observer),
        }
    }
}
