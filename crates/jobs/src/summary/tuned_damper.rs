//! A damper as in the paper's Table 2.

use retune_model::{Damper, Design, Parameter, Positive};
use retune_study::rounded;
use serde::Serialize;

/// A damper as in the paper's Table 2: m2 (kg) and its design.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TunedDamper {
    #[serde(rename = "m2")]
    pub mass: Positive,
    /// k2, c2, D, C, and what else is varied of it.
    #[serde(flatten)]
    pub design: Design,
}

impl TunedDamper {
    /// From a damper of a scene, with what is varied of it.
    pub fn of(damper: &Damper, varied: &[Parameter]) -> Self {
        let others: Vec<Parameter> =
            varied.iter().copied().filter(|parameter| *parameter != Parameter::M2).collect();
        Self { mass: damper.mass, design: Design::of_varied(damper, &others) }
    }

    /// The design, with the mass where that is varied.
    pub fn design_of(&self, varied: &[Parameter]) -> Design {
        let mass = |parameter| parameter == Parameter::M2 && varied.contains(&parameter);
        let value = |parameter| if mass(parameter) { self.mass.get() } else { self.design.get(parameter) };
        Design::new(value).unwrap_or(self.design)
    }

    /// The numbers in words, each to its digits: `m2 = 60 kg, k2 = 215 N/m, …`.
    pub fn words(&self, digits: impl Fn(Parameter) -> usize) -> String {
        let mass = [(Parameter::M2, self.mass.get())];
        let design = Parameter::VARIED.map(|parameter| (parameter, self.design.get(parameter)));
        let known = mass.into_iter().chain(design).filter(|(_, value)| !value.is_nan());
        let said: Vec<String> = known
            .map(|(parameter, value)| {
                format!("{parameter} = {} {}", rounded(value, digits(parameter)), parameter.unit())
            })
            .collect();
        said.join(", ") + if self.design.get(Parameter::D).is_nan() { ", no walls" } else { "" }
    }

    /// m2, k2, c2, D and C, in SI units; NaN for the gaps of a damper without walls.
    pub fn values(&self) -> [f64; 5] {
        let [k2, c2, d, c] = self.design.values();
        [self.mass.get(), k2, c2, d, c]
    }
}
