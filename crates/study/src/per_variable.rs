//! Something for some of the parameters that may be tuned.

use retune_model::{Design, Variable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Something for each parameter that may be tuned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PerVariable<T> {
    /// k2, stiffness of the damper's spring, N/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k2: Option<T>,
    /// c2, damping between damper and primary structure, N·s/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c2: Option<T>,
    /// D, distance between the damper at rest and the primary structure, m.
    #[serde(rename = "D", skip_serializing_if = "Option::is_none")]
    pub d: Option<T>,
    /// C, clearance between the damper at rest and the obstacle, m.
    #[serde(rename = "C", skip_serializing_if = "Option::is_none")]
    pub c: Option<T>,
    /// m2, mass of the damper, kg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub m2: Option<T>,
}

impl<T> Default for PerVariable<T> {
    fn default() -> Self {
        Self { k2: None, c2: None, d: None, c: None, m2: None }
    }
}

impl<T: Copy> PerVariable<T> {
    /// What is given for `variable`.
    pub fn get(&self, variable: Variable) -> Option<T> {
        match variable {
            Variable::K2 => self.k2,
            Variable::C2 => self.c2,
            Variable::D => self.d,
            Variable::C => self.c,
            Variable::M2 => self.m2,
        }
    }

    /// The place for `variable`.
    pub fn get_mut(&mut self, variable: Variable) -> &mut Option<T> {
        match variable {
            Variable::K2 => &mut self.k2,
            Variable::C2 => &mut self.c2,
            Variable::D => &mut self.d,
            Variable::C => &mut self.c,
            Variable::M2 => &mut self.m2,
        }
    }

    /// The variables that something is given for, in the order of the paper's tables.
    pub fn variables(&self) -> Vec<Variable> {
        Variable::ALL.into_iter().filter(|&variable| self.get(variable).is_some()).collect()
    }
}

impl PerVariable<f64> {
    /// The values of some variables.
    pub fn of(variables: &[Variable], values: &[f64]) -> Self {
        let mut all = Self::default();
        for (&variable, &value) in variables.iter().zip(values) {
            *all.get_mut(variable) = Some(value);
        }
        all
    }

    /// Those of a design that are among `variables` and not left out.
    pub fn of_design(design: &Design, variables: &[Variable]) -> Self {
        let known = variables.iter().map(|&variable| (variable, design.get(variable)));
        let (known, values): (Vec<Variable>, Vec<f64>) = known.filter(|(_, value)| !value.is_nan()).unzip();
        Self::of(&known, &values)
    }
}
