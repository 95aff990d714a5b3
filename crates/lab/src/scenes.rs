//! The scenes of the comparison: the paper's structure (Table 2) with six dampers.

use retune_model::Scene;
pub use retune_testkit::scenes::{Numbers, ROW1, SSVI, TMD};

/// A scene and the span of time over which its motion can be predicted.
pub struct Case {
    /// In tables.
    pub name: &'static str,
    /// On a chart.
    pub label: &'static str,
    pub scene: Scene,
    /// End of the run, s.
    pub to: f64,
}

impl Case {
    pub fn omega(&self) -> f64 {
        self.scene.forcing.frequency.get()
    }
}

/// The SSVI with the Hertz stiffness of its contacts so many times as large.
pub fn stiffer(factor: f64) -> Numbers {
    Numbers { q: SSVI.q * factor, ..SSVI }
}

/// Damping at which the SSVI's damper alone does not oscillate, N·s/m.
pub fn critical_damping() -> f64 {
    2.0 * (SSVI.k2 * SSVI.m2).sqrt()
}

/// The six scenes.
pub fn cases() -> Vec<Case> {
    let near_critical = Numbers { c2: critical_damping(), ..SSVI };
    [
        ("bare", "no damper", 20.0, TMD.bare_scene()),
        ("tmd", "TMD", 20.0, TMD.scene()),
        ("one-sided", "SSVI, one-sided", 20.0, Numbers { c: 5.0, ..SSVI }.scene()),
        ("two-sided", "SSVI, two-sided", 20.0, SSVI.scene()),
        ("near-rigid", "contact 10⁴ times as stiff", 10.0, stiffer(1e4).scene()),
        ("near-critical", "critically damped damper", 20.0, near_critical.scene()),
    ]
    .map(|(name, label, to, scene)| Case { name, label, scene, to })
    .into()
}
