//! A damper as in the paper's Table 2.

use retune_model::{Damper, Design, Positive, Variable};
use retune_study::rounded;
use serde::Serialize;

/// A damper as in the paper's Table 2: m2 (kg) and its design.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TunedDamper {
    /// m2, mass, kg.
    #[serde(rename = "m2")]
    pub mass: Positive,
    /// k2, c2, D, C.
    #[serde(flatten)]
    pub design: Design,
}

impl TunedDamper {
    /// From a damper of a scene.
    pub const fn of(damper: &Damper) -> Self {
        Self { mass: damper.mass, design: Design::of(damper) }
    }

    /// The numbers in words, each to its digits: `m2 = 60 kg, k2 = 215 N/m, …`.
    pub fn words(&self, digits: impl Fn(Variable) -> usize) -> String {
        let [m2, k2, c2, d, c] = self.values();
        let values =
            [(Variable::M2, m2), (Variable::K2, k2), (Variable::C2, c2), (Variable::D, d), (Variable::C, c)];
        let known = values.into_iter().filter(|(_, value)| !value.is_nan());
        let said: Vec<String> = known
            .map(|(variable, value)| {
                format!("{variable} = {} {}", rounded(value, digits(variable)), variable.unit())
            })
            .collect();
        said.join(", ") + if d.is_nan() { ", no walls" } else { "" }
    }

    /// m2, k2, c2, D and C, in SI units; NaN for the gaps of a damper without walls.
    pub fn values(&self) -> [f64; 5] {
        let [k2, c2, d, c] = self.design.values();
        [self.mass.get(), k2, c2, d, c]
    }
}
