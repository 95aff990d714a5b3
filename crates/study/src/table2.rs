//! The study behind Table 2: each damper's own study, beside the design the paper gives for it.

use super::built_in::read_plan_text;
use super::file::{StudyError, expect, parse};
use super::format::Study;
use super::kind::Kind;
use super::read::named;
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
    /// The paper's design, from which the refinement starts. Default: the damper of the study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paper: Option<Design>,
    /// The E1max that the paper prints for it, J, if it does.
    #[serde(rename = "E1max", default, skip_serializing_if = "Option::is_none")]
    pub e1_max: Option<Positive>,
}

/// A damper's study with the paper's design in its scene.
#[derive(Clone, Debug)]
pub struct PaperStudy {
    /// The damper's name in the table.
    pub damper: String,
    /// The study; the design in its scene is the paper's, if the table has one.
    pub study: Study,
    /// Whether the table has a design of the paper.
    pub of_paper: bool,
    /// The E1max that the paper prints, J.
    pub printed: Option<Positive>,
}

/// Reads the studies of a table, each with the paper's design in its scene.
///
/// # Errors
/// [`StudyError`], of the table's own file or of a study that it names.
pub fn read_table2(path: &Path) -> Result<Vec<PaperStudy>, StudyError> {
    let file = path.display().to_string();
    let text = read_plan_text(path)?;
    expect(Kind::Table2, &text, &file)?;
    let table: Table2 = parse(&text, &file)?;
    let refuse = |rule| StudyError::Rule { file: file.clone(), rule };
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut rows: Vec<PaperStudy> = Vec::new();
    for row in table.rows {
        let study_file = directory.join(&row.study);
        let of_paper = row.paper.is_some();
        let study = at_design(named(&study_file)?, row.paper)
            .map_err(|rule| StudyError::Rule { file: study_file.display().to_string(), rule })?;
        if rows.iter().any(|other| other.study.name() == study.name()) {
            return Err(refuse(Rule::SameName { name: study.name().to_owned() }));
        }
        rows.push(PaperStudy { damper: row.damper, study, of_paper, printed: row.e1_max });
    }
    if rows.is_empty() { Err(refuse(Rule::NoRows)) } else { Ok(rows) }
}

/// The study with another design in its scene, if there is one.
fn at_design(mut study: Study, design: Option<Design>) -> Result<Study, Rule> {
    if let Some(design) = design {
        study.scene = study.scene_at(&design).ok_or(Rule::NoDamper)?;
    }
    study.search()?;
    Ok(study)
}
