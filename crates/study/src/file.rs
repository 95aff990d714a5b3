//! Parses a file into the values of its fields, or reports one error with its correction.

use super::rule::Rule;
use super::units;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::error::Category;
use std::borrow::Cow;
use std::path::Path;
use thiserror::Error;

/// The error of a study file.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "its words say what each is and holds")]
pub enum StudyError {
    #[error("{file}: cannot be read: {source}")]
    Unreadable { file: String, source: std::io::Error },
    #[error("{file}: not UTF-8 text (at byte {byte})")]
    NotText { file: String, byte: usize },
    #[error("{file}:{line}:{column}: {problem}")]
    Field { file: String, line: usize, column: usize, problem: String },
    #[error("{file}: its kind is `{}`, for {}; a file of kind `{}` is needed here", found.name(), found.commands(), wanted.name())]
    Kind { file: String, found: Kind, wanted: Kind },
    #[error(
        "{file}: describes a structure for `retune design`; a study is needed here: run `retune design {file}` and take one of the studies that it writes"
    )]
    Structure { file: String },
    #[error("{file}: {field}: wrong type: list, expected an object")]
    List { file: String, field: String },
    #[error("{file}: {rule}")]
    Rule { file: String, rule: Rule },
    #[error("{file}: holds the designs of several searches{}", .one.as_ref().map_or(", but not their studies".to_owned(), |one| format!(": give one of them, for instance {one}")))]
    Several { file: String, one: Option<String> },
    #[error("{file}: these are no results: there is no study.json in it, but {found}{}", .one.as_ref().map(|one| format!("; give a study or results, for instance {one}")).unwrap_or_default())]
    NoResults { file: String, found: String, one: Option<String> },
    #[error("{file}: {problem}")]
    Paper { file: String, problem: String },
}

/// Reads a file as text, without a byte-order mark.
pub(super) fn read_text(path: &Path) -> Result<String, StudyError> {
    let file = || path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| StudyError::Unreadable { file: file(), source })?;
    let text = String::from_utf8(bytes)
        .map_err(|error| StudyError::NotText { file: file(), byte: error.utf8_error().valid_up_to() })?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// The text with every number converted to its SI unit, see [`units`]. Refuses text that is not JSON.
pub(super) fn in_si<'a>(text: &'a str, file: &str) -> Result<Cow<'a, str>, StudyError> {
    let whole = typed(text, file)?;
    units::in_si(text, &whole).map_err(|units::Refused { line, column, problem }| StudyError::Field {
        file: file.to_owned(),
        line,
        column,
        problem,
    })
}

/// Parses the text of `file`; an error names the field.
pub(super) fn parse<T: DeserializeOwned + Serialize>(text: &str, file: &str) -> Result<T, StudyError> {
    let text = &*in_si(text, file)?;
    let value: T = typed(text, file)?;
    let given = typed(text, file)?;
    let meant = serde_json::to_value(&value).map_err(|error| refused(file, None, &error))?;
    match list_for_object(&given, &meant) {
        Some(field) => Err(StudyError::List { file: file.to_owned(), field }),
        None => Ok(value),
    }
}

/// The text of `file` as a value of a type.
fn typed<T: DeserializeOwned>(text: &str, file: &str) -> Result<T, StudyError> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| refused(file, Some(error.path().to_string()), error.inner()))?;
    json.end().map_err(|error| refused(file, None, &error))?;
    Ok(value)
}

fn refused(file: &str, path: Option<String>, error: &serde_json::Error) -> StudyError {
    StudyError::Field {
        file: file.to_owned(),
        line: error.line(),
        column: error.column(),
        problem: explain(path.as_deref(), error),
    }
}

/// The kind of a study file. An unrecognised file counts as a study of one damper, whose reader reports what is wrong with it.
pub fn kind_of(path: &Path) -> Result<Kind, StudyError> {
    let json: Result<Value, _> = serde_json::from_str(&read_text(path)?);
    Ok(json.ok().as_ref().and_then(Kind::of).unwrap_or_default())
}

/// Refuses the text of a file that is recognised as one of another kind.
pub(super) fn expect(wanted: Kind, text: &str, file: &str) -> Result<(), StudyError> {
    let json: Option<Value> = serde_json::from_str(text).ok();
    match json.as_ref().and_then(Kind::of) {
        Some(found) if found != wanted => Err(StudyError::Kind { file: file.to_owned(), found, wanted }),
        None if json.is_some_and(|json| json.get("kind").is_none() && json.get("m1").is_some()) => {
            Err(StudyError::Structure { file: file.to_owned() })
        }
        _ => Ok(()),
    }
}

/// The first field given as a list instead of an object. (Serde accepts both.)
fn list_for_object(given: &Value, meant: &Value) -> Option<String> {
    match (given, meant) {
        (Value::Array(_), Value::Object(_)) => Some(String::new()),
        (Value::Object(given), Value::Object(meant)) => given.iter().find_map(|(key, value)| {
            let inner = list_for_object(value, meant.get(key)?)?;
            Some(if inner.is_empty() { key.clone() } else { format!("{key}.{inner}") })
        }),
        _ => None,
    }
}

/// The kind of a study file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// One structure with one damper.
    #[default]
    Study,
    /// A table of dampers, each with its study and a design of the paper.
    Table2,
    /// Dampers under ever looser bounds.
    Fronts,
    /// The whole paper.
    Paper,
}

impl Kind {
    /// Its name in the field `kind` of a file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Study => "study",
            Self::Table2 => "table2",
            Self::Fronts => "fronts",
            Self::Paper => "paper",
        }
    }

    /// The commands that take it.
    pub const fn commands(self) -> &'static str {
        match self {
            Self::Study => "`retune optimize`, `certify`, `simulate`, `sweep` and `evaluate`",
            Self::Table2 => "`retune table2` and `retune retention`",
            Self::Fronts => "`retune fronts`",
            Self::Paper => "`retune reproduce`, `figure` and `table`",
        }
    }

    /// The field that only files of this kind have; a file without `kind` is recognised by it.
    const fn field(self) -> &'static str {
        match self {
            Self::Study => "scene",
            Self::Table2 => "rows",
            Self::Fronts => "dampers",
            Self::Paper => "table2",
        }
    }

    /// The kind of a JSON object, from its field `kind` or else from its other fields; none for other JSON.
    pub(super) fn of(json: &Value) -> Option<Self> {
        match json.get("kind") {
            Some(kind) => Self::deserialize(kind).ok(),
            None => [Self::Study, Self::Table2, Self::Fronts, Self::Paper]
                .into_iter()
                .find(|kind| json.get(kind.field()).is_some()),
        }
    }
}

/// Describes the error at the field `path` (`scene.damper.k2`), if parsing reached a field.
pub(super) fn explain(path: Option<&str>, error: &serde_json::Error) -> String {
    let message = message_only(error);
    let field =
        path.map(|path| path.strip_suffix(".?").unwrap_or(path)).filter(|path| !matches!(*path, "." | "?"));
    if matches!(error.classify(), Category::Syntax | Category::Eof) {
        let place = field.map(|field| format!(" at {field}")).unwrap_or_default();
        return format!("not valid JSON{place}: {}", syntax(&message));
    }
    match quoted(&message).split_first() {
        Some((name, allowed)) if message.starts_with("unknown field") => {
            let parent = field.and_then(|field| parent_of(field, name));
            let parent = parent.map(|parent| format!("{parent}: ")).unwrap_or_default();
            format!("{parent}unknown field `{name}`{}", suggestion(name, allowed))
        }
        Some((name, allowed)) if message.starts_with("unknown variant") => {
            prefixed(field, &format!("\"{name}\" is not allowed here{}", suggestion(name, allowed)))
        }
        Some((name, _)) if message.starts_with("missing field") => {
            let full = field.map_or_else(|| (*name).to_owned(), |parent| format!("{parent}.{name}"));
            // The text after the name, if the rule says more than serde does.
            let rule = message
                .split_once("`: ")
                .map_or(", and it has no default".to_owned(), |(_, rule)| format!(": {rule}"));
            format!("{full}: missing{rule}")
        }
        Some((name, _)) if message.starts_with("duplicate field") => {
            let full = field.map_or_else(|| (*name).to_owned(), |parent| format!("{parent}.{name}"));
            format!("{full}: given twice")
        }
        _ => prefixed(field, &plain(&message)),
    }
}

/// The message without serde_json's " at line 3 column 5", which is already given before it.
fn message_only(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let position = format!(" at line {} column {}", error.line(), error.column());
    text.strip_suffix(&position).map(str::to_owned).unwrap_or(text)
}

fn prefixed(field: Option<&str>, problem: &str) -> String {
    field.map_or_else(|| problem.to_owned(), |field| format!("{field}: {problem}"))
}

/// The object that has an entry `name`, from a path that may end with that entry; none for the whole file.
fn parent_of<'a>(path: &'a str, name: &str) -> Option<&'a str> {
    match path.rsplit_once('.') {
        Some((parent, last)) if last == name => Some(parent),
        None if path == name => None,
        _ => Some(path),
    }
}

/// The words between backticks.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// A suggestion for `name`, and all allowed names.
pub(super) fn suggestion(name: &str, allowed: &[&str]) -> String {
    let typed = name.to_lowercase();
    let slips = |other: &str| strsim::damerau_levenshtein(&typed, &other.to_lowercase());
    // Among equally near names prefer one of equal length: for c3 suggest c2, not C.
    let nearest = allowed.iter().min_by_key(|other| (slips(other), other.len().abs_diff(name.len())));
    let meant = match nearest {
        Some(nearest) if slips(nearest) <= 1.max(name.len() / 3) => format!("did you mean `{nearest}`? "),
        _ => String::new(),
    };
    format!("; {meant}allowed: {}", allowed.join(", "))
}

/// Replaces Rust's type names in a message by plain words.
fn plain(message: &str) -> String {
    let mut text = message.to_owned();
    for (rust, words) in [
        ("floating point `", "number `"),
        ("integer `", "number `"),
        ("expected f64", "expected a number"),
        ("expected u64", "expected a whole number not below 0"),
        ("expected usize", "expected a whole number not below 0"),
        ("expected a tuple of size 2", "expected [smallest, largest]"),
        ("invalid type: map", "invalid type: object"),
        ("invalid type: sequence", "invalid type: list"),
        ("expected a sequence", "expected a list"),
        ("invalid type", "wrong type"),
    ] {
        text = text.replace(rust, words);
    }
    // "expected struct Damper with 6 elements" is of no use to the reader.
    match text.split_once("expected struct") {
        Some((before, _)) => format!("{before}expected an object"),
        None => text,
    }
}

/// Rewrites syntax messages of serde_json that can be made more helpful.
fn syntax(message: &str) -> String {
    match message {
        "number out of range" => "number out of range: its magnitude must be below 1.8e308".to_owned(),
        "expected value" => {
            "expected a value (a number, \"text\", true, false, null, [...] or {...}; JSON has no NaN or Infinity)"
                .to_owned()
        }
        "trailing characters" => "there is more text after the end of the study".to_owned(),
        other if other.starts_with("EOF") => format!("the text ends too early ({other})"),
        other => other.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn contract_a_file_of_another_kind_is_named_with_its_commands() {
        let error = expect(Kind::Study, r#"{ "rows": [] }"#, "t.json").expect_err("a table");
        assert_eq!(
            error.to_string(),
            "t.json: its kind is `table2`, for `retune table2` and `retune retention`; a file of kind `study` is needed here"
        );
        assert!(expect(Kind::Table2, r#"{ "rows": [] }"#, "t.json").is_ok());
        let error =
            expect(Kind::Study, r#"{ "m1": "40 t", "f1": "2 Hz" }"#, "bridge.json").expect_err("no study");
        assert!(error.to_string().contains("run `retune design bridge.json`"), "{error}");
    }

    #[test]
    fn contract_a_file_says_its_kind_or_is_recognised_by_its_fields() {
        assert_eq!(Kind::of(&json!({ "kind": "fronts", "rows": [] })), Some(Kind::Fronts));
        assert_eq!(Kind::of(&json!({ "rows": [] })), Some(Kind::Table2));
        assert_eq!(Kind::of(&json!({ "scene": {}, "window": {} })), Some(Kind::Study));
        assert_eq!(Kind::of(&json!({ "kind": "fronst" })), None);
        assert_eq!(Kind::of(&json!([1])), None);
    }
}
