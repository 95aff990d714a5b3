//! The complete input of results, with every default written out: `study.json` of one study, `resolved.json` of several.

use crate::{Error, recompute};
use retune_store::{Identity, json_text};
use retune_study::{Study, read::from_text};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;

/// The text of `study.json`.
pub fn study_text(study: &Study) -> Result<String, Error> {
    Ok(json_text(&study.resolved(), ONE)?)
}

/// The identity of the search of a study.
pub fn identity_of(study: &Study) -> Result<Identity, Error> {
    Ok(Identity::of(&study_text(study)?))
}

/// The file of the complete input, if it is one study.
pub const ONE: &str = "study.json";
/// The file of the complete input for several studies.
pub const SEVERAL: &str = "resolved.json";

/// The plan and the study of each damper.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Resolved {
    /// The input besides the studies.
    pub plan: Value,
    dampers: Vec<Damper>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Damper {
    damper: String,
    study: Value,
}

impl Resolved {
    /// The complete input from a plan and the studies of the named dampers.
    pub fn new<'a>(plan: Value, studies: impl Iterator<Item = (&'a str, &'a Study)>) -> Self {
        let damper = |(name, study): (&str, &Study)| Damper {
            damper: name.to_owned(),
            study: serde_json::json!(study.resolved()),
        };
        Self { plan, dampers: studies.map(damper).collect() }
    }

    /// The text of the file.
    pub fn text(&self) -> Result<String, Error> {
        Ok(json_text(self, SEVERAL)?)
    }

    /// Reads the file in a directory of results.
    pub fn read(place: &Path) -> Result<Self, Error> {
        let text = recompute::text(place, SEVERAL)?;
        serde_json::from_str(&text).map_err(|error| recompute::broken(place, SEVERAL, error.to_string()))
    }

    /// The name and the study of each damper.
    pub fn studies(&self) -> Result<Vec<(String, Study)>, Error> {
        let study =
            |damper: &Damper| Ok((damper.damper.clone(), from_text(&damper.study.to_string(), SEVERAL)?));
        self.dampers.iter().map(study).collect()
    }

    /// The plan and the study in a directory of results of a single study.
    pub fn one(place: &Path) -> Result<(Value, Study), Error> {
        let resolved = Self::read(place)?;
        let first = resolved.studies()?.into_iter().next();
        let (_, study) = first.ok_or_else(|| recompute::broken(place, SEVERAL, "it names no study"))?;
        Ok((resolved.plan, study))
    }
}
