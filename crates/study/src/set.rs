//! `--set NAME=VALUE`: one number of a study, changed on the command line.

use super::format::Study;
use super::rule::Rule;
use retune_model::{
    Absent, Design, NonNegative, OutOfRange, Parameter, Positive, Scene, Unit, Unsettable, unit,
};
use std::str::FromStr;
use thiserror::Error;

/// A number of a study that may be set: one of its scene or of its window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settable {
    /// A parameter of the scene.
    Scene(Parameter),
    /// t0, from where maxima are taken, s.
    From,
    /// T, the end of a run, s.
    To,
}

impl Settable {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        Parameter::ALL.into_iter().map(Self::Scene).chain([Self::From, Self::To])
    }

    /// Its symbol.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Scene(parameter) => parameter.symbol(),
            Self::From => "t0",
            Self::To => "T",
        }
    }

    /// Units in which it may be given, the SI unit first.
    pub const fn units(self) -> &'static [Unit] {
        match self {
            Self::Scene(parameter) => parameter.units(),
            Self::From | Self::To => unit::TIME,
        }
    }
}

impl From<Parameter> for Settable {
    fn from(parameter: Parameter) -> Self {
        Self::Scene(parameter)
    }
}

impl std::fmt::Display for Settable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.symbol())
    }
}

/// A parsed `NAME=VALUE`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    what: Settable,
    value: f64,
}

/// Why a setting is refused.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SettingError {
    /// There is no `=`.
    #[error("\"{text}\" is not of the form NAME=VALUE, for instance k1=30000")]
    Form {
        /// The text as given.
        text: String,
    },
    /// No such parameter.
    #[error("unknown parameter `{name}`{}", super::explain::suggestion(name, &symbols()))]
    Name {
        /// The name as given.
        name: String,
    },
    /// Not a number in a unit of the parameter.
    #[error("{name}: {problem}")]
    Number {
        /// The parameter.
        name: Settable,
        /// What it is, and what to give.
        problem: String,
    },
    /// A number out of the parameter's range.
    #[error("{name}: {source}")]
    OutOfRange {
        /// The parameter.
        name: Settable,
        /// Its value and the allowed values.
        source: OutOfRange,
    },
    /// A parameter that the scene does not have.
    #[error("{name}: {source}")]
    Absent {
        /// The parameter.
        name: Parameter,
        /// Why it does not have it.
        source: Absent,
    },
    /// What is typed is no state.
    #[error("--from: \"{text}\" is no state: give x1,v1,x2,v2 (m, m/s), or x1,v1 alone")]
    Start {
        /// As given.
        text: String,
    },
    /// The changed study breaks a rule.
    #[error(transparent)]
    Rule(#[from] Rule),
}

fn symbols() -> Vec<&'static str> {
    Settable::all().map(Settable::symbol).collect()
}

impl Setting {
    /// Sets a number, in its SI unit.
    pub fn new(what: impl Into<Settable>, value: f64) -> Self {
        Self { what: what.into(), value }
    }

    /// The new value, in the parameter's SI unit.
    pub fn value(&self) -> f64 {
        self.value
    }
}

impl FromStr for Settable {
    type Err = SettingError;

    fn from_str(name: &str) -> Result<Self, SettingError> {
        let unknown = || SettingError::Name { name: name.to_owned() };
        Self::all().find(|known| known.symbol() == name).ok_or_else(unknown)
    }
}

impl FromStr for Setting {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let (name, value) =
            text.split_once('=').ok_or_else(|| SettingError::Form { text: text.to_owned() })?;
        let what: Settable = name.trim().parse()?;
        let value = unit::read(value, what.units());
        let value = value.map_err(|problem| SettingError::Number { name: what, problem })?;
        Ok(Self { what, value })
    }
}

impl Study {
    /// The same study with `settings` applied, first to last, and checked like a file.
    ///
    /// # Errors
    /// The first setting that is refused, or the [`Rule`] that the changed study breaks.
    pub fn with(&self, settings: &[Setting]) -> Result<Self, SettingError> {
        let mut study = self.clone();
        settings.iter().try_for_each(|setting| study.set(setting))?;
        study.check()?;
        Ok(study)
    }

    /// The scene with `settings` applied, first to last. Bounds and other rules of the search are not checked.
    ///
    /// # Errors
    /// The first setting that is refused.
    pub fn scene_with(&self, settings: &[Setting]) -> Result<Scene, SettingError> {
        let mut study = self.clone();
        settings.iter().try_for_each(|setting| study.set(setting))?;
        Ok(study.scene)
    }

    /// The scene with another design of its damper; `None` if there is no damper.
    pub fn scene_at(&self, design: &Design) -> Option<Scene> {
        Some(Scene { damper: Some(design.on(self.scene.damper?)), ..self.scene })
    }

    /// The number that a setting would change; `None` of a parameter that the scene does not have.
    pub fn value_of(&self, what: impl Into<Settable>) -> Option<f64> {
        match what.into() {
            Settable::Scene(parameter) => parameter.of(&self.scene),
            Settable::From => Some(self.window.t0.get()),
            Settable::To => Some(self.window.end.get()),
        }
    }

    fn set(&mut self, &Setting { what, value }: &Setting) -> Result<(), SettingError> {
        let out_of_range = |source| SettingError::OutOfRange { name: what, source };
        match what {
            Settable::From => self.window.t0 = NonNegative::new(value).map_err(out_of_range)?,
            Settable::To => self.window.end = Positive::new(value).map_err(out_of_range)?,
            Settable::Scene(name) => match name.set(&mut self.scene, value) {
                Err(Unsettable::Absent(source)) => return Err(SettingError::Absent { name, source }),
                Err(Unsettable::OutOfRange(source)) => return Err(out_of_range(source)),
                Ok(()) => {}
            },
        }
        Ok(())
    }
}
