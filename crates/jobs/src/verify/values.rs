//! The comparison of two JSON values.

use super::tally::Tally;
use serde_json::Value;

/// Compares every field of `again`: numbers by their relative difference, anything else must be equal. Fields that `again` does not
/// have, and the version of Retune, are ignored; so are texts made of numbers where these may differ by a share `within`.
pub fn compare(said: &Value, again: &Value, within: f64) -> Tally {
    let mut tally = Tally::default();
    visit(said, again, within, &mut tally);
    tally
}

fn visit(said: &Value, again: &Value, within: f64, tally: &mut Tally) {
    match (said, again) {
        (_, Value::Object(fields)) => {
            let made_of_numbers = |name: &str| within > 0.0 && ["words", "at"].contains(&name);
            for (name, again) in fields.iter().filter(|(name, _)| *name != "retune" && !made_of_numbers(name))
            {
                visit(&said[name.as_str()], again, within, tally);
            }
        }
        (Value::Array(said), Value::Array(again)) if said.len() == again.len() => {
            said.iter().zip(again).for_each(|(said, again)| visit(said, again, within, tally));
        }
        // A number that is not finite is null.
        (Value::Number(_) | Value::Null, Value::Number(_) | Value::Null) => {
            let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
            tally.see(number(said), number(again));
        }
        _ if said == again => {}
        _ => tally.differs(f64::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn contract_every_leaf_is_compared() {
        let again = json!({ "a": [1.0, null], "retune": "2", "b": { "verdict": "robust", "words": "so" } });
        let look = |said: Value, within: f64| {
            let Tally { differ, most } = compare(&said, &again, within);
            (differ, most)
        };
        let with = |path: &str, value: Value| {
            let mut said = again.clone();
            *said.pointer_mut(path).expect(path) = value;
            said
        };
        assert_eq!(look(with("/retune", json!("1")), 0.0), (0, 0.0));
        assert_eq!(look(with("/a/0", json!(0.5)), 0.0), (1, 0.5));
        assert_eq!(look(with("/a/1", json!(0.5)), 0.0), (1, f64::INFINITY));
        assert_eq!(look(with("/a", json!([1.0])), 0.0), (1, f64::INFINITY));
        assert_eq!(look(with("/b/verdict", json!("sensitive")), 0.1), (1, f64::INFINITY));
        assert_eq!(look(with("/b/words", json!("other")), 0.0), (1, f64::INFINITY));
        assert_eq!(look(with("/b/words", json!("other")), 0.1), (0, 0.0));
        assert_eq!(look(with("/b", json!("gone")), 0.0), (2, f64::INFINITY));
    }
}
