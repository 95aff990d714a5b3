//! No more model than a scene needs: what the smallest exact model saves over the full contact model, with equal results.

use crate::own::shortest_of;
use crate::scenes::{Case, Numbers, SSVI, TMD, scene};
use retune_model::{Coupled, Drive, OutOfRange};
use retune_solver::observe::Peak;
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

/// The scenes of the comparison and, because the smallest models do not grow with the run, long ones.
fn long() -> Result<Vec<Case>, OutOfRange> {
    let tmd = scene(TMD)?;
    let case = |name, label, scene| Case { name, label, scene, to: 100.0 };
    Ok(vec![
        case("bare", "no damper, 100 s", retune_model::Scene { damper: None, ..tmd }),
        case("tmd", "TMD, 100 s", tmd),
        case("far", "damper out of reach, 100 s", scene(Numbers { d: 5.0, c: 5.0, ..SSVI })?),
        case("two-sided", "SSVI, two-sided, 100 s", scene(SSVI)?),
    ])
}

/// Measures the savings. The full model of the bare structure has a damper that nothing holds, out of reach of both walls.
///
/// # Errors
/// A run that failed.
pub fn savings(cases: &[Case]) -> Result<Vec<Saving>, Box<dyn Error>> {
    let free = scene(Numbers { k2: 0.0, c2: 0.0, d: 1e3, c: 1e3, ..TMD })?;
    let settings = Settings::default();
    let measure = |case: &Case| -> Result<Saving, Box<dyn Error>> {
        let window = Window { from: 0.0, to: case.to };
        let smallest = || e1_max(&case.scene, window, &settings, f64::INFINITY);
        let damper = case.scene.damper.or(free.damper).ok_or("no damper")?;
        let full = || {
            let system = Coupled::new(&case.scene.primary, &case.scene.forcing, &damper);
            let mut peak = Peak::new(
                |drive: Drive, y: &[f64; 4]| system.primary_energy_rates(drive, y),
                f64::INFINITY,
            );
            let start = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
            Hybrid::new(&system, settings.rtol, case.to, settings.max_steps)
                .propagate(start, case.to, &mut peak)
                .map(|_| peak.record())
        };
        let model = match simulate(&case.scene, window, &settings)?.scene {
            SceneKind::Bare => "one degree of freedom, closed form",
            SceneKind::Linear => "two degrees of freedom, closed form",
            SceneKind::Contact => "needs the contact model",
        };
        Ok(Saving {
            label: case.label,
            model,
            e1_max: [smallest()?.value, full()?.value],
            seconds: [shortest_of(smallest), shortest_of(full)],
        })
    };
    cases.iter().chain(&long()?).map(measure).collect()
}
