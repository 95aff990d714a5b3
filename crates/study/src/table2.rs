//! The study behind Table 2: each damper's own study, beside the design the paper gives for it.

use super::format::Study;
use super::read::{StudyError, has_field, parse, read, read_text};
use super::rule::Rule;
use retune_model::{Design, NonNegative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Table 2 of the paper: dampers to tune, beside the paper's own designs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table2 {
    /// The JSON Schema with which an editor completes and validates this file. Ignored by Retune.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// The rows of the table.
    #[schemars(length(min = 1))]
    pub rows: Vec<PaperRow>,
}

/// A row of Table 2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PaperRow {
    /// The damper's name in the table.
    pub damper: String,
    /// The study that tunes it; a path relative to this file.
    pub study: PathBuf,
    /// The paper's design, from which the refinement starts.
    pub paper: Design,
}

/// A damper's study with the paper's design in its scene.
#[derive(Clone, Debug)]
pub struct PaperStudy {
    /// The damper's name in the table.
    pub damper: String,
    /// The study; the design in its scene is the paper's.
    pub study: Study,
}

/// Reads the studies of a table, each with the paper's design in its scene.
///
/// # Errors
/// [`StudyError`], of the table's own file or of a study that it names.
pub fn read_table2(path: &Path) -> Result<Vec<PaperStudy>, StudyError> {
    let file = path.display().to_string();
    let table: Table2 = parse(&read_text(path)?, &file)?;
    let refuse = |rule| StudyError::Rule { file: file.clone(), rule };
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut rows: Vec<PaperStudy> = Vec::new();
    for row in table.rows {
        let study_file = directory.join(&row.study);
        let study = at_design(read(&study_file)?, row.paper)
            .map_err(|rule| StudyError::Rule { file: study_file.display().to_string(), rule })?;
        if rows.iter().any(|other| other.study.name() == study.name()) {
            return Err(refuse(Rule::SameName { name: study.name().to_owned() }));
        }
        rows.push(PaperStudy { damper: row.damper, study });
    }
    if rows.is_empty() { Err(refuse(Rule::NoRows)) } else { Ok(rows) }
}

/// The study with the design of the `optimum.json` at `path` in its scene; the inner error is of the study.
///
/// # Errors
/// [`StudyError`] of the file.
pub fn at_found(study: Study, path: &Path) -> Result<Result<Study, Rule>, StudyError> {
    let file = path.display().to_string();
    let found: serde_json::Value = parse(&read_text(path)?, &file)?;
    let number = |name: &str| {
        let value = found.get(name).and_then(serde_json::Value::as_f64).map(NonNegative::new);
        match value {
            Some(Ok(value)) => Ok(value),
            _ => Err(StudyError::Rule {
                file: file.clone(),
                rule: Rule::NotAllowed {
                    field: name.to_owned(),
                    value: found.get(name).map_or("nothing".to_owned(), ToString::to_string),
                    allowed: "a number not below 0: the design that `retune optimize` found",
                },
            }),
        }
    };
    let design = Design { k2: number("k2")?, c2: number("c2")?, d: number("D")?, c: number("C")? };
    Ok(with_design(study, design))
}

/// Whether a file is what `retune optimize` found, by its field `damper_type`.
///
/// # Errors
/// The file cannot be read.
pub fn is_optimum(path: &Path) -> Result<bool, StudyError> {
    has_field(path, "damper_type")
}

/// The study with another design in its scene.
fn at_design(study: Study, design: Design) -> Result<Study, Rule> {
    let study = with_design(study, design)?;
    study.search()?;
    Ok(study)
}

fn with_design(mut study: Study, design: Design) -> Result<Study, Rule> {
    let damper = study.scene.damper.as_mut().ok_or(Rule::NoDamper)?;
    *damper = design.on(*damper);
    Ok(study)
}

/// Whether a file is a table of studies and no study: whether it has `rows`. A file that is neither is none.
///
/// # Errors
/// It cannot be read.
pub fn is_table2(path: &Path) -> Result<bool, StudyError> {
    has_field(path, "rows")
}

/// Whether a file is a plan of the whole paper, by its field `table2`.
///
/// # Errors
/// The file cannot be read.
pub fn is_paper(path: &Path) -> Result<bool, StudyError> {
    has_field(path, "table2")
}
