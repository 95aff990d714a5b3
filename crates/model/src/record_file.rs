//! How a record is written in a study: as the file to read, or as samples in SI units.

use crate::record::{BadSamples, Column, Record, RecordFile, Samples};
use crate::unit::named;
use crate::{Finite, NonNegative, Positive, Unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A record: a file, or samples in SI units.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a file, or samples { \"step\" or \"times\", \"values\" } in SI units")]
pub(crate) enum InFile {
    /// A file.
    File(String),
    /// Samples.
    Whole(Whole),
}

/// Samples in SI units, straight lines between them: `step` s apart from `start` on, or at `times`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Samples", extend("oneOf" = [{ "required": ["step"] }, { "required": ["times"] }]))]
pub(crate) struct Whole {
    /// file, where they come from; for readers alone, as are column, unit and scale.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    file: String,
    /// column, which of that file they were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    column: Option<Column>,
    /// unit, in which they stand there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    /// scale, by how much they were multiplied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<Finite>,
    /// start, the time of the first sample, s; 0 if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<NonNegative>,
    /// step, the time between two samples, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    step: Option<Positive>,
    /// times, those of the samples, s; in the place of `step` where they are not equidistant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    times: Option<Vec<f64>>,
    /// values, at least two, N or m/s².
    values: Vec<f64>,
}

/// Why samples are not a valid record.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Refused {
    #[error("`record`: give one of `step` and `times` beside `values`")]
    Times,
    #[error("`record`: {0} values for {1} times")]
    Count(usize, usize),
    #[error("`record`: {0}")]
    Samples(#[from] BadSamples),
}

impl From<&Record> for InFile {
    fn from(record: &Record) -> Self {
        match record.samples().filter(|_| record.is_whole()) {
            None => Self::File(record.source().file.clone()),
            Some(samples) => Self::Whole(Whole::new(record.source().clone(), samples)),
        }
    }
}

impl Whole {
    fn new(RecordFile { file, column, unit, scale }: RecordFile, samples: Samples) -> Self {
        let values = samples.values().collect();
        let (start, step, times) = match samples.even() {
            Some([start, step]) => (
                NonNegative::new(start).ok().filter(|start| start.get() > 0.0),
                Positive::new(step).ok(),
                None,
            ),
            None => (None, None, Some((0..samples.len()).map(|i| samples.time(i)).collect())),
        };
        let unit = unit.map(|unit| unit.0.to_owned());
        Self { file, column, unit, scale, start, step, times, values }
    }

    /// The record of these samples.
    pub(crate) fn record(self, units: &[Unit]) -> Result<Record, Refused> {
        let Self { file, column, unit, scale, start, step, times, values } = self;
        let samples = match (step, times) {
            (Some(step), None) => Samples::every(start.unwrap_or_default().get(), step.get(), values)?,
            (None, Some(times)) if start.is_none() => {
                if times.len() != values.len() {
                    return Err(Refused::Count(values.len(), times.len()));
                }
                Samples::at(times, values)?
            }
            _ => return Err(Refused::Times),
        };
        let unit = unit.and_then(|unit| named(&unit, units));
        Ok(Record::new(RecordFile { file, column, unit, scale }).with(samples))
    }
}
