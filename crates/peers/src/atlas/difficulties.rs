//! The difficulties: scenes made to break methods.

use crate::scenes::{Case, Numbers, SSVI, TMD, scene};
use retune_model::{NonNegative, OutOfRange, Positive, Scene};

/// A scene made to break methods, with its row in the atlas.
pub struct Difficulty {
    /// The group it belongs to.
    pub group: &'static str,
    /// The scene.
    pub case: Case,
}

type Change = fn(&mut Scene) -> Result<(), OutOfRange>;

fn difficulty(
    group: &'static str,
    name: &'static str,
    to: f64,
    numbers: Numbers,
    change: Change,
) -> Result<Difficulty, OutOfRange> {
    let mut scene = scene(numbers)?;
    change(&mut scene)?;
    Ok(Difficulty { group, case: Case { name, label: name, scene, to } })
}

/// All of them.
///
/// # Errors
/// A number that cannot be.
pub fn all() -> Result<Vec<Difficulty>, OutOfRange> {
    let same: Change = |_| Ok(());
    let stiffness = |name, stiffer| difficulty("stiffness", name, 10.0, Numbers { stiffer, ..SSVI }, same);
    let critical = 2.0 * (SSVI.k2 * 60.0_f64).sqrt();
    let mass = |name, change| difficulty("mass", name, 10.0, SSVI, change);
    Ok(vec![
        stiffness("contact K × 10⁻²", 1e-2)?,
        stiffness("contact K (two-sided SSVI)", 1.0)?,
        stiffness("contact K × 10²", 1e2)?,
        stiffness("contact K × 10⁴", 1e4)?,
        stiffness("contact K × 10⁶", 1e6)?,
        stiffness("contact K × 10⁸", 1e8)?,
        difficulty("contact", "TMD that never touches", 20.0, Numbers { d: 0.327, ..TMD }, same)?,
        difficulty("contact", "D = 0: contact at t = 0", 10.0, Numbers { d: 0.0, ..SSVI }, same)?,
        difficulty(
            "contact",
            "D = 0, spring stiff: contact lasts",
            10.0,
            Numbers { d: 0.0, k2: 5000.0, ..SSVI },
            same,
        )?,
        difficulty(
            "contact",
            "D = 1e-6 m, C = 1e-6 m: two walls in a step",
            2.0,
            Numbers { d: 1e-6, c: 1e-6, ..SSVI },
            same,
        )?,
        difficulty("contact", "C = 0", 5.0, Numbers { c: 0.0, ..SSVI }, same)?,
        difficulty("contact", "contact lasts to T", 0.3, Numbers { d: 0.0, k2: 5000.0, ..SSVI }, same)?,
        difficulty("damping", "critical damping", 20.0, Numbers { c2: critical, ..SSVI }, same)?,
        difficulty("damping", "k2 = 0", 10.0, Numbers { k2: 0.0, ..SSVI }, same)?,
        difficulty("damping", "c2 = 0", 10.0, Numbers { c2: 0.0, k2: 600.0, d: 0.3, ..SSVI }, same)?,
        difficulty("frequency", "undamped resonance, no damper", 100.0, TMD, |s| {
            s.damper = None;
            s.primary.damping = NonNegative::new(0.0)?;
            s.forcing.frequency = NonNegative::new(39.5_f64.sqrt())?;
            Ok(())
        })?,
        difficulty("frequency", "omega = 1e-3 rad/s", 20.0, SSVI, |s| {
            s.forcing.frequency = NonNegative::new(1e-3)?;
            Ok(())
        })?,
        difficulty("frequency", "omega = 1000 rad/s", 5.0, SSVI, |s| {
            s.forcing.frequency = NonNegative::new(1e3)?;
            Ok(())
        })?,
        mass("mass ratio 1e-6", |s| {
            if let Some(d) = &mut s.damper {
                d.mass = Positive::new(1e-3)?;
                d.stiffness = NonNegative::new(215.0 * 1e-3 / 60.0)?;
                d.damping = NonNegative::new(232.0 * 1e-3 / 60.0)?;
            }
            Ok(())
        })?,
        mass("mass ratio 1", |s| {
            if let Some(d) = &mut s.damper {
                d.mass = Positive::new(1000.0)?;
            }
            Ok(())
        })?,
    ])
}
