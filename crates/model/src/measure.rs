//! What is measured of a motion, by the names of study files.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A quantity whose largest value tells how much a motion matters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub enum Measure {
    /// E1max, the largest energy of the primary structure, J.
    #[default]
    #[serde(rename = "E1max")]
    Energy,
    /// x1max, the largest displacement |x1| of the primary structure, m.
    #[serde(rename = "x1max")]
    Displacement,
    /// v1max, its largest velocity |v1|, m/s.
    #[serde(rename = "v1max")]
    Velocity,
    /// a1max, its largest acceleration |a1|, m/s².
    #[serde(rename = "a1max")]
    Acceleration,
    /// The largest force transmitted to the ground, |k1 x1 + c1 v1|, N.
    #[serde(rename = "ground_force")]
    GroundForce,
    /// The stroke: largest spring deflection |x2 - x1 - D|, m.
    #[serde(rename = "stroke")]
    Stroke,
    /// Largest contact force on either wall, N.
    #[serde(rename = "contact_force")]
    ContactForce,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Energy,
        Self::Displacement,
        Self::Velocity,
        Self::Acceleration,
        Self::GroundForce,
        Self::Stroke,
        Self::ContactForce,
    ];

    /// Its name in studies.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Energy => "E1max",
            Self::Displacement => "x1max",
            Self::Velocity => "v1max",
            Self::Acceleration => "a1max",
            Self::GroundForce => "ground_force",
            Self::Stroke => "stroke",
            Self::ContactForce => "contact_force",
        }
    }

    /// What it is, in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Energy => "the largest energy of the structure",
            Self::Displacement => "the largest displacement of the structure",
            Self::Velocity => "the largest velocity of the structure",
            Self::Acceleration => "the largest acceleration of the structure",
            Self::GroundForce => "the largest force on the ground",
            Self::Stroke => "the largest stroke of the damper",
            Self::ContactForce => "the largest contact force",
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Energy => "J",
            Self::Displacement | Self::Stroke => "m",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s²",
            Self::GroundForce | Self::ContactForce => "N",
        }
    }
}

/// A value for each [`Measure`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerMeasure<T>(pub [T; 7]);

impl<T: Copy> PerMeasure<T> {
    /// The value for `measure`.
    pub fn get(&self, measure: Measure) -> T {
        self.0[measure as usize]
    }

    /// Sets the value for `measure`.
    pub fn set(&mut self, measure: Measure, value: T) {
        self.0[measure as usize] = value;
    }
}

impl PerMeasure<bool> {
    /// Every measure.
    pub const EVERY: Self = Self([true; 7]);

    /// Those that are set.
    pub fn chosen(self) -> impl Iterator<Item = Measure> {
        Measure::ALL.into_iter().filter(move |measure| self.get(*measure))
    }
}

impl FromIterator<Measure> for PerMeasure<bool> {
    fn from_iter<I: IntoIterator<Item = Measure>>(measures: I) -> Self {
        let mut chosen = Self::default();
        measures.into_iter().for_each(|measure| chosen.set(measure, true));
        chosen
    }
}

impl PerMeasure<f64> {
    /// The larger of each.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].max(other.0[i])))
    }
}
