//! `certify`: the reliability of a design's E1max. Its error bar, its sensitivity to small errors, the type of motion, a verdict.

mod certificate;
mod margin;
mod measure;
mod motions;
mod records;
mod walls;

pub use certificate::{Certificate, Verdict};
pub(crate) use certificate::{Measured, periodic};
pub(crate) use walls::Walls;

use crate::artefact::Kind;
use crate::job::{Job, open, where_results_are};
use crate::recompute::{Recomputed, json};
use crate::resolved::{self, identity_of};
use crate::{Error, Observer, Request};
use measure::OtherStarts;
use retune_model::Damper;
use retune_store::Extent;
use retune_store::order::is_same;
use retune_study::{self as study, Rule, Study};
use std::path::Path;

/// The file that a certificate is written to.
pub const FILE: &str = "certificate.json";

/// The files of a certificate outside the results of a search.
pub static KIND: Kind = Kind {
    command: "certify",
    answer: FILE,
    input: resolved::ONE,
    rows: &[],
    whole: &[(FILE, of_study)],
    derived: &[],
};

/// Certifies the design of a study, or the one that a search found: `request.study` is a study, an `optimum.json`, or the directory of a
/// search's results. By default the certificate is written beside the optimum, else to `results/certify/<study>`.
///
/// # Errors
/// The input is wrong, the design cannot be run, or the certificate cannot be written.
pub fn certify_file(request: &Request, watch: &dyn Observer) -> Result<Certificate, Error> {
    let (study, found_in) = (study::read(&request.study)?, study::found_in(&request.study)?);
    let out = request.out.clone().or(found_in.clone());
    let out = out.unwrap_or_else(|| Path::new("results/certify").join(study.name()));
    // Written beside the search that found the design: its study and manifest are kept.
    let beside = found_in.is_some_and(|found_in| is_same(&found_in, &out));
    if !beside && out.join("optimum.json").exists() {
        let source = std::io::Error::other("the results of a search stand there; give another --out");
        return Err(retune_store::Error::Output { path: out, source }.into());
    }
    // A strongly irregular motion takes minutes.
    let bar = watch.progress("certificate", 1);
    let certificate = request.on_threads(|| certify(&study));
    bar.finish();
    let certificate = certificate?;
    let order = request.order(KIND.command);
    let results = if beside {
        let is_ours = |name: &str| name == FILE;
        let results = open(&out, &order, &identity_of(&study)?, Extent::Guest, is_ours, watch)?;
        results.write_json(FILE, &certificate)?;
        results.amend_manifest()?;
        results
    } else {
        let job = Job::of_study(&KIND, &study, &out, &order)?;
        job.make(watch, |results| Ok(results.write_json(FILE, &certificate)?))?.1
    };
    results.finish()?;
    watch.result(&certificate.to_string())?;
    watch.result(&where_results_are(&out)?)?;
    watch.answered(&out.join(FILE))?;
    Ok(certificate)
}

/// The certificate of the damper in the scene of a study, under the study's objective.
///
/// # Errors
/// There is no damper, or the design has no value.
pub fn certify(study: &Study) -> Result<Certificate, Error> {
    Ok(complete(study, measure::measure(study, damper_of(study)?, OtherStarts::Always)?))
}

/// Completes the certificate of a study's damper with the values for other walls and other records.
pub(crate) fn complete(study: &Study, certificate: Certificate) -> Certificate {
    let records = records::other_records(study, certificate.value);
    Certificate { records, ..between_other_walls(study, certificate) }
}

/// A certificate with the value between other walls.
pub(crate) fn between_other_walls(study: &Study, certificate: Certificate) -> Certificate {
    let (value, sensitivity) = (certificate.value, &certificate.measured.sensitivity);
    let walls = walls::other_walls(study, value, sensitivity, certificate.strikes());
    Certificate { walls, ..certificate }
}

/// Recomputes the certificate of the damper of a study.
fn of_study(place: &Path, name: &str) -> Result<Recomputed, Error> {
    let study = study::read(&place.join(resolved::ONE))?;
    Ok(recompute(&study, json(place, name)?))
}

/// Recomputes the certificate of the damper in the scene of a study, to compare it with `stored`.
pub(crate) fn recompute(study: &Study, stored: serde_json::Value) -> Recomputed {
    match certify(study) {
        Ok(recomputed) => {
            Recomputed::Part { what: "all of it", stored, recomputed: serde_json::json!(recomputed) }
        }
        Err(error) => Recomputed::Failed(format!("cannot be made again: {error}")),
    }
}

/// A certificate as far as the verdict needs it: starts other than rest only where they decide it, and no other walls.
pub fn judge(study: &Study) -> Result<Certificate, Error> {
    measure::measure(study, damper_of(study)?, OtherStarts::WhereTheyDecide)
}

/// As [`judge`], but in seconds even with contacts that lose energy, where derivatives are slow: a few other starts are run, no branch is
/// followed, and the force is not raised.
pub fn judge_in_seconds(study: &Study) -> Result<Certificate, Error> {
    measure::measure(study, damper_of(study)?, OtherStarts::FewWhereTheyDecide)
}

fn damper_of(study: &Study) -> Result<&Damper, Error> {
    study.begins_at_rest().map_err(Error::rule(study))?;
    study.scene.damper.as_ref().ok_or_else(|| {
        let allowed = "a damper, for that is what is certified";
        Error::rule(study)(Rule::not_allowed("scene.damper", "none", allowed))
    })
}

/// Refuses the results of a search in `out` whose design breaks the limits of its study by [`Error::Infeasible`].
pub fn check_limits_in(out: &Path, study: &str) -> Result<(), Error> {
    let text = std::fs::read_to_string(out.join(FILE)).unwrap_or_default();
    let stored: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    match (stored.get("verdict"), stored["words"].as_str()) {
        (Some(serde_json::Value::Null), Some(words)) => {
            Err(Error::Infeasible { name: study.to_owned(), words: words.to_owned() })
        }
        _ => Ok(()),
    }
}
