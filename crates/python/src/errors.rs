//! Converts every error to one of the package's exceptions, which `retune/_errors.py` defines.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyFloat;
use retune_model::Unsettable;
use retune_optim::Unusable;
use retune_solver::SolverError;
use retune_study::StudyError;
use serde_json::Value;

/// Why something has no result.
pub enum Fault {
    /// A field, an argument or a design is wrong.
    Study {
        /// What is wrong, and what is allowed.
        message: String,
        /// The path of the field; none if there is no single one.
        field: Option<String>,
        /// Its value.
        given: Given,
    },
    /// A run could not be finished.
    Solver(SolverError),
    /// Any other error of the library.
    Other(String),
    /// An exception raised by Python: Ctrl-C, or an error in the user's function.
    Python(PyErr),
}

/// A refused value.
pub enum Given {
    /// Not a single value, or not known.
    Nothing,
    /// A number, which JSON may not be able to hold.
    Number(f64),
    /// A value of a study.
    Json(Value),
}

impl Fault {
    /// Something is wrong with the field that the message begins with.
    pub fn study(message: String, given: Given) -> Self {
        Self::Study { field: field_of(&message), message, given }
    }

    /// An argument out of its range: the message names it, its value and what is allowed.
    pub fn argument(name: &str, value: f64, allowed: &str) -> Self {
        Self::study(format!("{name}: {value} is not allowed here: give {allowed}"), Given::Number(value))
    }

    /// A rule that is broken.
    pub fn of_rule(rule: &retune_study::Rule) -> Self {
        Self::study(rule.to_string(), Given::Nothing)
    }

    /// The error of a study with a known text; `whole` messages name the file and the position in it.
    pub fn of_study(error: &StudyError, text: &str, whole: bool) -> Self {
        let problem = match error {
            StudyError::Field { problem, .. } => problem.clone(),
            StudyError::Rule { rule, .. } => rule.to_string(),
            StudyError::List { field, .. } => format!("{field}: wrong type: list, expected an object"),
            StudyError::Paper { problem, .. } => problem.clone(),
            StudyError::Unreadable { .. }
            | StudyError::NotText { .. }
            | StudyError::Kind { .. }
            | StudyError::Structure { .. }
            | StudyError::Several { .. }
            | StudyError::NoResults { .. } => {
                return Self::Study { message: error.to_string(), field: None, given: Given::Nothing };
            }
        };
        let field = field_of(&problem);
        let json = serde_json::from_str(text).unwrap_or(Value::Null);
        let given = field.as_ref().and_then(|field| found(&json, field).cloned());
        let message = if whole { error.to_string() } else { problem };
        Self::Study { message, field, given: given.map_or(Given::Nothing, Given::Json) }
    }
}

impl From<SolverError> for Fault {
    fn from(error: SolverError) -> Self {
        Self::Solver(error)
    }
}

impl From<PyErr> for Fault {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl From<Unusable> for Fault {
    fn from(error: Unusable) -> Self {
        match error {
            Unusable::Run(error) => Self::Solver(error),
            Unusable::Value { source: Unsettable::Absent(_), .. } => {
                Self::study(error.to_string(), Given::Nothing)
            }
            Unusable::Value { source: Unsettable::OutOfRange(source), .. }
            | Unusable::Stiffness(source)
            | Unusable::Member(source)
            | Unusable::Frequency(source) => Self::study(error.to_string(), Given::Number(source.value)),
            Unusable::Motions(retune_dynamics::Error::Run(error)) => Self::Solver(error),
            Unusable::Resonates { .. }
            | Unusable::Touches { .. }
            | Unusable::Stopped
            | Unusable::Motions(_)
            | Unusable::NoDerivatives
            | Unusable::NotStationary
            | Unusable::NotDecayed { .. } => {
                Self::Study { message: error.to_string(), field: None, given: Given::Nothing }
            }
        }
    }
}

impl From<retune_study::SettingError> for Fault {
    fn from(error: retune_study::SettingError) -> Self {
        let given = match &error {
            retune_study::SettingError::OutOfRange { source, .. } => Given::Number(source.value),
            _ => Given::Nothing,
        };
        Self::study(error.to_string(), given)
    }
}

impl From<retune_jobs::Error> for Fault {
    fn from(error: retune_jobs::Error) -> Self {
        use retune_jobs::Error;
        match error {
            Error::Run(error) | Error::Motion(retune_dynamics::Error::Run(error)) => Self::Solver(error),
            Error::Unusable(error) => error.into(),
            Error::Setting(error) => error.into(),
            Error::Rule { rule, .. } => Self::of_rule(&rule),
            Error::Study(error) => Self::of_study(&error, "", true),
            Error::Requirement { place, problem } => {
                let field = place.rsplit(": ").next().unwrap_or_default();
                Self::study(format!("{field}: {problem}"), Given::Nothing)
            }
            error => Self::Other(error.to_string()),
        }
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        Python::attach(|py| raised(py, fault).unwrap_or_else(|error| error))
    }
}

fn raised(py: Python<'_>, fault: Fault) -> PyResult<PyErr> {
    let class = |name: &str| py.import("retune._errors")?.getattr(name);
    let exception = match fault {
        Fault::Python(error) => return Ok(error),
        Fault::Study { message, field, given } => {
            let given = match given {
                Given::Nothing => py.None().into_bound(py),
                Given::Number(number) => PyFloat::new(py, number).into_any(),
                Given::Json(json) => py.import("json")?.call_method1("loads", (json.to_string(),))?,
            };
            class("StudyError")?.call1((message, field, given))?
        }
        Fault::Solver(error) => class("SolverError")?.call1((error.to_string(), error.time()))?,
        Fault::Other(message) => class("Error")?.call1((message,))?,
    };
    Ok(PyErr::from_value(exception))
}

/// Converts a panic, which is a bug in Retune, into an error, so that the calling program goes on.
pub fn of_panic(payload: &(dyn std::any::Any + Send)) -> Fault {
    let words = payload.downcast_ref::<&str>().map(|words| (*words).to_owned());
    let words = words.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
    Fault::Other(format!("a mistake in Retune, please report it: {words}"))
}

/// The path of the field that a message is about. A message about a field begins with its path, one about an unknown field with the
/// path of its parent.
fn field_of(message: &str) -> Option<String> {
    for unknown in ["unknown field `", "unknown parameter `"] {
        if let Some((parent, rest)) = message.split_once(unknown) {
            let parent = parent.strip_suffix(": ").map(|parent| format!("{parent}."));
            return rest.split('`').next().map(|name| parent.unwrap_or_default() + name);
        }
    }
    let message = message.strip_prefix("not valid JSON at ").unwrap_or(message);
    let (path, _) = message.split_once(": ")?;
    let path = path.trim_start_matches("--");
    let is_path = !path.is_empty() && path.chars().all(|c| c.is_ascii_alphanumeric() || "._-[]$".contains(c));
    is_path.then(|| path.to_owned())
}

/// The value at a path like `optimize.starts[0].k2`.
fn found<'a>(json: &'a Value, path: &str) -> Option<&'a Value> {
    path.split(['.', '[']).try_fold(json, |value, step| match step.strip_suffix(']') {
        Some(index) => value.get(index.parse::<usize>().ok()?),
        None => value.get(step),
    })
}

/// An error of the interpreter that no user should see.
pub fn internal(words: &str) -> PyErr {
    PyRuntimeError::new_err(words.to_owned())
}
