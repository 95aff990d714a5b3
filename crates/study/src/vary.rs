//! The list of parameters that a search varies, in a file.

use retune_model::Parameter;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;

/// One of the list.
struct Varied(Parameter);

impl<'de> Deserialize<'de> for Varied {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Cow::<'de, str>::deserialize(deserializer)?;
        let unknown = || D::Error::unknown_variant(&name, &Parameter::VARIED_SYMBOLS);
        Parameter::varied(&name).map(Self).ok_or_else(unknown)
    }
}

/// Reads it; a parameter that no search may vary is refused.
pub fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Parameter>, D::Error> {
    Ok(Vec::<Varied>::deserialize(deserializer)?.into_iter().map(|Varied(parameter)| parameter).collect())
}

/// Its schema: symbols, each with its description.
pub fn schema(_: &mut SchemaGenerator) -> Schema {
    let one = |parameter: Parameter| json_schema!({ "type": "string", "const": parameter.symbol(), "description": parameter.sentence() });
    json_schema!({ "type": "array", "minItems": 1, "items": { "oneOf": Parameter::VARIED.map(one) } })
}
