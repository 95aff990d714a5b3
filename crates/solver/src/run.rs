//! A run: a scene, a window of time and a method in; what was observed out.

use crate::follow::{follow_bare, follow_coupled};
use crate::free::Free;
use crate::observe::{
    BareEnergy, DamperEnergy, Observer, Path, Peak, PrimaryEnergy, RelativePosition, Segment, Unobserved,
};
use crate::plausible;
use crate::settings::{Extreme, Method, Response, SceneKind, Settings, SolverError, Window};
use crate::steps::Steps;
use retune_model::{Bare, Coupled, Scene, Side, hertz_force};

/// Largest energy of the primary structure over the window, J, and when.
///
/// The run may end early, with any value above `cutoff` (J), once the maximum exceeds `cutoff`; pass infinity for the exact
/// maximum.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn e1_max(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    cutoff: f64,
) -> Result<Extreme, SolverError> {
    largest_energy(scene, window, settings, cutoff)
        .map_err(|error| plausible::error(window, error))
        .and_then(|peak| plausible::energy(scene, window, settings, peak))
}

fn largest_energy(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    cutoff: f64,
) -> Result<Extreme, SolverError> {
    let hybrid = settings.method == Method::Hybrid;
    match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing);
            let mut peak = Peak::new(BareEnergy::new(&system), cutoff);
            if hybrid {
                let steady = system.steady(system.frequency()).e1_max;
                return Free::new(&system, window.to, settings.max_steps).e1_max(window, peak, steady);
            }
            follow_bare(&system, 0.0, window, settings, &mut Unobserved, &mut peak)?;
            Ok(peak.record())
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            let mut peak = Peak::new(PrimaryEnergy::new(&system), cutoff);
            if hybrid {
                let mut free = Free::new(&system, window.to, settings.max_steps);
                if free.clears_walls() {
                    return free.e1_max(window, peak, system.steady(system.bare().frequency()).e1_max);
                }
            }
            follow_coupled(&system, 0.0, window, settings, &mut Unobserved, &mut peak)?;
            Ok(peak.record())
        }
    }
}

/// Everything that [`Response`] reports of a run.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn simulate(scene: &Scene, window: Window, settings: &Settings) -> Result<Response, SolverError> {
    let found = match &scene.damper {
        None => simulate_bare(&Bare::new(&scene.primary, &scene.forcing), window, settings),
        Some(damper) => {
            simulate_coupled(&Coupled::new(&scene.primary, &scene.forcing, damper), window, settings)
        }
    };
    found
        .map_err(|error| plausible::error(window, error))
        .and_then(|found| plausible::response(scene, window, settings, found))
}

fn simulate_bare(system: &Bare, window: Window, settings: &Settings) -> Result<Response, SolverError> {
    let mut peak = Peak::new(BareEnergy::new(system), f64::INFINITY);
    let (state, work) = follow_bare(system, 0.0, window, settings, &mut Unobserved, &mut peak)?;
    Ok(Response {
        e1_max: peak.record(),
        e2_max: Extreme { value: 0.0, time: window.from },
        impacts: [0; 2],
        force_max: [0.0; 2],
        relative_displacement_max: 0.0,
        spring_deflection_max: 0.0,
        final_state: [state[0], state[1], 0.0, 0.0],
        scene: SceneKind::Bare,
        work,
    })
}

fn simulate_coupled(system: &Coupled, window: Window, settings: &Settings) -> Result<Response, SolverError> {
    let mut before = Touches::default();
    let mut seen = Everything {
        e1: Peak::new(PrimaryEnergy::new(system), f64::INFINITY),
        e2: Peak::new(DamperEnergy::new(system), f64::INFINITY),
        farthest: Peak::new(RelativePosition::new(system, 1.0), f64::INFINITY),
        nearest: Peak::new(RelativePosition::new(system, -1.0), f64::INFINITY),
        touches: Touches::default(),
    };
    let (final_state, work) = follow_coupled(system, 0.0, window, settings, &mut before, &mut seen)?;
    let (nearest, farthest) = (-seen.nearest.record().value, seen.farthest.record().value);
    let e1_max = seen.e1.record();
    let farthest_from = |place: f64| (farthest - place).abs().max((nearest - place).abs());
    let relative_displacement_max = farthest_from(0.0);
    let spring_deflection_max = farthest_from(system.rest_distance());
    let mut depths = [-nearest, farthest - system.wall(Side::Obstacle)];
    if settings.method == Method::Hybrid {
        for side in Side::BOTH {
            let i = side as usize;
            let rests = system.wall(side) == system.rest_distance();
            if !rests && before.0[i] + seen.touches.0[i] == 0 {
                let reach = system.bare().reach(e1_max.value, final_state[0], window.to - window.from);
                let position = 2.0 * reach + system.rest_distance() + relative_displacement_max;
                depths[i] = plausible::untouched(depths[i], position, window.to)?;
            }
        }
    }
    let force_max = Side::BOTH.map(|side| hertz_force(system.hertz(side), depths[side as usize]));
    // A damper that rests on a wall at t = 0 presses it without a touch-down.
    let touched = before.0 != [0; 2] || seen.touches.0 != [0; 2] || force_max != [0.0; 2];
    Ok(Response {
        e1_max,
        e2_max: seen.e2.record(),
        impacts: seen.touches.0,
        force_max,
        relative_displacement_max,
        spring_deflection_max,
        final_state,
        scene: if touched { SceneKind::Contact } else { SceneKind::Linear },
        work,
    })
}

/// Touch-downs on each wall.
#[derive(Default)]
struct Touches([u64; 2]);

impl Observer<4> for Touches {
    fn segment(&mut self, _segment: &impl Segment<4>) {}
    fn path(&mut self, _path: &impl Path<4>) {}
    fn steps(&mut self, _steps: &Steps<'_, 4>) {}
    fn touch_down(&mut self, _t: f64, side: Side) {
        self.0[side as usize] += 1;
    }
}

struct Everything<'a> {
    e1: Peak<PrimaryEnergy<'a>>,
    e2: Peak<DamperEnergy<'a>>,
    farthest: Peak<RelativePosition<'a>>,
    nearest: Peak<RelativePosition<'a>>,
    touches: Touches,
}

impl Observer<4> for Everything<'_> {
    fn segment(&mut self, segment: &impl Segment<4>) {
        self.e1.segment(segment);
        self.e2.segment(segment);
        self.farthest.segment(segment);
        self.nearest.segment(segment);
    }
    fn path(&mut self, path: &impl Path<4>) {
        self.e1.path(path);
        self.e2.path(path);
        self.farthest.path(path);
        self.nearest.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.e1.steps(steps);
        self.e2.steps(steps);
        self.farthest.steps(steps);
        self.nearest.steps(steps);
    }
    fn touch_down(&mut self, t: f64, side: Side) {
        self.touches.touch_down(t, side);
    }
}

/// When the damper touched each wall in the window, s, in the order of time.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn touch_downs(
    scene: &Scene,
    window: Window,
    settings: &Settings,
) -> Result<Vec<(f64, Side)>, SolverError> {
    let mut times = Times::default();
    if let Some(damper) = &scene.damper {
        let system = Coupled::new(&scene.primary, &scene.forcing, damper);
        follow_coupled(&system, 0.0, window, settings, &mut Unobserved, &mut times)?;
    }
    Ok(times.0)
}

#[derive(Default)]
struct Times(Vec<(f64, Side)>);

impl Observer<4> for Times {
    fn segment(&mut self, _segment: &impl Segment<4>) {}
    fn path(&mut self, _path: &impl Path<4>) {}
    fn steps(&mut self, _steps: &Steps<'_, 4>) {}
    fn touch_down(&mut self, t: f64, side: Side) {
        self.0.push((t, side));
    }
}
