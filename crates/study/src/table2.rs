//! The study behind Table 2: each damper's own study, beside the design the paper gives for it.

use super::file::{StudyError, expect, parse, read_text};
use super::format::Study;
use super::fronts::MOST_SAMPLES;
use super::kind::Kind;
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
    /// For `retune track`: the bounds on k2 where a damper is tuned anew for another k1.
    #[serde(default, skip_serializing_if = "SpringBounds::is_default")]
    pub k2_bounds: SpringBounds,
    /// For `retune track`: number of band samples on which the designs are re-evaluated, so that they are compared on the same
    /// frequencies. Default: those of each study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 10000))]
    pub samples: Option<usize>,
}

/// What becomes of the bounds on k2 of a study when its damper is tuned anew for another k1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SpringBounds {
    /// They are in proportion to k1: every structure may have a spring of the same ratio k2/k1.
    #[default]
    Scaled,
    /// They stay as they are.
    Fixed,
}

impl SpringBounds {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
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
    read_rows(path).map(|(_, rows)| rows)
}

/// Reads a table with its studies, each with the paper's design in its scene.
///
/// # Errors
/// As [`read_table2`].
pub fn read_rows(path: &Path) -> Result<(Table2, Vec<PaperStudy>), StudyError> {
    let file = path.display().to_string();
    let text = read_text(path)?;
    expect(Kind::Table2, &text, &file)?;
    let table: Table2 = parse(&text, &file)?;
    let refuse = |rule| StudyError::Rule { file: file.clone(), rule };
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut rows: Vec<PaperStudy> = Vec::new();
    if let Some(samples) = table.samples.filter(|samples| !(2..=MOST_SAMPLES).contains(samples)) {
        let (field, value) = ("samples".to_owned(), samples.to_string());
        return Err(refuse(Rule::NotAllowed { field, value, allowed: "a whole number from 2 to 10000" }));
    }
    for row in &table.rows {
        let study_file = directory.join(&row.study);
        let study = at_design(read(&study_file)?, row.paper)
            .map_err(|rule| StudyError::Rule { file: study_file.display().to_string(), rule })?;
        if rows.iter().any(|other| other.study.name() == study.name()) {
            return Err(refuse(Rule::SameName { name: study.name().to_owned() }));
        }
        rows.push(PaperStudy { damper: row.damper.clone(), study, printed: row.e1_max });
    }
    if rows.is_empty() { Err(refuse(Rule::NoRows)) } else { Ok((table, rows)) }
}

/// The study with another design in its scene.
fn at_design(study: Study, design: Design) -> Result<Study, Rule> {
    let scene = study.scene_at(&design).ok_or(Rule::NoDamper)?;
    let study = Study { scene, ..study };
    study.search()?;
    Ok(study)
}
