//! Time saved by the smallest exact model of a scene against the full contact model, with equal results.

use crate::own::shortest_of;
use crate::scenes::{Case, Numbers, SSVI, TMD, scene};
use retune_model::{Coupled, OutOfRange, Scene};
use retune_solver::observe::{PrimaryEnergy, RunningMaximum, Unobserved};
use retune_solver::{Hybrid, Motion, Phase, SceneKind, Settings, Window, e1_max, simulate};
use std::error::Error;

/// Cost of a scene under the smallest exact model and under the full contact model.
pub struct Saving {
    /// Scene.
    pub label: &'static str,
    /// The smallest exact model, in words.
    pub model: &'static str,
    /// Times, s: smallest, full.
    pub seconds: [f64; 2],
    /// E1max, J: smallest, full.
    pub e1_max: [f64; 2],
}

/// A measured case: a label, a scene and a window.
type Subject = (&'static str, Scene, Window);

/// The scenes of the comparison over their whole runs, and four over the window of the paper's studies, after the transient.
fn subjects(cases: &[Case]) -> Result<Vec<Subject>, OutOfRange> {
    let tmd = scene(TMD)?;
    let late = Window { from: 50.0, to: 100.0 };
    let mut all: Vec<Subject> =
        cases.iter().map(|c| (c.label, c.scene, Window { from: 0.0, to: c.to })).collect();
    all.extend([
        ("no damper, 50 to 100 s", Scene { damper: None, ..tmd }, late),
        ("TMD, 50 to 100 s", tmd, late),
        ("damper out of reach, 50 to 100 s", scene(Numbers { d: 5.0, c: 5.0, ..SSVI })?, late),
        ("SSVI, two-sided, 50 to 100 s", scene(SSVI)?, late),
    ]);
    Ok(all)
}

/// Measures the savings. The full model of the bare structure has a damper without spring and dashpot, out of reach of both walls.
///
/// # Errors
/// A run that failed.
pub fn savings(cases: &[Case]) -> Result<Vec<Saving>, Box<dyn Error>> {
    let free = scene(Numbers { k2: 0.0, c2: 0.0, d: 1e3, c: 1e3, ..TMD })?;
    let settings = Settings::default();
    let measure = |&(label, scene, window): &Subject| -> Result<Saving, Box<dyn Error>> {
        let smallest = || e1_max(&scene, window, &settings, f64::INFINITY);
        let damper = scene.damper.or(free.damper).ok_or("no damper")?;
        let full = || {
            let system = Coupled::new(&scene.primary, &scene.forcing, &damper);
            let mut peak = RunningMaximum::new(PrimaryEnergy::new(&system), f64::INFINITY);
            let start = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
            let mut hybrid = Hybrid::new(&system, settings.rtol, window.to, settings.max_steps);
            let begin = if window.from > 0.0 {
                hybrid.propagate(start, window.from, &mut Unobserved)?
            } else {
                start
            };
            hybrid.propagate(begin, window.to, &mut peak).map(|_| peak.record())
        };
        let model = match simulate(&scene, window, &settings)?.scene {
            SceneKind::Bare => "one degree of freedom, closed form",
            SceneKind::Linear => "two degrees of freedom, closed form",
            SceneKind::Contact => "needs the contact model",
        };
        Ok(Saving {
            label,
            model,
            e1_max: [smallest()?.value, full()?.value],
            seconds: [shortest_of(smallest), shortest_of(full)],
        })
    };
    subjects(cases)?.iter().map(measure).collect()
}
