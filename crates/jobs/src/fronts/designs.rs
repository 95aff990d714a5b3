//! The designs of `fronts`: searched for, compared, certified.
//!
//! Every search finds a design. Afterwards all designs of a damper are evaluated on more samples of the band, and under each bound
//! stands the best that keeps it, whichever search found it: so a looser bound is never worse.

use super::candidate::{Candidate, SAME};
use crate::Error;
use crate::again::{Made, json};
use crate::certify::{Certificate, certify};
use crate::columns;
use crate::needs::Largest;
use crate::resolved::Resolved;
use crate::tune::objective::finer;
use rayon::prelude::*;
use retune_model::{Design, Measure, Parameter};
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_study::{FrontsPlan, Study, Sweep};
use std::fmt::Display;
use std::path::Path;

/// The verdict of a damper that no search found.
pub(super) const GIVEN: &str = "of the study";

/// Most samples of a band that a certificate begins with.
const MOST: usize = 121;

/// What a table tells of the structure beside the stroke and the force of a design: the largest values from rest on.
pub(super) const NEEDS: [Measure; 3] = [Measure::Displacement, Measure::Acceleration, Measure::GroundForce];

/// The best design of a damper under a bound; none where no design that was found keeps it.
#[derive(Debug)]
pub struct Row<'a> {
    /// The bounded quantity.
    pub sweep: Sweep,
    /// The bound, in the unit of the sweep.
    pub bound: f64,
    /// The index of the damper.
    pub damper: usize,
    /// Its best design.
    pub design: Option<&'a Candidate>,
}

/// The designs that all searches found.
#[derive(Debug)]
pub struct Fronts {
    /// The plan of the study of fronts.
    pub plan: FrontsPlan,
    /// Those of the searches, in their order.
    pub designs: Vec<Candidate>,
    /// The dampers in the scenes of the studies, where they can be run.
    pub given: Vec<Candidate>,
    /// What the structure does without a damper, from rest on.
    pub none: Option<Largest>,
    /// The certificates of the designs that are furthest below the first damper under the same bound, each value once.
    pub certified: Vec<Certified>,
}

/// A design that is certified: below the best of the first damper under the same bound.
#[derive(Debug)]
pub struct Certified {
    /// The bounded quantity.
    pub sweep: Sweep,
    /// The bound, in the unit of the sweep.
    pub bound: f64,
    /// The design.
    pub design: Candidate,
    /// The least E1max of the first damper under this bound, J.
    pub reference: Option<f64>,
    /// The name of the certificate's file.
    pub file: String,
    /// The certificate.
    pub certificate: Certificate,
}

impl Fronts {
    /// No design yet.
    pub(super) fn new(plan: FrontsPlan) -> Self {
        Self { plan, designs: Vec::new(), given: Vec::new(), none: None, certified: Vec::new() }
    }

    /// The number of the design found that is the best of a damper under a bound; none where none keeps it. Of those as good, the best
    /// that is not known to do much worse from other starts than rest, nor is nearly one that does.
    pub(super) fn row_index(&self, damper: usize, sweep: Sweep, bound: f64) -> Option<usize> {
        let keeps = |design: &Candidate| design.damper == damper && design.excess(sweep, bound) == 0.0;
        let mut kept: Vec<usize> = (0..self.designs.len()).filter(|&i| keeps(&self.designs[i])).collect();
        kept.sort_by(|&a, &b| self.designs[a].known().total_cmp(&self.designs[b].known()));
        let most = (1.0 + SAME) * self.designs[*kept.first()?].known();
        let unsafe_ones = || self.designs.iter().filter(|design| design.is_unsafe());
        let is_safe = |i: &&usize| !unsafe_ones().any(|other| other.is_nearly(&self.designs[**i]));
        let mut as_good = kept.iter().take_while(|&&i| self.designs[i].known() <= most);
        as_good.find(is_safe).or(kept.first()).copied()
    }

    /// The best designs under each bound, the dampers in their order under each.
    pub fn rows(&self, sweep: Sweep) -> Vec<Row<'_>> {
        let row = |bound: f64, damper: usize| {
            let kept = |design: &&Candidate| design.damper == damper && design.excess(sweep, bound) == 0.0;
            let found = self.row_index(damper, sweep, bound).map(|number| &self.designs[number]);
            let given = self.given.iter().filter(kept).min_by(|a, b| a.known().total_cmp(&b.known()));
            let is_better = |given: &&Candidate| found.is_none_or(|found| given.known() < found.known());
            let design = given.filter(is_better).or(found);
            Row { sweep, bound, damper, design }
        };
        let dampers = 0..self.plan.dampers.len();
        let bounds = self.plan.values(sweep).into_iter();
        bounds.flat_map(|bound| dampers.clone().map(move |damper| row(bound, damper))).collect()
    }

    /// The designs that no other dominates in all of E1max, stroke, force and k2.
    pub fn front(&self) -> Vec<&Candidate> {
        let dominated = |design: &Candidate| self.designs.iter().any(|other| other.dominates(design));
        let mut front: Vec<&Candidate> = self.designs.iter().filter(|design| !dominated(design)).collect();
        front.sort_by(|a, b| a.e1_max.total_cmp(&b.e1_max));
        front.dedup();
        front
    }

    /// The name of a damper.
    pub fn name(&self, damper: usize) -> &str {
        self.plan.dampers.get(damper).map_or("", |(name, _)| name)
    }

    /// Whether a damper's response is in closed form, and so touches nothing.
    pub fn is_steady(&self, damper: usize) -> bool {
        let study = self.plan.dampers.get(damper).map(|(_, study)| study);
        study.is_some_and(|study| study.objective().is_steady())
    }

    /// Certifies the designs that are furthest below the first damper under the same bound, each value once.
    pub(super) fn certify(&self) -> Result<Vec<Certified>, Error> {
        let mut gains: Vec<(f64, Option<f64>, Row, &Candidate)> = Vec::new();
        let rows = self.plan.sweeps().into_iter().flat_map(|sweep| self.rows(sweep));
        for row in rows.filter(|row| row.damper > 0) {
            let strikes = |design: &&Candidate| design.force > 0.0 && design.verdict != GIVEN;
            let Some(design) = row.design.filter(strikes) else { continue };
            let reference = self.reference(&row);
            let share = reference.map_or(0.0, |reference| design.e1_max / reference);
            if share < 1.0 - SAME && gains.iter().all(|(.., other)| !other.is_like(design)) {
                gains.push((share, reference, row, design));
            }
        }
        gains.sort_by(|a, b| a.0.total_cmp(&b.0));
        gains.truncate(self.plan.said.certificates);
        let certified = |(_, reference, row, design): &(f64, Option<f64>, Row, &Candidate)| {
            let (_, study) = &self.plan.dampers[design.damper];
            let study = certifiable(study, self.plan.said.samples, &design.at)?;
            let Row { sweep, bound, .. } = *row;
            let (reference, design) = (*reference, Candidate::clone(design));
            let file = format!("certificate-{}-{bound}.json", sweep.name());
            let certificate = certify(&study);
            Some(certificate.map(|certificate| Certified {
                sweep,
                bound,
                design,
                reference,
                file,
                certificate,
            }))
        };
        let certified: Vec<Option<Result<Certified, Error>>> = gains.par_iter().map(certified).collect();
        certified.into_iter().flatten().collect()
    }

    /// The least E1max of the first damper under the bound of a row, J.
    pub fn reference(&self, row: &Row) -> Option<f64> {
        let rows = self.rows(row.sweep);
        let own = rows.iter().find(|other| other.damper == 0 && other.bound == row.bound);
        Some(own?.design?.e1_max)
    }

    /// The parameters that tables have columns for: the paper's, what else a study varies, and what a known design has otherwise than its
    /// study.
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

    /// The table along a bound: a row for each bound and damper; what no design keeps has empty fields.
    pub fn table(&self, sweep: Sweep) -> Table {
        let parameters = self.parameters();
        let (bound, designs) = (format!("{}_most", sweep.name()), Candidate::names(&parameters));
        let needs = NEEDS.map(Measure::name);
        let mut table = columns::table(&[&[&*bound, "damper"], &*designs, &needs, &["verdict"]].concat());
        for Row { bound, damper, design, .. } in self.rows(sweep) {
            let cells = match design {
                None => [vec![Cell::Empty; designs.len() + needs.len()], cells!["none keeps it"]],
                Some(design) => {
                    let need = |measure| Cell::from(design.needs.map(|needs| needs.value(measure)));
                    let needs = NEEDS.map(need).into_iter().chain([design.verdict.into()]);
                    [design.cells(&parameters), needs.collect()]
                }
            };
            table.push([cells![bound, self.name(damper)], cells.concat()].concat());
        }
        table
    }

    /// The table of [`Self::front`].
    pub fn front_table(&self) -> Table {
        let parameters = self.parameters();
        let mut table =
            columns::table(&[&["damper"], &*Candidate::names(&parameters), &["verdict"]].concat());
        for design in self.front() {
            let name = cells![self.name(design.damper)];
            table.push([name, design.cells(&parameters), cells![design.verdict]].concat());
        }
        table
    }
}

/// A bound in words: `k2 at most 400 N/m`.
pub(super) fn at_most(sweep: Sweep, bound: impl Display) -> String {
    format!("{} at most {bound} {}", sweep.name(), sweep.unit())
}

/// The certificate of a design, made again.
///
/// # Errors
/// The file cannot be read.
pub(super) fn again(place: &Path, name: &str) -> Result<Made, Error> {
    let said = json(place, name)?;
    let resolved = Resolved::read(place)?;
    let samples = resolved.plan["samples"].as_u64().map(|samples| samples as usize);
    let studies = resolved.studies()?;
    let certified = || {
        let (_, study) = studies.iter().find(|(_, study)| said["study"] == study.name())?;
        certifiable(study, samples?, &crate::again::design(&said["design"])?)
    };
    Ok(match certified() {
        Some(study) => crate::certify::again(&study, said),
        None => Made::Not("is of none of the studies".to_owned()),
    })
}

/// The study that a design is certified by: on the samples of the study of fronts, or fewer, since a certificate looks at a hundred designs
/// and at four times the samples.
fn certifiable(study: &Study, samples: usize, at: &Design) -> Option<Study> {
    finer(study, samples.min(MOST), at)
}
