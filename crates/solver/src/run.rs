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

/// The least number of steps of a run of `seconds` (s) by the default method, unless it [`leaves_out_a_fast_part`]: those of its flight.
/// Contacts add to them.
pub fn least_steps(scene: &Scene, seconds: f64) -> f64 {
    let Scene { primary, forcing, damper } = scene;
    let bare = Bare::new(primary, forcing);
    let step = match damper {
        None => Flow::new(bare.linear(), seconds).step(),
        Some(damper) => Flow::new(Coupled::new(primary, forcing, damper).linear(), seconds).step(),
    };
    // Each piece of a record is a step at least.
    let over = longest_step(bare.sampled_force(), step);
    let paced = seconds.min(bare.paced_until());
    paced / over + (seconds - paced) / step
}

/// Whether a run of `seconds` (s) by the default method leaves out a fast part of its flights once that has decayed, as that of a strong
/// dashpot, and flies on in longer steps.
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
    /// Follows it to the end of a window, or until its motion repeats where the plan allows: `before` sees the motion to the window,
    /// `observer` that inside it. Returns the last state that was reached, and the work.
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

    /// The same, compiled for this observer, and some per cent faster: for the runs that a search consists of. Compiled for every observer, loops
    /// over time would make a build half as long again.
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
            Plan::General(method) => follow_by(method, self, window, settings, before, observer),
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
            Plan::General(method) => follow_by(method, self, window, settings, before, observer),
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

/// Follows what has no walls to touch.
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

/// Follows any system by a general method, whose loop calls observers through a table.
fn follow_by<S: LinearSystem<N>, const N: usize>(
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

/// Continues a run to time `to` (s) by a general method. Its steps end where the force jumps or bends, and none sees the force beyond.
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
    run.allow(to);
    while let Some(stretch) = system.structure().stretch(run.time()) {
        observer.seam();
        let during = system.during(stretch);
        let mut part = run.on(&during);
        method.follow(&mut part, stretch.to.min(to), observer)?;
        run = part.on(system);
        if stretch.to >= to || observer.satisfied() {
            return Ok(run);
        }
    }
    method.follow(&mut run, to, observer)?;
    Ok(run)
}

/// A structure and its damper, followed from any moment on by the plan for its motion.
pub struct Follower<'a> {
    system: &'a Coupled,
    settings: Settings,
    way: Way<'a>,
}

enum Way<'a> {
    Exact(Box<Hybrid<'a>>),
    /// Without walls, in steps of at most so many seconds.
    Free(f64),
    Steps(General),
}

impl<'a> Follower<'a> {
    /// Prepares for stretches of at most `longest` seconds, each of which may take [`Settings::max_steps`] steps.
    pub fn new(system: &'a Coupled, settings: &Settings, longest: f64) -> Self {
        let way = match Plan::of(system, settings, Request::Motion) {
            Plan::General(method) => Way::Steps(method),
            Plan::Closed | Plan::Free => Way::Free(longest),
            Plan::Hybrid | Plan::UntilItRepeats(_) => {
                Way::Exact(Box::new(Hybrid::new(system, settings.rtol, longest, settings.max_steps)))
            }
        };
        Self { system, settings: *settings, way }
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
        match &mut self.way {
            Way::Exact(hybrid) => {
                hybrid.work = Work::default();
                hybrid.propagate(from, to, observer)
            }
            Way::Free(longest) => {
                let mut free =
                    ContactFree::new(self.system, *longest, self.settings.max_steps).from(from.t, from.y);
                free.propagate(to, observer)?;
                Ok(Motion { t: to, y: free.state(), phase: Phase::Flight })
            }
            Way::Steps(_) if self.system.is_rigid() => Err(SolverError::RigidWalls { t: from.t }),
            Way::Steps(method) => {
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
