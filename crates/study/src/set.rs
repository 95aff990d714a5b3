//! `--set NAME=VALUE`: one number of a study, changed on the command line.

use super::angular_frequency::angular_frequency;
use super::format::Study;
use super::rule::Rule;
use retune_model::{Damper, Design, NonNegative, OutOfRange, Positive, Scene, Source};
use std::str::FromStr;
use thiserror::Error;

/// The numbers of a study that may be set, by their symbols, each with its SI unit: those of the scene, then the window's.
pub const PARAMETERS: [(&str, &str); 15] = [
    ("m1", "kg"),
    ("c1", "N·s/m"),
    ("k1", "N/m"),
    ("m2", "kg"),
    ("k2", "N/m"),
    ("c2", "N·s/m"),
    ("D", "m"),
    ("C", "m"),
    ("P", "N"),
    ("imbalance", "kg·m"),
    ("base", "m"),
    ("omega", "rad/s"),
    ("R", "m"),
    ("T", "s"),
    ("t0", "s"),
];

/// A parsed `NAME=VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    name: &'static str,
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
    #[error("unknown parameter `{name}`{}", super::explain::suggestion(name, &PARAMETERS.map(|(name, _)| name)))]
    Name {
        /// The name as given.
        name: String,
    },
    /// Not a number.
    #[error("{name}: \"{text}\" is not a number")]
    Number {
        /// The parameter.
        name: &'static str,
        /// The text as given.
        text: String,
    },
    /// Not a frequency.
    #[error("{name}: {problem}")]
    Frequency {
        /// The parameter.
        name: &'static str,
        /// What it is, and what to give.
        problem: String,
    },
    /// A number out of the parameter's range.
    #[error("{name}: {source}")]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// Its value and the allowed values.
        source: OutOfRange,
    },
    /// A parameter that the forcing of the scene does not have.
    #[error("{name}: the forcing of the scene is given by `{has}`")]
    Forcing {
        /// The parameter.
        name: &'static str,
        /// What the forcing is given by.
        has: &'static str,
    },
    /// What is typed is no state.
    #[error("--from: \"{text}\" is no state: give x1,v1,x2,v2 (m, m/s), or x1,v1 alone")]
    Start {
        /// As given.
        text: String,
    },
    /// A parameter of the damper in a scene without one.
    #[error("{name}: the scene has no damper")]
    NoDamper {
        /// The parameter.
        name: &'static str,
    },
    /// A gap or a contact of a damper without walls.
    #[error("{name}: the damper has no walls")]
    NoWalls {
        /// The parameter.
        name: &'static str,
    },
    /// The changed study breaks a rule.
    #[error(transparent)]
    Rule(#[from] Rule),
}

impl Setting {
    /// Sets the parameter `name`, one of those of the command line.
    pub fn new(name: &'static str, value: f64) -> Self {
        Self { name, value }
    }

    /// The new value, in the parameter's SI unit.
    pub fn value(&self) -> f64 {
        self.value
    }
}

impl FromStr for Setting {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let (name, value) =
            text.split_once('=').ok_or_else(|| SettingError::Form { text: text.to_owned() })?;
        let name = known(name.trim())?;
        let value = number(name, value.trim())?;
        Ok(Self { name, value })
    }
}

/// The value of a parameter as it was typed: in its SI unit; a frequency may have a unit of its own.
fn number(name: &'static str, text: &str) -> Result<f64, SettingError> {
    if name == "omega" {
        return angular_frequency(text).map_err(|problem| SettingError::Frequency { name, problem });
    }
    text.parse().map_err(|_| SettingError::Number { name, text: text.to_owned() })
}

fn known(name: &str) -> Result<&'static str, SettingError> {
    let unknown = || SettingError::Name { name: name.to_owned() };
    PARAMETERS.into_iter().map(|(known, _)| known).find(|known| *known == name).ok_or_else(unknown)
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

    /// The number that a setting of this name would change; `None` for a damper's parameter in a scene without one.
    pub fn value_of(&self, name: &str) -> Option<f64> {
        let (primary, forcing) = (&self.scene.primary, &self.scene.forcing);
        let damper = self.scene.damper.as_ref();
        let value = match name {
            "m1" => primary.mass.get(),
            "c1" => primary.damping.get(),
            "k1" => primary.stiffness.get(),
            "P" | "imbalance" | "base" => forcing.amplitude().filter(|(own, _)| *own == name)?.1.get(),
            "omega" => forcing.frequency.get(),
            "t0" => self.window.t0.get(),
            "T" => self.window.end.get(),
            "m2" => damper?.mass.get(),
            "k2" => damper?.stiffness.get(),
            "c2" => damper?.damping.get(),
            "D" => damper.filter(walled)?.rest_distance.get(),
            "C" => damper.filter(walled)?.clearance.get(),
            "R" => damper?.contact?.radius.get(),
            _ => return None,
        };
        Some(value)
    }

    fn set(&mut self, &Setting { name, value }: &Setting) -> Result<(), SettingError> {
        let out_of_range = |source| SettingError::OutOfRange { name, source };
        let positive = || Positive::new(value).map_err(out_of_range);
        let not_negative = || NonNegative::new(value).map_err(out_of_range);
        let (primary, forcing) = (&mut self.scene.primary, &mut self.scene.forcing);
        match name {
            "m1" => primary.mass = positive()?,
            "c1" => primary.damping = not_negative()?,
            "k1" => primary.stiffness = not_negative()?,
            "P" | "imbalance" | "base" => match forcing.amplitude() {
                Some((own, _)) if own == name => *forcing = forcing.with_amplitude(not_negative()?),
                own => return Err(SettingError::Forcing { name, has: own.map_or("start", |own| own.0) }),
            },
            "omega" if matches!(forcing.source, Source::Decay(_)) => {
                return Err(SettingError::Forcing { name, has: "start" });
            }
            "omega" => forcing.frequency = not_negative()?,
            "t0" => self.window.t0 = not_negative()?,
            "T" => self.window.end = positive()?,
            _ => {
                let damper = self.scene.damper.as_mut().ok_or(SettingError::NoDamper { name })?;
                set_damper(damper, name, positive, not_negative)?;
            }
        }
        Ok(())
    }
}

fn walled(damper: &&Damper) -> bool {
    damper.contact.is_some()
}

fn set_damper(
    damper: &mut Damper,
    name: &'static str,
    positive: impl Fn() -> Result<Positive, SettingError>,
    not_negative: impl Fn() -> Result<NonNegative, SettingError>,
) -> Result<(), SettingError> {
    match name {
        "m2" => damper.mass = positive()?,
        "k2" => damper.stiffness = not_negative()?,
        "c2" => damper.damping = not_negative()?,
        _ => {
            let contact = damper.contact.as_mut().ok_or(SettingError::NoWalls { name })?;
            match name {
                "D" => damper.rest_distance = not_negative()?,
                "C" => damper.clearance = not_negative()?,
                _ => contact.radius = positive()?, // R, the last of `PARAMETERS` of a damper
            }
        }
    }
    Ok(())
}
