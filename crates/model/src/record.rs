//! A record: samples in time with straight lines between them.

use crate::excitation::Stretch;
use crate::{Finite, Unit};
use serde::{Deserialize, Serialize};
use std::sync::{Mutex, PoisonError};

/// A record that a study names, and its samples once they are read.
///
/// Scenes are plain numbers that are copied freely. So what a record says is kept once, until the program ends, however often it is read.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    source: &'static RecordFile,
    samples: Option<&'static Samples>,
    /// Whether a study is written with the samples and not with the name of the file.
    whole: bool,
}

/// Where a record is read from, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFile {
    /// The file.
    pub file: String,
    /// The column of the values; the second if none is named.
    pub column: Option<Column>,
    /// The unit of the values, if one is given: that of the file, or the SI unit.
    pub unit: Option<Unit>,
    /// By how much they are multiplied, if it is given: 1.
    pub scale: Option<Finite>,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
pub enum Column {
    /// By its number, from 1.
    Number(usize),
    /// By its name in the header.
    Name(String),
}

/// Samples in SI units.
#[derive(Debug, PartialEq)]
pub struct Samples {
    times: Times,
    values: Vec<f64>,
    bounds: [f64; 2],
}

/// The times of samples, s.
#[derive(Debug, PartialEq)]
enum Times {
    /// Equidistant: the first, and the time between two.
    Every(f64, f64),
    At(Vec<f64>),
}

/// Why samples are no record.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BadSamples {
    /// Two samples are the least.
    #[error("it has {0} samples: give at least two")]
    Few(usize),
    /// A value that is none.
    #[error("sample {0}: {1} is not allowed here: give a finite number")]
    NotFinite(usize, f64),
    /// The run begins at t = 0.
    #[error("sample 1: the time {0} s is not allowed here: give 0 or more")]
    Before(f64),
    /// Times increase.
    #[error("sample {0}: the time {1} s does not come after the time {2} s of the sample before it")]
    Unsorted(usize, f64, f64),
}

/// By how much of their distance samples may be off equal distances and still count as equidistant: what rounding to decimals leaves.
const EVEN: f64 = 1e-9;

static FILES: Mutex<Vec<&'static RecordFile>> = Mutex::new(Vec::new());
static SAMPLES: Mutex<Vec<&'static Samples>> = Mutex::new(Vec::new());

/// The one that is kept and equal to `new`.
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

    /// The same with its samples, in SI units.
    #[must_use]
    pub fn with(self, samples: Samples) -> Self {
        Self { samples: Some(samples.keep()), ..self }
    }

    /// The same, to be written with its samples, so that a study needs no other file.
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
    pub fn samples(&self) -> Option<&'static Samples> {
        self.samples
    }
}

impl PartialEq for Record {
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &'static Samples, b: &'static Samples| std::ptr::eq(a, b);
        let samples = match (self.samples, other.samples) {
            (Some(a), Some(b)) => same(a, b),
            (None, None) => true,
            _ => false,
        };
        samples && std::ptr::eq(self.source, other.source)
    }
}

impl Samples {
    /// The same for as long as the program runs.
    pub(crate) fn keep(self) -> &'static Self {
        kept(&SAMPLES, self)
    }

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
        let (first, step) = (times[0], (times[count - 1] - times[0]) / (count - 1) as f64);
        let even =
            times.iter().enumerate().all(|(i, t)| (t - (first + i as f64 * step)).abs() <= EVEN * step);
        Self::new(if even { Times::Every(first, step) } else { Times::At(times) }, values)
    }

    /// Samples from the time `start` (s) on, `step` (s) apart.
    ///
    /// # Errors
    /// [`BadSamples`]: the first fault.
    pub fn every(start: f64, step: f64, values: Vec<f64>) -> Result<Self, BadSamples> {
        if !(step.is_finite() && step > 0.0 && start + step > start) {
            return Err(BadSamples::Unsorted(2, start + step, start));
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
        let mut samples = Self { times, values, bounds: [0.0; 2] };
        samples.bounds[0] = samples.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        samples.bounds[1] = (1..samples.len()).fold(0.0, |most: f64, i| most.max(samples.slope(i - 1).abs()));
        Ok(samples)
    }

    /// The same times a factor.
    ///
    /// # Errors
    /// [`BadSamples::NotFinite`].
    pub fn times(&self, factor: f64) -> Result<Self, BadSamples> {
        let times = match &self.times {
            Times::Every(first, step) => Times::Every(*first, *step),
            Times::At(times) => Times::At(times.clone()),
        };
        Self::new(times, self.values.iter().map(|value| factor * value).collect())
    }

    /// Every second of them, from the first on.
    ///
    /// # Errors
    /// [`BadSamples::Few`].
    pub fn every_second(&self) -> Result<Self, BadSamples> {
        let values = self.values.iter().copied().step_by(2).collect();
        let times = match &self.times {
            Times::Every(first, step) => Times::Every(*first, 2.0 * step),
            Times::At(times) => Times::At(times.iter().copied().step_by(2).collect()),
        };
        Self::new(times, values)
    }

    /// How many there are, at least two.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// There are never none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The first time and the time between two, s, of equidistant samples.
    pub fn even(&self) -> Option<[f64; 2]> {
        if let Times::Every(start, step) = self.times { Some([start, step]) } else { None }
    }

    /// The values, SI units.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The time of a sample, s.
    pub fn time(&self, i: usize) -> f64 {
        match &self.times {
            Times::Every(first, step) => first + i as f64 * step,
            Times::At(times) => times[i],
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
        (self.values[i + 1] - self.values[i]) / (self.time(i + 1) - self.time(i))
    }

    /// The last sample not after `t`; none before the first.
    fn last_before(&self, t: f64) -> Option<usize> {
        let found = match &self.times {
            Times::At(times) => times.partition_point(|time| *time <= t),
            Times::Every(first, step) => {
                let guess = (((t - first) / step).max(0.0) as usize).min(self.len() - 1);
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
                Stretch { from: self.time(i), to: self.time(i + 1), begin: [self.values[i], -self.slope(i)] }
            }
        }
    }
}

/// The equidistant samples of a force.
#[derive(Clone, Copy, Debug)]
pub struct EvenForce {
    /// The first time and the time between two, s.
    pub even: [f64; 2],
    values: &'static [f64],
    /// The force of a value of 1, N.
    unit: f64,
}

impl EvenForce {
    /// The force of some samples; none if they are not equidistant.
    pub(crate) fn new(samples: &'static Samples, unit: f64) -> Option<Self> {
        Some(Self { even: samples.even()?, values: samples.values(), unit })
    }

    /// The time of a sample, s.
    pub fn time(&self, i: usize) -> f64 {
        let [first, step] = self.even;
        first + i as f64 * step
    }

    /// The sample at exactly this time, s.
    pub fn at(&self, t: f64) -> Option<usize> {
        let [first, step] = self.even;
        let i = ((t - first) / step).round().max(0.0) as usize;
        (self.time(i) == t).then_some(i)
    }

    /// So many forces from a sample on, N, if there are as many.
    pub fn forces<const K: usize>(&self, from: usize) -> Option<[f64; K]> {
        let values = self.values.get(from..from + K)?;
        Some(std::array::from_fn(|i| self.unit * values[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_record_is_linear_between_its_samples_and_nothing_outside() {
        for times in [vec![0.5, 0.75, 1.0, 1.25], vec![0.5, 0.8, 1.0, 1.25]] {
            let samples = Samples::at(times.clone(), vec![1.0, -2.0, 4.0, 3.0]).expect("a record");
            let is_even = matches!(samples.times, Times::Every(..));
            assert_eq!(is_even, times[1] == 0.75);
            assert_eq!(samples.stretch(0.2), Stretch { from: 0.0, to: 0.5, begin: [0.0; 2] });
            assert_eq!(samples.stretch(1.25).begin, [0.0; 2]);
            assert_eq!(samples.stretch(1.25).to, f64::INFINITY);
            for (i, t) in times.iter().take(3).enumerate() {
                let slope = (samples.values[i + 1] - samples.values[i]) / (times[i + 1] - t);
                let expected = Stretch { from: *t, to: times[i + 1], begin: [samples.values[i], -slope] };
                assert_eq!(samples.stretch(*t), expected);
                assert_eq!(samples.stretch(0.5 * (t + times[i + 1])), expected);
            }
            assert_eq!(samples.bounds()[0], 4.0);
        }
    }

    /// The time of every sample finds that sample, whatever rounding does to the division by the distance.
    #[test]
    fn exact_the_time_of_a_sample_begins_its_stretch() {
        let count = 4001;
        let samples = Samples::every(0.0, 0.01, (0..count).map(f64::from).collect()).expect("a record");
        for i in 0..count as usize - 1 {
            let stretch = samples.stretch(samples.time(i));
            assert_eq!([stretch.from, stretch.to], [samples.time(i), samples.time(i + 1)]);
            assert_eq!(samples.stretch(stretch.to.next_down()).from, stretch.from);
        }
    }

    #[test]
    fn contract_what_is_no_record_says_why() {
        let refused = |times: &[f64], values: &[f64]| {
            Samples::at(times.to_vec(), values.to_vec()).expect_err("no record").to_string()
        };
        assert_eq!(refused(&[], &[]), "it has 0 samples: give at least two");
        assert_eq!(refused(&[0.0], &[1.0]), "it has 1 samples: give at least two");
        assert!(refused(&[0.0, 1.0], &[1.0, f64::NAN]).starts_with("sample 2: NaN is not allowed"));
        assert!(refused(&[0.0, f64::INFINITY], &[1.0, 1.0]).starts_with("sample 2: inf is not allowed"));
        assert!(refused(&[-1.0, 1.0], &[1.0, 1.0]).starts_with("sample 1: the time -1 s"));
        assert!(refused(&[0.0, 1.0, 1.0], &[1.0, 1.0, 1.0]).starts_with("sample 3: the time 1 s does not"));
        assert!(Samples::every(0.0, 0.0, vec![1.0, 1.0]).is_err());
        assert!(Samples::every(0.0, 0.1, vec![]).is_err());
    }

    #[test]
    fn contract_what_is_read_again_is_kept_once() {
        let file = |column| RecordFile {
            file: "a.csv".to_owned(),
            column,
            unit: None,
            scale: Finite::new(2.0).ok(),
        };
        let read =
            || Record::new(file(None)).with(Samples::every(0.0, 0.1, vec![1.0, 2.0]).expect("a record"));
        assert_eq!(read(), read());
        assert!(std::ptr::eq(read().samples().expect("read"), read().samples().expect("read")));
        assert_ne!(read(), Record::new(file(None)));
        assert_ne!(Record::new(file(Some(Column::Number(1)))), Record::new(file(None)));
    }
}
