//! The list of parameters that a search varies, in a file.

use retune_model::{Parameter, VARIED, varied};
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;

/// Reads it; a parameter that no search may vary is refused.
pub fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Parameter>, D::Error> {
    let known = |name: &Cow<'de, str>| varied(name).ok_or_else(|| D::Error::unknown_variant(name, &VARIED));
    Vec::<Cow<'de, str>>::deserialize(deserializer)?.iter().map(known).collect()
}

/// Its schema: symbols, each with its description.
pub fn schema(_: &mut SchemaGenerator) -> Schema {
    let one = |parameter: Parameter| json_schema!({ "type": "string", "const": parameter.symbol(), "description": parameter.sentence() });
    json_schema!({ "type": "array", "minItems": 1, "items": { "oneOf": Parameter::VARIED.map(one) } })
}
