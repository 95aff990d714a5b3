//! A value of the quantity that a study minimises, which its files call by the name of that quantity: `"E1max": 225.8`, `"x1max": 0.021`.

use retune_model::Measure;
use retune_study::{rounded, short};
use serde::ser::{Serialize, SerializeMap, Serializer};

/// A value of a quantity. As JSON it is one entry of an object, for `#[serde(flatten)]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amount {
    /// What is measured.
    pub quantity: Measure,
    /// Suffix of the name of the entry: `_none` in `E1max_none`.
    suffix: &'static str,
    /// The value, in the unit of the quantity.
    pub value: f64,
}

impl Amount {
    /// A value of a quantity, named by the quantity alone.
    pub fn new(quantity: Measure, value: f64) -> Self {
        Self { quantity, suffix: "", value }
    }

    /// A value of a quantity, with a suffix that distinguishes it from others in one object.
    pub fn of(quantity: Measure, suffix: &'static str, value: f64) -> Self {
        Self { quantity, suffix, value }
    }

    /// The value with its unit, to four digits: `225.8 J`.
    pub fn words(&self) -> String {
        format!("{} {}", rounded(self.value, 4), self.quantity.unit())
    }
}

impl Serialize for Amount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(&format!("{}{}", self.quantity.name(), self.suffix), &self.value)?;
        map.end()
    }
}

/// A value with its unit, to six digits: `225.814 J`.
pub fn measured(value: f64, quantity: Measure) -> String {
    format!("{} {}", short(value), quantity.unit())
}

/// A quantity with its unit, for axes and the heads of tables: `E1max, J`.
pub fn label(quantity: Measure) -> String {
    format!("{}, {}", quantity.name(), quantity.unit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_an_amount_is_an_entry_by_the_name_of_its_quantity() {
        #[derive(serde::Serialize)]
        struct Two {
            #[serde(flatten)]
            own: Amount,
            #[serde(flatten)]
            none: Amount,
        }
        let two = Two {
            own: Amount::new(Measure::Displacement, 0.021),
            none: Amount::of(Measure::Displacement, "_none", f64::INFINITY),
        };
        let text = serde_json::to_string(&two).expect("JSON");
        assert_eq!(text, r#"{"x1max":0.021,"x1max_none":null}"#);
    }
}
