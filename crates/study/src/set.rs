//! `--set NAME=VALUE`: one number of a study, changed on the command line.

use super::format::Study;
use super::rule::Rule;
use retune_model::{
    Absent, Design, Finite, NonNegative, OutOfRange, Parameter, Positive, Scene, Start, Unit, Unsettable,
    unit,
};
use std::str::FromStr;
use thiserror::Error;

/// A number of the scene or window of a study that may be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settable {
    /// A parameter of the scene.
    Scene(Parameter),
    /// t0, from when maxima are taken, s.
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
#[expect(missing_docs, reason = "its words say what each is and holds")]
pub enum SettingError {
    #[error("\"{text}\" is not of the form NAME=VALUE, for instance k1=30000")]
    Form { text: String },
    #[error("unknown parameter `{name}`{}", super::file::suggestion(name, &symbols()))]
    Name { name: String },
    #[error("{name}: {problem}")]
    Number { name: Settable, problem: String },
    #[error("{name}: {source}")]
    OutOfRange { name: Settable, source: OutOfRange },
    #[error("{name}: {source}")]
    Absent { name: Parameter, source: Absent },
    #[error("--from: \"{text}\" is no state: give x1,v1,x2,v2 (m, m/s), or x1,v1 alone")]
    Start { text: String },
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

    /// What is set.
    pub fn what(&self) -> Settable {
        self.what
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
    /// The study with `settings` applied in order, and checked like a file.
    ///
    /// # Errors
    /// The first setting that is refused, or the [`Rule`] that the changed study breaks.
    pub fn with(&self, settings: &[Setting]) -> Result<Self, SettingError> {
        let mut study = self.clone();
        settings.iter().try_for_each(|setting| study.set(setting))?;
        study.check()?;
        Ok(study)
    }

    /// The scene with `settings` applied in order. Bounds and other rules of the search are not checked.
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

    /// The number that a setting would change; `None` if the scene does not have it.
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

/// Parses a state at t = 0 from `x1,v1,x2,v2` (m, m/s), or from `x1,v1` with the damper's spring at rest.
pub fn start(text: &str) -> Result<Start, SettingError> {
    let refused = || SettingError::Start { text: text.to_owned() };
    let number = |text: &str| text.trim().parse().ok().and_then(|value| Finite::new(value).ok());
    let numbers: Option<Vec<Finite>> = text.split(',').map(number).collect();
    match numbers.ok_or_else(refused)?.as_slice() {
        [x1, v1] => Ok(Start { x1: *x1, v1: *v1, ..Start::default() }),
        [x1, v1, x2, v2] => Ok(Start { x1: *x1, v1: *v1, x2: Some(*x2), v2: *v2 }),
        _ => Err(refused()),
    }
}

impl Study {
    /// The study with runs that begin at a state (m, m/s), checked like a file except for its search, which begins at rest.
    ///
    /// # Errors
    /// The [`Rule`] that it breaks.
    pub fn beginning_at(mut self, start: Start) -> Result<Self, Rule> {
        self.scene.forcing.begin(start);
        Self { optimize: None, ..self.clone() }.check()?;
        Ok(self)
    }

    /// Refuses a scene whose forced motion does not begin at rest, for callers that compare with runs from rest.
    pub fn begins_at_rest(&self) -> Result<(), Rule> {
        match self.scene.forcing.start {
            None => Ok(()),
            Some(_) => Err(Rule::not_allowed(
                "scene.forcing.start",
                "a start beside a force",
                "none, for this compares with runs from rest; `simulate` and `sweep` begin anywhere",
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_start_is_two_or_four_numbers() {
        let state = start("0.1, -2e-1,0.3,4").expect("a start");
        assert_eq!([state.x1.get(), state.v1.get(), state.v2.get()], [0.1, -0.2, 4.0]);
        assert_eq!(state.x2.map(Finite::get), Some(0.3));
        assert_eq!(start("1,2").expect("a start").x2, None);
        for text in ["", "1", "1,2,3", "1,2,3,4,5", "a,b", "1,inf"] {
            let said = start(text).expect_err(text).to_string();
            assert!(said.contains("give x1,v1,x2,v2"), "{said}");
        }
    }
}
