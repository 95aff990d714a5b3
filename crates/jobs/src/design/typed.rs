//! Requirements as given on the command line, in a file or from Python. Each is a number in its SI unit, or a text with a unit.

use crate::Error;
use retune_model::{Unit, unit};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::path::Path;

/// A number in its SI unit, or a text with a unit.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "Value")]
pub struct Typed {
    /// As given.
    pub text: String,
    /// The file it comes from; none for the command line.
    pub(super) file: Option<String>,
}

impl From<String> for Typed {
    fn from(text: String) -> Self {
        Self { text, file: None }
    }
}

impl TryFrom<Value> for Typed {
    type Error = String;

    fn try_from(value: Value) -> Result<Self, String> {
        match value {
            Value::String(text) => Ok(text.into()),
            Value::Number(number) => Ok(number.to_string().into()),
            Value::Array(ends) if ends.len() == 2 => {
                let [from, to] = [&ends[0], &ends[1]].map(|end| Self::try_from(end.clone()));
                Ok(format!("{} .. {}", from?.text, to?.text).into())
            }
            other => Err(format!("{other} is neither a number nor a text with a unit, as \"20 kN/m\"")),
        }
    }
}

/// The requirements on a design as given; `requirements` checks them.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Specification {
    /// Mass of the structure.
    pub m1: Option<Typed>,
    /// Its stiffness; or `f1`.
    pub k1: Option<Typed>,
    /// Its natural frequency without damping; or `k1`.
    pub f1: Option<Typed>,
    /// Its damping; or `zeta`.
    pub c1: Option<Typed>,
    /// Its share of critical damping; or `c1`.
    pub zeta: Option<Typed>,
    /// Amplitude of a force on it.
    #[serde(alias = "P")]
    pub force: Option<Typed>,
    /// A rotating imbalance.
    pub imbalance: Option<Typed>,
    /// Amplitude of a moving base.
    pub base: Option<Typed>,
    /// Amplitude of the acceleration of a moving base.
    pub base_acceleration: Option<Typed>,
    /// A shock, `half-sine,20ms,5g`.
    pub shock: Option<Typed>,
    /// A file with a record, `quake.csv,unit=g`.
    pub record: Option<Typed>,
    /// Time from which on largest values count under a shock or a record; by default its beginning.
    pub after: Option<Typed>,
    /// The frequencies of the forcing; by default those within 10 % of the natural frequency.
    pub band: Option<Typed>,
    /// Mass of the damper, or its share of the structure's.
    pub mass: Option<Typed>,
    /// The quantity to minimise.
    pub goal: Option<Typed>,
    /// The largest allowed values of quantities, by name.
    pub limits: Map<String, Value>,
    /// Largest stroke: a limit.
    pub stroke: Option<Typed>,
    /// Largest k2: a limit.
    #[serde(alias = "k2-max")]
    pub k2_max: Option<Typed>,
    /// Limits as typed, `stroke=15mm`.
    #[serde(skip)]
    pub limit: Vec<Typed>,
    /// Share by which k1 may be off: the worst k1 within it counts.
    pub k1_error: Option<Typed>,
    /// The dampers that are compared: tmd, ssvi, both.
    pub damper: Option<Typed>,
    /// The walls of an SSVI NES, `R=20mm,E=5MPa`, `R=20mm,rubber`, with `e=0.7` for a restitution.
    pub wall: Option<Typed>,
    /// The file that all this comes from, if any.
    #[serde(skip)]
    pub file: Option<String>,
}

impl Specification {
    /// Reads a file of requirements.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let file = path.display().to_string();
        let specification: Self = serde_json::from_str(&retune_store::plain::text(path)?)
            .map_err(|error| Error::Requirement { place: file.clone(), problem: error.to_string() })?;
        Ok(specification.within(&file))
    }

    /// Marks all values as coming from a file, for messages.
    #[must_use]
    pub fn within(mut self, file: &str) -> Self {
        self.fields().into_iter().flatten().for_each(|typed| typed.file = Some(file.to_owned()));
        Self { file: Some(file.to_owned()), ..self }
    }

    /// Replaces values by those that `other` gives.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        // Alternatives replace one another.
        let any_given = |options: &[&Option<Typed>]| options.iter().any(|typed| typed.is_some());
        if any_given(&[&other.k1, &other.f1]) {
            (self.k1, self.f1) = (None, None);
        }
        if any_given(&[&other.c1, &other.zeta]) {
            (self.c1, self.zeta) = (None, None);
        }
        let harmonic = any_given(&[&other.force, &other.imbalance, &other.base, &other.base_acceleration]);
        let in_time = any_given(&[&other.shock, &other.record]);
        if harmonic || in_time {
            (self.force, self.imbalance, self.base, self.base_acceleration) = (None, None, None, None);
            (self.shock, self.record) = (None, None);
        }
        if harmonic {
            self.after = None;
        }
        if in_time {
            self.band = None;
        }
        let limits = std::mem::take(&mut self.limits);
        let limit = [std::mem::take(&mut self.limit), other.limit.clone()].concat();
        let mut given = other;
        let mut all = self;
        for (own, new) in all.fields().into_iter().zip(given.fields()) {
            if new.is_some() {
                *own = new.take();
            }
        }
        Self { limits, limit, ..all }
    }

    /// The fields that hold one value each.
    fn fields(&mut self) -> [&mut Option<Typed>; 20] {
        [
            &mut self.m1,
            &mut self.k1,
            &mut self.f1,
            &mut self.c1,
            &mut self.zeta,
            &mut self.force,
            &mut self.imbalance,
            &mut self.base,
            &mut self.base_acceleration,
            &mut self.shock,
            &mut self.record,
            &mut self.after,
            &mut self.band,
            &mut self.mass,
            &mut self.goal,
            &mut self.stroke,
            &mut self.k2_max,
            &mut self.k1_error,
            &mut self.damper,
            &mut self.wall,
        ]
    }

    /// The limits with their names: those of the file, then those of the command line, which replace them. Each source may limit a quantity
    /// only once.
    pub(super) fn all_limits(&self) -> Result<Vec<(String, Typed)>, Error> {
        let mut all = Vec::new();
        for (name, value) in &self.limits {
            let typed = Typed::try_from(value.clone());
            let file = self.file.clone();
            let nothing = Typed { file: file.clone(), ..Typed::default() };
            let typed = typed.map_err(|problem| nothing.refused(&format!("limits.{name}"), problem))?;
            all.push((name.clone(), Typed { file, ..typed }));
        }
        for typed in &self.limit {
            let Some((name, value)) = typed.text.split_once('=') else {
                let problem =
                    format!("\"{}\" is not of the form NAME=VALUE, for instance stroke=15mm", typed.text);
                return Err(typed.refused("limit", problem));
            };
            all.push((name.trim().to_owned(), Typed { text: value.trim().to_owned(), ..typed.clone() }));
        }
        for (name, typed) in [("stroke", &self.stroke), ("k2", &self.k2_max)] {
            all.extend(typed.clone().map(|typed| (name.to_owned(), typed)));
        }
        let plain = |name: &str| name.replace('-', "_");
        for (number, (name, typed)) in all.iter().enumerate() {
            let twice =
                |(other, before): &&(String, Typed)| plain(other) == plain(name) && before.file == typed.file;
            if let Some((_, before)) = all[..number].iter().find(twice) {
                let problem = format!(
                    "is limited twice, to {} and to {}: give one limit of it",
                    before.text, typed.text
                );
                return Err(typed.refused(&format!("limit {}", plain(name)), problem));
            }
        }
        all.sort_by_key(|(_, typed)| typed.file.is_none());
        Ok(all)
    }
}

impl Typed {
    /// The error for this value of a field.
    pub(super) fn refused(&self, field: &str, problem: impl Into<String>) -> Error {
        let place = match &self.file {
            Some(file) => format!("{file}: {}", field.replace("limit ", "limits.")),
            None => format!("--{}", field.replace('_', "-")),
        };
        Error::Requirement { place, problem: problem.into() }
    }

    /// The value in the SI unit.
    pub(super) fn number(&self, field: &str, units: &[Unit]) -> Result<f64, Error> {
        unit::read(&self.text, units).map_err(|problem| self.refused(field, problem))
    }
}
