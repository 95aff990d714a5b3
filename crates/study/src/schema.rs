//! The JSON Schemas of files: where numbers have a unit, a text with one is as good.

use schemars::{JsonSchema, Schema, schema_for};
use serde_json::{Map, Value, json};

/// Definitions whose numbers may be texts, by their names or what these begin with. Numbers without a unit are of other types, or their texts
/// are refused by the reader.
const NUMBERS: [&str; 9] = [
    "Positive",
    "NonNegative",
    "Finite",
    "Margins",
    "GridAxis",
    "BoxSide",
    "K1Range",
    "Band",
    "PerVariable_",
];

/// A number in quotes is a slip.
const MORE_THAN_A_NUMBER: &str = "[^-+.0-9eE ]";

/// The schema of a kind of file.
pub fn schema<T: JsonSchema>() -> Schema {
    let mut schema = schema_for!(T);
    if let Some(Value::Object(all)) = schema.get_mut("$defs") {
        for (name, of) in all.iter_mut() {
            if NUMBERS.iter().any(|known| name == known || known.ends_with('_') && name.starts_with(known)) {
                widen(of);
            }
        }
    }
    schema
}

/// Lets a text stand in the place of each number. Keywords on the size of numbers say nothing of texts.
fn widen(schema: &mut Value) {
    match schema {
        Value::Object(keywords) => {
            widen_type(keywords);
            keywords.values_mut().for_each(widen);
        }
        Value::Array(all) => all.iter_mut().for_each(widen),
        _ => {}
    }
}

fn widen_type(keywords: &mut Map<String, Value>) {
    let Some(of) = keywords.get_mut("type") else { return };
    match of {
        Value::String(one) if one == "number" => *of = json!(["number", "string"]),
        Value::Array(several) if several.contains(&json!("number")) => several.push(json!("string")),
        _ => return,
    }
    let words = keywords.get("description").and_then(Value::as_str).map(|words| format!("{words} "));
    let words =
        format!("{}A number in the SI unit, or a text with a unit: \"20 kN/m\".", words.unwrap_or_default());
    keywords.insert("description".to_owned(), words.into());
    keywords.insert("pattern".to_owned(), MORE_THAN_A_NUMBER.into());
}
