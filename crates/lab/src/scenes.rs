//! The scenes of the comparison: the paper's structure (Table 2) with twelve dampers.

use crate::system;
use retune_model::{Scene, Side};
pub use retune_testkit::scenes::{Numbers, ROW1, SSVI, TMD};

/// A scene and the span of time over which its motion can be predicted.
pub struct Case {
    /// Name in tables.
    pub name: &'static str,
    /// Label on charts.
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

/// The SSVI with the Hertz stiffness of its contacts multiplied by `factor`.
pub fn stiffer(factor: f64) -> Numbers {
    Numbers { q: SSVI.q * factor, ..SSVI }
}

/// Critical damping of the SSVI's damper alone, N·s/m.
pub fn critical_damping() -> f64 {
    2.0 * (SSVI.k2 * SSVI.m2).sqrt()
}

/// For half of each period a spring presses the damper on its wall, 2 mm from its rest position: it chatters, is held, and leaves again.
pub const CHATTER: Numbers = Numbers { k2: 5e3, c2: 100.0, d: 0.002, c: 5.0, e: 0.5, ..SSVI };

/// The scenes: six with the paper's contacts, three with contacts that lose energy, and three where a damper is held, creeps or chatters.
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
        ("chatter", "chatters, stays, leaves", 10.0, CHATTER.scene()),
    ]
    .map(|(name, label, to, scene)| Case { name, label, scene, to })
    .into()
}

/// The scenes as plain numbers for other programs.
pub fn in_json<'a>(cases: impl Iterator<Item = &'a Case>) -> Result<String, serde_json::Error> {
    let list: Vec<_> = cases
        .map(|case| {
            let (p, f) = (&case.scene.primary, &case.scene.forcing);
            let mut object = serde_json::json!({
                "scene": case.name.replace(',', ";"), "T": case.to,
                "m1": p.mass.get(), "c1": p.damping.get(), "k1": p.stiffness.get(),
                "P": f.amplitude().map_or(0.0, |(_, amplitude)| amplitude.get()), "omega": f.frequency.get(),
            });
            let numbers = match case.scene.damper.zip(system(&case.scene)) {
                None => serde_json::json!({"m2": 1.0, "k2": 0.0, "c2": 0.0, "D": 1e6, "C": 1e6, "K1": 0.0, "K3": 0.0}),
                Some((d, system)) => serde_json::json!({
                    "m2": d.mass.get(), "k2": d.stiffness.get(), "c2": d.damping.get(),
                    "D": d.rest_distance.get(), "C": d.clearance.get(),
                    "K1": system.hertz(Side::Primary), "K3": system.hertz(Side::Obstacle),
                    "lambda": system.regularised_contact(Side::Primary).lambda(),
                    "restitution": system.restitution().or_else(|| {
                        system.regularised_contact(Side::Primary).restoring().map(|law| law.restitution())
                    }),
                    "rigid": system.is_rigid(),
                }),
            };
            if let (Some(all), serde_json::Value::Object(more)) = (object.as_object_mut(), numbers) {
                all.extend(more);
            }
            object
        })
        .collect();
    Ok(serde_json::to_string_pretty(&list)? + "\n")
}
