//! A force, or an acceleration of the base, that is given in time: a pulse, or a record that is linear between its samples.
//!
//! Over a [`Stretch`] of time each of them obeys `f'' = -ω² f`, a record with ω = 0. So its value and slope form a pair like that of a
//! harmonic force, and the exact flow, the bounds and the contacts under a harmonic force apply. The pair jumps at known times.

use crate::excitation::Stretch;
use crate::made::{Form, Made, Recipe, Spectrum};
use crate::record::{Record, RecordFile, Samples};
use crate::unit::{ACCELERATION, FORCE};
use crate::{Finite, Positive, Unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A force or a base acceleration given as a function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct History {
    /// What it acts on.
    pub of: Of,
    /// Its course.
    pub course: Course,
}

/// What a [`History`] is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Of {
    /// A force on the primary structure, N.
    #[serde(rename = "force")]
    Force,
    /// The acceleration a of the base, m/s²: in coordinates that move with the base it is the force -m1 a on the structure and -m2 a on
    /// the damper. Then x1, v1, x2, v2 and energies are relative to the base, and a1 is the acceleration of the structure that it feels,
    /// of its motion and that of its base together.
    #[serde(rename = "base acceleration")]
    BaseAcceleration,
}

/// The time course of a [`History`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// A pulse from t = 0 on; zero after it.
    Pulse(Pulse),
    /// Samples with straight lines between them; zero before the first and after the last.
    Record(Record),
    /// Samples of a formula or of a spectrum, joined like a record's.
    Made(Made),
}

/// A pulse that begins at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Its shape.
    pub shape: Shape,
    /// Its largest value, in `unit`.
    pub peak: Finite,
    /// The unit of the peak.
    pub unit: Unit,
    /// How long it lasts, s.
    pub duration: Positive,
}

/// The shape of a pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Shape {
    /// peak sin(π t / duration).
    #[serde(rename = "half sine")]
    HalfSine,
    /// The peak all the time.
    #[serde(rename = "rectangle")]
    Rectangle,
    /// peak (1 - cos(2π t / duration)) / 2. It becomes samples: see [`Made`].
    #[serde(rename = "versed sine")]
    VersedSine,
}

const NO_STRETCH: Stretch = Stretch { from: 0.0, to: f64::INFINITY, begin: [f64::NAN; 2] };

impl Of {
    /// The units in which it may be given, the SI unit first.
    pub const fn units(self) -> &'static [Unit] {
        match self {
            Self::Force => FORCE,
            Self::BaseAcceleration => ACCELERATION,
        }
    }
}

impl History {
    /// The history with the opposite sign.
    pub fn reversed(self) -> Option<Self> {
        let course = match self.course {
            Course::Pulse(pulse) => {
                let peak = Finite::new(-pulse.peak.get()).ok()?;
                Course::Pulse(Pulse { peak, ..pulse })
            }
            Course::Record(_) | Course::Made(_) => of_samples(self.course.samples()?.times(-1.0).ok()?),
        };
        Some(Self { course, ..self })
    }

    /// The history at half its sample rate: every second sample of a record, or a formula sampled anew. None for a pulse.
    pub fn coarser(self) -> Option<Self> {
        let course = match self.course {
            Course::Pulse(_) => return None,
            Course::Record(_) => of_samples(self.course.samples()?.every_second().ok()?),
            Course::Made(made) => Course::Made(made.denser(0.5).ok()?),
        };
        Some(Self { course, ..self })
    }

    /// Another draw of a random force, with `seeds` added to its seed; none for any other history.
    pub fn drawn_again(self, seeds: u64) -> Option<Self> {
        let Course::Made(made) = self.course else { return None };
        let Form::Spectrum(spectrum) = made.recipe().form.clone() else { return None };
        let form = Form::Spectrum(Spectrum { seed: spectrum.seed.wrapping_add(seeds), ..spectrum });
        let redrawn = Made::new(Recipe { form, ..made.recipe().clone() }).ok()?;
        Some(Self { course: Course::Made(redrawn), ..self })
    }
}

/// A record without a file.
fn of_samples(samples: Samples) -> Course {
    let nowhere = RecordFile { file: String::new(), column: None, unit: None, scale: None };
    Course::Record(Record::new(nowhere).with(samples))
}

impl Course {
    /// The two factors ω (rad/s) of `df/dt = -ω s` and `ds/dt = ω f`: equal for a half sine, whose pair rotates; 1 and 0 on a straight
    /// line, where `s` is constant, minus the slope.
    pub(crate) fn turning(&self) -> [f64; 2] {
        match self {
            Self::Pulse(Pulse { shape: Shape::HalfSine, duration, .. }) => [PI / duration.get(); 2],
            _ => [1.0, 0.0],
        }
    }

    /// Bounds on its value and on its slope wherever it has one.
    pub fn bounds(&self) -> [f64; 2] {
        match self {
            Self::Pulse(pulse) => {
                let peak = pulse.peak().abs();
                [peak, if pulse.shape == Shape::HalfSine { peak * PI / pulse.duration.get() } else { 0.0 }]
            }
            Self::Record(_) | Self::Made(_) => {
                self.samples().map_or([f64::NAN; 2], |samples| samples.bounds())
            }
        }
    }

    /// The field of a study that defines it.
    pub(crate) fn given_by(&self) -> &'static str {
        match self {
            Self::Pulse(_) => "pulse",
            Self::Record(_) => "record",
            Self::Made(made) => match made.recipe().form {
                Form::VersedSine(_) => "pulse",
                Form::Harmonics(_) => "harmonics",
                Form::Sweep(_) => "sweep",
                Form::Spectrum(_) => "spectrum",
            },
        }
    }

    /// The spectrum from which it is drawn, if it is a draw.
    pub fn spectrum(&self) -> Option<&'static Spectrum> {
        match self {
            Self::Made(made) => match &made.recipe().form {
                Form::Spectrum(spectrum) => Some(spectrum),
                _ => None,
            },
            _ => None,
        }
    }

    /// The samples, if it has any.
    pub fn samples(&self) -> Option<Samples> {
        match self {
            Self::Pulse(_) => None,
            Self::Record(record) => record.samples(),
            Self::Made(made) => Some(made.samples()),
        }
    }

    /// The stretch of time in which it is at `t` (s); at a jump the one that begins there.
    pub(crate) fn stretch(&self, t: f64) -> Stretch {
        match self {
            Self::Pulse(pulse) => pulse.stretch(t),
            // A record that was not read has no value.
            Self::Record(_) | Self::Made(_) => {
                self.samples().map_or(NO_STRETCH, |samples| samples.stretch(t))
            }
        }
    }

    /// Its value at `t` (s), N or m/s², from the pair of its stretch; at its end, the value just before.
    pub fn at(&self, t: f64) -> f64 {
        if t < 0.0 {
            return 0.0;
        }
        let within = if t == self.end() { t.next_down() } else { t };
        let (Stretch { from, begin: [f, s], .. }, [omega, returns]) = (self.stretch(within), self.turning());
        let turned = omega * (t - from);
        if returns == 0.0 { f - turned * s } else { f * turned.cos() - s * turned.sin() }
    }

    /// The time (s) until which a flight takes a step for each of its pieces. Pieces of a record are about as long as steps of the motion;
    /// those of a formula are as short as its error requires, a pace not worth keeping once it is over.
    pub fn paced_until(&self) -> f64 {
        if let Self::Made(_) = self { self.end() } else { f64::INFINITY }
    }

    /// When it is over, s.
    pub fn end(&self) -> f64 {
        match self {
            Self::Pulse(pulse) => pulse.duration.get(),
            Self::Record(_) | Self::Made(_) => self.samples().map_or(f64::NAN, |samples| samples.end()),
        }
    }
}

impl Pulse {
    /// Its largest value, N or m/s².
    pub fn peak(&self) -> f64 {
        self.peak.get() * self.unit.1
    }

    fn stretch(&self, t: f64) -> Stretch {
        let end = self.duration.get();
        if t >= end {
            return Stretch { from: end, to: f64::INFINITY, begin: [0.0; 2] };
        }
        let begin = match self.shape {
            Shape::HalfSine => [0.0, -self.peak()],
            Shape::Rectangle => [self.peak(), 0.0],
            // It has samples, and no pair of its own.
            Shape::VersedSine => return NO_STRETCH,
        };
        Stretch { from: 0.0, to: end, begin }
    }
}
