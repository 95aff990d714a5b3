//! The excitation of the structure of a design: a harmonic force or base motion over a band of frequencies, or a shock or a record.

use crate::Error;
use retune_model::{Amplitude, Course, Forcing, History, NonNegative, Source};
use retune_solver::Window;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// The excitation of the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Driving {
    /// A harmonic.
    Harmonic {
        /// The kind of its amplitude, and its size in the SI unit.
        amplitude: (Amplitude, f64),
        /// Its angular frequencies, rad/s.
        band: [f64; 2],
    },
    /// A shock or a record.
    History {
        /// The forcing.
        forcing: Forcing,
        /// Time from which on largest values count, s.
        after: f64,
    },
}

/// Length of a run in periods of the structure, after the end of a shock or record or after the time from which largest values count.
const FREE: f64 = 10.0;

impl Driving {
    /// The kind of amplitude of a harmonic; none for a history.
    pub fn amplitude(&self) -> Option<Amplitude> {
        match self {
            Self::Harmonic { amplitude: (of, _), .. } => Some(*of),
            Self::History { .. } => None,
        }
    }

    /// The angular frequencies of a harmonic, rad/s; none for a history.
    pub fn band(&self) -> Option<[f64; 2]> {
        match self {
            Self::Harmonic { band, .. } => Some(*band),
            Self::History { .. } => None,
        }
    }

    /// Whether the opposite sign is equally likely, as for a record.
    pub(super) fn has_either_sign(&self) -> bool {
        let Self::History { forcing, .. } = self else { return false };
        matches!(forcing.history(), Some(History { course: Course::Record(_), .. }))
    }

    /// The forcing; a harmonic has the frequency of its band nearest to `natural`, rad/s.
    pub(super) fn forcing(&self, natural: f64) -> Result<Forcing, Error> {
        let ((of, size), [from, to]) = match self {
            Self::Harmonic { amplitude, band } => (*amplitude, *band),
            Self::History { forcing, .. } => return Ok(*forcing),
        };
        let source = Source::Harmonic(of, NonNegative::new(size)?);
        Ok(Forcing { source, frequency: NonNegative::new(natural.clamp(from, to))?, start: None })
    }

    /// The window of a run under a history, for a structure of this period, s; none for a harmonic.
    pub(super) fn run(&self, period: f64) -> Option<Window> {
        let Self::History { forcing, after } = self else { return None };
        let end = forcing.history().map_or(0.0, |History { course, .. }| course.end());
        Some(Window { from: *after, to: end.max(*after) + FREE * period })
    }
}

impl Serialize for Driving {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(2))?;
        match self {
            Self::Harmonic { amplitude: (of, size), band } => {
                map.serialize_entry(of.parameter().symbol(), size)?;
                map.serialize_entry("band", band)?;
            }
            Self::History { forcing, after } => {
                map.serialize_entry("forcing", forcing)?;
                map.serialize_entry("after", after)?;
            }
        }
        map.end()
    }
}
