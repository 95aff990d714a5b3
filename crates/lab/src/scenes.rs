//! The scenes of the comparison: the paper's structure (Table 2) with eleven dampers.

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

/// The scenes: six of the paper's contacts, three of contacts that lose energy, and two where the hybrid is at its worst.
pub fn cases() -> Vec<Case> {
    let near_critical = Numbers { c2: critical_damping(), ..SSVI };
    [
        ("bare", "no damper", 20.0, TMD.bare_scene()),
        ("tmd", "TMD", 20.0, TMD.scene()),
        ("one-sided", "SSVI, one-sided", 20.0, Numbers { c: 5.0, ..SSVI }.scene()),
        ("two-sided", "SSVI, two-sided", 20.0, SSVI.scene()),
        ("near-rigid", "contact 10⁴ times as stiff", 10.0, stiffer(1e4).scene()),
        ("near-critical", "critically damped damper", 20.0, near_critical.scene()),
        ("lambda", "loss, λ = 0.45 s/m", 20.0, Numbers { lambda: 0.45, ..SSVI }.scene()),
        ("restitution", "restitution 0.7 at every speed", 20.0, Numbers { e: 0.7, ..SSVI }.scene()),
        ("rigid", "rigid walls, restitution 0.7", 20.0, Numbers { rigid: Some(0.7), ..SSVI }.scene()),
        ("held", "held by a stiff spring", 20.0, Numbers { k2: 1e6, d: 0.0, ..SSVI }.scene()),
        ("stiff-dashpot", "stiff dashpot", 5.0, Numbers { c2: 1e7, ..SSVI }.scene()),
    ]
    .map(|(name, label, to, scene)| Case { name, label, scene, to })
    .into()
}
