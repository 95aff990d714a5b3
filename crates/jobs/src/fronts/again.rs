//! `fronts`, computed again: its certificates.

use crate::Error;
use crate::again::{Made, design, json};
use crate::look::finer;
use crate::resolved::Resolved;
use retune_model::Design;
use retune_study::Study;
use serde_json::Value;
use std::path::Path;

/// Most samples of a band that a certificate begins with.
const MOST: usize = 121;

/// The certificate of a design.
///
/// # Errors
/// The file cannot be read.
pub(super) fn again(place: &Path, name: &str) -> Result<Made, Error> {
    let said = json(place, name)?;
    let resolved = Resolved::read(place)?;
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    Ok(match certified(&resolved.studies()?, samples, &said) {
        Some(study) => crate::certify::again(&study, said),
        None => Made::Not("is of none of the studies".to_owned()),
    })
}

/// The study with the design that a certificate is of.
fn certified(studies: &[(String, Study)], samples: Option<usize>, said: &Value) -> Option<Study> {
    let (_, study) = studies.iter().find(|(_, study)| said["study"] == study.name())?;
    certifiable(study, samples?, &design(&said["design"])?)
}

/// The study that a design is certified by: on the samples of the study of fronts, or fewer, since a certificate looks at a hundred designs
/// and at four times the samples.
pub(super) fn certifiable(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    finer(study, samples.min(MOST), at)
}
