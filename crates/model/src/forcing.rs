//! What makes the structure move: a harmonic force, a rotating imbalance, a moving base, a start away from rest, or a pulse or a record.
//! `docs/theory.md` has the equations of each; the first three are a harmonic force on the structure.

mod in_file;
mod start;

use crate::NonNegative;
use crate::amplitude::{Amplitude, by_power};
use crate::history::{Course, History, Of};
use crate::record::Record;
use in_file::{InFile, Refused};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
pub use start::Start;

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
    /// A harmonic: what its amplitude is of, and its size in the SI unit.
    Harmonic(Amplitude, NonNegative),
    /// Nothing but a start away from rest.
    Decay(Start),
    /// A force or an acceleration of the base, given as a function of time.
    History(History),
}

impl Source {
    /// Whether it has a frequency.
    pub const fn is_harmonic(&self) -> bool {
        matches!(self, Self::Harmonic(..))
    }

    /// Whether it is a base that moves in space, with a frequency.
    pub const fn is_moving_base(&self) -> bool {
        matches!(self, Self::Harmonic(of, _) if of.is_of_base())
    }

    /// The history, if the forcing is one.
    pub fn history(&self) -> Option<&History> {
        if let Self::History(history) = self { Some(history) } else { None }
    }
}

impl Forcing {
    /// A force P cos ωt on the structure: P, N, and ω, rad/s.
    pub const fn force(amplitude: NonNegative, frequency: NonNegative) -> Self {
        Self { source: Source::Harmonic(Amplitude::Force, amplitude), frequency, start: None }
    }

    /// Whether it has no frequency: a free decay, a pulse or a record. Such a motion has no steady response beyond its run.
    pub fn is_transient(&self) -> bool {
        !self.source.is_harmonic()
    }

    /// The history, if the forcing is one.
    pub fn history(&self) -> Option<&History> {
        self.source.history()
    }

    /// When it ends, s: at once for a free decay, never for a harmonic force.
    pub fn end(&self) -> f64 {
        match &self.source {
            Source::History(history) => history.course.end(),
            Source::Decay(_) => 0.0,
            Source::Harmonic(..) => f64::INFINITY,
        }
    }

    /// Its record, if it has one.
    pub fn record_mut(&mut self) -> Option<(Of, &mut Record)> {
        match &mut self.source {
            Source::History(History { of, course: Course::Record(record) }) => Some((*of, record)),
            _ => None,
        }
    }

    /// Where the motion starts; none if at rest.
    pub fn start(&self) -> Option<Start> {
        match self.source {
            Source::Decay(start) => Some(start),
            _ => self.start,
        }
    }

    /// Sets where the motion starts.
    pub fn begin(&mut self, at: Start) {
        match &mut self.source {
            Source::Decay(start) => *start = at,
            _ => self.start = Some(at),
        }
    }

    /// Value at `t` (s) of the quantity that the forcing gives: the force on the structure, N (also for an imbalance), the displacement of
    /// the base, m, or its acceleration, m/s²; 0 for a free decay.
    pub fn at(&self, t: f64) -> f64 {
        let omega = self.frequency.get();
        match &self.source {
            // A base of which the acceleration is given moves by Y cos ωt with Y = a / ω².
            Source::Harmonic(Amplitude::BaseAcceleration, size) => -size.get() * (omega * t).cos(),
            Source::Harmonic(of, size) => of.at(size.get(), omega) * (omega * t).cos(),
            Source::Decay(_) => 0.0,
            Source::History(history) => history.course.at(t),
        }
    }

    /// The transmissibility of a motion with these largest values (m, N): the force on the ground over the amplitude of the force on
    /// the structure; on a moving base the displacement of the structure over that of the base. NaN or infinite where nothing moves it.
    pub fn transmissibility(&self, displacement: f64, ground_force: f64) -> f64 {
        let Source::Harmonic(of, size) = self.source else { return f64::NAN };
        let response = if of.is_of_base() { displacement } else { ground_force };
        by_power(response, self.frequency.get(), -of.power()) / size.get()
    }
}

impl From<Forcing> for InFile {
    fn from(Forcing { source, frequency, start }: Forcing) -> Self {
        let none = Self { start, omega: Some(frequency), ..Self::default() };
        match source {
            Source::Harmonic(of, size) => {
                let mut file = none;
                *file.amplitude(of) = Some(size);
                file
            }
            Source::Decay(start) => Self { start: Some(start), omega: None, ..none },
            Source::History(history) => Self { start, ..history.into() },
        }
    }
}

impl TryFrom<InFile> for Forcing {
    type Error = Refused;

    fn try_from(mut file: InFile) -> Result<Self, Refused> {
        let history = file.history()?;
        let stray = file.stray(&["omega"]).filter(|_| history.is_none());
        let others = file.histories().skip(1).count();
        let harmonic = |of: Amplitude| file.amplitude(of).map(|size| Source::Harmonic(of, size));
        let harmonics: Vec<Source> = Amplitude::ALL.into_iter().filter_map(harmonic).collect();
        let given: Vec<Source> = harmonics.into_iter().chain(history.map(Source::History)).collect();
        let InFile { start, omega, .. } = file;
        if let (Some(field), [Source::Harmonic(of, _)]) = (stray, given.as_slice()) {
            return Err(Refused::Beside { field, beside: of.parameter().symbol() });
        }
        if let (Some(field), []) = (stray, given.as_slice()) {
            return Err(Refused::Beside { field, beside: "start" });
        }
        if others > 0 {
            return Err(Refused::Count(given.len() + others));
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
