//! Numbers with a unit in a file: `"k1": "20 kN/m"` is `"k1": 20000` before anything else is read, on the same line.
//!
//! A field has the units of its name in the catalogue: a parameter, a quantity or a time. In `from` and `to`, in lists and in bounds it is the
//! name around them that counts.

use retune_model::{Measure, Parameter, Unit, unit};
use serde_json::Value;
use std::borrow::Cow;

/// A text in the place of a number that has no unit of its field.
pub(super) struct Refused {
    pub line: usize,
    pub column: usize,
    /// The field and what it may be.
    pub problem: String,
}

/// Objects and lists in one another, at most: as many as the parser allows.
const DEEPEST: usize = 128;

/// The text with every number that has a unit as one in its SI unit. A text that is not JSON comes back as it is, as far as it is none: the
/// parser says what is wrong with it.
pub(super) fn in_si(text: &str) -> Result<Cow<'_, str>, Refused> {
    let mut scan = Scan { text, at: 0, path: Vec::new(), found: Vec::new() };
    // What stops early is told by the parser.
    let _ = scan.value();
    let whole: Option<Value> = if scan.found.is_empty() { None } else { serde_json::from_str(text).ok() };
    let (mut out, mut copied) = (String::new(), 0);
    for Text { span, path } in &scan.found {
        let token = &text[span.clone()];
        let Ok(typed) = serde_json::from_str::<String>(token) else { continue };
        let Some(units) = units(path, whole.as_ref()) else { continue };
        if typed.trim().parse::<f64>().is_ok() {
            continue; // a number in quotes is a slip, and no unit
        }
        let number = read(&typed, units);
        let number = number.map_err(|problem| refused(text, span.start, path, &problem))?;
        out.push_str(&text[copied..span.start]);
        out.push_str(&Value::from(number).to_string());
        copied = span.end;
    }
    if copied == 0 {
        return Ok(Cow::Borrowed(text));
    }
    out.push_str(&text[copied..]);
    Ok(Cow::Owned(out))
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

/// A number of a name of the catalogue as it was typed, in the SI unit: without a unit, or with one of its own.
///
/// # Errors
/// It is none, or the name has no units; the message says what to give.
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

/// The units of a name; none of what is no number, or has no unit.
fn of_name(name: &str) -> Option<&'static [Unit]> {
    match name {
        "t0" | "T" | "duration" => return Some(unit::TIME),
        "x1" | "x2" | "cavity" => return Some(unit::LENGTH),
        "v1" | "v2" => return Some(Measure::Velocity.units()),
        _ => {}
    }
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.symbol() == name);
    let measure = Measure::ALL.into_iter().find(|measure| measure.name() == name);
    let units = parameter.map(Parameter::units).or(measure.map(Measure::units))?;
    (!units[0].0.is_empty()).then_some(units)
}

/// The units of the field at a path; none where a text is no number.
fn units(path: &[Step], whole: Option<&Value>) -> Option<&'static [Unit]> {
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
    // A band that moves with the structure has shares of its natural frequency.
    let shares = name == "omega" && own != "omega" && is_relative(path, whole);
    if shares { Some(unit::SHARE) } else { of_name(name) }
}

/// Whether the object around a field says that it is relative.
fn is_relative(path: &[Step], whole: Option<&Value>) -> bool {
    let around = path.split_last().map_or(path, |(_, around)| around);
    let inner = whole.and_then(|whole| {
        around.iter().try_fold(whole, |value, step| match step {
            Step::Field(name) => value.get(name),
            Step::Item(i) => value.get(i),
        })
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

/// A text that is a value: where it stands, its quotes included, and the path to it.
struct Text {
    span: std::ops::Range<usize>,
    path: Vec<Step>,
}

/// A walk through JSON that notes where texts are; none of its steps where the text is not JSON.
struct Scan<'a> {
    text: &'a str,
    at: usize,
    path: Vec<Step>,
    found: Vec<Text>,
}

impl Scan<'_> {
    fn value(&mut self) -> Option<()> {
        match self.next()? {
            b'{' => self.inside(b'}', |scan, _| {
                let key = scan.word()?;
                scan.expect(b':')?;
                Some(Step::Field(serde_json::from_str(&scan.text[key]).ok()?))
            }),
            b'[' => self.inside(b']', |_, i| Some(Step::Item(i))),
            b'"' => {
                let span = self.word()?;
                self.found.push(Text { span, path: self.path.clone() });
                Some(())
            }
            _ => {
                let rest = &self.text[self.at..];
                let end = rest.find([',', '}', ']', ' ', '\n', '\r', '\t']).unwrap_or(rest.len());
                self.at += end;
                (end > 0).then_some(())
            }
        }
    }

    /// The values of an object or a list, whose end is `close`.
    fn inside(&mut self, close: u8, step: impl Fn(&mut Self, usize) -> Option<Step>) -> Option<()> {
        self.at += 1;
        if self.path.len() == DEEPEST {
            return None;
        }
        for i in 0.. {
            if i == 0 && self.next()? == close {
                break;
            }
            let step = step(self, i)?;
            self.path.push(step);
            self.value()?;
            self.path.pop();
            match self.next()? {
                b',' => self.at += 1,
                end if end == close => break,
                _ => return None,
            }
        }
        self.at += 1;
        Some(())
    }

    /// The next byte that is no blank.
    fn next(&mut self) -> Option<u8> {
        let blanks = self.text.as_bytes()[self.at..].iter().take_while(|byte| b" \n\r\t".contains(byte));
        self.at += blanks.count();
        self.text.as_bytes().get(self.at).copied()
    }

    fn expect(&mut self, byte: u8) -> Option<()> {
        (self.next()? == byte).then(|| self.at += 1)
    }

    /// A text in quotes, its quotes included.
    fn word(&mut self) -> Option<std::ops::Range<usize>> {
        self.expect(b'"')?;
        let start = self.at - 1;
        let mut escaped = false;
        for byte in self.text.as_bytes()[self.at..].iter() {
            self.at += 1;
            match byte {
                _ if escaped => escaped = false,
                b'\\' => escaped = true,
                b'"' => return Some(start..self.at),
                _ => {}
            }
        }
        None
    }
}
