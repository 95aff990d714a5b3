//! From a file to the values of its fields, or to one message with the correction.

use super::explain::explain;
use super::kind::Kind;
use super::rule::Rule;
use super::units;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::borrow::Cow;
use std::path::Path;
use thiserror::Error;

/// The error of a study file.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The file does not exist or cannot be read.
    #[error("{file}: cannot be read: {source}")]
    Unreadable {
        /// The file.
        file: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The file is not text.
    #[error("{file}: not UTF-8 text (at byte {byte})")]
    NotText {
        /// The file.
        file: String,
        /// Offset of the first byte that is not UTF-8.
        byte: usize,
    },
    /// The text is not JSON, or does not have the fields of a study.
    #[error("{file}:{line}:{column}: {problem}")]
    Field {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The field's path and the error.
        problem: String,
    },
    /// The file is of another kind.
    #[error("{file}: its kind is `{}`, for {}; a file of kind `{}` is needed here", found.name(), found.commands(), wanted.name())]
    Kind {
        /// The file.
        file: String,
        /// Its kind.
        found: Kind,
        /// The kind that is needed.
        wanted: Kind,
    },
    /// Values without their names.
    #[error("{file}: {field}: wrong type: list, expected an object")]
    List {
        /// The file.
        file: String,
        /// The field's path.
        field: String,
    },
    /// Each field is valid but they contradict one another.
    #[error("{file}: {rule}")]
    Rule {
        /// The file.
        file: String,
        /// The rule that is broken.
        rule: Rule,
    },
    /// Results of several dampers, where those of one are needed.
    #[error("{file}: holds the designs of several searches{}", .one.as_ref().map_or(", but not their studies".to_owned(), |one| format!(": give one of them, for instance {one}")))]
    Several {
        /// The directory.
        file: String,
        /// The first that can be read in their place.
        one: Option<String>,
    },
    /// A directory without the results of a search.
    #[error("{file}: these are no results: there is no study.json in it, but {found}{}", .one.as_ref().map(|one| format!("; give a study or results, for instance {one}")).unwrap_or_default())]
    NoResults {
        /// The directory.
        file: String,
        /// What is in it.
        found: String,
        /// The first in it that can be read in its place.
        one: Option<String>,
    },
    /// A value of the paper's plan is not allowed.
    #[error("{file}: {problem}")]
    Paper {
        /// The file.
        file: String,
        /// The field and the allowed values.
        problem: String,
    },
}

/// Reads a file as text, without a byte-order mark.
///
/// # Errors
/// The file cannot be read or is not UTF-8.
pub(super) fn read_text(path: &Path) -> Result<String, StudyError> {
    let file = || path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| StudyError::Unreadable { file: file(), source })?;
    let text = String::from_utf8(bytes)
        .map_err(|error| StudyError::NotText { file: file(), byte: error.utf8_error().valid_up_to() })?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// The text with every number in its SI unit, see [`units`].
///
/// # Errors
/// [`StudyError::Field`]: the first that has no unit of its field.
pub(super) fn in_si<'a>(text: &'a str, file: &str) -> Result<Cow<'a, str>, StudyError> {
    units::in_si(text).map_err(|units::Refused { line, column, problem }| StudyError::Field {
        file: file.to_owned(),
        line,
        column,
        problem,
    })
}

/// Parses the text of `file`; an error names the field.
///
/// # Errors
/// [`StudyError::Field`].
pub(super) fn parse<T: DeserializeOwned + Serialize>(text: &str, file: &str) -> Result<T, StudyError> {
    let refuse = |path: Option<String>, error: &serde_json::Error| StudyError::Field {
        file: file.to_owned(),
        line: error.line(),
        column: error.column(),
        problem: explain(path.as_deref(), error),
    };
    let text = &*in_si(text, file)?;
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| refuse(Some(error.path().to_string()), error.inner()))?;
    json.end().map_err(|error| refuse(None, &error))?;
    let given = serde_json::from_str(text).map_err(|error| refuse(None, &error))?;
    let meant = serde_json::to_value(&value).map_err(|error| refuse(None, &error))?;
    match list_for_object(&given, &meant) {
        Some(field) => Err(StudyError::List { file: file.to_owned(), field }),
        None => Ok(value),
    }
}

/// The kind of a study file. What cannot be recognised counts as a study of one damper, whose reader says what is wrong with it.
///
/// # Errors
/// The file cannot be read.
pub fn kind_of(path: &Path) -> Result<Kind, StudyError> {
    let json: Result<Value, _> = serde_json::from_str(&read_text(path)?);
    Ok(json.ok().as_ref().and_then(Kind::of).unwrap_or_default())
}

/// Refuses the text of a file that is recognised as one of another kind.
///
/// # Errors
/// [`StudyError::Kind`].
pub(super) fn expect(wanted: Kind, text: &str, file: &str) -> Result<(), StudyError> {
    let json: Result<Value, _> = serde_json::from_str(text);
    match json.ok().as_ref().and_then(Kind::of) {
        Some(found) if found != wanted => Err(StudyError::Kind { file: file.to_owned(), found, wanted }),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_file_of_another_kind_is_named_with_its_commands() {
        let error = expect(Kind::Study, r#"{ "rows": [] }"#, "t.json").expect_err("a table");
        assert_eq!(
            error.to_string(),
            "t.json: its kind is `table2`, for `retune table2` and `retune retention`; a file of kind `study` is needed here"
        );
        assert!(expect(Kind::Table2, r#"{ "rows": [] }"#, "t.json").is_ok());
    }
}
