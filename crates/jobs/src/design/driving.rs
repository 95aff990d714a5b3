//! What moves the structure of a design: a harmonic force or base over a band of frequencies, or a shock or a record.

use crate::Error;
use retune_model::{Amplitude, Course, Forcing, History, NonNegative, Source};
use retune_solver::Window;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// What moves the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Driving {
    /// A harmonic.
    Harmonic {
        /// What its amplitude is of, and its size in the SI unit.
        amplitude: (Amplitude, f64),
        /// Its angular frequencies, rad/s.
        band: [f64; 2],
    },
    /// A shock or a record.
    History {
        /// It.
        forcing: Forcing,
        /// From when on largest values count, s.
        after: f64,
    },
}

/// Periods of the structure for which a run goes on after a shock or a record, and after the time from which largest values count.
const FREE: f64 = 10.0;

impl Driving {
    /// What the amplitude of a harmonic is of; none of a history.
    pub fn amplitude(&self) -> Option<Amplitude> {
        match self {
            Self::Harmonic { amplitude: (of, _), .. } => Some(*of),
            Self::History { .. } => None,
        }
    }

    /// The angular frequencies of a harmonic, rad/s; none of a history.
    pub fn band(&self) -> Option<[f64; 2]> {
        match self {
            Self::Harmonic { band, .. } => Some(*band),
            Self::History { .. } => None,
        }
    }

    /// Whether the next one is as likely to have the other sign: a record.
    pub(super) fn has_either_sign(&self) -> bool {
        let Self::History { forcing, .. } = self else { return false };
        matches!(forcing.history(), Some(History { course: Course::Record(_), .. }))
    }

    /// The forcing; a harmonic has that frequency of its band which is nearest to `natural`, rad/s.
    pub(super) fn forcing(&self, natural: f64) -> Result<Forcing, Error> {
        let ((of, size), [from, to]) = match self {
            Self::Harmonic { amplitude, band } => (*amplitude, *band),
            Self::History { forcing, .. } => return Ok(*forcing),
        };
        let source = Source::Harmonic(of, NonNegative::new(size)?);
        Ok(Forcing { source, frequency: NonNegative::new(natural.clamp(from, to))?, start: None })
    }

    /// The run under a history, of a structure with this period (s); none of a harmonic.
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
