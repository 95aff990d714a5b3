//! The catalogue of parameters: each number of a scene once, with its symbol, words, units, place and range. Study files, the command
//! line, sweeps, sensitivities, sliders and the Python package read it.

use crate::unit::{DAMPING, FORCE, FREQUENCY, IMBALANCE, LENGTH, MASS, MODULUS, NONE, STIFFNESS};
use crate::{Damper, NonNegative, OutOfRange, PoissonRatio, Positive, Scene, Source, Unit, unit};
use schemars::{Schema, json_schema};
use serde::{Deserialize, Serialize};

/// A parameter of a scene: first those of the damper that a search may vary, in the order of the paper's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "&'static str")]
#[expect(missing_docs, reason = "described by `words`")]
pub enum Parameter {
    K2,
    C2,
    D,
    C,
    M2,
    R,
    M1,
    C1,
    K1,
    P,
    Imbalance,
    Base,
    Omega,
    Q,
    E1,
    Nu1,
    E2,
    Nu2,
    E3,
    Nu3,
    E4,
    Nu4,
}

/// Why a scene has no such parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Absent {
    /// There is no damper.
    #[error("the scene has no damper")]
    NoDamper,
    /// The damper has no walls: no gaps, no surfaces.
    #[error("the damper has no walls")]
    NoWalls,
    /// Another number gives the forcing.
    #[error("the forcing of the scene is given by `{0}`")]
    Forcing(&'static str),
}

/// Why a parameter cannot be set.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unsettable {
    /// The scene does not have it.
    #[error(transparent)]
    Absent(#[from] Absent),
    /// The value is not allowed.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}

/// Where a parameter stands in a scene, with its range.
enum Place<'a> {
    Positive(&'a mut Positive),
    NonNegative(&'a mut NonNegative),
    Poisson(&'a mut PoissonRatio),
}

impl Place<'_> {
    fn get(&self) -> f64 {
        match self {
            Self::Positive(at) => at.get(),
            Self::NonNegative(at) => at.get(),
            Self::Poisson(at) => at.get(),
        }
    }

    fn set(self, value: f64) -> Result<(), OutOfRange> {
        match self {
            Self::Positive(at) => *at = Positive::new(value)?,
            Self::NonNegative(at) => *at = NonNegative::new(value)?,
            Self::Poisson(at) => *at = PoissonRatio::new(value)?,
        }
        Ok(())
    }
}

impl Parameter {
    /// All of them.
    pub const ALL: [Self; 22] = [
        Self::K2,
        Self::C2,
        Self::D,
        Self::C,
        Self::M2,
        Self::R,
        Self::M1,
        Self::C1,
        Self::K1,
        Self::P,
        Self::Imbalance,
        Self::Base,
        Self::Omega,
        Self::Q,
        Self::E1,
        Self::Nu1,
        Self::E2,
        Self::Nu2,
        Self::E3,
        Self::Nu3,
        Self::E4,
        Self::Nu4,
    ];
    /// Those that a search may vary, the first of [`Self::ALL`].
    pub const VARIED: [Self; 6] = [Self::K2, Self::C2, Self::D, Self::C, Self::M2, Self::R];
    /// Those that the paper varies, in the order of its tables.
    pub const PAPER: [Self; 4] = [Self::K2, Self::C2, Self::D, Self::C];
    /// Those that set the size of the forcing, of which a scene has one.
    pub const AMPLITUDES: [Self; 3] = [Self::P, Self::Imbalance, Self::Base];

    /// Symbol, words, units: its own entry of the catalogue.
    const fn entry(self) -> (&'static str, &'static str, &'static [Unit]) {
        match self {
            Self::K2 => ("k2", "stiffness of the damper's spring", STIFFNESS),
            Self::C2 => ("c2", "damping between damper and primary structure", DAMPING),
            Self::D => ("D", "distance between the damper at rest and the primary structure", LENGTH),
            Self::C => ("C", "clearance between the damper at rest and the obstacle", LENGTH),
            Self::M2 => ("m2", "mass of the damper", MASS),
            Self::R => ("R", "radius of the damper's surfaces", LENGTH),
            Self::M1 => ("m1", "mass of the primary structure", MASS),
            Self::C1 => ("c1", "damping of the primary structure", DAMPING),
            Self::K1 => ("k1", "stiffness of the primary structure", STIFFNESS),
            Self::P => ("P", "amplitude of the force on the primary structure", FORCE),
            Self::Imbalance => {
                ("imbalance", "rotating imbalance, mass times its distance from the axis", IMBALANCE)
            }
            Self::Base => ("base", "amplitude of the moving base", LENGTH),
            Self::Omega => ("omega", "angular frequency of the forcing", FREQUENCY),
            Self::Q => ("q", "geometrical coefficient of Hertz's theory", NONE),
            Self::E1 => ("E1", "Young's modulus of the primary structure's surface", MODULUS),
            Self::Nu1 => ("nu1", "Poisson's ratio of the primary structure's surface", NONE),
            Self::E2 => {
                ("E2", "Young's modulus of the damper's surface that meets the primary structure", MODULUS)
            }
            Self::Nu2 => {
                ("nu2", "Poisson's ratio of the damper's surface that meets the primary structure", NONE)
            }
            Self::E3 => ("E3", "Young's modulus of the obstacle's surface", MODULUS),
            Self::Nu3 => ("nu3", "Poisson's ratio of the obstacle's surface", NONE),
            Self::E4 => ("E4", "Young's modulus of the damper's surface that meets the obstacle", MODULUS),
            Self::Nu4 => ("nu4", "Poisson's ratio of the damper's surface that meets the obstacle", NONE),
        }
    }

    /// Its symbol: the paper's, or the name in study files.
    pub const fn symbol(self) -> &'static str {
        self.entry().0
    }

    /// What it is.
    pub const fn words(self) -> &'static str {
        self.entry().1
    }

    /// Units in which it may be given, the SI unit first.
    pub const fn units(self) -> &'static [Unit] {
        self.entry().2
    }

    /// The SI unit; empty of a number without one.
    pub const fn unit(self) -> &'static str {
        self.units()[0].0
    }

    /// Whether it is the angular frequency of the forcing.
    pub const fn is_frequency(self) -> bool {
        matches!(self, Self::Omega)
    }

    /// Whether it is the distance to a wall.
    pub const fn is_gap(self) -> bool {
        matches!(self, Self::D | Self::C)
    }

    /// Whether it belongs to the surfaces in contact.
    pub const fn is_of_contact(self) -> bool {
        self as usize >= Self::Q as usize || matches!(self, Self::R)
    }

    /// Whether it belongs to the damper, its gaps and its surfaces included.
    pub const fn is_of_damper(self) -> bool {
        matches!(self, Self::K2 | Self::C2 | Self::M2) || self.is_gap() || self.is_of_contact()
    }

    /// Whether motions have derivatives by it.
    pub const fn has_derivative(self) -> bool {
        !matches!(self, Self::M1) && (!self.is_of_contact() || matches!(self, Self::R))
    }

    /// The columns of a table of designs in which these are varied: the paper's, and what else is varied.
    pub fn columns(varied: &[Self]) -> Vec<Self> {
        let others = varied.iter().copied().filter(|parameter| !Self::PAPER.contains(parameter));
        Self::PAPER.into_iter().chain(others).collect()
    }

    /// A value as it was typed, in the SI unit: without a unit, or with one of [`Self::units`].
    ///
    /// # Errors
    /// It is no such number; the message says what to give.
    pub fn read(self, text: &str) -> Result<f64, String> {
        unit::read(text, self.units())
    }

    /// Where it stands in a scene.
    fn place(self, scene: &mut Scene) -> Result<Place<'_>, Absent> {
        let has = scene.forcing.amplitude().map_or("start", |(own, _)| own.symbol());
        let Scene { primary, forcing, damper } = scene;
        let place = match (self, &mut forcing.source) {
            (Self::M1, _) => Place::Positive(&mut primary.mass),
            (Self::C1, _) => Place::NonNegative(&mut primary.damping),
            (Self::K1, _) => Place::NonNegative(&mut primary.stiffness),
            (Self::P, Source::Force(at))
            | (Self::Imbalance, Source::Imbalance(at))
            | (Self::Base, Source::Base(at)) => Place::NonNegative(at),
            (Self::Omega, Source::Force(_) | Source::Imbalance(_) | Source::Base(_)) => {
                Place::NonNegative(&mut forcing.frequency)
            }
            (Self::P | Self::Imbalance | Self::Base | Self::Omega, _) => return Err(Absent::Forcing(has)),
            _ => return self.place_in(damper.as_mut().ok_or(Absent::NoDamper)?),
        };
        Ok(place)
    }

    /// Where it stands in a damper.
    fn place_in(self, damper: &mut Damper) -> Result<Place<'_>, Absent> {
        let Damper { mass, stiffness, damping, rest_distance, clearance, contact } = damper;
        match self {
            Self::M2 => return Ok(Place::Positive(mass)),
            Self::K2 => return Ok(Place::NonNegative(stiffness)),
            Self::C2 => return Ok(Place::NonNegative(damping)),
            _ => {}
        }
        let contact = contact.as_mut().ok_or(Absent::NoWalls)?;
        let place = match self {
            Self::D => Place::NonNegative(rest_distance),
            Self::C => Place::NonNegative(clearance),
            Self::Q => Place::Positive(&mut contact.coefficient),
            Self::E1 => Place::Positive(&mut contact.young_1),
            Self::Nu1 => Place::Poisson(&mut contact.poisson_1),
            Self::E2 => Place::Positive(&mut contact.young_2),
            Self::Nu2 => Place::Poisson(&mut contact.poisson_2),
            Self::E3 => Place::Positive(&mut contact.young_3),
            Self::Nu3 => Place::Poisson(&mut contact.poisson_3),
            Self::E4 => Place::Positive(&mut contact.young_4),
            Self::Nu4 => Place::Poisson(&mut contact.poisson_4),
            _ => Place::Positive(&mut contact.radius),
        };
        Ok(place)
    }

    /// Its value in a scene, in its SI unit; none where the scene has no such parameter.
    pub fn of(self, scene: &Scene) -> Option<f64> {
        self.place(&mut scene.clone()).ok().map(|place| place.get())
    }

    /// Gives it a value in a scene, in its SI unit.
    ///
    /// # Errors
    /// The scene does not have it, or the value is out of its range; the scene is then unchanged.
    pub fn set(self, scene: &mut Scene, value: f64) -> Result<(), Unsettable> {
        Ok(self.place(scene)?.set(value)?)
    }

    /// Its value in a damper; none where it is not one of a damper, or the damper has no walls.
    pub fn of_damper(self, damper: &Damper) -> Option<f64> {
        let mut damper = *damper;
        let place = self.is_of_damper().then(|| self.place_in(&mut damper).ok()).flatten();
        place.map(|place| place.get())
    }

    /// Its value in a damper; NaN where it has none.
    pub fn get(self, damper: &Damper) -> f64 {
        self.of_damper(damper).unwrap_or(f64::NAN)
    }

    /// Gives it a value in a damper.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn set_damper(self, damper: &mut Damper, value: f64) -> Result<(), Unsettable> {
        if !self.is_of_damper() {
            return Err(Absent::NoDamper.into());
        }
        Ok(self.place_in(damper)?.set(value)?)
    }

    /// Whether its value must be above zero, of those that a search may vary.
    const fn is_positive(self) -> bool {
        matches!(self, Self::M2 | Self::R)
    }

    /// Checks a value of one of [`Self::VARIED`], without a damper.
    ///
    /// # Errors
    /// It is out of its range.
    pub fn check(self, value: f64) -> Result<(), OutOfRange> {
        if self.is_positive() {
            Positive::new(value).map(|_| ())
        } else {
            NonNegative::new(value).map(|_| ())
        }
    }

    /// The range of one of [`Self::VARIED`] as a JSON Schema.
    pub(crate) fn range_schema(self) -> Schema {
        if self.is_positive() {
            json_schema!({ "type": "number", "exclusiveMinimum": 0.0 })
        } else {
            json_schema!({ "type": "number", "minimum": 0.0 })
        }
    }

    /// Symbol, words and unit, as schemas describe it.
    pub fn sentence(self) -> String {
        let unit = self.unit();
        format!("{}, {}{}{unit}.", self.symbol(), self.words(), if unit.is_empty() { "" } else { ", " })
    }

    /// The scene with this parameter at `value`, in its SI unit; as it is where it has no such parameter.
    ///
    /// # Errors
    /// The value is out of the parameter's range.
    pub fn at(self, mut scene: Scene, value: f64) -> Result<Scene, OutOfRange> {
        match self.set(&mut scene, value) {
            Err(Unsettable::OutOfRange(refused)) => Err(refused),
            Ok(()) | Err(Unsettable::Absent(_)) => Ok(scene),
        }
    }
}

impl std::fmt::Display for Parameter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.symbol())
    }
}

impl std::str::FromStr for Parameter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|parameter| parameter.symbol() == text);
        known.ok_or_else(|| {
            let all = Self::ALL.map(Self::symbol).join(", ");
            format!("there is no parameter \"{text}\": give one of {all}")
        })
    }
}

impl TryFrom<String> for Parameter {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Parameter> for &'static str {
    fn from(parameter: Parameter) -> Self {
        parameter.symbol()
    }
}
