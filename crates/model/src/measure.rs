//! The catalogue of quantities: each measure of a motion once, with its name, words and unit.

use crate::unit::{ACCELERATION, ENERGY, FORCE, LENGTH, MODULUS, TIME, VELOCITY};
use crate::{Rms, Unit};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A quantity whose largest value tells how much a motion matters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "Cow<'_, str>", into = "&'static str")]
pub enum Measure {
    /// E1, the energy of the primary structure.
    #[default]
    Energy,
    /// |x1|.
    Displacement,
    /// |v1|.
    Velocity,
    /// |a1|.
    Acceleration,
    /// |k1 x1 + c1 v1|.
    GroundForce,
    /// The spring's deflection |x2 - x1 - D|.
    Stroke,
    /// The force on either wall.
    ContactForce,
    /// The pressure of Hertz's contact at the middle of either wall's contact area.
    ContactPressure,
    /// How long after the forcing the energy of the primary structure exceeds a share of its largest value; no harmonic motion has it.
    DecayTime,
    /// What a stationary random motion has in the place of a largest value.
    Stationary(Rms),
}

impl Measure {
    /// All largest values of a run.
    pub const ALL: [Self; 8] = [
        Self::Energy,
        Self::Displacement,
        Self::Velocity,
        Self::Acceleration,
        Self::GroundForce,
        Self::Stroke,
        Self::ContactForce,
        Self::ContactPressure,
    ];

    /// All that a run may have a limit on: its largest values, then the decay time.
    pub const OF_RUN: [Self; Self::ALL.len() + 1] = {
        let mut all = [Self::DecayTime; Self::ALL.len() + 1];
        let mut i = 0;
        while i < Self::ALL.len() {
            all[i] = Self::ALL[i];
            i += 1;
        }
        all
    };

    /// Those that exist without a damper, too: the first of [`Self::ALL`].
    pub const OF_STRUCTURE: [Self; 5] =
        [Self::Energy, Self::Displacement, Self::Velocity, Self::Acceleration, Self::GroundForce];
    /// Those that need a damper.
    pub const OF_DAMPER: [Self; 3] = [Self::Stroke, Self::ContactForce, Self::ContactPressure];

    /// Name in files, short name, words, SI unit: its entry of the catalogue.
    const fn entry(self) -> [&'static str; 4] {
        match self {
            Self::Energy => ["E1max", "E1", "the largest energy of the structure", "J"],
            Self::Displacement => ["x1max", "x1", "the largest displacement of the structure", "m"],
            Self::Velocity => ["v1max", "v1", "the largest velocity of the structure", "m/s"],
            Self::Acceleration => ["a1max", "a1", "the largest acceleration of the structure", "m/s²"],
            Self::GroundForce => ["ground_force", "ground", "the largest force on the ground", "N"],
            Self::Stroke => ["stroke", "stroke", "the largest deflection of the damper's spring", "m"],
            Self::ContactForce => {
                ["contact_force", "walls", "the largest force between damper and wall", "N"]
            }
            Self::ContactPressure => {
                ["contact_pressure", "pressure", "the largest pressure between damper and wall", "Pa"]
            }
            Self::DecayTime => [
                "decay_time",
                "decay",
                "the time from the end of the forcing until E1 stays below 5 % of its largest value",
                "s",
            ],
            Self::Stationary(rms) => rms.entry(),
        }
    }

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        self.entry()[0]
    }

    /// Its name where space is short.
    pub const fn short_name(self) -> &'static str {
        self.entry()[1]
    }

    /// What it is.
    pub const fn words(self) -> &'static str {
        self.entry()[2]
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        self.entry()[3]
    }

    /// Units in which it may be given, the SI unit first.
    pub const fn units(self) -> &'static [Unit] {
        match self {
            Self::Energy => ENERGY,
            Self::Displacement | Self::Stroke => LENGTH,
            Self::Velocity => VELOCITY,
            Self::Acceleration => ACCELERATION,
            Self::GroundForce | Self::ContactForce => FORCE,
            Self::ContactPressure => MODULUS,
            Self::DecayTime => TIME,
            Self::Stationary(_) => self.of_run().units(),
        }
    }

    /// Whether only a motion with a damper has it.
    pub const fn is_of_damper(self) -> bool {
        matches!(self, Self::Stroke | Self::Stationary(Rms::Stroke)) || self.is_of_walls()
    }

    /// Whether only a motion that touches a wall has it.
    pub const fn is_of_walls(self) -> bool {
        matches!(self, Self::ContactForce | Self::ContactPressure)
    }

    /// The corresponding largest value of a run: itself, that of the quantity whose mean this is, or the energy for a decay time.
    pub const fn of_run(self) -> Self {
        match self {
            Self::DecayTime => Self::Energy,
            Self::Stationary(Rms::Energy) => Self::Energy,
            Self::Stationary(Rms::Displacement) => Self::Displacement,
            Self::Stationary(Rms::Velocity) => Self::Velocity,
            Self::Stationary(Rms::Acceleration) => Self::Acceleration,
            Self::Stationary(Rms::GroundForce) => Self::GroundForce,
            Self::Stationary(Rms::Stroke) => Self::Stroke,
            largest => largest,
        }
    }

    /// Its place in [`Self::OF_RUN`].
    pub const fn index(self) -> usize {
        match self {
            Self::Energy => 0,
            Self::Displacement => 1,
            Self::Velocity => 2,
            Self::Acceleration => 3,
            Self::GroundForce => 4,
            Self::Stroke => 5,
            Self::ContactForce => 6,
            Self::ContactPressure => 7,
            Self::DecayTime => 8,
            Self::Stationary(_) => self.of_run().index(),
        }
    }

    /// All that may be minimised: those of runs, then those of stationary motions.
    pub fn every() -> impl Iterator<Item = Self> + Clone {
        Self::OF_RUN.into_iter().chain(Rms::ALL.map(Self::Stationary))
    }

    /// Name, words and unit: its description in schemas.
    pub fn sentence(self) -> String {
        format!("{}, {}, {}.", self.name(), self.words(), self.unit())
    }
}

impl TryFrom<Cow<'_, str>> for Measure {
    type Error = String;

    fn try_from(name: Cow<'_, str>) -> Result<Self, String> {
        Self::every().find(|measure| measure.name() == name).ok_or_else(|| {
            let all: Vec<String> = Self::every().map(|measure| format!("`{}`", measure.name())).collect();
            format!("unknown variant `{name}`, expected one of {}", all.join(", "))
        })
    }
}

impl From<Measure> for &'static str {
    fn from(measure: Measure) -> Self {
        measure.name()
    }
}

impl JsonSchema for Measure {
    fn schema_name() -> Cow<'static, str> {
        "Measure".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let one = |measure: Self| json_schema!({ "type": "string", "const": measure.name(), "description": measure.sentence() });
        json_schema!({
            "description": "A quantity whose largest value tells how much a motion matters.",
            "oneOf": Self::every().map(one).collect::<Vec<_>>()
        })
    }
}

/// A value for each of [`Measure::OF_RUN`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerMeasure<T>(pub [T; Measure::OF_RUN.len()]);

impl<T: Copy> PerMeasure<T> {
    /// The same value for every measure.
    pub const fn all(value: T) -> Self {
        Self([value; Measure::OF_RUN.len()])
    }

    /// The value for `measure`.
    pub fn get(&self, measure: Measure) -> T {
        self.0[measure.index()]
    }

    /// Sets the value for `measure`.
    pub fn set(&mut self, measure: Measure, value: T) {
        self.0[measure.index()] = value;
    }
}

impl PerMeasure<bool> {
    /// Every largest value.
    pub const EVERY: Self = {
        let mut every = [true; Measure::OF_RUN.len()];
        every[Measure::DecayTime.index()] = false;
        Self(every)
    };

    /// The largest values that are set.
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
    /// The larger value of each measure.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].max(other.0[i])))
    }
}
