//! Numbers with a unit in a file: `"k1": "20 kN/m"` is `"k1": 20000` before anything else is read, on the same line.
//!
//! The units of a field follow from its name in the catalogue: a parameter, a quantity or a time. For `from` and `to`, in lists and in
//! bounds, the name of the enclosing field counts.

use retune_model::{Measure, Parameter, Unit, unit};
use serde_json::Value;
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A text in place of a number, without a unit that its field allows.
pub(super) struct Refused {
    pub line: usize,
    pub column: usize,
    /// The field and what it may be.
    pub problem: String,
}

/// The text of `whole` with every number with a unit converted to its SI unit.
pub(super) fn in_si<'a>(text: &'a str, whole: &Value) -> Result<Cow<'a, str>, Refused> {
    let (mut found, mut out, mut copied) = (Vec::new(), String::new(), 0);
    // This cannot fail: the text has already been parsed into `whole`.
    let _ = serde_json::from_str(text).and_then(|raw| texts(raw, &mut Vec::new(), &mut found));
    found.sort_by_key(|(quoted, _)| quoted.as_ptr());
    for (quoted, path) in found {
        let Ok(typed) = serde_json::from_str::<String>(quoted) else { continue };
        let Some(units) = units(&path, whole) else { continue };
        if typed.trim().parse::<f64>().is_ok() {
            continue; // a number in quotes is a mistake, not a number with a unit
        }
        let start = quoted.as_ptr().addr() - text.as_ptr().addr();
        let number = read(&typed, units).map_err(|problem| refused(text, start, &path, &problem))?;
        out.push_str(&text[copied..start]);
        out.push_str(&Value::from(number).to_string());
        copied = start + quoted.len();
    }
    if copied == 0 {
        return Ok(Cow::Borrowed(text));
    }
    out.push_str(&text[copied..]);
    Ok(Cow::Owned(out))
}

/// Collects every string value, with its quotes, as a slice of the parsed text, and the path to it.
fn texts<'a>(
    raw: &'a RawValue,
    path: &mut Vec<Step>,
    found: &mut Vec<(&'a str, Vec<Step>)>,
) -> serde_json::Result<()> {
    let text = raw.get();
    let inner: Vec<(Step, &RawValue)> = match text.as_bytes().first() {
        Some(b'{') => {
            let fields: BTreeMap<String, &RawValue> = serde_json::from_str(text)?;
            fields.into_iter().map(|(name, value)| (Step::Field(name), value)).collect()
        }
        Some(b'[') => {
            let items: Vec<&RawValue> = serde_json::from_str(text)?;
            items.into_iter().enumerate().map(|(i, value)| (Step::Item(i), value)).collect()
        }
        Some(b'"') => {
            found.push((text, path.clone()));
            Vec::new()
        }
        _ => Vec::new(),
    };
    for (step, value) in inner {
        path.push(step);
        texts(value, path, found)?;
        path.pop();
    }
    Ok(())
}

fn refused(text: &str, at: usize, path: &[Step], problem: &str) -> Refused {
    let before = &text[..at];
    let mut field = String::new();
    for step in path {
        match step {
            Step::Field(name) if field.is_empty() => field.push_str(name),
            Step::Field(name) => field.push_str(&format!(".{name}")),
            Step::Item(i) => field.push_str(&format!("[{i}]")),
        }
    }
    Refused {
        line: before.matches('\n').count() + 1,
        column: before.len() - before.rfind('\n').map_or(0, |end| end + 1) + 1,
        problem: format!("{field}: {problem}"),
    }
}

/// Parses a number typed for a name of the catalogue, with one of its units or without, into its SI unit.
///
/// # Errors
/// It is not a number, or its unit is not one of the name; the message says what to give.
pub fn typed(name: &str, text: &str) -> Result<f64, String> {
    read(text, of_name(name).unwrap_or_default())
}

fn read(text: &str, units: &[Unit]) -> Result<f64, String> {
    let value = unit::read(text, units)?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("\"{text}\" is not allowed here: give a finite number"))
    }
}

/// The units of a name; none if it is not a number or has no unit.
fn of_name(name: &str) -> Option<&'static [Unit]> {
    match name {
        "t0" | "T" | "duration" => return Some(unit::TIME),
        "x1" | "x2" | "cavity" => return Some(unit::LENGTH),
        "v1" | "v2" => return Some(Measure::Velocity.units()),
        _ => {}
    }
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.symbol() == name);
    let measure = Measure::OF_RUN.into_iter().find(|measure| measure.name() == name);
    let units = parameter.map(Parameter::units).or(measure.map(Measure::units))?;
    (!units[0].0.is_empty()).then_some(units)
}

/// The units of the field at a path; none if it is not a number.
fn units(path: &[Step], whole: &Value) -> Option<&'static [Unit]> {
    let names: Vec<&str> = path.iter().filter_map(Step::field).collect();
    let mut inwards = names.iter().rev().copied().peekable();
    let own = inwards.peek().copied()?;
    match (own, names.iter().rev().nth(1).copied()) {
        ("from", Some("limits")) => return Some(unit::TIME),
        ("at", Some("loss" | "loss_obstacle")) => return Some(Measure::Velocity.units()),
        ("force" | "errors", Some("certificate")) => return Some(unit::SHARE),
        _ => {}
    }
    let name = inwards.find(|name| !["from", "to", "set", "range"].contains(name))?;
    // A relative band is given as fractions of the natural frequency.
    let shares = name == "omega" && own != "omega" && is_relative(path, whole);
    if shares { Some(unit::SHARE) } else { of_name(name) }
}

/// Whether the object that contains a field has `"relative": true`.
fn is_relative(path: &[Step], whole: &Value) -> bool {
    let around = path.split_last().map_or(path, |(_, around)| around);
    let inner = around.iter().try_fold(whole, |value, step| match step {
        Step::Field(name) => value.get(name),
        Step::Item(i) => value.get(i),
    });
    inner.and_then(|band| band.get("relative")) == Some(&Value::Bool(true))
}

/// A step of a path.
#[derive(Clone)]
enum Step {
    Field(String),
    Item(usize),
}

impl Step {
    fn field(&self) -> Option<&str> {
        match self {
            Self::Field(name) => Some(name),
            Self::Item(_) => None,
        }
    }
}
