//! `fronts`, computed again: its certificates.

use crate::Error;
use crate::look::finer;
use crate::resolved::Resolved;
use crate::verify::{Report, input, one};
use retune_model::Design;
use retune_study::Study;
use serde_json::Value;
use std::path::Path;

/// Most samples of a band that a certificate begins with.
const MOST: usize = 121;

/// Checks the certificate of a design by making it again.
///
/// # Errors
/// The file cannot be read, as of all checks.
pub fn again(place: &Path, name: &str, _most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let said = input::json(place, name)?;
    let resolved = Resolved::read(place)?;
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    match certified(&resolved.studies()?, samples, &said) {
        Some(study) => one::certificate(&study, &said, name, report),
        None => report.fail(name, "is of none of the studies"),
    }
}

/// The study with the design that a certificate is of.
fn certified(studies: &[(String, Study)], samples: Option<usize>, said: &Value) -> Option<Study> {
    let (_, study) = studies.iter().find(|(_, study)| said["study"] == study.name())?;
    certifiable(study, samples?, &one::design(&said["design"])?)
}

/// The study that a design is certified by: on the samples of the study of fronts, or fewer, since a certificate looks at a hundred designs
/// and at four times the samples.
pub(super) fn certifiable(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    finer(study, samples.min(MOST), at)
}
