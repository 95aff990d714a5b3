//! Retune's own methods on a scene.

use crate::record::Found;
use crate::scenes::Case;
use retune_model::Coupled;
use retune_solver::methods::{Dop853, Euler, Ode23, Ode23s, Ode45, Rk4, Run};
use retune_solver::observe::Observer;
use retune_solver::{
    Contacts, Hybrid, Method, Motion, Phase, Settings, SolverError, Window, e1_max, simulate, touch_downs,
};
use retune_workbench::verify::methods;
use std::time::{Duration, Instant};

/// The shortest of several runs, s: after a warm-up 100 runs if one takes less than a millisecond, else fewer.
pub fn shortest_of<T>(mut run: impl FnMut() -> T) -> f64 {
    let timed = |run: &mut dyn FnMut()| {
        let begun = Instant::now();
        run();
        begun.elapsed()
    };
    let mut once = || {
        std::hint::black_box(run());
    };
    let warm_up = timed(&mut once);
    let wanted = match warm_up {
        t if t < Duration::from_millis(1) => 100,
        t if t < Duration::from_millis(20) => 6,
        t if t < Duration::from_millis(150) => 2,
        t => return t.as_secs_f64(),
    };
    (0..wanted).map(|_| timed(&mut once)).fold(Duration::MAX, Duration::min).as_secs_f64()
}

/// Most steps of a run.
pub const MOST_STEPS: u64 = 3_000_000;

/// Settings of a method at a tolerance, or at a step.
pub fn settings(method: Method, contacts: Contacts, setting: f64) -> Settings {
    methods::settings(method, contacts, setting, MOST_STEPS)
}

/// All results of one run; the time is that of finding E1max alone.
///
/// # Errors
/// The reason why the run failed.
pub fn run(case: &Case, settings: &Settings, timed: bool) -> Result<Found, String> {
    let window = Window { from: 0.0, to: case.to };
    let response = simulate(&case.scene, window, settings).map_err(|e| e.to_string())?;
    let touches = touch_downs(&case.scene, window, settings).map_err(|e| e.to_string())?;
    let seconds =
        if timed { shortest_of(|| e1_max(&case.scene, window, settings, f64::INFINITY)) } else { f64::NAN };
    Ok(Found {
        e1_max: response.e1_max.value,
        final_state: response.final_state,
        impacts: touches.len(),
        touches: Some(touches.into_iter().map(|(t, _)| t).collect()),
        evaluations: methods::evaluations(settings.method, &response),
        seconds,
    })
}

/// Integrates a motion from a state of flight at t = 0 to time `to` (s) or until the observer is satisfied; returns the state
/// reached.
///
/// # Errors
/// As the method's own.
pub fn follow(
    system: &Coupled,
    start: [f64; 4],
    to: f64,
    settings: &Settings,
    observer: &mut impl Observer<4>,
) -> Result<[f64; 4], SolverError> {
    let mut run = Run::new(system, settings, 0.0, start, settings.longest_step(to));
    match settings.method {
        Method::Hybrid => {
            let begin = Motion { t: 0.0, y: start, phase: Phase::Flight };
            let mut hybrid = Hybrid::new(system, settings.rtol, to, settings.max_steps);
            return Ok(hybrid.propagate(begin, to, observer)?.y);
        }
        Method::Ode23s => run.integrate::<Ode23s>(to, observer),
        Method::Ode45 => run.integrate::<Ode45>(to, observer),
        Method::Ode23 => run.integrate::<Ode23>(to, observer),
        Method::Dop853 => run.integrate::<Dop853>(to, observer),
        Method::Rk4 => run.integrate::<Rk4>(to, observer),
        Method::Euler => run.integrate::<Euler>(to, observer),
    }?;
    Ok(run.state())
}

/// How a method treats contacts, in a word.
pub fn way(settings: &Settings) -> &'static str {
    match (settings.method, settings.contacts) {
        (Method::Hybrid, _) => "exact",
        (_, Contacts::Located) => "located",
        (_, Contacts::Stepped) => "stepped",
    }
}
