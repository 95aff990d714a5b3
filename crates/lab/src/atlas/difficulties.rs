//! The difficulties: scenes designed to make methods fail.

use crate::scenes::{Case, Numbers, SSVI, TMD, scene, system};
use retune_model::{Contact, NonNegative, Positive, Scene};
use retune_solver::observe::{RelativePosition, RunningMaximum};
use retune_solver::{Hybrid, Motion, Phase};
use std::error::Error;

/// A scene designed to make methods fail, with its row in the atlas.
pub struct Difficulty {
    /// The group it belongs to.
    pub group: &'static str,
    /// The scene.
    pub case: Case,
}

type Any<T> = Result<T, Box<dyn Error>>;

struct List(Vec<Difficulty>);

impl List {
    fn add(&mut self, group: &'static str, name: &'static str, to: f64, scene: Scene) {
        self.0.push(Difficulty { group, case: Case { name, label: name, scene, to } });
    }
}

/// All of them, but the energy over 1,000 impacts.
///
/// # Errors
/// A value out of range.
pub fn all() -> Any<Vec<Difficulty>> {
    let mut list = List(Vec::new());
    stiffness(&mut list)?;
    touching(&mut list)?;
    damper(&mut list)?;
    forcing(&mut list)?;
    list.add("maxima", "two maxima in one step", 20.0, two_maxima()?);
    Ok(list.0)
}

fn stiffness(list: &mut List) -> Any<()> {
    for (name, n) in [
        ("contact K × 10⁻²", -2),
        ("contact K: two-sided SSVI", 0),
        ("contact K × 10²", 2),
        ("contact K × 10⁴", 4),
        ("contact K × 10⁶", 6),
        ("contact K × 10⁸", 8),
    ] {
        list.add("stiffness", name, 10.0, scene(Numbers { stiffer: 10f64.powi(n), ..SSVI })?);
    }
    Ok(())
}

/// Largest displacement of the damper of `numbers` from its rest position towards the structure without walls, m.
///
/// # Errors
/// A run that failed.
pub fn reach(numbers: Numbers, to: f64) -> Any<f64> {
    let far = 10.0;
    let system = system(&scene(Numbers { d: far, c: far, ..numbers })?).ok_or("no damper")?;
    let mut peak = RunningMaximum::new(RelativePosition::new(&system, -1.0), f64::INFINITY);
    let begin = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    Hybrid::new(&system, 1e-12, to, 10_000_000).propagate(begin, to, &mut peak)?;
    Ok(far + peak.record().value)
}

fn touching(list: &mut List) -> Any<()> {
    let group = "touching";
    let deepest = reach(SSVI, 5.0)?;
    let graze = |depth: f64| scene(Numbers { d: deepest - depth, c: 5.0, ..SSVI });
    let heavy = Numbers { d: 0.0, k2: 5000.0, ..SSVI };
    list.add(group, "misses the wall by 1 nm", 5.0, graze(-1e-9)?);
    list.add(group, "grazes, 1 µm deep without wall", 5.0, graze(1e-6)?);
    list.add(group, "grazes, 1 nm deep without wall", 5.0, graze(1e-9)?);
    list.add(group, "D = 0: on the wall at t = 0", 10.0, scene(Numbers { d: 0.0, ..SSVI })?);
    list.add(group, "D = 0, stiff spring: held to the wall", 10.0, scene(heavy)?);
    list.add(group, "a contact lasts to T", 0.3, scene(heavy)?);
    list.add(group, "C = 0: on the other wall", 5.0, scene(Numbers { c: 0.0, ..SSVI })?);
    list.add(group, "D = C = 1 µm: two walls in a step", 2.0, scene(Numbers { d: 1e-6, c: 1e-6, ..SSVI })?);
    list.add(group, "D = C = 0: clamped", 2.0, scene(Numbers { d: 0.0, c: 0.0, ..SSVI })?);
    Ok(())
}

fn damper(list: &mut List) -> Any<()> {
    let group = "damper";
    let critical = 2.0 * (SSVI.k2 * 60.0_f64).sqrt();
    list.add(group, "critical damping, c2² = 4 k2 m2", 20.0, scene(Numbers { c2: critical, ..SSVI })?);
    list.add(group, "k2 = 0", 10.0, scene(Numbers { k2: 0.0, ..SSVI })?);
    list.add(group, "c2 = 0", 10.0, scene(Numbers { c2: 0.0, k2: 600.0, d: 0.3, ..SSVI })?);
    for (name, ratio) in [
        ("mass ratio 10⁻⁶", 1e-6),
        ("mass ratio 10⁻⁴", 1e-4),
        ("mass ratio 10⁻²", 1e-2),
        ("mass ratio 1", 1.0),
    ] {
        // Spring and dashpot in proportion, so that the damper keeps its frequency and damping ratio.
        let share = 1000.0 * ratio / 60.0;
        let mut scene = scene(Numbers { k2: SSVI.k2 * share, c2: SSVI.c2 * share, ..SSVI })?;
        if let Some(damper) = &mut scene.damper {
            damper.mass = Positive::new(1000.0 * ratio)?;
        }
        list.add(group, name, 10.0, scene);
    }
    Ok(())
}

/// A heavy damper on a stiff structure: in one flight step of the hybrid, concave at both ends, E1 has two maxima with a minimum
/// between; treating it as a step with one maximum lost 0.2 % of E1max. Found by adversarial search.
fn two_maxima() -> Any<Scene> {
    let mut scene = scene(Numbers {
        k2: 1662.5681305782794,
        c2: 8.649689386577819,
        d: 0.0595372531637714,
        c: 0.69253168895597,
        ..SSVI
    })?;
    scene.primary.stiffness = NonNegative::new(62235.81747936603)?;
    scene.forcing.frequency = NonNegative::new(8.576461062918153)?;
    if let Some(damper) = &mut scene.damper {
        damper.mass = Positive::new(1094.99843495297)?;
        let radius = Positive::new(0.6350272881550908)?;
        damper.contact = damper.contact.map(|contact| Contact { radius, ..contact });
    }
    Ok(scene)
}

fn forcing(list: &mut List) -> Any<()> {
    let group = "forcing";
    let undamped = |numbers: Numbers, omega: f64| -> Any<Scene> {
        let mut scene = scene(Numbers { c2: 0.0, ..numbers })?;
        scene.primary.damping = NonNegative::new(0.0)?;
        scene.forcing.frequency = NonNegative::new(omega)?;
        Ok(scene)
    };
    let bare = Scene { damper: None, ..undamped(TMD, 39.5_f64.sqrt())? };
    list.add(group, "resonance without damping, bare", 100.0, bare);
    // The lower root of (k1 + k2 - m1 ω²)(k2 - m2 ω²) = k2².
    let (k1, k2, m1, m2) = (3.95e4, TMD.k2, 1000.0, 60.0);
    let (half, product) = (0.5 * ((k1 + k2) / m1 + k2 / m2), k1 * k2 / (m1 * m2));
    let lower = (half - (half * half - product).sqrt()).sqrt();
    let far = Numbers { d: 1e3, c: 1e3, ..TMD };
    list.add(group, "resonance without damping, TMD", 50.0, undamped(far, lower)?);
    for (name, to, omega) in
        [("ω = 0", 10.0, 0.0), ("ω = 10⁻³ rad/s", 20.0, 1e-3), ("ω = 1000 rad/s", 5.0, 1e3)]
    {
        let mut scene = scene(SSVI)?;
        scene.forcing.frequency = NonNegative::new(omega)?;
        list.add(group, name, to, scene);
    }
    Ok(())
}
