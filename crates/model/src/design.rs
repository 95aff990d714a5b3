//! A design: values of the parameters of the damper that may be tuned.

use crate::per_variable::properties;
use crate::{Damper, OutOfRange, Parameter, PerVariable, Unsettable};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A damper's design: k2, c2 and, for a damper with walls, both gaps. Other parameters that are left out keep the value of the study's
/// damper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "PerVariable<f64>", into = "PerVariable<f64>")]
pub struct Design(PerVariable<f64>);

/// The parameters that every design has.
const NEEDED: [Parameter; 2] = [Parameter::K2, Parameter::C2];

/// Why given values are not a valid design.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoDesign {
    /// A parameter that every design has is left out.
    #[error("missing field `{0}`")]
    Missing(Parameter),
    /// A value out of its parameter's range.
    #[error("{0}: {1}")]
    OutOfRange(Parameter, OutOfRange),
}

impl TryFrom<PerVariable<f64>> for Design {
    type Error = NoDesign;

    fn try_from(given: PerVariable<f64>) -> Result<Self, NoDesign> {
        let missing = NEEDED.into_iter().find(|needed| given.get(*needed).is_none());
        if let Some(missing) = missing {
            return Err(NoDesign::Missing(missing));
        }
        Self::checked(given).map_err(|(parameter, refused)| NoDesign::OutOfRange(parameter, refused))
    }
}

impl From<Design> for PerVariable<f64> {
    fn from(design: Design) -> Self {
        design.0
    }
}

impl Design {
    /// The design of a damper, whatever its mass and its surfaces.
    pub fn of(damper: &Damper) -> Self {
        Self::of_varied(damper, &[])
    }

    /// The design of a damper, including all of `varied`.
    pub fn of_varied(damper: &Damper, varied: &[Parameter]) -> Self {
        let mut values = PerVariable::default();
        for parameter in Parameter::columns(varied) {
            values.set(parameter, parameter.of_damper(damper));
        }
        Self(values)
    }

    /// From a value for each parameter that may be varied, in SI units; NaN for those that are left out.
    ///
    /// # Errors
    /// The first value out of range, with its parameter; a required one that is left out is refused as NaN.
    pub fn new(value: impl Fn(Parameter) -> f64) -> Result<Self, (Parameter, OutOfRange)> {
        let mut values = PerVariable::default();
        for parameter in Parameter::VARIED {
            let value = value(parameter);
            if NEEDED.contains(&parameter) || !value.is_nan() {
                values.set(parameter, Some(value));
            }
        }
        Self::checked(values)
    }

    /// The design with these values, or the first value out of its parameter's range.
    fn checked(values: PerVariable<f64>) -> Result<Self, (Parameter, OutOfRange)> {
        for parameter in values.parameters() {
            let checked = values.get(parameter).map_or(Ok(()), |value| parameter.check(value));
            checked.map_err(|refused| (parameter, refused))?;
        }
        Ok(Self(values))
    }

    /// The value of a parameter; NaN where it is left out.
    pub fn get(&self, parameter: Parameter) -> f64 {
        self.0.get(parameter).unwrap_or(f64::NAN)
    }

    /// The values of [`Parameter::PAPER`], in its order; NaN where they are left out.
    pub fn values(&self) -> [f64; 4] {
        Parameter::PAPER.map(|parameter| self.get(parameter))
    }

    /// The values of some parameters that are not left out.
    pub fn only(&self, parameters: &[Parameter]) -> PerVariable<f64> {
        let mut all = PerVariable::default();
        parameters.iter().for_each(|&parameter| all.set(parameter, self.0.get(parameter)));
        all
    }

    /// `damper` with this design. Parameters of walls are ignored if it has none.
    #[must_use]
    pub fn on(&self, mut damper: Damper) -> Damper {
        for parameter in self.0.parameters() {
            // The values are checked, so only those of missing walls can fail.
            let _: Result<(), Unsettable> = parameter.set_damper(&mut damper, self.get(parameter));
        }
        damper
    }
}

impl JsonSchema for Design {
    fn schema_name() -> Cow<'static, str> {
        "Design".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A damper's design.",
            "type": "object",
            "properties": properties(Parameter::range_schema),
            "additionalProperties": false,
            "required": NEEDED.map(Parameter::symbol)
        })
    }
}
