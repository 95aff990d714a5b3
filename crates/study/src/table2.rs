//! The study behind Table 2: each damper's own study, beside the design the paper gives for it.

use super::file::{StudyError, expect, parse, read_text};
use super::format::Study;
use super::kind::Kind;
use super::objective::check_energy;
use super::read::read;
use super::rule::Rule;
use retune_model::{Design, Positive};
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
    /// "table2". A file without it is recognised by its other fields.
    #[serde(default = "kind")]
    #[schemars(extend("const" = "table2"))]
    pub kind: Kind,
    /// The rows of the table.
    #[schemars(length(min = 1))]
    pub rows: Vec<PaperRow>,
}

fn kind() -> Kind {
    Kind::Table2
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
    /// The E1max that the paper prints for it, J, if it does.
    #[serde(rename = "E1max", default, skip_serializing_if = "Option::is_none")]
    pub e1_max: Option<Positive>,
}

/// A damper's study with the paper's design in its scene.
#[derive(Clone, Debug)]
pub struct PaperStudy {
    /// The damper's name in the table.
    pub damper: String,
    /// The study; the design in its scene is the paper's.
    pub study: Study,
    /// The E1max that the paper prints, J.
    pub printed: Option<Positive>,
}

/// Reads the studies of a table, each with the paper's design in its scene.
///
/// # Errors
/// [`StudyError`], of the table's own file or of a study that it names.
pub fn read_table2(path: &Path) -> Result<Vec<PaperStudy>, StudyError> {
    let file = path.display().to_string();
    let text = read_text(path)?;
    expect(Kind::Table2, &text, &file)?;
    let table: Table2 = parse(&text, &file)?;
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
        rows.push(PaperStudy { damper: row.damper, study, printed: row.e1_max });
    }
    if rows.is_empty() { Err(refuse(Rule::NoRows)) } else { Ok(rows) }
}

/// The study with another design in its scene.
fn at_design(study: Study, design: Design) -> Result<Study, Rule> {
    let scene = study.scene_at(&design).ok_or(Rule::NoDamper)?;
    let study = Study { scene, ..study };
    study.search()?;
    check_energy(&study)?;
    Ok(study)
}
