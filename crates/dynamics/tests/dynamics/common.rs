//! The paper's scenes with a given stiffness, frequency and damper, for every test of this crate.

use retune_model::Scene;
use retune_testkit::scenes::{self, Numbers};

/// The paper's structure under `omega` with stiffness `k1` and a damper `[k2, c2, D, C]`.
pub fn scene(k1: f64, omega: f64, design: Option<[f64; 4]>) -> Scene {
    let structure = Numbers { k1, omega, ..scenes::SSVI };
    match design {
        Some([k2, c2, d, c]) => Numbers { k2, c2, d, c, ..structure }.scene(),
        None => structure.bare_scene(),
    }
}

pub const SSVI: [f64; 4] = design(&scenes::SSVI);
pub const TMD: [f64; 4] = design(&scenes::TMD);
pub const ROW1: [f64; 4] = design(&scenes::ROW1);

const fn design(numbers: &Numbers) -> [f64; 4] {
    [numbers.k2, numbers.c2, numbers.d, numbers.c]
}
