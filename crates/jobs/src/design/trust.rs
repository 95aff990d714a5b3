//! Selects the result of a search that is compared, and rates how far a damper can be trusted.

use super::candidate::{Candidate, What, with_design};
use super::ssvi;
use crate::certify::{Certificate, Verdict, judge, judge_in_seconds};
use crate::{Error, Observer};
use retune_model::Parameter;
use retune_study::Study;

/// Designs whose goal is larger by less than this share are nearly as good: among them the best certificate decides.
const NEARLY: f64 = 0.15;
/// Most designs that are certified: a certificate with motions from other starts takes seconds.
const JUDGED: usize = 2;

/// The results of a search that can be run and strike a wall, if only in the transient from rest; others are TMDs. The best first, each
/// with the value of the search; evaluated lazily.
pub(super) fn striking<'a>(
    study: &'a Study,
    found: &'a ssvi::Ends,
) -> impl Iterator<Item = Result<(f64, Candidate), Error>> + 'a {
    let measured = |(value, end): &'a (f64, Vec<f64>)| -> Result<Option<(f64, Candidate)>, Error> {
        let place = |parameter: Parameter| Parameter::PAPER.iter().position(|own| *own == parameter);
        let study = with_design(study, |parameter| place(parameter).map_or(f64::NAN, |i| end[i]))?;
        let steady = Candidate::new(What::Ssvi, &study).ok();
        let all = steady.and_then(|of| if of.strikes() { Some(of) } else { of.with_start().ok() });
        Ok(all.filter(Candidate::strikes).map(|candidate| (*value, candidate)))
    };
    found.ends.iter().filter_map(move |end| measured(end).transpose())
}

/// The first candidate that keeps the limits on all samples, since the best on the few samples of a search may not; else the first.
pub(super) fn first_feasible(
    all: &mut dyn Iterator<Item = Result<(f64, Candidate), Error>>,
) -> Result<Option<(f64, Candidate)>, Error> {
    let mut first = None;
    for found in all {
        let found = found?;
        if found.1.feasible {
            return Ok(Some(found));
        }
        first.get_or_insert(found);
    }
    Ok(first)
}

/// Rank of the verdict: 0 for the best, larger for less trust.
pub(super) fn doubt(certificate: &Certificate) -> u8 {
    match certificate.judged.verdict {
        Some(Verdict::Robust) => 0,
        Some(Verdict::Edge) => 1,
        Some(Verdict::FromRest) => 2,
        Some(Verdict::Sensitive) => 3,
        Some(Verdict::SingleChaoticRealisation) | None => 4,
    }
}

/// Whether the only objection is sensitivity to small errors of a predictable motion, whose effect is known.
pub(super) fn is_sensitive(certificate: &Certificate) -> bool {
    certificate.judged.verdict == Some(Verdict::Sensitive) && certificate.judged.predictable
}

/// The largest value within 1 % of each parameter, of 95 % of the neighbours, on more samples, and of motions from other starts. It may be
/// a multiple of the design's value and still far below that of another damper.
pub(super) fn worst_nearby(certificate: &Certificate) -> f64 {
    let measured = &certificate.measured;
    let motion = measured.motions.as_ref().and_then(|motions| motions.largest.as_ref());
    let others = motion.map(|other| other.value.value).into_iter().chain(measured.finer);
    let worst = measured.sensitivity.iter().map(|of| of.worst).chain(others);
    worst.fold(measured.neighbourhood.high, f64::max)
}

/// The certificate of a candidate, limited to what takes seconds.
pub(super) fn certified(study: &Study) -> Result<Certificate, Error> {
    if ssvi::is_lossy(&study.scene) { judge_in_seconds(study) } else { judge(study) }
}

/// Among designs nearly as good as the first, the one with the best certificate; a robust one ends the search.
pub(super) fn trusted(
    first: (f64, Candidate),
    others: impl Iterator<Item = Result<(f64, Candidate), Error>>,
    watch: &dyn Observer,
) -> Result<(Candidate, Certificate), Error> {
    let (least, first) = first;
    let bar = watch.progress("certificate of the SSVI NES", JUDGED as u64);
    let certificate = certified(&first.study)?;
    bar.inc(1);
    let mut best = (first, certificate);
    let mut others = others.take(JUDGED - 1);
    while doubt(&best.1) > 0
        && let Some((value, candidate)) = others.next().transpose()?
        && candidate.feasible
        && value <= (1.0 + NEARLY) * least
    {
        let certificate = certified(&candidate.study)?;
        bar.inc(1);
        if doubt(&certificate) < doubt(&best.1) {
            best = (candidate, certificate);
        }
    }
    bar.finish();
    Ok(best)
}
