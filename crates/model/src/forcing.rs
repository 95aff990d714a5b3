//! What makes the structure move: a harmonic force, a rotating imbalance, a moving base, a start away from rest, or a pulse or a record.
//! `docs/theory.md` has the equations of each; the first three are a harmonic force on the structure.

use crate::history::{Course, History, Of, Pulse, Shape};
use crate::record::{Column, Record, RecordFile};
use crate::record_file;
use crate::unit::named;
use crate::{Finite, NonNegative, Positive, Unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What makes the primary structure move, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "InFile", into = "InFile")]
#[schemars(with = "InFile")]
pub struct Forcing {
    /// Its kind and size.
    pub source: Source,
    /// omega, its angular frequency, rad/s; 0 of a free decay, a pulse and a record.
    pub frequency: NonNegative,
    /// Where a motion under a force starts; at rest if there is none. A free decay has its own.
    pub start: Option<Start>,
}

/// The kinds of forcing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A force P cos ωt on the structure: P, N.
    Force(NonNegative),
    /// A rotating imbalance of the structure: m e, the mass (part of m1) times its distance from the axis, kg·m. It is the force
    /// m e ω² cos ωt.
    Imbalance(NonNegative),
    /// A base that moves by Y cos ωt: Y, m. On the structure it acts as the force k1 y + c1 dy/dt.
    Base(NonNegative),
    /// A base that moves by Y cos ωt with Y = a / ω², so that its acceleration has the amplitude a at every frequency: a, m/s².
    BaseAcceleration(NonNegative),
    /// Nothing but a start away from rest.
    Decay(Start),
    /// A force, or an acceleration of the base, that is given in time.
    History(History),
}

/// A state at t = 0, SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// x1, displacement of the structure, m.
    pub x1: Finite,
    /// v1, its velocity, m/s.
    pub v1: Finite,
    /// x2, position of the damper, m; x1 + D if left out, where its spring is at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x2: Option<Finite>,
    /// v2, its velocity, m/s.
    pub v2: Finite,
}

impl Source {
    /// Whether it has a frequency.
    pub const fn is_harmonic(&self) -> bool {
        !matches!(self, Self::Decay(_) | Self::History(_))
    }

    /// Whether it is a base that moves in space, with a frequency.
    pub const fn is_moving_base(&self) -> bool {
        matches!(self, Self::Base(_) | Self::BaseAcceleration(_))
    }

    /// What is given in time, if anything is.
    pub fn history(&self) -> Option<&History> {
        if let Self::History(history) = self { Some(history) } else { None }
    }
}

impl Start {
    /// The state `[x1, v1, x2, v2]` (m, m/s) of a damper that is at the distance `rest` (m) from the structure where its spring is at rest.
    pub fn state(&self, rest: f64) -> [f64; 4] {
        let Self { x1, v1, x2, v2 } = self;
        [x1.get(), v1.get(), x2.map_or(x1.get() + rest, Finite::get), v2.get()]
    }
}

impl Forcing {
    /// A force P cos ωt on the structure: P, N, and ω, rad/s.
    pub const fn force(amplitude: NonNegative, frequency: NonNegative) -> Self {
        Self { source: Source::Force(amplitude), frequency, start: None }
    }

    /// Whether it has no frequency: of a free decay, a pulse and a record. All there is of such a motion is in its run.
    pub fn is_transient(&self) -> bool {
        !self.source.is_harmonic()
    }

    /// What is given in time, if anything is.
    pub fn history(&self) -> Option<&History> {
        self.source.history()
    }

    /// The record that it names, if it does.
    pub fn record_mut(&mut self) -> Option<(Of, &mut Record)> {
        match &mut self.source {
            Source::History(History { of, course: Course::Record(record) }) => Some((*of, record)),
            _ => None,
        }
    }

    /// Where the motion starts; none at rest.
    pub fn start(&self) -> Option<Start> {
        match self.source {
            Source::Decay(start) => Some(start),
            _ => self.start,
        }
    }

    /// Begins elsewhere.
    pub fn begin(&mut self, at: Start) {
        match &mut self.source {
            Source::Decay(start) => *start = at,
            _ => self.start = Some(at),
        }
    }

    /// The transmissibility of a motion with these largest values (m, N): the force on the ground over the amplitude of the force on
    /// the structure; on a moving base the displacement of the structure over that of the base. NaN or infinite where nothing moves it.
    pub fn transmissibility(&self, displacement: f64, ground_force: f64) -> f64 {
        let omega = self.frequency.get();
        match self.source {
            Source::Force(force) => ground_force / force.get(),
            Source::Imbalance(imbalance) => ground_force / (imbalance.get() * omega * omega),
            Source::Base(base) => displacement / base.get(),
            Source::BaseAcceleration(base) => displacement * omega * omega / base.get(),
            Source::Decay(_) | Source::History(_) => f64::NAN,
        }
    }
}

/// What makes the primary structure move: one of `P`, `imbalance`, `base` and `base_acceleration` with its `omega`, from rest or from `start`; a `pulse` or a
/// `record`, each with `of`; or `start` alone.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Forcing", extend("oneOf" = [
    { "required": ["P", "omega"] }, { "required": ["imbalance", "omega"] }, { "required": ["base", "omega"] },
    { "required": ["base_acceleration", "omega"] },
    { "required": ["pulse", "of", "peak", "duration"], "properties": { "omega": false } },
    { "required": ["record", "of"], "properties": { "omega": false } },
    { "required": ["start"], "properties": { "omega": false } }
]))]
struct InFile {
    /// P, amplitude of the force on the primary structure, N: P cos(omega t).
    #[serde(rename = "P", default, skip_serializing_if = "Option::is_none")]
    force: Option<NonNegative>,
    /// imbalance, rotating imbalance, mass times its distance from the axis, kg·m: the force imbalance omega² cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    imbalance: Option<NonNegative>,
    /// base, amplitude of the moving base, m: base cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    base: Option<NonNegative>,
    /// base_acceleration, amplitude of the acceleration of the moving base, m/s²: the base moves by base_acceleration / omega² cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    base_acceleration: Option<NonNegative>,
    /// The state at t = 0, rest if left out; alone it is a free decay, without any force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<Start>,
    /// omega, angular frequency of the forcing, rad/s: of the force, of the rotation or of the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    omega: Option<NonNegative>,
    /// pulse, the shape of a pulse that begins at t = 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pulse: Option<Shape>,
    /// record, a file with samples, straight lines between them: CSV with a header and the time in its first column, s, or PEER's AT2, whose
    /// unit is g; or samples in SI units. A path that is not absolute begins at the directory of the study. Before the first and after the last sample there is nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    record: Option<record_file::InFile>,
    /// of, what a pulse or a record gives: a force on the structure, or an acceleration of the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    of: Option<Of>,
    /// peak, the largest value of a pulse, in its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    peak: Option<Finite>,
    /// duration, how long a pulse lasts, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    duration: Option<Positive>,
    /// unit, that of a pulse's peak or a record's values: N if left out, or m/s² of an acceleration (of an AT2 file g).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    /// scale, by how much the values of a record are multiplied; 1 if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<Finite>,
    /// column, that of a record's values in a CSV file, by its name in the header or its number from 1; the second if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    column: Option<Column>,
}

impl From<History> for InFile {
    fn from(History { of, course }: History) -> Self {
        let unit = |unit: Unit| (unit != of.units()[0]).then(|| unit.0.to_owned());
        let file = Self { of: Some(of), ..Self::default() };
        match course {
            Course::Pulse(Pulse { shape, peak, unit: own, duration }) => Self {
                pulse: Some(shape),
                peak: Some(peak),
                duration: Some(duration),
                unit: unit(own),
                ..file
            },
            Course::Record(record) => {
                let written = record_file::InFile::from(&record);
                if let record_file::InFile::Whole(_) = written {
                    return Self { record: Some(written), ..file };
                }
                let RecordFile { column, unit, scale, .. } = record.source().clone();
                let unit = unit.map(|unit| unit.0.to_owned());
                Self { record: Some(written), column, unit, scale, ..file }
            }
        }
    }
}

impl From<Forcing> for InFile {
    fn from(Forcing { source, frequency, start }: Forcing) -> Self {
        let none = Self { start, omega: Some(frequency), ..Self::default() };
        match source {
            Source::Force(amplitude) => Self { force: Some(amplitude), ..none },
            Source::Imbalance(amplitude) => Self { imbalance: Some(amplitude), ..none },
            Source::Base(amplitude) => Self { base: Some(amplitude), ..none },
            Source::BaseAcceleration(amplitude) => Self { base_acceleration: Some(amplitude), ..none },
            Source::Decay(start) => Self { start: Some(start), omega: None, ..none },
            Source::History(history) => Self { start, ..history.into() },
        }
    }
}

/// Why what a file says is no forcing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Refused {
    #[error(
        "give one of `P`, `imbalance`, `base`, `base_acceleration`, `pulse` and `record`, or `start` alone, not {0} of them"
    )]
    Count(usize),
    #[error("missing field `omega`: the angular frequency, rad/s")]
    NoFrequency,
    #[error("`omega` has no meaning beside `start`: a free decay has no force")]
    FreeFrequency,
    #[error("`{field}` has no meaning beside `{beside}`")]
    Beside { field: &'static str, beside: &'static str },
    #[error("missing field `{field}` beside `{beside}`: {what}")]
    Without { field: &'static str, beside: &'static str, what: &'static str },
    #[error(transparent)]
    Record(#[from] record_file::Refused),
    #[error("`unit`: \"{given}\" is not allowed here: give one of {allowed}")]
    Unit { given: String, allowed: String },
}

impl InFile {
    /// The first of the fields of pulses and records that is given and not among `known`.
    fn stray(&self, known: &[&str]) -> Option<&'static str> {
        let fields = [
            ("omega", self.omega.is_some()),
            ("of", self.of.is_some()),
            ("peak", self.peak.is_some()),
            ("duration", self.duration.is_some()),
            ("unit", self.unit.is_some()),
            ("scale", self.scale.is_some()),
            ("column", self.column.is_some()),
        ];
        fields.into_iter().find(|(name, given)| *given && !known.contains(name)).map(|(name, _)| name)
    }

    /// The unit that is given, if one is.
    fn unit(&self, of: Of) -> Result<Option<Unit>, Refused> {
        let Some(given) = &self.unit else { return Ok(None) };
        let refused = || {
            let all: Vec<&str> = of.units().iter().map(|(name, _)| *name).collect();
            Refused::Unit { given: given.clone(), allowed: all.join(", ") }
        };
        named(given, of.units()).map(Some).ok_or_else(refused)
    }

    /// What is given in time, if it is.
    fn history(&self) -> Result<Option<History>, Refused> {
        let beside = match (self.pulse, &self.record) {
            (None, None) => return Ok(None),
            (Some(_), _) => "pulse",
            (None, Some(_)) => "record",
        };
        let without = |field, what| Refused::Without { field, beside, what };
        let known: &[&str] = match (beside, &self.record) {
            ("pulse", _) => &["of", "peak", "duration", "unit"],
            (_, Some(record_file::InFile::Whole(_))) => &["of"],
            _ => &["of", "unit", "scale", "column"],
        };
        if let Some(field) = self.stray(known) {
            return Err(Refused::Beside { field, beside });
        }
        let of = self.of.ok_or(without("of", "`force` or `base acceleration`"))?;
        let unit = self.unit(of)?;
        let course = match (self.pulse, &self.record) {
            (Some(shape), _) => Course::Pulse(Pulse {
                shape,
                peak: self.peak.ok_or(without("peak", "the largest value"))?,
                duration: self.duration.ok_or(without("duration", "how long it lasts, s"))?,
                unit: unit.unwrap_or(of.units()[0]),
            }),
            (None, Some(record_file::InFile::Whole(whole))) => {
                Course::Record(whole.clone().record(of.units())?)
            }
            (None, Some(record_file::InFile::File(file))) => Course::Record(Record::new(RecordFile {
                file: file.clone(),
                column: self.column.clone(),
                unit,
                scale: self.scale,
            })),
            (None, None) => return Ok(None),
        };
        Ok(Some(History { of, course }))
    }
}

impl TryFrom<InFile> for Forcing {
    type Error = Refused;

    fn try_from(file: InFile) -> Result<Self, Refused> {
        let history = file.history()?;
        let stray = file.stray(&["omega"]).filter(|_| history.is_none());
        let InFile { force, imbalance, base, base_acceleration, start, omega, pulse, record, .. } = file;
        let sources = [
            force.map(Source::Force),
            imbalance.map(Source::Imbalance),
            base.map(Source::Base),
            base_acceleration.map(Source::BaseAcceleration),
            history.map(Source::History),
            // A pulse and a record are two.
            history.filter(|_| pulse.is_some() && record.is_some()).map(Source::History),
        ];
        let given: Vec<Source> = sources.into_iter().flatten().collect();
        if let (Some(field), [source]) = (stray, given.as_slice()) {
            let beside = match source {
                Source::Force(_) => "P",
                Source::Imbalance(_) => "imbalance",
                Source::BaseAcceleration(_) => "base_acceleration",
                _ => "base",
            };
            return Err(Refused::Beside { field, beside });
        }
        if let (Some(field), []) = (stray, given.as_slice()) {
            return Err(Refused::Beside { field, beside: "start" });
        }
        match (given.as_slice(), start, omega) {
            ([], Some(_), Some(_)) => Err(Refused::FreeFrequency),
            ([], Some(start), None) => {
                Ok(Self { source: Source::Decay(start), frequency: NonNegative::default(), start: None })
            }
            ([source @ Source::History(_)], start, None) => {
                Ok(Self { source: *source, frequency: NonNegative::default(), start })
            }
            ([source], start, Some(frequency)) => Ok(Self { source: *source, frequency, start }),
            ([_], _, None) => Err(Refused::NoFrequency),
            (others, ..) => Err(Refused::Count(others.len())),
        }
    }
}

#[cfg(test)]
mod tests;
