//! The parameter of a sweep.

use retune_study::{PARAMETERS, Setting, angular_frequency};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// A parameter of a scene, by its symbol in study files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Parameter(usize);

impl Parameter {
    /// All of them: the numbers of a study but those of its window.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..PARAMETERS.len()).map(Self).filter(|parameter| !matches!(parameter.symbol(), "T" | "t0"))
    }

    /// Its symbol.
    pub const fn symbol(self) -> &'static str {
        PARAMETERS[self.0].0
    }

    /// Its SI unit.
    pub const fn unit(self) -> &'static str {
        PARAMETERS[self.0].1
    }

    /// Whether it is ω, the angular frequency of the force.
    pub fn is_frequency(self) -> bool {
        self.symbol() == "omega"
    }

    /// A scene's setting to this value.
    pub fn at(self, value: f64) -> Setting {
        Setting::new(self.symbol(), value)
    }

    /// A value as it was typed, in `unit` where it has none of its own; in SI units.
    ///
    /// # Errors
    /// It is no number, or its unit is not one of this parameter; the message says what to give.
    pub fn read(self, text: &str, unit: Option<&str>) -> Result<f64, String> {
        let number: Result<f64, _> = text.trim().parse();
        if self.is_frequency() {
            return match (number, unit) {
                (Ok(_), Some(unit)) => angular_frequency(&format!("{}{unit}", text.trim())),
                _ => angular_frequency(text),
            };
        }
        match unit.filter(|unit| *unit != self.unit()) {
            Some(unit) => Err(format!("{} is given in {}, not in {unit}", self.symbol(), self.unit())),
            None => number.map_err(|_| format!("\"{text}\" is not a number: give one in {}", self.unit())),
        }
    }
}

impl FromStr for Parameter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::all().find(|parameter| parameter.symbol() == text).ok_or_else(|| {
            let symbols: Vec<&str> = Self::all().map(Self::symbol).collect();
            format!("\"{text}\" cannot be swept: give one of {}", symbols.join(", "))
        })
    }
}

impl TryFrom<String> for Parameter {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Parameter> for String {
    fn from(parameter: Parameter) -> Self {
        parameter.symbol().to_owned()
    }
}
