//! Why a message is not answered.

use retune_study::{Settable, SettingError};
use serde::Serialize;

/// Why a message is not answered.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Refused {
    /// The field, where it is known.
    pub field: Option<String>,
    /// What is wrong, and what to do.
    pub problem: String,
}

impl Refused {
    /// Refuses because of a field.
    pub fn of(field: &str, problem: impl std::fmt::Display) -> Self {
        Self { field: Some(field.to_owned()), problem: format!("{field}: {problem}") }
    }

    /// Refuses the message as a whole.
    pub fn whole(problem: impl std::fmt::Display) -> Self {
        Self { field: None, problem: problem.to_string() }
    }
}

impl From<SettingError> for Refused {
    fn from(error: SettingError) -> Self {
        let problem = error.to_string();
        let field = problem.split([':', '`']).next().map(str::to_owned);
        Self { field: field.filter(|name| name.parse::<Settable>().is_ok()), problem }
    }
}
