//! A validator of JSON Schema (draft 2020-12) for only the keywords that Retune's schemas use. A complete validator takes longer to compile
//! than half of the program.

use serde_json::Value;

/// The errors of a value, each with its place; empty if it is valid.
///
/// # Panics
/// At an unknown keyword, so that nothing is left unchecked.
pub fn errors(schema: &Value, value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    check(schema, schema, value, "", &mut found);
    found
}

/// Whether a value is valid.
pub fn is_valid(schema: &Value, value: &Value) -> bool {
    errors(schema, value).is_empty()
}

fn check(root: &Value, schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    let Value::Object(keywords) = schema else {
        match schema {
            Value::Bool(true) => {}
            Value::Bool(false) => found.push(format!("{at}: not allowed")),
            _ => panic!("no schema: {schema}"),
        }
        return;
    };
    let holds = |schema: &Value| {
        let mut inner = Vec::new();
        check(root, schema, value, at, &mut inner);
        inner.is_empty()
    };
    for (keyword, said) in keywords {
        let good = match keyword.as_str() {
            "$schema" | "$defs" | "title" | "description" | "default" | "format" => true,
            "$ref" => {
                let place =
                    said.as_str().and_then(|place| place.strip_prefix('#')).expect("a place in this file");
                check(root, root.pointer(place).expect(place), value, at, found);
                true
            }
            "type" => match said {
                Value::Array(all) => all.iter().any(|one| is_of_type(value, one)),
                one => is_of_type(value, one),
            },
            // The only pattern in the schemas: more than a number.
            "pattern" => {
                assert_eq!(said, "[^-+.0-9eE ]", "a pattern that is not known here");
                value.as_str().is_none_or(|text| text.contains(|c: char| !"-+.0123456789eE ".contains(c)))
            }
            "const" => value == said,
            "anyOf" => list(said).iter().any(holds),
            "oneOf" => list(said).iter().filter(|one| holds(one)).count() == 1,
            "minimum" | "maximum" | "exclusiveMinimum" | "exclusiveMaximum" => {
                let limit = said.as_f64().expect("a number");
                value.as_f64().is_none_or(|number| match keyword.as_str() {
                    "minimum" => number >= limit,
                    "maximum" => number <= limit,
                    "exclusiveMinimum" => number > limit,
                    _ => number < limit,
                })
            }
            "minItems" => value.as_array().is_none_or(|items| items.len() as u64 >= count(said)),
            "maxItems" => value.as_array().is_none_or(|items| items.len() as u64 <= count(said)),
            "prefixItems" => {
                for (i, (schema, item)) in list(said).iter().zip(items(value)).enumerate() {
                    check(root, schema, item, &format!("{at}/{i}"), found);
                }
                true
            }
            "items" => {
                let before = keywords.get("prefixItems").map_or(0, |prefix| list(prefix).len());
                for (i, item) in items(value).iter().enumerate().skip(before) {
                    check(root, said, item, &format!("{at}/{i}"), found);
                }
                true
            }
            "required" => !value.is_object() || has_all(value, said),
            "dependentRequired" => {
                fields(said).all(|(field, others)| value.get(field).is_none() || has_all(value, others))
            }
            "properties" => {
                for (field, schema) in fields(said) {
                    if let Some(inner) = value.get(field) {
                        check(root, schema, inner, &format!("{at}/{field}"), found);
                    }
                }
                true
            }
            "additionalProperties" => {
                let known =
                    |field: &String| keywords.get("properties").is_some_and(|all| all.get(field).is_some());
                for (field, inner) in fields(value).filter(|(field, _)| !known(field)) {
                    check(root, said, inner, &format!("{at}/{field}"), found);
                }
                true
            }
            other => panic!("a keyword that is not known here: {other}"),
        };
        if !good {
            found.push(format!("{at}: {value} is not as {keyword} says: {said}"));
        }
    }
}

fn is_of_type(value: &Value, name: &Value) -> bool {
    match name.as_str().expect("the name of a type") {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        other => panic!("no type: {other}"),
    }
}

fn has_all(value: &Value, names: &Value) -> bool {
    list(names).iter().all(|name| value.get(name.as_str().expect("a name")).is_some())
}

fn list(said: &Value) -> &[Value] {
    said.as_array().expect("a list")
}

/// The items of a list; none of anything else.
fn items(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// The fields of an object; none of anything else.
fn fields(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

fn count(said: &Value) -> u64 {
    said.as_u64().expect("a count")
}
