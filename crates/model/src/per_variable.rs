//! Optional values for the parameters that a search may vary; in a file, an object keyed by their symbols.

use crate::Parameter;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::marker::PhantomData;

const COUNT: usize = Parameter::VARIED.len();
const SYMBOLS: [&str; COUNT] = Parameter::VARIED_SYMBOLS;

/// An optional value for each of [`Parameter::VARIED`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerVariable<T>([Option<T>; COUNT]);

impl<T> Default for PerVariable<T> {
    fn default() -> Self {
        Self([const { None }; COUNT])
    }
}

/// The index of a parameter in [`Parameter::VARIED`].
const fn index(parameter: Parameter) -> Option<usize> {
    let index = parameter as usize;
    if index < COUNT { Some(index) } else { None }
}

impl<T: Copy> PerVariable<T> {
    /// The value for a parameter, if any.
    pub fn get(&self, parameter: Parameter) -> Option<T> {
        index(parameter).and_then(|i| self.0[i])
    }

    /// Sets or clears the value for a parameter; ignored for one that no search may vary.
    pub fn set(&mut self, parameter: Parameter, value: Option<T>) {
        if let Some(i) = index(parameter) {
            self.0[i] = value;
        }
    }

    /// The value for a parameter, mutable.
    pub fn get_mut(&mut self, parameter: Parameter) -> Option<&mut T> {
        index(parameter).and_then(|i| self.0[i].as_mut())
    }

    /// The parameters that have a value, in the order of the paper's tables.
    pub fn parameters(&self) -> Vec<Parameter> {
        Parameter::VARIED.into_iter().filter(|&parameter| self.get(parameter).is_some()).collect()
    }
}

impl PerVariable<f64> {
    /// The values of some parameters.
    pub fn of(parameters: &[Parameter], values: &[f64]) -> Self {
        let mut all = Self::default();
        for (&parameter, &value) in parameters.iter().zip(values) {
            all.set(parameter, Some(value));
        }
        all
    }
}

impl<T: Copy + Serialize> Serialize for PerVariable<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let given = Parameter::VARIED.into_iter().filter_map(|one| Some((one.symbol(), self.get(one)?)));
        serializer.collect_map(given)
    }
}

impl<'de, T: Copy + Deserialize<'de>> Deserialize<'de> for PerVariable<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Object<T>(PhantomData<T>);
        impl<'de, T: Copy + Deserialize<'de>> Visitor<'de> for Object<T> {
            type Value = PerVariable<T>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "an object with some of {}", SYMBOLS.join(", "))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut all = PerVariable::default();
                while let Some(name) = map.next_key::<Cow<'de, str>>()? {
                    let parameter =
                        Parameter::varied(&name).ok_or_else(|| A::Error::unknown_field(&name, &SYMBOLS))?;
                    if all.get(parameter).is_some() {
                        return Err(A::Error::duplicate_field(parameter.symbol()));
                    }
                    all.set(parameter, map.next_value()?);
                }
                Ok(all)
            }
        }
        deserializer.deserialize_map(Object(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for PerVariable<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("PerVariable_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let schema = generator.subschema_for::<Option<T>>();
        json_schema!({
            "description": "Something for each parameter that may be tuned.",
            "type": "object",
            "properties": properties(|_| schema.clone()),
            "additionalProperties": false
        })
    }
}

/// Properties of a schema: one, with its description, for each parameter that a search may vary.
pub(crate) fn properties(schema: impl Fn(Parameter) -> Schema) -> serde_json::Map<String, serde_json::Value> {
    let field = |parameter: Parameter| {
        let mut schema = schema(parameter);
        schema.insert("description".to_owned(), parameter.sentence().into());
        (parameter.symbol().to_owned(), schema.to_value())
    };
    Parameter::VARIED.map(field).into_iter().collect()
}
