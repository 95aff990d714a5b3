#![doc = include_str!("../PROTOCOL.md")]

use crate::limits::{MOST_BYTES, MOST_COLUMNS, MOST_RECORD};
use crate::refused::Refused;
use retune_model::Measure;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// The kinds of damper that a page may hang on the structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DamperKind {
    /// No damper.
    None,
    /// A damper without walls.
    Tmd,
    /// A damper between two walls.
    Ssvi,
}

/// What a page shows: the study of the session with another damper and other numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// The damper.
    pub damper: DamperKind,
    /// Numbers by the names of `--set`, in SI units; those left out are the study's.
    pub set: BTreeMap<String, f64>,
}

/// A message of a page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Message {
    /// Show this place.
    Look {
        /// Returned with every answer.
        id: u64,
        /// What to show.
        place: Place,
        /// The time that is shown, s; the window of the study if left out.
        span: Option<[f64; 2]>,
        /// Pixels that the time series have.
        columns: usize,
        /// Whether to follow every motion over the band, too.
        #[serde(default)]
        branches: bool,
        /// The quantity of the curves; what the study minimises if left out.
        #[serde(default)]
        quantity: Option<Measure>,
    },
    /// Keep this design for comparison.
    Pin {
        /// 0 for A, 1 for B.
        slot: usize,
        /// The design.
        place: Place,
        /// The quantity of its curve, as in `Look`.
        #[serde(default)]
        quantity: Option<Measure>,
    },
    /// Tune from here.
    Tune {
        /// The start.
        place: Place,
    },
    /// Begin with another structure, in the words of a file of `retune design`.
    Own {
        /// Its fields: m1, f1, zeta, force, band, mass and so on.
        structure: BTreeMap<String, Value>,
    },
    /// Force the structure by a pulse or a record, or again by the study's own forcing.
    Force {
        /// The fields of `scene.forcing`; none for the study's own.
        forcing: Option<serde_json::Map<String, Value>>,
        /// The text of the file with the record.
        #[serde(default)]
        text: Option<String>,
    },
    /// End the tuning and keep its best design.
    Stop {},
    /// Export this place.
    Write(Write),
}

/// An export of a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Write {
    /// The place.
    pub place: Place,
    /// As what.
    pub what: What,
    /// The pinned designs A and B, for forms that show them.
    #[serde(default)]
    pub pins: [Option<Place>; 2],
    /// The quantity of the curves, as in `Look`.
    #[serde(default)]
    pub quantity: Option<Measure>,
}

/// Forms of export. The page offers them as files; the server writes none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum What {
    /// A study file.
    Study,
    /// The command line that makes this run.
    Command,
    /// Python code that makes this run.
    Python,
    /// The motion as `retune simulate --trajectory` writes it.
    Motion,
    /// A figure of the motion.
    Picture,
    /// A figure of the response over frequency.
    Response,
    /// The run as `retune simulate --json` prints it.
    Json,
    /// A page with the figures, the curves, the motion and the study.
    Report,
}

/// The beginning of a message that may hold a record.
const RECORD: &str = "{\"force\":";

/// Reads a message.
///
/// # Errors
/// It is too long, malformed, or has a field out of range.
pub fn read(text: &str) -> Result<Message, Refused> {
    let most = if text.starts_with(RECORD) { MOST_RECORD } else { MOST_BYTES };
    if text.len() > most {
        let length = text.len();
        return Err(Refused::whole(format!("a message of {length} bytes: at most {most} are read")));
    }
    let message: Message = serde_json::from_str(text).map_err(Refused::whole)?;
    match &message {
        Message::Look { columns, .. } if !(1..=MOST_COLUMNS).contains(columns) => {
            Err(Refused::of("columns", format!("{columns} is not allowed here: 1 to {MOST_COLUMNS}")))
        }
        Message::Look { span: Some([from, to]), .. } if !(*from >= 0.0 && from < to) => {
            Err(Refused::of("span", format!("{from} to {to} s is not a span of the run")))
        }
        Message::Pin { slot, .. } if *slot > 1 => {
            Err(Refused::of("slot", format!("{slot} is not allowed here: 0 or 1")))
        }
        _ => Ok(message),
    }
}

/// An answer: an object, and columns of numbers. See the layout above.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    head: serde_json::Map<String, Value>,
    names: Vec<Value>,
    numbers: Vec<u8>,
}

impl Answer {
    /// An answer of a kind.
    pub fn new(kind: &str) -> Self {
        Self::default().with("kind", kind)
    }

    /// Adds a field.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Serialize) -> Self {
        // JSON has no non-finite numbers: they become null.
        self.head.insert(name.to_owned(), serde_json::to_value(value).unwrap_or(Value::Null));
        self
    }

    /// Adds a column of numbers.
    #[must_use]
    pub fn column(mut self, name: &str, values: &[f64]) -> Self {
        self.names.push(serde_json::json!([name, values.len()]));
        self.numbers.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self
    }

    /// A field.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.head.get(name)
    }

    /// A column.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let length = |of: &Value| of[1].as_u64().map_or(0, |count| count as usize);
        let place = self.names.iter().position(|of| of[0] == name)?;
        let before: usize = self.names[..place].iter().map(length).sum();
        let bytes = self.numbers.chunks_exact(8).skip(before).take(length(&self.names[place]));
        Some(bytes.filter_map(|bytes| Some(f64::from_le_bytes(bytes.try_into().ok()?))).collect())
    }

    /// The bytes of the message.
    pub fn bytes(mut self) -> Vec<u8> {
        self.head.insert("columns".to_owned(), Value::Array(self.names));
        let mut head = Value::Object(self.head).to_string().into_bytes();
        head.resize(head.len().next_multiple_of(8) + 4, b' '); // aligns the numbers to eight bytes
        let mut bytes = (head.len() as u32).to_le_bytes().to_vec();
        bytes.append(&mut head);
        bytes.extend(self.numbers);
        bytes
    }
}

impl From<Refused> for Answer {
    fn from(refused: Refused) -> Self {
        Self::new("refused").with("field", refused.field).with("problem", refused.problem)
    }
}
