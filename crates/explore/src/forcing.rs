//! The forcing over time: the curve under the motion.

use crate::thin::{Thin, Thinning};
use retune_model::{Amplitude, Course, Forcing, History, Of, Source};
use serde_json::{Value, json};

/// The name, description and unit of a forcing's curve; none for a free decay.
pub fn forced(forcing: &Forcing) -> Option<Value> {
    let (name, words, unit) = match forcing.source {
        Source::Harmonic(Amplitude::BaseAcceleration, _)
        | Source::History(History { of: Of::BaseAcceleration, .. }) => {
            ("a0", "acceleration of the base", "m/s²")
        }
        Source::Harmonic(of, _) if of.is_of_base() => ("y", "displacement of the base", "m"),
        Source::Harmonic(..) | Source::History(_) => ("f", "force on the structure", "N"),
        Source::Decay(_) => return None,
    };
    Some(json!({ "name": name, "words": words, "unit": unit }))
}

/// Points of a pulse, and points of a harmonic per pixel column.
const PULSE_POINTS: usize = 128;
const POINTS_PER_COLUMN: usize = 4;

/// The curve of a forcing over a span of time, s, thinned to pixel columns. Every sample of a record counts.
pub fn curve(forcing: &Forcing, [from, to]: [f64; 2], columns: usize) -> Thin<1> {
    let mut thinning = Thinning::new([from, to], columns);
    thinning.push(from, [forcing.at(from)]);
    let mut push = |t: f64, value: f64| {
        if from < t && t < to {
            thinning.push(t, [value]);
        }
    };
    let even = |count: usize, [from, to]: [f64; 2]| {
        (0..=count).map(move |i| from + i as f64 / count as f64 * (to - from))
    };
    match forcing.history().map(|history| &history.course) {
        None => even(POINTS_PER_COLUMN * columns, [from, to]).for_each(|t| push(t, forcing.at(t))),
        Some(course @ Course::Pulse(_)) => {
            let end = course.end();
            even(PULSE_POINTS, [0.0, end]).for_each(|t| push(t, course.at(t)));
            push(end, 0.0); // a pulse may end in a jump
        }
        Some(course) => {
            let Some(samples) = course.samples() else { return thinning.finish() };
            push(samples.time(0), 0.0);
            samples.values().enumerate().for_each(|(i, value)| push(samples.time(i), value));
            push(samples.end(), 0.0);
        }
    }
    thinning.push(to, [forcing.at(to)]);
    thinning.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forcing(text: Value) -> Forcing {
        serde_json::from_value(text).expect("a forcing")
    }

    /// With a hundred samples per pixel column the largest and the smallest are kept; a rectangle ends in a jump.
    #[test]
    fn invariant_every_peak_of_a_record_is_drawn() {
        let rows: String = (0..10_000)
            .map(|i| format!("{},{}\n", f64::from(i) / 1e3, if i == 5003 { 7.0 } else { 0.1 }))
            .collect();
        let mut record = forcing(json!({ "record": "a.csv", "of": "force" }));
        retune_study::read_record_text(&mut record, &format!("t,f\n{rows}")).expect("a record");
        let Thin { t, columns: [values] } = curve(&record, [0.0, 20.0], 200);
        assert!(t.len() < 1000 && t.is_sorted() && t.first() == Some(&0.0) && t.last() == Some(&20.0));
        assert_eq!(values.iter().copied().fold(0.0, f64::max), 7.0);
        let rectangle = forcing(json!({ "pulse": "rectangle", "of": "force", "peak": 3, "duration": 2 }));
        let Thin { t, columns: [values] } = curve(&rectangle, [0.0, 10.0], 50);
        let at_end: Vec<f64> =
            t.iter().zip(&values).filter(|(t, _)| **t == 2.0).map(|(_, value)| *value).collect();
        assert_eq!((at_end, values.last()), (vec![3.0, 0.0], Some(&0.0)));
    }

    #[test]
    fn exact_the_curve_of_a_pulse_of_a_record_and_of_a_harmonic() {
        let half =
            forcing(json!({ "pulse": "half sine", "of": "force", "peak": 2, "unit": "kN", "duration": 0.1 }));
        let found = [-0.01, 0.0, 0.025, 0.05, 0.11].map(|t| half.at(t));
        let expected = [0.0, 0.0, 2000.0 * 0.5_f64.sqrt(), 2000.0, 0.0];
        assert!(
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9),
            "{found:?}"
        );
        let mut record = forcing(json!({ "record": "a.csv", "of": "base acceleration", "unit": "g" }));
        retune_study::read_record_text(&mut record, "t,a\n1,0\n2,1\n4,-1\n").expect("a record");
        let found = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 4.5].map(|t| record.at(t) / 9.80665);
        assert_eq!(found, [0.0, 0.0, 0.5, 1.0, 0.0, -1.0, 0.0]);
        let imbalance = forcing(json!({ "imbalance": 0.5, "omega": 4 }));
        assert_eq!(imbalance.at(0.0), 8.0);
        assert_eq!(forced(&imbalance).map(|said| said["unit"].clone()), Some(json!("N")));
        assert_eq!(forced(&forcing(json!({ "start": { "x1": 1 } }))), None);
    }
}
