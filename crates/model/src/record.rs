//! A record: samples in time with straight lines between them.

mod spacing;

use crate::excitation::Stretch;
use crate::{Finite, Unit};
use serde::{Deserialize, Serialize};
pub use spacing::Spacing;
use std::sync::{Mutex, PoisonError};

/// A record that a study names, and its samples once they are read.
///
/// Scenes are copied freely. So the contents of a record are stored once, until the program ends, however often they are read and with
/// whatever factor.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    source: &'static RecordFile,
    samples: Option<Samples>,
    /// Whether a study is written with the samples instead of the file's name.
    whole: bool,
}

/// Where a record is read from, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFile {
    /// The file.
    pub file: String,
    /// The column of the values; the second if none is named.
    pub column: Option<Column>,
    /// The unit of the values; if none is given, that of the file or the SI unit.
    pub unit: Option<Unit>,
    /// The factor on the values; 1 if none is given.
    pub scale: Option<Finite>,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged, expecting = "give a column's name in the header, or its number from 1")]
pub enum Column {
    /// By its number, from 1.
    Number(usize),
    /// By its name in the header.
    Name(String),
}

/// Samples in SI units: each `every`th value of a table, times a factor. So a record that is scaled, reversed or resampled takes no memory
/// of its own.
#[derive(Clone, Copy, Debug)]
pub struct Samples {
    table: &'static Table,
    factor: f64,
    every: usize,
    bounds: [f64; 2],
}

/// The stored numbers that [`Samples`] refer to.
#[derive(Debug, PartialEq)]
struct Table {
    times: Times,
    values: Vec<f64>,
}

/// The times of samples, s.
#[derive(Debug, PartialEq)]
enum Times {
    /// Equidistant: the first, and the time between two.
    Every(f64, f64),
    At(Vec<f64>),
}

/// Why samples are not a valid record.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BadSamples {
    /// Fewer than two samples.
    #[error("it has {0} sample{s}: give at least two", s = if *.0 == 1 { "" } else { "s" })]
    Few(usize),
    /// A value or a time that is not finite.
    #[error("sample {0}: {1} is not allowed here: give a finite number")]
    NotFinite(usize, f64),
    /// A first time below zero.
    #[error("sample 1: the time {0} s is not allowed here: give 0 or more")]
    Before(f64),
    /// Times that do not increase.
    #[error("sample {0}: the time {1} s does not come after the time {2} s of the sample before it")]
    Unsorted(usize, f64, f64),
    /// Times too close for a finite slope.
    #[error(
        "sample {0}: it comes only {1:e} s after the sample before it, so that the slope between them is not finite: give times farther apart"
    )]
    Close(usize, f64),
}

static FILES: Mutex<Vec<&'static RecordFile>> = Mutex::new(Vec::new());
static TABLES: Mutex<Vec<&'static Table>> = Mutex::new(Vec::new());

/// Interns a value: returns the stored one that is equal to `new`.
pub(crate) fn kept<T: PartialEq>(all: &Mutex<Vec<&'static T>>, new: T) -> &'static T {
    let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(same) = all.iter().copied().find(|old| **old == new) {
        return same;
    }
    let new: &'static T = Box::leak(Box::new(new));
    all.push(new);
    new
}

impl Record {
    /// The record of a file that is still to be read.
    pub fn new(source: RecordFile) -> Self {
        let whole = source.file.is_empty();
        Self { source: kept(&FILES, source), samples: None, whole }
    }

    /// Adds the samples, in SI units.
    #[must_use]
    pub fn with(self, samples: Samples) -> Self {
        Self { samples: Some(samples), ..self }
    }

    /// Has it written with its samples, so that a study needs no other file.
    #[must_use]
    pub fn whole(self) -> Self {
        Self { whole: true, ..self }
    }

    /// Whether it is written with its samples.
    pub fn is_whole(&self) -> bool {
        self.whole
    }

    /// Where it is read from.
    pub fn source(&self) -> &'static RecordFile {
        self.source
    }

    /// Its samples; none before they are read.
    pub fn samples(&self) -> Option<Samples> {
        self.samples
    }
}

impl PartialEq for Record {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.source, other.source) && self.samples == other.samples
    }
}

impl PartialEq for Samples {
    fn eq(&self, other: &Self) -> bool {
        let view = |of: &Self| (of.factor, of.every);
        let same = std::ptr::eq(self.table, other.table) && view(self) == view(other);
        let equal = |i: usize| self.time(i) == other.time(i) && self.value(i) == other.value(i);
        same || (self.len() == other.len() && (0..self.len()).all(equal))
    }
}

impl Samples {
    /// Samples at these times, s.
    ///
    /// # Errors
    /// [`BadSamples`]: the first fault.
    pub fn at(times: Vec<f64>, values: Vec<f64>) -> Result<Self, BadSamples> {
        let count = times.len().min(values.len());
        debug_assert_eq!(times.len(), values.len(), "a value for each time");
        if count < 2 {
            return Err(BadSamples::Few(count));
        }
        if let Some(i) = times.iter().position(|t| !t.is_finite()) {
            return Err(BadSamples::NotFinite(i + 1, times[i]));
        }
        if times[0] < 0.0 {
            return Err(BadSamples::Before(times[0]));
        }
        if let Some(i) = (1..count).find(|&i| times[i] <= times[i - 1]) {
            return Err(BadSamples::Unsorted(i + 1, times[i], times[i - 1]));
        }
        let mut spacing = Spacing::default();
        let even = times.iter().all(|t| spacing.push(*t)).then(|| spacing.even()).flatten();
        Self::new(even.map_or(Times::At(times), |[first, step]| Times::Every(first, step)), values)
    }

    /// Samples from the time `start` (s) on, `step` (s) apart.
    ///
    /// # Errors
    /// [`BadSamples`]: the first fault.
    pub fn every(start: f64, step: f64, values: Vec<f64>) -> Result<Self, BadSamples> {
        if !(step.is_finite() && step > 0.0 && start + step > start) {
            return Err(BadSamples::Unsorted(2, start + step, start));
        }
        let end = start + (values.len() as f64 - 1.0) * step;
        if !end.is_finite() {
            return Err(BadSamples::NotFinite(values.len(), end));
        }
        Self::new(Times::Every(start, step), values)
    }

    fn new(times: Times, values: Vec<f64>) -> Result<Self, BadSamples> {
        if values.len() < 2 {
            return Err(BadSamples::Few(values.len()));
        }
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            return Err(BadSamples::NotFinite(i + 1, values[i]));
        }
        let table = kept(&TABLES, Table { times, values });
        Self { table, factor: 1.0, every: 1, bounds: [0.0; 2] }.checked()
    }

    /// Checks values and slopes, and sets their bounds.
    fn checked(mut self) -> Result<Self, BadSamples> {
        let count = self.len();
        if count < 2 {
            return Err(BadSamples::Few(count));
        }
        if let Some(i) = (0..count).find(|&i| !self.value(i).is_finite()) {
            return Err(BadSamples::NotFinite(i + 1, self.value(i)));
        }
        self.bounds = [self.values().fold(0.0, |most: f64, value| most.max(value.abs())), 0.0];
        for i in 1..count {
            let slope = self.slope(i - 1).abs();
            if !slope.is_finite() {
                return Err(BadSamples::Close(i + 1, self.time(i) - self.time(i - 1)));
            }
            self.bounds[1] = self.bounds[1].max(slope);
        }
        Ok(self)
    }

    /// The samples times a factor.
    ///
    /// # Errors
    /// [`BadSamples::NotFinite`].
    pub fn times(self, factor: f64) -> Result<Self, BadSamples> {
        Self { factor: factor * self.factor, ..self }.checked()
    }

    /// Every second sample, from the first on.
    ///
    /// # Errors
    /// [`BadSamples::Few`].
    pub fn every_second(self) -> Result<Self, BadSamples> {
        Self { every: 2 * self.every, ..self }.checked()
    }

    /// How many there are, at least two.
    pub fn len(&self) -> usize {
        self.table.values.len().div_ceil(self.every)
    }

    /// Never true: there are at least two.
    pub fn is_empty(&self) -> bool {
        self.table.values.is_empty()
    }

    /// The first time and the time between two, s, of equidistant samples.
    pub fn even(&self) -> Option<[f64; 2]> {
        let Times::Every(start, step) = self.table.times else { return None };
        Some([start, self.every as f64 * step])
    }

    /// The value of a sample, SI units.
    #[inline]
    pub fn value(&self, i: usize) -> f64 {
        self.factor * self.table.values[i * self.every]
    }

    /// All values.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let factor = self.factor;
        self.table.values.iter().step_by(self.every).map(move |value| factor * value)
    }

    /// The time of a sample, s.
    pub fn time(&self, i: usize) -> f64 {
        match &self.table.times {
            Times::Every(first, step) => first + i as f64 * (self.every as f64 * step),
            Times::At(times) => times[i * self.every],
        }
    }

    /// The time of the last sample, s.
    pub fn end(&self) -> f64 {
        self.time(self.len() - 1)
    }

    /// Bounds on the value, and on the slope between two samples.
    pub fn bounds(&self) -> [f64; 2] {
        self.bounds
    }

    /// The slope after a sample that is not the last.
    fn slope(&self, i: usize) -> f64 {
        (self.value(i + 1) - self.value(i)) / (self.time(i + 1) - self.time(i))
    }

    /// The last sample not after `t`; none before the first.
    fn last_before(&self, t: f64) -> Option<usize> {
        let found = match &self.table.times {
            Times::At(times) => times.partition_point(|time| *time <= t).div_ceil(self.every),
            Times::Every(first, step) => {
                let guess =
                    (((t - first) / (self.every as f64 * step)).max(0.0) as usize).min(self.len() - 1);
                // Rounding may be one off.
                let from = guess.saturating_sub(1);
                from + (from..self.len().min(guess + 2)).take_while(|&i| self.time(i) <= t).count()
            }
        };
        found.checked_sub(1)
    }

    /// The stretch of time at `t` (s); at a sample the one that begins there.
    pub(crate) fn stretch(&self, t: f64) -> Stretch {
        match self.last_before(t) {
            None => Stretch { from: 0.0, to: self.time(0), begin: [0.0; 2] },
            Some(i) if i + 1 == self.len() => {
                Stretch { from: self.end(), to: f64::INFINITY, begin: [0.0; 2] }
            }
            Some(i) => {
                Stretch { from: self.time(i), to: self.time(i + 1), begin: [self.value(i), -self.slope(i)] }
            }
        }
    }
}

/// The samples of a force.
#[derive(Clone, Copy, Debug)]
pub struct SampledForce {
    samples: Samples,
    /// The force of a value of 1, N.
    unit: f64,
}

impl SampledForce {
    /// The force of samples, each times `unit` (N).
    pub(crate) fn new(samples: Samples, unit: f64) -> Self {
        Self { samples, unit }
    }

    /// The first time and the time between two, s, of equidistant samples.
    pub fn even(&self) -> Option<[f64; 2]> {
        self.samples.even()
    }

    /// The sample at exactly this time, s.
    pub fn at(&self, t: f64) -> Option<usize> {
        self.samples.last_before(t).filter(|&i| self.samples.time(i) == t)
    }

    /// `K` times from a sample on, s, if there are as many.
    #[inline]
    pub fn times<const K: usize>(&self, from: usize) -> Option<[f64; K]> {
        (from + K <= self.samples.len()).then(|| std::array::from_fn(|i| self.samples.time(from + i)))
    }

    /// `K` forces from a sample on, N, if there are as many.
    pub fn forces<const K: usize>(&self, from: usize) -> Option<[f64; K]> {
        let Samples { table, factor, every, .. } = self.samples;
        let values = table.values.get(from * every..=(from + K - 1) * every)?;
        Some(std::array::from_fn(|i| self.unit * (factor * values[i * every])))
    }
}

#[cfg(test)]
mod tests;
