//! The difficulties: scenes designed to make methods fail.

use crate::Any;
use crate::scenes::{CHATTER, Case, Numbers, SSVI, TMD, critical_damping, stiffer};
use retune_solver::observe::{RelativePosition, RunningMaximum};
use retune_solver::{Hybrid, Motion, Phase};

/// A scene designed to make methods fail, with its group in the atlas.
pub struct Difficulty {
    pub group: &'static str,
    pub case: Case,
}

/// Scenes of a group, each with its name and the end of its run, s.
type Scenes = [(&'static str, f64, Numbers)];

/// All difficulties except the energy over 1,000 impacts.
pub fn all() -> Any<Vec<Difficulty>> {
    let deepest = reach(SSVI, 5.0)?;
    let graze = |depth: f64| Numbers { d: deepest - depth, c: 5.0, ..SSVI };
    let heavy = Numbers { d: 0.0, k2: 5000.0, ..SSVI };
    // Spring and dashpot scale with the mass, so that the damper keeps its frequency and damping ratio.
    let mass_ratio = |ratio: f64| {
        let share = 1000.0 * ratio / 60.0;
        Numbers { m2: 1000.0 * ratio, k2: SSVI.k2 * share, c2: SSVI.c2 * share, ..SSVI }
    };
    let groups: [(&'static str, &Scenes); 5] = [
        (
            "stiffness",
            &[
                ("contact K × 10⁻²", 10.0, stiffer(1e-2)),
                ("contact K: two-sided SSVI", 10.0, SSVI),
                ("contact K × 10²", 10.0, stiffer(1e2)),
                ("contact K × 10⁴", 10.0, stiffer(1e4)),
                ("contact K × 10⁶", 10.0, stiffer(1e6)),
                ("contact K × 10⁸", 10.0, stiffer(1e8)),
            ],
        ),
        (
            "touching",
            &[
                ("misses the wall by 1 nm", 5.0, graze(-1e-9)),
                ("grazes, 1 µm deep without wall", 5.0, graze(1e-6)),
                ("grazes, 1 nm deep without wall", 5.0, graze(1e-9)),
                ("D = 0: on the wall at t = 0", 10.0, Numbers { d: 0.0, ..SSVI }),
                ("D = 0, stiff spring: held to the wall", 10.0, heavy),
                ("a contact lasts to T", 0.3, heavy),
                ("chatters, stays, leaves: once a period", 10.0, CHATTER),
                ("C = 0: on the other wall", 5.0, Numbers { c: 0.0, ..SSVI }),
                ("D = C = 1 µm: two walls in a step", 2.0, Numbers { d: 1e-6, c: 1e-6, ..SSVI }),
                ("D = C = 0: clamped", 2.0, Numbers { d: 0.0, c: 0.0, ..SSVI }),
            ],
        ),
        (
            "damper",
            &[
                ("critical damping, c2² = 4 k2 m2", 20.0, Numbers { c2: critical_damping(), ..SSVI }),
                ("k2 = 0", 10.0, Numbers { k2: 0.0, ..SSVI }),
                ("c2 = 0", 10.0, Numbers { c2: 0.0, k2: 600.0, d: 0.3, ..SSVI }),
                ("mass ratio 10⁻⁶", 10.0, mass_ratio(1e-6)),
                ("mass ratio 10⁻⁴", 10.0, mass_ratio(1e-4)),
                ("mass ratio 10⁻²", 10.0, mass_ratio(1e-2)),
                ("mass ratio 1", 10.0, mass_ratio(1.0)),
            ],
        ),
        (
            "forcing",
            &[
                (BARE, 100.0, Numbers { c1: 0.0, omega: 39.5_f64.sqrt(), ..TMD }),
                ("resonance without damping, TMD", 50.0, resonant_tmd()),
                ("ω = 0", 10.0, Numbers { omega: 0.0, ..SSVI }),
                ("ω = 10⁻³ rad/s", 20.0, Numbers { omega: 1e-3, ..SSVI }),
                ("ω = 1000 rad/s", 5.0, Numbers { omega: 1e3, ..SSVI }),
            ],
        ),
        ("maxima", &[("two maxima in one step", 20.0, TWO_MAXIMA)]),
    ];
    let mut list = Vec::new();
    for (group, rows) in groups {
        for &(name, to, numbers) in rows {
            let scene = if name == BARE { numbers.bare_scene() } else { numbers.scene() };
            list.push(Difficulty { group, case: Case { name, label: name, scene, to } });
        }
    }
    Ok(list)
}

const BARE: &str = "resonance without damping, bare";

/// A heavy damper on a stiff structure: in one flight step of the hybrid, E1 is concave at both ends but has two maxima with a
/// minimum in between; treating it as a step with one maximum lost 0.2 % of E1max. Found by adversarial search.
const TWO_MAXIMA: Numbers = Numbers {
    k1: 62235.81747936603,
    omega: 8.576461062918153,
    m2: 1094.99843495297,
    k2: 1662.5681305782794,
    c2: 8.649689386577819,
    d: 0.0595372531637714,
    c: 0.69253168895597,
    r: 0.6350272881550908,
    ..SSVI
};

/// The undamped TMD, with walls out of reach, at the lower root of (k1 + k2 - m1 ω²)(k2 - m2 ω²) = k2².
fn resonant_tmd() -> Numbers {
    let Numbers { m1, k1, m2, k2, .. } = TMD;
    let (half, product) = (0.5 * ((k1 + k2) / m1 + k2 / m2), k1 * k2 / (m1 * m2));
    let lower = (half - (half * half - product).sqrt()).sqrt();
    Numbers { c1: 0.0, c2: 0.0, d: 1e3, c: 1e3, omega: lower, ..TMD }
}

/// Largest displacement of the damper from its rest position towards the structure without walls, m.
fn reach(numbers: Numbers, to: f64) -> Any<f64> {
    let far = 10.0;
    let system = Numbers { d: far, c: far, ..numbers }.coupled();
    let mut peak = RunningMaximum::new(RelativePosition::new(&system, -1.0), f64::INFINITY);
    let begin = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    Hybrid::new(&system, 1e-12, to, 10_000_000).propagate(begin, to, &mut peak)?;
    Ok(far + peak.record().value)
}
