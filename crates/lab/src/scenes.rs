//! The scenes of the comparison: the paper's structure (Table 2, R = 2 m, q = 0.318) with six dampers.

use retune_model::{Contact, Coupled, Damper, NonNegative, OutOfRange, Positive, Scene};
use retune_solver::{Hybrid, Motion, Phase, SolverError, observe::Unobserved};
use retune_testkit::scenes as paper;

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
pub const SSVI: Numbers = Numbers::of(&paper::SSVI);
/// Table 2's TMD.
pub const TMD: Numbers = Numbers::of(&paper::TMD);
/// Row 1 of Table 1.
pub const ROW1: Numbers = Numbers::of(&paper::ROW1);

impl Numbers {
    const fn of(&paper::Numbers { k2, c2, d, c, .. }: &paper::Numbers) -> Self {
        Self { k2, c2, d, c, stiffer: 1.0 }
    }
}

/// The structure and the damper of a scene that has one, as one system.
pub fn system(scene: &Scene) -> Option<Coupled> {
    scene.damper.as_ref().map(|damper| Coupled::new(&scene.primary, &scene.forcing, damper))
}

/// The paper's structure with a damper.
///
/// # Errors
/// A value out of range.
pub fn scene(n: Numbers) -> Result<Scene, OutOfRange> {
    let paper = paper::SSVI.damper();
    let coefficient = Positive::new(paper::SSVI.q * n.stiffer)?;
    let damper = Damper {
        stiffness: NonNegative::new(n.k2)?,
        damping: NonNegative::new(n.c2)?,
        rest_distance: NonNegative::new(n.d)?,
        clearance: NonNegative::new(n.c)?,
        contact: paper.contact.map(|contact| Contact { coefficient, ..contact }),
        ..paper
    };
    Ok(Scene { damper: Some(damper), ..paper::SSVI.scene() })
}

/// The six scenes.
///
/// # Errors
/// A value out of range.
pub fn cases() -> Result<Vec<Case>, OutOfRange> {
    let bare = Scene { damper: None, ..scene(TMD)? };
    let critical = 2.0 * (paper::SSVI.k2 * paper::SSVI.m2).sqrt();
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
