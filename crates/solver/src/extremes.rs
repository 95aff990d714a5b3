//! The largest values on which a study may set limits: E1max, stroke and contact force, for any phase of the force. Only those that
//! are asked for are computed.

use crate::energy_bound;
use crate::error::SolverError;
use crate::observe::displacement_range::DisplacementRange;
use crate::observe::observer::Unobserved;
use crate::observe::quantity::{BareEnergy, PrimaryEnergy};
use crate::observe::running_maximum::RunningMaximum;
use crate::response::Extreme;
use crate::run::{follow_bare, follow_coupled};
use crate::settings::{Settings, Window};
use crate::simulate::e1_max;
use retune_model::{Bare, Coupled, Scene};

/// The question put to a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// φ of the force `P cos(ωt + φ)`, rad. The run starts at rest at t = 0.
    pub phase: f64,
    /// The time, s, from which on stroke and contact forces are observed too: 0 for the whole run, whatever the window of E1max;
    /// `None` if they are not needed.
    pub walls: Option<f64>,
    /// The run may end early, with any value above this one (J), once E1max exceeds it.
    pub cutoff: f64,
}

impl Default for Ask {
    fn default() -> Self {
        Self { phase: 0.0, walls: None, cutoff: f64::INFINITY }
    }
}

/// The largest values of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest energy of the primary structure, J, and when.
    pub e1_max: Extreme,
    /// The stroke: largest spring deflection `|x2 - x1 - D|`, m; 0 where it was not asked for, or without a damper.
    pub stroke: f64,
    /// Largest contact force on either wall, N; 0 where it was not asked for, or without a damper.
    pub force: f64,
    /// Whether the motion has settled; true where that was not asked.
    pub settled: bool,
}

/// The largest E1 over a window, and the stroke and the force from [`Ask::walls`] to its end.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn extremes(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    ask: Ask,
) -> Result<Extremes, SolverError> {
    let nothing = |e1_max| Extremes { e1_max, stroke: 0.0, force: 0.0, settled: true };
    if ask.phase == 0.0 && ask.walls.is_none() {
        return Ok(nothing(e1_max(scene, window, settings, ask.cutoff)?));
    }
    let seen = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing).with_phase(ask.phase);
            let mut e1 = RunningMaximum::new(BareEnergy::new(&system), ask.cutoff);
            follow_bare(&system, window, settings, &mut Unobserved, &mut e1)?;
            nothing(e1.record())
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper).with_phase(ask.phase);
            let mut before = ask.walls.map(|from| DisplacementRange::new(&system, from));
            let mut seen = maxima(&system, ask);
            follow_coupled(&system, window, settings, &mut before, &mut seen)?;
            let ([stroke, force], seen) = (stroke_and_force(before.as_ref()), read(&seen));
            Extremes { stroke: stroke.max(seen.stroke), force: force.max(seen.force), ..seen }
        }
    };
    energy_bound::energy(scene, window, settings, seen.e1_max)?;
    Ok(seen)
}

/// E1max, and the range of the damper where stroke and force are asked for.
pub(crate) type Maxima<'a> = (RunningMaximum<PrimaryEnergy<'a>>, Option<DisplacementRange<'a>>);

pub(crate) fn maxima(system: &Coupled, ask: Ask) -> Maxima<'_> {
    let e1 = RunningMaximum::new(PrimaryEnergy::new(system), ask.cutoff);
    (e1, ask.walls.map(|from| DisplacementRange::new(system, from)))
}

pub(crate) fn read((e1, range): &Maxima<'_>) -> Extremes {
    let [stroke, force] = stroke_and_force(range.as_ref());
    Extremes { e1_max: e1.record(), stroke, force, settled: true }
}

/// The stroke, m, and the largest force, N; 0 where they were not asked for.
fn stroke_and_force(range: Option<&DisplacementRange<'_>>) -> [f64; 2] {
    range.map_or([0.0; 2], DisplacementRange::stroke_and_force)
}
