//! The manifest of results and the file with their scenes, from which `retune verify` reruns their rows.

use crate::Any;
use crate::scenes::Case;
use retune_jobs::artefact::Kind;
use retune_jobs::resolved::{Resolved, SEVERAL};
use retune_model::{NonNegative, Positive};
use retune_store::identity::Identity;
use retune_store::json_text;
use retune_store::manifest::{MadeBy, Manifest, NAME, file_sha256};
use retune_study::{Solver, Span, Study};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Writes both into a directory, for the files there.
pub fn seal<'a>(folder: &Path, kind: &Kind, plan: Value, cases: impl Iterator<Item = &'a Case>) -> Any<()> {
    let study = |case: &Case| -> Any<(String, Study)> {
        let study = Study {
            certificate: Default::default(),
            schema: None,
            kind: retune_study::Kind::Study,
            retune: None,
            name: None,
            scene: case.scene,
            window: Span { t0: NonNegative::default(), end: Positive::new(case.to)? },
            solver: Solver::default(),
            optimize: None,
        };
        Ok((case.name.replace(',', ";"), study))
    };
    let studies = cases.map(study).collect::<Result<Vec<_>, _>>()?;
    let input = Resolved::new(plan, studies.iter().map(|(name, study)| (name.as_str(), study))).text()?;
    fs::write(folder.join(SEVERAL), &input)?;
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if name == SEVERAL || kind.makes(&name) {
            files.insert(name, file_sha256(&path)?);
        }
    }
    let Identity { study: study_sha256, version, arithmetic } = Identity::of(&input);
    let made_by = MadeBy { command: kind.command.to_owned(), study: SEVERAL.to_owned() };
    let manifest = Manifest {
        retune: version,
        made_by,
        study_sha256,
        arithmetic,
        solver: None,
        files,
        earlier: BTreeMap::new(),
        parts: BTreeMap::new(),
    };
    Ok(fs::write(folder.join(NAME), json_text(&manifest, NAME)?)?)
}
