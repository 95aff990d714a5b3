//! Serde's messages in plain words: the field, the error, the allowed values, and a suggestion.

use serde_json::error::Category;

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
            let parent = field.and_then(parent_of).map(|parent| format!("{parent}: ")).unwrap_or_default();
            format!("{parent}unknown field `{name}`{}", suggestion(name, allowed))
        }
        Some((name, allowed)) if message.starts_with("unknown variant") => {
            prefixed(field, &format!("\"{name}\" is not allowed here{}", suggestion(name, allowed)))
        }
        Some((name, _)) if message.starts_with("missing field") => {
            let full = field.map_or_else(|| (*name).to_owned(), |parent| format!("{parent}.{name}"));
            format!("{full}: missing, and it has no default")
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

fn parent_of(path: &str) -> Option<&str> {
    path.rsplit_once('.').map(|(parent, _)| parent)
}

/// The words between backticks.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// A suggestion for `name`, and all allowed names.
pub(super) fn suggestion(name: &str, allowed: &[&str]) -> String {
    let typed = name.to_lowercase();
    let slips = |other: &str| strsim::damerau_levenshtein(&typed, &other.to_lowercase());
    // Of two equally near names the one of the same length: for c3 suggest c2, not C.
    let nearest = allowed.iter().min_by_key(|other| (slips(other), other.len().abs_diff(name.len())));
    let meant = match nearest {
        Some(nearest) if slips(nearest) <= 1.max(name.len() / 3) => format!("did you mean `{nearest}`? "),
        _ => String::new(),
    };
    format!("; {meant}allowed: {}", allowed.join(", "))
}

/// Rust's names for what was expected, in words.
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

/// serde_json's syntax messages, where they can be more helpful.
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
