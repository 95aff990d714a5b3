//! The paper's scenes, for every test of this crate.
#![allow(dead_code)] // each test file uses what it needs

use retune_model::{Contact, Damper, Forcing, NonNegative, PoissonRatio, Positive, Primary, Scene};

/// The paper's structure under `omega` with stiffness `k1` and a damper `[k2, c2, D, C]`.
pub fn scene(k1: f64, omega: f64, design: Option<[f64; 4]>) -> Scene {
    let positive = |v| Positive::new(v).expect("positive");
    let value = |v| NonNegative::new(v).expect("not negative");
    let nu = |v| PoissonRatio::new(v).expect("a Poisson ratio");
    let contact = Contact {
        radius: positive(2.0),
        coefficient: positive(0.318),
        young_1: positive(2.1e11),
        poisson_1: nu(0.3),
        young_2: positive(2.21e7),
        poisson_2: nu(0.4),
        young_3: positive(2.1e11),
        poisson_3: nu(0.3),
        young_4: positive(2.05e7),
        poisson_4: nu(0.4),
    };
    let damper = design.map(|[k2, c2, d, c]| Damper {
        mass: positive(60.0),
        stiffness: value(k2),
        damping: value(c2),
        rest_distance: value(d),
        clearance: value(c),
        contact,
    });
    Scene {
        primary: Primary { mass: positive(1000.0), damping: value(452.0), stiffness: value(k1) },
        forcing: Forcing { amplitude: value(800.0), frequency: value(omega) },
        damper,
    }
}

pub const SSVI: [f64; 4] = [215.0, 232.0, 0.06, 0.36];
pub const TMD: [f64; 4] = [600.0, 262.0, 2.08, 4.7];
pub const ROW1: [f64; 4] = [150.0, 218.4, 0.06, 0.11];
