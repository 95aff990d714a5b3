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

use crate::again::{Made, json};
use crate::artefact::Kind;
use crate::job::{Job, open, where_results_are};
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

/// The files of a certificate that does not stand beside the search that found its design.
pub static KIND: Kind = Kind {
    command: "certify",
    answer: FILE,
    input: resolved::ONE,
    rows: &[],
    whole: &[(FILE, of_study)],
    derived: &[],
};

/// Certifies the design of a study, or the one that a search found: `request.study` is a study, an `optimum.json`, or the directory of
/// a search's results. The certificate goes beside an optimum, or to `results/certify/<study>`, unless told otherwise.
///
/// # Errors
/// The input is wrong, the design cannot be run, or the certificate cannot be written.
pub fn certify_file(request: &Request, watch: &dyn Observer) -> Result<Certificate, Error> {
    let (study, found_in) = (study::read(&request.study)?, study::found_in(&request.study)?);
    let out = request.out.clone().or(found_in.clone());
    let out = out.unwrap_or_else(|| Path::new("results/certify").join(study.name()));
    // Beside the search that found the design, whose study and manifest stay.
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

/// A certificate of the damper of a study that has all but the value between other walls, with that too.
pub(crate) fn complete(study: &Study, certificate: Certificate) -> Certificate {
    let (own, sensitivity) = (certificate.value, &certificate.measured.sensitivity);
    let walls = walls::other_walls(study, own, sensitivity, certificate.strikes());
    Certificate { walls, records: records::other_records(study, own), ..certificate }
}

/// The certificate of the damper of a study, made again.
fn of_study(place: &Path, name: &str) -> Result<Made, Error> {
    let study = study::read(&place.join(resolved::ONE))?;
    Ok(again(&study, json(place, name)?))
}

/// A certificate of the damper in the scene of a study, made again beside what a file says.
pub(crate) fn again(study: &Study, said: serde_json::Value) -> Made {
    match certify(study) {
        Ok(again) => Made::Of { what: "all of it", said, again: serde_json::json!(again) },
        Err(error) => Made::Not(format!("cannot be made again: {error}")),
    }
}

/// The same as far as the verdict goes: other starts than rest are not looked at where it is decided without, nor are other walls.
pub fn judge(study: &Study) -> Result<Certificate, Error> {
    measure::measure(study, damper_of(study)?, OtherStarts::WhereTheyDecide)
}

/// The same in seconds where contacts lose energy too, through which derivatives take long: what a few other starts lead to is looked at, and
/// no branch is followed, nor the force raised.
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
    let said: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    match (said.get("verdict"), said["words"].as_str()) {
        (Some(serde_json::Value::Null), Some(words)) => {
            Err(Error::Infeasible { name: study.to_owned(), words: words.to_owned() })
        }
        _ => Ok(()),
    }
}
