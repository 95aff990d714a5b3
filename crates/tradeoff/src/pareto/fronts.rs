//! The designs of `fronts`: searched for, compared, certified.
//!
//! Every search finds a design. Afterwards all designs of a damper are evaluated on more samples of the band, and under each bound
//! stands the best that keeps it, whichever search found it: so a looser bound is never worse.

use super::candidate::{Candidate, SAME, by_excess};
use retune_model::{Design, Variable};
use retune_optim::Limit;
use retune_study::{self as study, FrontsPlan, PerVariable, Study, Sweep};
use retune_workbench::certify::{Certificate, certify};
use retune_workbench::designs::quoted;
use retune_workbench::look::{finer, look};
use retune_workbench::searches::Searches;
use retune_workbench::{Error, Observer};

/// A search keeps this much below a limit of stroke, for between its samples a stroke may be a little larger.
const ROOM: f64 = 0.99;
/// The verdict of a damper that no search found.
const GIVEN: &str = "of the study";

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
    /// Makes all searches, the tighter bounds first.
    pub(super) fn search(
        plan: FrontsPlan,
        searches: &mut Searches,
        watch: &dyn Observer,
    ) -> Result<Self, Error> {
        let mut fronts = Self { plan, designs: Vec::new(), given: Vec::new(), certified: Vec::new() };
        for damper in 0..fronts.plan.dampers.len() {
            let (name, study) = fronts.plan.dampers[damper].clone();
            if let Some(place) = study.scene.damper {
                let at = Design::of(&place);
                fronts.given.extend(fronts.look(damper, at, GIVEN));
            }
            for sweep in Sweep::ALL {
                for bound in fronts.plan.values(sweep) {
                    let room = if sweep == Sweep::Stroke { ROOM } else { 1.0 };
                    let starts = fronts.starts(damper, sweep, bound);
                    let refuse = |rule| Error::Rule { name: study.name().to_owned(), rule };
                    let study = study::bounded(&study, sweep, room * bound, starts).map_err(refuse)?;
                    let (what, unit) = (sweep.name(), sweep.unit());
                    watch.log(&format!("\n{name}, {what} at most {bound} {unit}"))?;
                    let optimum = searches.tune(&study, &format!("{what}-{bound}"))?;
                    watch.log(&optimum.report())?;
                    let at = optimum.found().damper.design;
                    fronts.designs.extend(fronts.look(damper, at, optimum.verdict()));
                }
            }
        }
        fronts.certified = fronts.certify()?;
        Ok(fronts)
    }

    /// The designs at which a search starts: the best so far of the damper itself, and of those before it, under the bound.
    fn starts(&self, damper: usize, sweep: Sweep, bound: f64) -> Vec<PerVariable<f64>> {
        let best = (0..=damper).filter_map(|other| {
            let own = self.designs.iter().filter(|design| design.damper == other);
            own.min_by(|a, b| by_excess(a, b, sweep, bound))
        });
        let Some(optimize) = &self.plan.dampers[damper].1.optimize else { return Vec::new() };
        let clipped = |design: &Candidate| {
            let mut start = PerVariable::default();
            for (variable, value) in Variable::ALL.into_iter().zip(design.at.values()) {
                if optimize.vary.contains(&variable) {
                    let (low, high) = optimize.bounds.get(variable).unwrap_or((0.0, None));
                    let bound =
                        if (sweep, variable) == (Sweep::K2, Variable::K2) { Some(bound) } else { high };
                    *start.get_mut(variable) = Some(value.min(bound.unwrap_or(value)).max(low));
                }
            }
            start
        };
        best.map(clipped).collect()
    }

    /// A design on the samples of the study of fronts; none where it cannot be run.
    fn look(&self, damper: usize, at: Design, verdict: &'static str) -> Option<Candidate> {
        let found = look(&self.finer(damper, &at)?)?;
        let [stroke, force] = [Limit::Stroke, Limit::Force].map(|limit| found.reached.get(limit));
        Some(Candidate { damper, at, e1_max: found.energy, stroke, force, verdict })
    }

    /// The study of a damper with a design in its scene, its bands on the samples of the study of fronts.
    fn finer(&self, damper: usize, at: &Design) -> Option<Study> {
        let (_, study) = self.plan.dampers.get(damper)?;
        finer(study, self.plan.said.samples, at)
    }

    /// The best designs under each bound, the dampers in their order under each.
    pub fn rows(&self, sweep: Sweep) -> Vec<Row<'_>> {
        let row = |bound: f64, damper: usize| {
            let kept = |design: &&Candidate| design.damper == damper && design.excess(sweep, bound) == 0.0;
            let all = self.designs.iter().chain(&self.given);
            let design = all.filter(kept).min_by(|a, b| a.e1_max.total_cmp(&b.e1_max));
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
    fn certify(&self) -> Result<Vec<Certified>, Error> {
        let mut gains: Vec<(f64, Sweep, f64, &Candidate, Option<f64>)> = Vec::new();
        for row in Sweep::ALL.into_iter().flat_map(|sweep| self.rows(sweep)).filter(|row| row.damper > 0) {
            let reference = self.reference(&row);
            let Some(design) = row.design.filter(|design| design.force > 0.0 && design.verdict != GIVEN)
            else {
                continue;
            };
            let share = reference.map_or(0.0, |reference| design.e1_max / reference);
            if share < 1.0 - SAME && gains.iter().all(|(.., other, _)| !other.is_like(design)) {
                gains.push((share, row.sweep, row.bound, design, reference));
            }
        }
        gains.sort_by(|a, b| a.0.total_cmp(&b.0));
        gains.truncate(self.plan.said.certificates);
        let mut certified = Vec::new();
        for (_, sweep, bound, design, reference) in gains {
            let Some(study) = self.finer(design.damper, &design.at) else { continue };
            let file = format!("certificate-{}-{bound}.json", sweep.name());
            let (design, certificate) = (design.clone(), certify(&study)?);
            certified.push(Certified { sweep, bound, design, reference, file, certificate });
        }
        Ok(certified)
    }

    /// The least E1max of the first damper under the bound of a row, J.
    pub fn reference(&self, row: &Row) -> Option<f64> {
        let rows = self.rows(row.sweep);
        let own = rows.iter().find(|other| other.damper == 0 && other.bound == row.bound);
        Some(own?.design?.e1_max)
    }

    /// The table along a bound: a row for each bound and damper; what no design keeps has empty fields.
    pub fn csv(&self, sweep: Sweep) -> String {
        let mut text = format!("{}_most,damper,E1max,k2,c2,D,C,stroke,force,verdict\n", sweep.name());
        for Row { bound, damper, design, .. } in self.rows(sweep) {
            let fields = design.map_or(",,,,,,,none keeps it".to_owned(), Candidate::fields);
            text += &format!("{bound},{},{fields}\n", quoted(self.name(damper)));
        }
        text
    }

    /// The table of [`Self::front`].
    pub fn front_csv(&self) -> String {
        let rows = self
            .front()
            .into_iter()
            .map(|design| format!("{},{}\n", quoted(self.name(design.damper)), design.fields()));
        format!("damper,E1max,k2,c2,D,C,stroke,force,verdict\n{}", rows.collect::<String>())
    }
}
