//! The scenes of the comparison: the paper's structure (Table 2, R = 2 m, q = 0.318) with six dampers.

use retune_model::{
    Contact, Coupled, Damper, Forcing, NonNegative, OutOfRange, PoissonRatio, Positive, Primary, Scene,
};
use retune_solver::{Hybrid, Motion, Phase, SolverError, observe::Unobserved};

/// A scene and the span of time over which its motion can be predicted.
pub struct Case {
    /// Its name in tables.
    pub name: &'static str,
    /// Its label on a chart.
    pub label: &'static str,
    /// The scene.
    pub scene: Scene,
    /// End of the run, s.
    pub to: f64,
}

/// The damper's own numbers.
#[derive(Clone, Copy)]
pub struct Numbers {
    /// Stiffness `k2`, N/m.
    pub k2: f64,
    /// Damping `c2`, N·s/m.
    pub c2: f64,
    /// Rest distance `D`, m.
    pub d: f64,
    /// Clearance `C`, m.
    pub c: f64,
    /// Factor on the Hertz stiffness.
    pub stiffer: f64,
}

/// Table 2's SSVI NES.
pub const SSVI: Numbers = Numbers { k2: 215.0, c2: 232.0, d: 0.06, c: 0.36, stiffer: 1.0 };
/// Table 2's TMD.
pub const TMD: Numbers = Numbers { k2: 600.0, c2: 262.0, d: 2.08, c: 4.7, stiffer: 1.0 };

/// The structure and the damper of a scene that has one, as one system.
pub fn system(scene: &Scene) -> Option<Coupled> {
    scene.damper.as_ref().map(|damper| Coupled::new(&scene.primary, &scene.forcing, damper))
}

/// The paper's structure with a damper.
///
/// # Errors
/// A value out of range.
#[expect(clippy::approx_constant, reason = "the paper's rounded numbers")]
pub fn scene(n: Numbers) -> Result<Scene, OutOfRange> {
    let steel = (Positive::new(2.1e11)?, PoissonRatio::new(0.3)?);
    let soft = PoissonRatio::new(0.4)?;
    Ok(Scene {
        primary: Primary {
            mass: Positive::new(1000.0)?,
            damping: NonNegative::new(452.0)?,
            stiffness: NonNegative::new(3.95e4)?,
        },
        forcing: Forcing { amplitude: NonNegative::new(800.0)?, frequency: NonNegative::new(6.28)? },
        damper: Some(Damper {
            mass: Positive::new(60.0)?,
            stiffness: NonNegative::new(n.k2)?,
            damping: NonNegative::new(n.c2)?,
            rest_distance: NonNegative::new(n.d)?,
            clearance: NonNegative::new(n.c)?,
            contact: Contact {
                radius: Positive::new(2.0)?,
                coefficient: Positive::new(0.318 * n.stiffer)?,
                young_1: steel.0,
                poisson_1: steel.1,
                young_2: Positive::new(2.21e7)?,
                poisson_2: soft,
                young_3: steel.0,
                poisson_3: steel.1,
                young_4: Positive::new(2.05e7)?,
                poisson_4: soft,
            },
        }),
    })
}

/// The six scenes.
///
/// # Errors
/// A value out of range.
pub fn cases() -> Result<Vec<Case>, OutOfRange> {
    let bare = Scene { damper: None, ..scene(TMD)? };
    let critical = 2.0 * (SSVI.k2 * 60.0_f64).sqrt();
    let case = |name, label, to, numbers| Ok(Case { name, label, scene: scene(numbers)?, to });
    Ok(vec![
        Case { name: "bare", label: "no damper", scene: bare, to: 20.0 },
        case("tmd", "TMD", 20.0, TMD)?,
        case("one-sided", "SSVI, one-sided", 20.0, Numbers { c: 5.0, ..SSVI })?,
        case("two-sided", "SSVI, two-sided", 20.0, SSVI)?,
        case("near-rigid", "contact 10⁴ times as stiff", 10.0, Numbers { stiffer: 1e4, ..SSVI })?,
        case("near-critical", "critically damped damper", 20.0, Numbers { c2: critical, ..SSVI })?,
    ])
}

/// Finite-time Lyapunov exponent (1/s) of two motions of a scene that start 1e-9 m apart in `x1`; `None` without a damper.
///
/// # Errors
/// A run that failed.
pub fn parting_rate(case: &Case) -> Result<Option<f64>, SolverError> {
    let Some(system) = system(&case.scene) else { return Ok(None) };
    let apart = 1e-9;
    let end = |shift: f64| {
        let mut y = system.rest();
        y[0] += shift;
        y[2] += shift;
        let start = Motion { t: 0.0, y, phase: Phase::Flight };
        Hybrid::new(&system, 1e-13, case.to, 10_000_000).propagate(start, case.to, &mut Unobserved)
    };
    let (a, b) = (end(0.0)?.y, end(apart)?.y);
    let omega = case.scene.forcing.frequency.get();
    let distance: f64 =
        (0..4).map(|i| (b[i] - a[i]) * if i % 2 == 0 { 1.0 } else { 1.0 / omega }).map(|d| d * d).sum();
    Ok(Some((distance.sqrt() / apart).ln() / case.to))
}
