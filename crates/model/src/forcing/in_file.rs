//! How a forcing is written in a study.

use super::start::Start;
use crate::amplitude::Amplitude;
use crate::history::{Course, History, Of, Pulse, Shape};
use crate::made::{Form, Harmonic, Made, Recipe, Spectrum, Sweep, Unmade};
use crate::record::{Column, Record, RecordFile};
use crate::record_file;
use crate::unit::named;
use crate::{Finite, NonNegative, Positive, Unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What makes the primary structure move: one of `P`, `imbalance`, `base` and `base_acceleration` with its `omega`, from rest or from `start`; one of `pulse`,
/// `record`, `harmonics`, `sweep` and `spectrum`, each with `of`; or `start` alone.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Forcing", extend("oneOf" = [
    { "required": ["P", "omega"] }, { "required": ["imbalance", "omega"] }, { "required": ["base", "omega"] },
    { "required": ["base_acceleration", "omega"] },
    { "required": ["pulse", "of", "peak", "duration"], "properties": { "omega": false } },
    { "required": ["record", "of"], "properties": { "omega": false } },
    { "required": ["harmonics", "of", "duration"], "properties": { "omega": false } },
    { "required": ["sweep", "of", "duration"], "properties": { "omega": false } },
    { "required": ["spectrum", "of", "duration"], "properties": { "omega": false } },
    { "required": ["start"], "properties": { "omega": false } }
]))]
pub(super) struct InFile {
    /// P, amplitude of the force on the primary structure, N: P cos(omega t).
    #[serde(rename = "P", default, skip_serializing_if = "Option::is_none")]
    pub(super) force: Option<NonNegative>,
    /// imbalance, rotating imbalance, mass times its distance from the axis, kg·m: the force imbalance omega² cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) imbalance: Option<NonNegative>,
    /// base, amplitude of the moving base, m: base cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) base: Option<NonNegative>,
    /// base_acceleration, amplitude of the acceleration of the moving base, m/s²: the base moves by base_acceleration / omega² cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) base_acceleration: Option<NonNegative>,
    /// The state at t = 0, rest if left out; alone it is a free decay, without any force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<Start>,
    /// omega, angular frequency of the forcing, rad/s: of the force, of the rotation or of the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) omega: Option<NonNegative>,
    /// pulse, the shape of a pulse that begins at t = 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) pulse: Option<Shape>,
    /// record, a file with samples, straight lines between them: CSV with a header and the time in its first column, s, or PEER's AT2, whose
    /// unit is g; or samples in SI units. A path that is not absolute begins at the directory of the study. Before the first and after the last sample there is nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) record: Option<record_file::InFile>,
    /// harmonics, a sum of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) harmonics: Option<Vec<Harmonic>>,
    /// sweep, a harmonic whose frequency grows or falls at a constant rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) sweep: Option<Sweep>,
    /// spectrum, the density of a stationary random force, of which one draw is made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) spectrum: Option<Spectrum>,
    /// of, what a pulse, a record and what follows it give: a force on the structure, or an acceleration of the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) of: Option<Of>,
    /// peak, the largest value of a pulse, in its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) peak: Option<Finite>,
    /// duration, how long a pulse, a sum of harmonics, a sweep or a random force lasts, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) duration: Option<Positive>,
    /// step, the time between the samples of what becomes some, s; by default so short that the force of a sum of harmonics or a sweep is
    /// off by at most 1e-5 of the sum of its amplitudes, that of a versed sine by 1e-6 of its peak, and of a spectrum 0.2 / its largest omega.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) step: Option<Positive>,
    /// unit, that of a pulse's peak, of amplitudes or of a record's values: N if left out, or m/s² of an acceleration (of an AT2 file g).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) unit: Option<String>,
    /// scale, by how much the values of a record are multiplied; 1 if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) scale: Option<Finite>,
    /// column, that of a record's values in a CSV file, by its name in the header or its number from 1; the second if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) column: Option<Column>,
}

impl From<History> for InFile {
    fn from(History { of, course }: History) -> Self {
        let unit = |unit: Unit| (unit != of.units()[0]).then(|| unit.0.to_owned());
        let file = Self { of: Some(of), ..Self::default() };
        match course {
            Course::Pulse(Pulse { shape, peak, unit: given, duration }) => Self {
                pulse: Some(shape),
                peak: Some(peak),
                duration: Some(duration),
                unit: unit(given),
                ..file
            },
            Course::Made(made) => made_file(made.recipe(), unit(made.recipe().unit), file),
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

/// A recipe in the fields of a study.
fn made_file(recipe: &Recipe, unit: Option<String>, file: InFile) -> InFile {
    let file = InFile { unit, duration: Some(recipe.duration), step: recipe.step, ..file };
    match recipe.form.clone() {
        Form::VersedSine(peak) => InFile { pulse: Some(Shape::VersedSine), peak: Some(peak), ..file },
        Form::Harmonics(harmonics) => InFile { harmonics: Some(harmonics), ..file },
        Form::Sweep(sweep) => InFile { sweep: Some(sweep), ..file },
        Form::Spectrum(spectrum) => InFile { spectrum: Some(spectrum), ..file },
    }
}

/// Why the fields of a file do not describe a forcing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Refused {
    #[error(
        "give one of `P`, `imbalance`, `base`, `base_acceleration`, `pulse`, `record`, `harmonics`, `sweep` and `spectrum`, or `start` alone, not {0} of them"
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
    Made(#[from] Unmade),
    #[error(transparent)]
    Record(#[from] record_file::Refused),
    #[error("`unit`: \"{given}\" is not allowed here: give one of {allowed}")]
    Unit { given: String, allowed: String },
}

impl InFile {
    /// The field of an amplitude.
    pub(super) fn amplitude(&mut self, of: Amplitude) -> &mut Option<NonNegative> {
        match of {
            Amplitude::Force => &mut self.force,
            Amplitude::Imbalance => &mut self.imbalance,
            Amplitude::Base => &mut self.base,
            Amplitude::BaseAcceleration => &mut self.base_acceleration,
        }
    }

    /// The first given field of pulses and records that is not among `known`.
    pub(super) fn stray(&self, known: &[&str]) -> Option<&'static str> {
        let fields = [
            ("omega", self.omega.is_some()),
            ("of", self.of.is_some()),
            ("peak", self.peak.is_some()),
            ("duration", self.duration.is_some()),
            ("step", self.step.is_some()),
            ("unit", self.unit.is_some()),
            ("scale", self.scale.is_some()),
            ("column", self.column.is_some()),
        ];
        fields.into_iter().find(|(name, given)| *given && !known.contains(name)).map(|(name, _)| name)
    }

    /// The given unit, if any.
    fn unit(&self, of: Of) -> Result<Option<Unit>, Refused> {
        let Some(given) = &self.unit else { return Ok(None) };
        let refused = || {
            let all: Vec<&str> = of.units().iter().map(|(name, _)| *name).collect();
            Refused::Unit { given: given.clone(), allowed: all.join(", ") }
        };
        named(given, of.units()).map(Some).ok_or_else(refused)
    }

    /// The given fields that define a time history, of which one is allowed.
    pub(super) fn histories(&self) -> impl Iterator<Item = &'static str> {
        let fields = [
            ("pulse", self.pulse.is_some()),
            ("record", self.record.is_some()),
            ("harmonics", self.harmonics.is_some()),
            ("sweep", self.sweep.is_some()),
            ("spectrum", self.spectrum.is_some()),
        ];
        fields.into_iter().filter(|(_, given)| *given).map(|(name, _)| name)
    }

    /// The time history, if one is given.
    pub(super) fn history(&self) -> Result<Option<History>, Refused> {
        let Some(beside) = self.histories().next() else { return Ok(None) };
        let known: &[&str] = match (beside, self.pulse, &self.record) {
            ("pulse", Some(Shape::VersedSine), _) => &["of", "peak", "duration", "unit", "step"],
            ("pulse", ..) => &["of", "peak", "duration", "unit"],
            ("record", _, Some(record_file::InFile::Whole(_))) => &["of"],
            ("record", ..) => &["of", "unit", "scale", "column"],
            _ => &["of", "duration", "unit", "step"],
        };
        if let Some(field) = self.stray(known) {
            return Err(Refused::Beside { field, beside });
        }
        let without = |field, what| Refused::Without { field, beside, what };
        let of = self.of.ok_or(without("of", "`force` or `base acceleration`"))?;
        let unit = self.unit(of)?;
        if let Some(record) = &self.record {
            return Ok(Some(History { of, course: Course::Record(self.read(record, of, unit)?) }));
        }
        let duration = self.duration.ok_or(without("duration", "how long it lasts, s"))?;
        let unit = unit.unwrap_or(of.units()[0]);
        let recipe = |form| Made::new(Recipe { form, unit, duration, step: self.step }).map(Course::Made);
        let peak = || self.peak.ok_or(without("peak", "the largest value"));
        let course = match (self.pulse, &self.harmonics, &self.sweep, &self.spectrum) {
            (Some(Shape::VersedSine), ..) => recipe(Form::VersedSine(peak()?))?,
            (Some(shape), ..) => Course::Pulse(Pulse { shape, peak: peak()?, duration, unit }),
            (_, Some(harmonics), ..) => recipe(Form::Harmonics(harmonics.clone()))?,
            (_, _, Some(sweep), _) => recipe(Form::Sweep(*sweep))?,
            (.., Some(spectrum)) => recipe(Form::Spectrum(spectrum.clone()))?,
            _ => return Ok(None),
        };
        Ok(Some(History { of, course }))
    }

    /// A record with samples, or of a file still to be read.
    fn read(&self, record: &record_file::InFile, of: Of, unit: Option<Unit>) -> Result<Record, Refused> {
        match record {
            record_file::InFile::Whole(whole) => Ok(whole.clone().record(of.units())?),
            record_file::InFile::File(file) => Ok(Record::new(RecordFile {
                file: file.clone(),
                column: self.column.clone(),
                unit,
                scale: self.scale,
            })),
        }
    }
}
