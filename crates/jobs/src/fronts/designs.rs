//! The designs of `fronts`: the best under each bound, their tables and certificates.
//!
//! All designs of a damper are evaluated on more samples of the band than in the searches. Each bound gets the best design that keeps it,
//! whichever search found it, so a looser bound is never worse.

use super::candidate::{CONTINUED, Candidate, SAME, Under};
use crate::Error;
use crate::Observer;
use crate::certify::{Certificate, certify};
use crate::columns;
use crate::needs::Largest;
use crate::recompute::{Recomputed, json};
use crate::resolved::Resolved;
use crate::rows::in_a_stage;
use crate::tune::objective::with_samples;
use retune_model::{Design, Measure, Parameter};
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_study::{FrontsPlan, Study, Sweep};
use std::path::Path;

/// The verdict of a study's damper, which no search found.
pub(super) const GIVEN: &str = "of the study";

/// Most samples of the band for a certificate.
const MOST: usize = 121;

/// The largest values of the structure from rest on that tables have besides stroke and force.
pub(super) const NEEDS: [Measure; 3] = [Measure::Displacement, Measure::Acceleration, Measure::GroundForce];

/// The best design of a damper under a bound; none where no design found keeps it.
pub type Row<'a> = (Under, Option<&'a Candidate>);

/// The designs that all searches found.
#[derive(Debug)]
pub struct Fronts {
    pub plan: FrontsPlan,
    /// The designs of the searches, in their order.
    pub designs: Vec<Candidate>,
    /// The dampers of the studies, where they can be run.
    pub given: Vec<Candidate>,
    /// The largest values of the structure without a damper, from rest on.
    pub none: Option<Largest>,
    /// The certified designs: those with the largest gain over the first damper under the same bound, each value once.
    pub certified: Vec<Certified>,
}

/// A certified design, better than the best of the first damper under the same bound.
#[derive(Debug)]
pub struct Certified {
    pub under: Under,
    pub design: Candidate,
    pub file: String,
    pub certificate: Certificate,
}

impl Fronts {
    /// The index of the best design found for a damper under a bound; none where none keeps it. Among equally good designs it is the best
    /// that is not, nor is close to, one known to be unsafe ([`Candidate::is_unsafe`]).
    pub(super) fn found(&self, under: Under) -> Option<usize> {
        let mut kept: Vec<usize> =
            (0..self.designs.len()).filter(|&i| self.designs[i].keeps(under)).collect();
        kept.sort_by(|&a, &b| self.designs[a].known().total_cmp(&self.designs[b].known()));
        let most = (1.0 + SAME) * self.designs[*kept.first()?].known();
        let unsafe_ones = || self.designs.iter().filter(|design| design.is_unsafe());
        let is_safe = |i: &&usize| !unsafe_ones().any(|other| other.is_nearly(&self.designs[**i]));
        let mut as_good = kept.iter().take_while(|&&i| self.designs[i].known() <= most);
        as_good.find(is_safe).or(kept.first()).copied()
    }

    /// The best design under a bound, including the study's damper.
    fn row(&self, under: Under) -> Option<&Candidate> {
        let found = self.found(under).map(|number| &self.designs[number]);
        let kept = self.given.iter().filter(|given| given.keeps(under));
        let given = kept.min_by(|a, b| a.known().total_cmp(&b.known()));
        let is_better = |given: &&Candidate| found.is_none_or(|found| given.known() < found.known());
        given.filter(is_better).or(found)
    }

    /// The best designs of all dampers, bound by bound.
    pub fn rows(&self, sweep: Sweep) -> Vec<Row<'_>> {
        let row = |under: Under| (under, self.row(under));
        let dampers = 0..self.plan.dampers.len();
        let bounds = self.plan.values(sweep).into_iter();
        let all = bounds.flat_map(|bound| dampers.clone().map(move |damper| Under { damper, sweep, bound }));
        all.map(row).collect()
    }

    /// The designs that no other dominates in all of E1max, stroke, force and k2.
    pub fn front(&self) -> Vec<&Candidate> {
        let dominated = |design: &Candidate| self.designs.iter().any(|other| other.dominates(design));
        let mut front: Vec<&Candidate> = self.designs.iter().filter(|design| !dominated(design)).collect();
        // Of one design that several searches found, the one with a verdict.
        let rank = |design: &Candidate| (design.damper, design.verdict == CONTINUED);
        front.sort_by(|a, b| a.known().total_cmp(&b.known()).then(rank(a).cmp(&rank(b))));
        front.dedup_by(|a, b| a.damper == b.damper && a.at == b.at);
        front
    }

    pub fn name(&self, damper: usize) -> &str {
        self.plan.dampers.get(damper).map_or("", |(name, _)| name)
    }

    /// Whether a damper's response is steady, in closed form, and so touches no wall.
    pub fn is_steady(&self, damper: usize) -> bool {
        let study = self.plan.dampers.get(damper).map(|(_, study)| study);
        study.is_some_and(|study| study.objective().is_steady())
    }

    /// Certifies the designs with the largest gain over the first damper under the same bound, each value once.
    pub(super) fn certify(&self, watch: &dyn Observer) -> Result<Vec<Certified>, Error> {
        let mut gains: Vec<(f64, Under, &Candidate)> = Vec::new();
        let rows = self.plan.sweeps().into_iter().flat_map(|sweep| self.rows(sweep));
        for (under, design) in rows.filter(|(under, _)| under.damper > 0) {
            let strikes = |design: &&Candidate| design.force > 0.0 && design.verdict != GIVEN;
            let Some(design) = design.filter(strikes) else { continue };
            let share = self.reference(under).map_or(0.0, |reference| design.known() / reference);
            let is_like = |other: &Candidate| {
                other.damper == design.damper && (other.known() / design.known() - 1.0).abs() < SAME
            };
            if share < 1.0 - SAME && gains.iter().all(|(.., other)| !is_like(other)) {
                gains.push((share, under, design));
            }
        }
        gains.sort_by(|a, b| a.0.total_cmp(&b.0));
        gains.truncate(self.plan.said.certificates);
        let certified = |(_, under, design): &(f64, Under, &Candidate)| {
            let (_, study) = &self.plan.dampers[design.damper];
            let study = certifiable(study, self.plan.said.samples, &design.at);
            let Some(certificate) = study.map(|study| certify(&study)).transpose()? else { return Ok(None) };
            let file = format!("certificate-{}-{}.json", under.sweep.name(), under.bound);
            Ok(Some(Certified { under: *under, design: Candidate::clone(design), file, certificate }))
        };
        Ok(in_a_stage((watch, "certificates"), &gains, certified)?.into_iter().flatten().collect())
    }

    /// The least E1max of the first damper under a bound, J.
    pub fn reference(&self, under: Under) -> Option<f64> {
        Some(self.row(Under { damper: 0, ..under })?.known())
    }

    /// The parameters that tables have columns for: the paper's, others that a study varies, and those in which a known design differs from
    /// its study.
    pub fn parameters(&self) -> Vec<Parameter> {
        let studies = || self.plan.dampers.iter().map(|(_, study)| study);
        let has = |parameter: &Parameter| {
            let changed = |(damper, at): &(usize, Design)| {
                let value = at.get(*parameter);
                !value.is_nan() && parameter.of(&self.plan.dampers[*damper].1.scene) != Some(value)
            };
            studies().any(|study| study.varied().contains(parameter)) || self.plan.designs.iter().any(changed)
        };
        Parameter::columns(&Parameter::VARIED.into_iter().filter(has).collect::<Vec<_>>())
    }

    /// The table along a bound: a row for each bound and damper, with empty fields where no design keeps the bound.
    pub fn table(&self, sweep: Sweep) -> Table {
        let parameters = self.parameters();
        let (bound, designs) = (format!("{}_most", sweep.name()), Candidate::names(&parameters));
        let names = [&[&*bound, "damper"], &*designs, &NEEDS.map(Measure::name), &["verdict"]].concat();
        let row = |(under, design): Row| {
            let first = cells![under.bound, self.name(under.damper)];
            let Some(design) = design else {
                let empty = vec![Cell::Empty; designs.len() + NEEDS.len()];
                return [first, empty, cells!["none keeps it"]].concat();
            };
            let needs = NEEDS.map(|measure| design.needs.map(|needs| needs.value(measure)).into());
            [first, design.cells(&parameters), needs.into(), cells![design.verdict]].concat()
        };
        columns::table(&names).with(self.rows(sweep).into_iter().map(row))
    }

    /// The table of [`Self::front`].
    pub fn front_table(&self) -> Table {
        let parameters = self.parameters();
        let names = [&["damper"], &*Candidate::names(&parameters), &["verdict"]].concat();
        let row = |design: &Candidate| {
            [cells![self.name(design.damper)], design.cells(&parameters), cells![design.verdict]].concat()
        };
        columns::table(&names).with(self.front().into_iter().map(row))
    }
}

/// Recomputes the certificate of a design.
pub(super) fn recompute(place: &Path, name: &str) -> Result<Recomputed, Error> {
    let stored = json(place, name)?;
    let resolved = Resolved::read(place)?;
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    let studies = resolved.studies()?;
    let certified = || {
        let (_, study) = studies.iter().find(|(_, study)| stored["study"] == study.name())?;
        certifiable(study, samples?, &crate::recompute::design(&stored["design"])?)
    };
    Ok(match certified() {
        Some(study) => crate::certify::recompute(&study, stored),
        None => Recomputed::Failed("is of none of the studies".to_owned()),
    })
}

/// The study by which a design is certified: on the samples of the plan, at most [`MOST`], since a certificate evaluates a hundred designs
/// and four times the samples.
fn certifiable(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    with_samples(study, samples.min(MOST), at)
}
