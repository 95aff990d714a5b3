//! Limits in a file: an object with the names of those that are set, and `from`.

use super::{Limit, Limits};
use retune_model::{NonNegative, Positive};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// The field with the time from which limits apply.
const FROM: &str = "from";
/// All fields.
const FIELDS: [&str; Limit::ALL.len() + 1] = {
    let mut fields = [FROM; Limit::ALL.len() + 1];
    let mut i = 0;
    while i < Limit::ALL.len() {
        fields[i] = Limit::ALL[i].name();
        i += 1;
    }
    fields
};

impl Serialize for Limits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_map(None)?;
        for limit in self.set() {
            object.serialize_entry(limit.name(), &self.get(limit))?;
        }
        if let Some(from) = self.from {
            object.serialize_entry(FROM, &from)?;
        }
        object.end()
    }
}

impl<'de> Deserialize<'de> for Limits {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Object;
        impl<'de> Visitor<'de> for Object {
            type Value = Limits;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "an object with some of {}", FIELDS.join(", "))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Limits, A::Error> {
                let (mut limits, mut seen) = (Limits::default(), Vec::new());
                while let Some(name) = map.next_key::<Cow<'de, str>>()? {
                    let Some(field) = FIELDS.iter().find(|field| **field == name) else {
                        return Err(A::Error::unknown_field(&name, &FIELDS));
                    };
                    if seen.contains(field) {
                        return Err(A::Error::duplicate_field(field));
                    }
                    seen.push(field);
                    match Limit::ALL.into_iter().find(|limit| limit.name() == name) {
                        Some(limit) => limits.most.set(limit, map.next_value::<Option<Positive>>()?),
                        None => limits.from = map.next_value::<Option<NonNegative>>()?,
                    }
                }
                Ok(limits)
            }
        }
        deserializer.deserialize_map(Object)
    }
}

impl JsonSchema for Limits {
    fn schema_name() -> Cow<'static, str> {
        "Limits".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (most, time) =
            (generator.subschema_for::<Option<Positive>>(), generator.subschema_for::<Option<NonNegative>>());
        let described = |mut schema: Schema, words: String| {
            schema.insert("description".to_owned(), words.into());
            schema.to_value()
        };
        let limit = |limit: Limit| {
            let words = format!(
                "The most that is allowed of {}, {}, in any run of the objective.",
                limit.words(),
                limit.unit()
            );
            (limit.name().to_owned(), described(most.clone(), words))
        };
        let mut properties: serde_json::Map<_, _> = Limit::ALL.map(limit).into_iter().collect();
        let words = "Time from which the limits of runs apply, s. Default: 0, the whole run from rest; t0 of `window` for the same motion \
                     as the objective. A settled motion is always included, in whole blocks. Limits of a steady response are of that alone.";
        properties.insert(FROM.to_owned(), described(time, words.to_owned()));
        json_schema!({
            "description": "Limits on a design. Any design that violates a limit ranks below every feasible one; of two infeasible designs \
                            the one with the smaller violation (the sum of reached / limit - 1) is better.",
            "type": "object",
            "properties": properties,
            "additionalProperties": false
        })
    }
}
