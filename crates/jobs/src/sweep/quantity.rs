//! What is looked at in each run.

use retune_model::Measure;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// A quantity of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Quantity {
    /// A largest value of the motion in the window.
    Largest(Measure),
    /// The transmissibility, see [`retune_model::Forcing::transmissibility`].
    Transmissibility,
    /// Impacts in the window, on both walls together.
    Impacts,
}

impl Quantity {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        Measure::ALL.into_iter().map(Self::Largest).chain([Self::Transmissibility, Self::Impacts])
    }

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Largest(measure) => measure.name(),
            Self::Transmissibility => "transmissibility",
            Self::Impacts => "impacts",
        }
    }

    /// Its SI unit; empty for a pure number.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Largest(measure) => measure.unit(),
            Self::Transmissibility | Self::Impacts => "",
        }
    }
}

impl FromStr for Quantity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::all().find(|quantity| quantity.name() == text).ok_or_else(|| {
            let names: Vec<&str> = Self::all().map(Self::name).collect();
            format!("there is no quantity \"{text}\": give one or more of {}", names.join(", "))
        })
    }
}

impl TryFrom<String> for Quantity {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Quantity> for String {
    fn from(quantity: Quantity) -> Self {
        quantity.name().to_owned()
    }
}
