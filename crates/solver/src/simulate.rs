//! Simulations: a scene, a window of time and a method go in, largest values and counts come out.

use crate::collisions::{CollisionObserver, Collisions};
use crate::energy_bound;
use crate::error::SolverError;
use crate::hybrid::contact_free::ContactFree;
use crate::losses::{LossObserver, Losses};
use crate::observe::Magnitude;
use crate::observe::contact_forces::ContactForces;
use crate::observe::counters::{TouchDownTimes, TouchDowns};
use crate::observe::observer::{Observer, Unobserved};
use crate::observe::quantity::{BareEnergy, DamperEnergy, PrimaryEnergy, Quantity, RelativePosition};
use crate::observe::running_maximum::RunningMaximum;
use crate::observe::structure::{Structure, StructureMotion};
use crate::plan::{Plan, Request};
use crate::response::{Extreme, Response, SceneKind, StructureMaxima};
use crate::run::Follow;
use crate::settings::{Settings, Window};
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
    let found = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing);
            largest_energy(&system, BareEnergy::new(&system), window, settings, cutoff)
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            largest_energy(&system, PrimaryEnergy::new(&system), window, settings, cutoff)
        }
    };
    found
        .map_err(|error| energy_bound::clamp_error_time(window, error))
        .and_then(|e1| energy_bound::check_energy(scene, window, settings, e1))
}

fn largest_energy<S: Follow<N>, const N: usize>(
    system: &S,
    energy: impl Quantity<N>,
    window: Window,
    settings: &Settings,
    cutoff: f64,
) -> Result<Extreme, SolverError> {
    let mut e1 = RunningMaximum::new(energy, cutoff);
    let plan = Plan::of(system, settings, Request::Energy(window));
    if plan == Plan::Closed {
        let mut free = ContactFree::new(system, window.to, settings.max_steps);
        return free.e1_max(window, e1, system.steady_energy());
    }
    system.follow_for(plan, window, settings, &mut Unobserved, &mut e1)?;
    Ok(e1.record())
}

/// Runs a scene and returns everything that [`Response`] reports.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn simulate(scene: &Scene, window: Window, settings: &Settings) -> Result<Response, SolverError> {
    let found = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing);
            simulate_bare(&system, window, settings, &mut Unobserved)
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            simulate_coupled(&system, window, settings, &mut Unobserved)
        }
    };
    check_bounds(scene, window, settings, found)
}

/// [`simulate`] with the energy losses of the run and its contacts with structure and obstacle.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn simulate_in_detail(
    scene: &Scene,
    window: Window,
    settings: &Settings,
) -> Result<(Response, Losses, [Collisions; 2]), SolverError> {
    match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing);
            let mut lost = LossObserver::new(&system);
            let found = simulate_bare(&system, window, settings, &mut lost);
            Ok((check_bounds(scene, window, settings, found)?, lost.losses(), [Collisions::NONE; 2]))
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            let mut extra = (LossObserver::new(&system), CollisionObserver::new(&system));
            let found = simulate_coupled(&system, window, settings, &mut extra);
            let (lost, touched) = extra;
            Ok((check_bounds(scene, window, settings, found)?, lost.losses(), touched.walls))
        }
    }
}

/// Checks a response against the bound on the energy that the force can supply.
fn check_bounds(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    found: Result<Response, SolverError>,
) -> Result<Response, SolverError> {
    let response = found.map_err(|error| energy_bound::clamp_error_time(window, error))?;
    energy_bound::check_response(scene, window, settings, response)
}

fn simulate_bare(
    system: &Bare,
    window: Window,
    settings: &Settings,
    extra: &mut dyn Observer<2>,
) -> Result<Response, SolverError> {
    let e1 = RunningMaximum::new(BareEnergy::new(system), f64::INFINITY);
    let mut seen = ((e1, structure_observers(system)), extra);
    let plan = Plan::of(system, settings, Request::Motion);
    let (state, work) = system.follow(plan, window, settings, &mut Unobserved, &mut seen)?;
    let ((e1, structure), _) = seen;
    Ok(Response {
        e1_max: e1.record(),
        e2_max: Extreme { value: 0.0, time: window.from },
        structure: structure_maxima(&structure, window),
        impacts: [0; 2],
        force_max: [0.0; 2],
        pressure_max: [0.0; 2],
        relative_displacement_max: 0.0,
        spring_deflection_max: 0.0,
        final_state: [state[0], state[1], 0.0, 0.0],
        scene: SceneKind::Bare,
        work,
    })
}

/// Observers of the largest displacement, velocity and acceleration of the structure and of its largest force on the ground.
type StructureObservers<'a, S, const N: usize> = [Magnitude<StructureMotion<'a, S, N>>; 4];

fn structure_observers<S: Structure<N>, const N: usize>(system: &S) -> StructureObservers<'_, S, N> {
    let quantities = [
        StructureMotion::displacement,
        StructureMotion::velocity,
        StructureMotion::acceleration,
        StructureMotion::ground_force,
    ];
    quantities.map(|quantity| Magnitude::new(|sign| quantity(system, sign), f64::INFINITY))
}

/// Their records. Times that rounding has put outside the window are moved to its ends.
fn structure_maxima<S: Structure<N>, const N: usize>(
    seen: &StructureObservers<'_, S, N>,
    window: Window,
) -> StructureMaxima {
    let [displacement, velocity, acceleration, ground_force] = seen.each_ref().map(|largest| {
        let Extreme { value, time } = largest.record();
        let time = if time > window.to { window.to } else { time };
        Extreme { value, time: if time < window.from { window.from } else { time } }
    });
    StructureMaxima { displacement, velocity, acceleration, ground_force }
}

fn simulate_coupled(
    system: &Coupled,
    window: Window,
    settings: &Settings,
    extra: &mut dyn Observer<4>,
) -> Result<Response, SolverError> {
    let position = |sign: f64| RunningMaximum::new(RelativePosition::new(system, sign), f64::INFINITY);
    let e1 = RunningMaximum::new(PrimaryEnergy::new(system), f64::INFINITY);
    let e2 = RunningMaximum::new(DamperEnergy::new(system), f64::INFINITY);
    let mut before = TouchDowns::default();
    let mut seen = (
        (e1, e2),
        (
            (
                [1.0, -1.0].map(position),
                (TouchDowns::default(), (ContactForces::of(system), structure_observers(system))),
            ),
            extra,
        ),
    );
    let plan = Plan::of(system, settings, Request::Motion);
    let (final_state, work) = system.follow(plan, window, settings, &mut before, &mut seen)?;
    let ((e1, e2), (([farthest, nearest], (TouchDowns(impacts), (forces, structure))), _)) = seen;
    let (nearest, farthest) = (-nearest.record().value, farthest.record().value);
    let e1_max = e1.record();
    let farthest_from = |place: f64| (farthest - place).abs().max((nearest - place).abs());
    let relative_displacement_max = farthest_from(0.0);
    let spring_deflection_max = farthest_from(system.rest_distance());
    let places = [nearest, farthest];
    let mut depths = Side::BOTH.map(|side| side.sign() * (places[side as usize] - system.wall(side)));
    if settings.method.is_exact() {
        for side in Side::BOTH {
            let i = side as usize;
            // A damper that starts at a wall, or inside it, is in contact without a touch-down.
            let starts_there = system.indentation(&system.start())[i] >= 0.0;
            if !starts_there && before.0[i] + impacts[i] == 0 {
                let reach = system.bare().reach(e1_max.value, final_state[0], window.to - window.from);
                let position = 2.0 * reach + system.rest_distance() + relative_displacement_max;
                depths[i] = energy_bound::check_untouched(depths[i], position, window.to)?;
            }
        }
    }
    let force_max = match forces {
        Some(forces) => forces.records().map(|largest| largest.value.max(0.0)),
        // The force of an impact has no bound.
        None if system.is_rigid() => impacts.map(|count| if count > 0 { f64::INFINITY } else { 0.0 }),
        None => Side::BOTH.map(|side| hertz_force(system.hertz(side), depths[side as usize])),
    };
    // A damper that rests on a wall at t = 0 is in contact without a touch-down.
    let rests = system.is_rigid() && Side::BOTH.iter().any(|&side| system.rests_on(side, &system.start()));
    let touched = before.0 != [0; 2] || impacts != [0; 2] || force_max != [0.0; 2] || rests;
    Ok(Response {
        e1_max,
        e2_max: e2.record(),
        structure: structure_maxima(&structure, window),
        impacts,
        force_max,
        pressure_max: match system.is_rigid() {
            true => force_max,
            false => Side::BOTH.map(|side| system.wall_pressure(side, depths[side as usize])),
        },
        relative_displacement_max,
        spring_deflection_max,
        final_state,
        scene: if touched { SceneKind::Contact } else { SceneKind::Linear },
        work,
    })
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
    let mut times = TouchDownTimes::default();
    if let Some(damper) = &scene.damper {
        let system = Coupled::new(&scene.primary, &scene.forcing, damper);
        let plan = Plan::of(&system, settings, Request::Motion);
        system.follow(plan, window, settings, &mut Unobserved, &mut times)?;
    }
    Ok(times.0)
}
