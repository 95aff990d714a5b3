//! A shock or a record as it is typed: `half-sine,20ms,5g` and `quake.csv,unit=g,column=a`.

use super::typed::{Specification, Typed};
use crate::Error;
use retune_model::{Forcing, History, Of, unit};
use retune_study::read_record;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The fields that may follow the file of a record, and the default of `of`.
const FIELDS: [&str; 4] = ["of", "unit", "column", "scale"];
const OF: &str = "base acceleration";

/// The given shock or record, and the time from which on largest values count, s; none if neither is given.
pub(super) fn given(specification: &Specification) -> Result<Option<(Forcing, f64)>, Error> {
    let Specification { shock, record, after, band, .. } = specification;
    let (name, typed) = match (shock, record, after) {
        (Some(_), Some(typed), _) => {
            return Err(typed.refused("record", "shock is given too: leave one of them out"));
        }
        (Some(typed), None, _) => ("shock", typed),
        (None, Some(typed), _) => ("record", typed),
        (None, None, Some(typed)) => {
            let problem = "is for a shock or a record: give --shock or --record, or leave it out";
            return Err(typed.refused("after", problem));
        }
        (None, None, None) => return Ok(None),
    };
    let others = [
        ("force", &specification.force),
        ("imbalance", &specification.imbalance),
        ("base", &specification.base),
        ("base_acceleration", &specification.base_acceleration),
    ];
    if let Some((other, typed)) = others.into_iter().find_map(|(other, typed)| Some((other, typed.as_ref()?)))
    {
        return Err(typed.refused(other, format!("{name} is given too: leave one of them out")));
    }
    if let Some(band) = band {
        let problem = format!("{name} is given, which has no band of frequencies: leave one of them out");
        return Err(band.refused("band", problem));
    }
    let read = if name == "shock" { of_shock(typed) } else { of_record(typed) };
    let forcing = read.map_err(|problem| typed.refused(name, problem))?;
    let largest = forcing.history().map_or(0.0, |History { course, .. }| course.bounds()[0]);
    if largest == 0.0 {
        return Err(typed.refused(name, "is zero all the time: nothing moves the structure"));
    }
    let after = after.as_ref().map_or(Ok(0.0), from)?;
    Ok(Some((forcing, after)))
}

/// The time from which on largest values count, s.
fn from(typed: &Typed) -> Result<f64, Error> {
    let after = typed.number("after", unit::TIME)?;
    if after >= 0.0 && after.is_finite() {
        return Ok(after);
    }
    Err(typed.refused("after", format!("{} is not allowed here: give a time not below 0", typed.text)))
}

/// `half-sine,20ms,5g`: its unit tells whether it is an acceleration of the base or a force.
fn of_shock(typed: &Typed) -> Result<Forcing, String> {
    let parts: Vec<&str> = typed.text.split(',').map(str::trim).collect();
    let [shape, duration, peak] = parts.as_slice() else {
        return Err(format!(
            "\"{}\" is not of the form SHAPE,DURATION,PEAK, for instance half-sine,20ms,5g or rectangle,0.1s,300N",
            typed.text
        ));
    };
    let known = ["half-sine", "versed-sine", "rectangle"];
    if !known.contains(shape) {
        return Err(format!("\"{shape}\" is none: give one of {}", known.join(", ")));
    }
    let seconds = unit::read(duration, unit::TIME)?;
    if !(seconds > 0.0 && seconds.is_finite()) {
        return Err(format!(
            "the duration {duration} is not allowed here: give a time above 0, for instance 20ms"
        ));
    }
    let has_unit = peak.parse::<f64>().is_err();
    let one =
        |of: Of| Some((of, unit::read(peak, of.units()).ok().filter(|peak| has_unit && peak.is_finite())?));
    let (of, value) = [Of::BaseAcceleration, Of::Force].into_iter().find_map(one).ok_or_else(|| {
        format!("\"{peak}\" is no peak: give an acceleration of the base with its unit, for instance 5g or 20m/s2, or a force, 300N")
    })?;
    let fields = json!({ "pulse": shape.replace('-', " "), "of": of, "peak": value, "duration": seconds });
    serde_json::from_value(fields).map_err(|error| error.to_string())
}

/// `quake.csv,unit=g,column=a`: the file, then its fields as in `scene.forcing`.
fn of_record(typed: &Typed) -> Result<Forcing, String> {
    let mut parts = typed.text.split(',').map(str::trim);
    let mut fields = Map::new();
    fields.insert("record".to_owned(), json!(parts.next().unwrap_or_default()));
    fields.insert("of".to_owned(), json!(OF));
    for part in parts {
        let known = part.split_once('=').filter(|(name, _)| FIELDS.contains(name));
        let Some((name, value)) = known else {
            return Err(format!(
                "\"{part}\" is not known: give FILE and, where they are needed, of=force, unit=g, column=2, scale=1.5"
            ));
        };
        let value = match name {
            "of" => json!(value.replace('-', " ")),
            "column" => value.parse::<usize>().map_or(json!(value), |number| json!(number)),
            "scale" => {
                json!(value.parse::<f64>().map_err(|_| format!("scale: \"{value}\" is not a number"))?)
            }
            _ => json!(value),
        };
        fields.insert(name.to_owned(), value);
    }
    let mut forcing: Forcing =
        serde_json::from_value(Value::Object(fields)).map_err(|error| error.to_string())?;
    let base = typed.file.as_deref().and_then(|file| Path::new(file).parent()).unwrap_or(Path::new(""));
    read_record(&mut forcing, base)?;
    // The samples are embedded, so that the studies of a design need no other file.
    if let Some((_, record)) = forcing.record_mut() {
        *record = record.whole();
    }
    Ok(forcing)
}
