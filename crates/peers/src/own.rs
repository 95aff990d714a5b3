//! Retune's own methods on a scene.

use crate::record::Found;
use crate::scenes::Case;
use retune_solver::{Contacts, Method, Settings, Window, e1_max, simulate, touch_downs};
use std::time::{Duration, Instant};

/// The shortest of several runs, s: after a warm-up at least 5 and at most 20, fewer where one takes long.
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
        t if t < Duration::from_millis(1) => 20,
        t if t < Duration::from_millis(20) => 5,
        t if t < Duration::from_millis(100) => 1,
        t => return t.as_secs_f64(),
    };
    (0..wanted).map(|_| timed(&mut once)).fold(Duration::MAX, Duration::min).as_secs_f64()
}

/// Settings of a method at a tolerance, or at a step.
pub fn settings(method: Method, contacts: Contacts, setting: f64) -> Settings {
    let shared = Settings { method, contacts, max_steps: 3_000_000, ..Settings::default() };
    if method.has_fixed_step() {
        Settings { step: Some(setting), ..shared }
    } else {
        Settings { rtol: setting, atol: setting * 1e-3, ..shared }
    }
}

/// Everything of one run; the time is that of finding E1max alone.
///
/// # Errors
/// Why the run failed.
pub fn run(case: &Case, settings: &Settings, timed: bool) -> Result<Found, String> {
    let window = Window { from: 0.0, to: case.to };
    let response = simulate(&case.scene, window, settings).map_err(|e| e.to_string())?;
    let touches = touch_downs(&case.scene, window, settings).map_err(|e| e.to_string())?;
    let seconds =
        if timed { shortest_of(|| e1_max(&case.scene, window, settings, f64::INFINITY)) } else { f64::NAN };
    let hybrid = settings.method == Method::Hybrid;
    Ok(Found {
        e1_max: response.e1_max.value,
        final_state: response.final_state,
        impacts: touches.len(),
        touches: Some(touches.into_iter().map(|(t, _)| t).collect()),
        evaluations: response.work.evaluations + if hybrid { response.work.steps } else { 0 },
        seconds,
    })
}
