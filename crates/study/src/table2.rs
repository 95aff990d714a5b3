//! The study behind Table 2: a study for each damper, and the design that the paper gives for it.

use super::built_in::{PLACE, read_plan_text, text};
use super::file::{Kind, StudyError, expect, parse};
use super::format::{Study, is_default};
use super::objective::{MOST_SAMPLES, check_quantity};
use super::read::{from_text, named};
use super::rule::Rule;
use retune_model::{Damper, Design, Positive, Scene};
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
    /// For `retune retention`: the bounds on k2 where a damper is tuned anew for another k1.
    #[serde(default, skip_serializing_if = "is_default")]
    pub k2_bounds: SpringBounds,
    /// For `retune retention`: number of band samples on which the designs are re-evaluated, so that they are compared on the same
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
    /// A known design, as that of the paper, from which the refinement starts. Default: the damper of the study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Design>,
    /// The E1max that the paper prints for it, J, if it does.
    #[serde(rename = "E1max", default, skip_serializing_if = "Option::is_none")]
    pub e1_max: Option<Positive>,
}

/// A damper's study with the reference design in its scene.
#[derive(Clone, Debug)]
pub struct PaperStudy {
    /// The damper's name in the table.
    pub damper: String,
    /// The study; the design in its scene is the reference of the table, if it has one.
    pub study: Study,
    /// Whether the reference design is one of the paper.
    pub of_paper: bool,
    /// The E1max that the paper prints, J.
    pub printed: Option<Positive>,
}

/// Reads the studies of a table, each with its reference design in its scene.
///
/// # Errors
/// [`StudyError`], of the table's own file or of a study that it names.
pub fn read_table2(path: &Path) -> Result<Vec<PaperStudy>, StudyError> {
    read_rows(path).map(|(_, rows)| rows)
}

/// Reads a table with its studies, each with its reference design in its scene.
pub fn read_rows(path: &Path) -> Result<(Table2, Vec<PaperStudy>), StudyError> {
    let file = path.display().to_string();
    let text = read_plan_text(path)?;
    expect(Kind::Table2, &text, &file)?;
    let table: Table2 = parse(&text, &file)?;
    let refuse = |rule| StudyError::Rule { file: file.clone(), rule };
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut rows: Vec<PaperStudy> = Vec::new();
    if let Some(samples) = table.samples.filter(|samples| !(2..=MOST_SAMPLES).contains(samples)) {
        return Err(refuse(Rule::not_allowed("samples", samples, "a whole number from 2 to 10000")));
    }
    for row in &table.rows {
        let study_file = directory.join(&row.study);
        let study = at_design(named(&study_file)?, row.reference)
            .map_err(|rule| StudyError::Rule { file: study_file.display().to_string(), rule })?;
        if rows.iter().any(|other| other.study.name() == study.name()) {
            return Err(refuse(Rule::SameName { name: study.name().to_owned() }));
        }
        let of_paper = study.scene.damper.as_ref().is_some_and(is_of_paper);
        rows.push(PaperStudy { damper: row.damper.clone(), study, of_paper, printed: row.e1_max });
    }
    if rows.is_empty() { Err(refuse(Rule::NoRows)) } else { Ok((table, rows)) }
}

/// Whether a damper is an optimum published in the paper: it has the mass and design of a row of Table 2.
pub fn is_of_paper(damper: &Damper) -> bool {
    built_in_rows().into_iter().any(|(paper, own)| {
        paper == Some(Design::of(damper)) && own.damper.is_some_and(|own| own.mass == damper.mass)
    })
}

/// Whether a scene has the structure of the paper, with a damper of the paper's mass.
pub fn is_papers_structure(scene: &Scene) -> bool {
    let mass = |scene: &Scene| scene.damper.map(|damper| damper.mass);
    built_in_rows().iter().any(|(_, own)| own.primary == scene.primary && mass(own) == mass(scene))
}

/// The rows of the paper's Table 2, each with its scene.
fn built_in_rows() -> Vec<(Option<Design>, Scene)> {
    let text_of = |name: &Path| text(&Path::new(PLACE).join(name));
    let table = text_of(Path::new("table2.json")).and_then(|text| parse::<Table2>(text, "table2.json").ok());
    let rows = table.into_iter().flat_map(|table| table.rows);
    rows.filter_map(|row| Some((row.reference, from_text(text_of(&row.study)?, "built in").ok()?.scene)))
        .collect()
}

/// The study with another design in its scene, if there is one.
fn at_design(mut study: Study, design: Option<Design>) -> Result<Study, Rule> {
    if let Some(design) = design {
        study.scene = study.scene_at(&design).ok_or(Rule::NoDamper)?;
    }
    study.search()?;
    check_quantity(&study)?;
    Ok(study)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_the_papers_dampers_are_recognised_by_their_numbers() {
        let damper = |name: &str| {
            let text = text(&Path::new(PLACE).join(name)).expect(name);
            from_text(text, name).ok().and_then(|study| study.scene.damper).expect("a damper")
        };
        let tmd = damper("tmd.json");
        assert!(is_of_paper(&tmd) && is_of_paper(&damper("table2-ssvi.json")));
        assert!(!is_of_paper(&Damper { stiffness: tmd.damping, ..tmd }), "another stiffness");
        assert!(!is_of_paper(&Damper { mass: damper_mass(70.0), ..tmd }), "another mass");
    }

    #[test]
    fn contract_the_papers_structure_is_recognised_with_any_design() {
        let text = text(&Path::new(PLACE).join("table2-ssvi.json")).expect("a study");
        let scene = from_text(text, "table2-ssvi.json").expect("a study").scene;
        let damper = scene.damper.expect("a damper");
        let with = |damper: Damper| Scene { damper: Some(damper), ..scene };
        assert!(is_papers_structure(&with(Damper { stiffness: damper.damping, ..damper })), "another design");
        assert!(!is_papers_structure(&with(Damper { mass: damper_mass(70.0), ..damper })), "another mass");
        assert!(!is_papers_structure(&Scene { damper: None, ..scene }), "no damper");
        let mut heavier = scene;
        heavier.primary.mass = damper_mass(1001.0);
        assert!(!is_papers_structure(&heavier), "another structure");
    }

    fn damper_mass(mass: f64) -> Positive {
        Positive::new(mass).expect("a mass")
    }
}
