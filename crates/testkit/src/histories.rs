//! Pulses and records for tests, and scenes under them.

use crate::scenes::{Numbers, Spread};
use retune_model::{
    Course, Finite, Forcing, Form, History, Made, NonNegative, Of, Positive, Pulse, Recipe, Record,
    RecordFile, Samples, Scene, Shape, Source,
};

/// A pulse in SI units.
pub fn pulse(of: Of, shape: Shape, peak: f64, duration: f64) -> History {
    let pulse = Pulse {
        shape,
        peak: Finite::new(peak).expect("finite"),
        unit: of.units()[0],
        duration: Positive::new(duration).expect("above 0"),
    };
    History { of, course: Course::Pulse(pulse) }
}

/// A force generated from a form in SI units, with samples `denser` times as dense as by default.
pub fn made(of: Of, form: Form, duration: f64, denser: f64) -> History {
    let duration = Positive::new(duration).expect("above 0");
    let made = Made::new(Recipe { form, unit: of.units()[0], duration, step: None });
    History { of, course: Course::Made(made.and_then(|made| made.denser(denser)).expect("samples")) }
}

/// A record of these samples.
pub fn record(of: Of, samples: Samples) -> History {
    let file = RecordFile { file: "test.csv".to_owned(), column: None, unit: None, scale: None };
    History { of, course: Course::Record(Record::new(file).with(samples)) }
}

/// A record of noise up to `size`, with samples about `step` (s) apart, equidistant if `even`.
pub fn noise(of: Of, size: f64, (step, count, even): (f64, usize, bool), spread: &mut Spread) -> History {
    let values: Vec<f64> = (0..count).map(|_| size * spread.signed()).collect();
    let samples = if even {
        Samples::every(0.0, step, values)
    } else {
        let mut now = 0.0;
        let mut next = || {
            let next = now + step * (1.0 + 0.7 * spread.signed());
            std::mem::replace(&mut now, next)
        };
        Samples::at((0..count).map(|_| next()).collect(), values)
    };
    record(of, samples.expect("a record"))
}

impl Numbers {
    /// The scene under a history, from rest.
    pub fn under(&self, history: History) -> Scene {
        let forcing =
            Forcing { source: Source::History(history), frequency: NonNegative::default(), start: None };
        Scene { forcing, ..self.scene() }
    }
}
