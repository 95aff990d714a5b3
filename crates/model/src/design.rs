//! A design: the parameters of the damper that may be tuned, in the order of the paper's tables.

use crate::{Damper, NonNegative, OutOfRange, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter of the damper that a search may vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub enum Variable {
    /// k2, stiffness of the damper's spring, N/m.
    #[serde(rename = "k2")]
    K2,
    /// c2, damping between damper and primary structure, N·s/m.
    #[serde(rename = "c2")]
    C2,
    /// D, distance between the damper at rest and the primary structure, m.
    D,
    /// C, clearance between the damper at rest and the obstacle, m.
    C,
    /// m2, mass of the damper, kg.
    #[serde(rename = "m2")]
    M2,
}

impl Variable {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::K2, Self::C2, Self::D, Self::C, Self::M2];
    /// Those that the paper varies, in the order of its tables.
    pub const PAPER: [Self; 4] = [Self::K2, Self::C2, Self::D, Self::C];

    /// The columns of a table of designs in which these are varied: the paper's, and what else is varied.
    pub fn columns(varied: &[Self]) -> Vec<Self> {
        let others = varied.iter().copied().filter(|variable| !Self::PAPER.contains(variable));
        Self::PAPER.into_iter().chain(others).collect()
    }

    /// The paper's symbol.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::K2 => "k2",
            Self::C2 => "c2",
            Self::D => "D",
            Self::C => "C",
            Self::M2 => "m2",
        }
    }

    /// The SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::K2 => "N/m",
            Self::C2 => "N·s/m",
            Self::D | Self::C => "m",
            Self::M2 => "kg",
        }
    }

    /// Its value in `damper`; NaN for a gap of one without walls.
    pub const fn get(self, damper: &Damper) -> f64 {
        match self {
            Self::K2 => damper.stiffness.get(),
            Self::C2 => damper.damping.get(),
            Self::D | Self::C if damper.contact.is_none() => f64::NAN,
            Self::D => damper.rest_distance.get(),
            Self::C => damper.clearance.get(),
            Self::M2 => damper.mass.get(),
        }
    }

    /// Gives it a value in `damper`.
    ///
    /// # Errors
    /// A value that no damper can have; `damper` is then unchanged.
    pub fn set(self, damper: &mut Damper, value: f64) -> Result<(), OutOfRange> {
        match self {
            Self::K2 => damper.stiffness = NonNegative::new(value)?,
            Self::C2 => damper.damping = NonNegative::new(value)?,
            Self::D => damper.rest_distance = NonNegative::new(value)?,
            Self::C => damper.clearance = NonNegative::new(value)?,
            Self::M2 => damper.mass = Positive::new(value)?,
        }
        Ok(())
    }
}

impl std::fmt::Display for Variable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.symbol())
    }
}

/// A damper's design.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// k2, stiffness of the damper's spring, N/m.
    pub k2: NonNegative,
    /// c2, damping between damper and primary structure, N·s/m.
    pub c2: NonNegative,
    /// D, distance between the damper at rest and the primary structure, m; of a damper with walls.
    #[serde(rename = "D", default, skip_serializing_if = "Option::is_none")]
    pub d: Option<NonNegative>,
    /// C, clearance between the damper at rest and the obstacle, m; of a damper with walls.
    #[serde(rename = "C", default, skip_serializing_if = "Option::is_none")]
    pub c: Option<NonNegative>,
    /// m2, mass of the damper, kg; that of the study's damper if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub m2: Option<Positive>,
}

impl Design {
    /// The design of a damper, whatever its mass.
    pub const fn of(damper: &Damper) -> Self {
        let Damper { stiffness, damping, rest_distance, clearance, contact, .. } = *damper;
        let (d, c) = match contact {
            Some(_) => (Some(rest_distance), Some(clearance)),
            None => (None, None),
        };
        Self { k2: stiffness, c2: damping, d, c, m2: None }
    }

    /// From a value for each variable, in SI units; NaN for D, C and m2 where they are left out.
    ///
    /// # Errors
    /// The first value that no damper can have, with its variable.
    pub fn new(value: impl Fn(Variable) -> f64) -> Result<Self, (Variable, OutOfRange)> {
        let given = |variable| Some(value(variable)).filter(|value| !value.is_nan());
        let checked = |variable| NonNegative::new(value(variable)).map_err(|refused| (variable, refused));
        let perhaps = |variable| given(variable).map(|_| checked(variable)).transpose();
        let mass = given(Variable::M2).map(Positive::new).transpose();
        Ok(Self {
            k2: checked(Variable::K2)?,
            c2: checked(Variable::C2)?,
            d: perhaps(Variable::D)?,
            c: perhaps(Variable::C)?,
            m2: mass.map_err(|refused| (Variable::M2, refused))?,
        })
    }

    /// The value of a variable; NaN where it is left out.
    pub fn get(&self, variable: Variable) -> f64 {
        match variable {
            Variable::K2 => self.k2.get(),
            Variable::C2 => self.c2.get(),
            Variable::D => self.d.map_or(f64::NAN, NonNegative::get),
            Variable::C => self.c.map_or(f64::NAN, NonNegative::get),
            Variable::M2 => self.m2.map_or(f64::NAN, Positive::get),
        }
    }

    /// All values but the mass, in the order of [`Variable::PAPER`]; NaN where they are left out.
    pub fn values(&self) -> [f64; 4] {
        Variable::PAPER.map(|variable| self.get(variable))
    }

    /// A damper with this design, all else as it is in `damper`.
    #[must_use]
    pub fn on(&self, damper: Damper) -> Damper {
        let mass = self.m2.unwrap_or(damper.mass);
        Damper {
            mass,
            stiffness: self.k2,
            damping: self.c2,
            rest_distance: self.d.unwrap_or(damper.rest_distance),
            clearance: self.c.unwrap_or(damper.clearance),
            ..damper
        }
    }
}
