//! The catalogue of parameters: each number of a scene once, with its symbol, words, units, place and range. Study files, the command
//! line, sweeps, sensitivities, sliders and the Python package read it.

pub mod place;

use crate::amplitude::Amplitude;
use crate::unit::{
    ACCELERATION, DAMPING, DENSITY, FORCE, FREQUENCY, IMBALANCE, LENGTH, LOSS, MASS, MODULUS, NONE, STIFFNESS,
};
use crate::{Unit, unit};
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
    BaseAcceleration,
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
    Lambda,
    Restitution,
    Strength,
    Density,
}

impl Parameter {
    /// All of them.
    pub const ALL: [Self; 27] = [
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
        Self::BaseAcceleration,
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
        Self::Lambda,
        Self::Restitution,
        Self::Strength,
        Self::Density,
    ];
    /// Those that a search may vary, the first of [`Self::ALL`].
    pub const VARIED: [Self; 6] = [Self::K2, Self::C2, Self::D, Self::C, Self::M2, Self::R];
    /// The symbols of [`Self::VARIED`], in its order.
    pub const VARIED_SYMBOLS: [&str; Self::VARIED.len()] = {
        let mut symbols = [""; Self::VARIED.len()];
        let mut i = 0;
        while i < symbols.len() {
            symbols[i] = Self::VARIED[i].symbol();
            i += 1;
        }
        symbols
    };
    /// Those that the paper varies, in the order of its tables.
    pub const PAPER: [Self; 4] = [Self::K2, Self::C2, Self::D, Self::C];
    /// Those that set the size of a harmonic forcing, which has one of them.
    pub const AMPLITUDES: [Self; Amplitude::ALL.len()] = {
        let mut all = [Self::P; Amplitude::ALL.len()];
        let mut i = 0;
        while i < all.len() {
            all[i] = Amplitude::ALL[i].parameter();
            i += 1;
        }
        all
    };

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
            Self::BaseAcceleration => {
                ("base_acceleration", "amplitude of the acceleration of the moving base", ACCELERATION)
            }
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
            Self::Lambda => ("lambda", "damping factor of the contact force", LOSS),
            Self::Restitution => ("restitution", "restitution of a contact at every speed", NONE),
            Self::Strength => {
                ("strength", "yield strength of the weakest of the colliding surfaces", MODULUS)
            }
            Self::Density => ("density", "density of the damper", DENSITY),
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

    /// The SI unit; empty for a dimensionless number.
    pub const fn unit(self) -> &'static str {
        self.units()[0].0
    }

    /// Symbol, words and unit: its description in schemas.
    pub fn sentence(self) -> String {
        let unit = self.unit();
        format!("{}, {}{}{unit}.", self.symbol(), self.words(), if unit.is_empty() { "" } else { ", " })
    }

    /// Whether it is the angular frequency of the forcing.
    pub const fn is_frequency(self) -> bool {
        matches!(self, Self::Omega)
    }

    /// Whether it is the distance to a wall.
    pub const fn is_gap(self) -> bool {
        matches!(self, Self::D | Self::C)
    }

    /// Whether it belongs to the law of the walls.
    pub const fn is_of_contact(self) -> bool {
        self as usize >= Self::Q as usize || matches!(self, Self::R)
    }

    /// Whether it belongs to the damper, its gaps and its surfaces included.
    pub const fn is_of_damper(self) -> bool {
        matches!(self, Self::K2 | Self::C2 | Self::M2) || self.is_gap() || self.is_of_contact()
    }

    /// The parameter with this symbol, of those that a search may vary.
    pub fn varied(symbol: &str) -> Option<Self> {
        Self::VARIED.into_iter().find(|parameter| parameter.symbol() == symbol)
    }

    /// The symbols of the parameters with [`Self::has_derivative`], with `separator` between them.
    pub fn differentiable(separator: &str) -> String {
        let all = Self::ALL.into_iter().filter(|parameter| parameter.has_derivative());
        all.map(Self::symbol).collect::<Vec<_>>().join(separator)
    }

    /// Whether motions can be differentiated with respect to it.
    pub const fn has_derivative(self) -> bool {
        !matches!(self, Self::M1)
            && (!self.is_of_contact() || matches!(self, Self::R | Self::Lambda | Self::Restitution))
    }

    /// The parameter columns of a table of designs: the paper's, then the others of `varied`.
    pub fn columns(varied: &[Self]) -> Vec<Self> {
        let others = varied.iter().copied().filter(|parameter| !Self::PAPER.contains(parameter));
        Self::PAPER.into_iter().chain(others).collect()
    }

    /// A value as it was typed, in the SI unit: without a unit, or with one of [`Self::units`].
    ///
    /// # Errors
    /// `text` is no such number; the message says what to give.
    pub fn read(self, text: &str) -> Result<f64, String> {
        unit::read(text, self.units())
    }
}

impl Amplitude {
    /// Its parameter, one of [`Parameter::AMPLITUDES`].
    pub const fn parameter(self) -> Parameter {
        match self {
            Self::Force => Parameter::P,
            Self::Imbalance => Parameter::Imbalance,
            Self::Base => Parameter::Base,
            Self::BaseAcceleration => Parameter::BaseAcceleration,
        }
    }

    /// The transmissibility as a formula in symbols: force on the ground over force on the structure, or displacement of the structure
    /// over that of the base.
    pub fn transmissibility(self) -> String {
        let symbol = self.parameter().symbol();
        let omega = match self.power().abs() {
            0 => "",
            1 => " omega",
            _ => " omega²",
        };
        match (self.is_of_base(), omega) {
            (true, _) => format!("x1max{omega} / {symbol}"),
            (false, "") => format!("that force / {symbol}"),
            (false, _) => format!("that force / ({symbol}{omega})"),
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
