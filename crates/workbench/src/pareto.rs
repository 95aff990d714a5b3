//! `fronts`: what a damper is good for. The least E1max under ever looser bounds on the spring and on the stroke, and the trade
//! between them.
//!
//! Every search makes a design. Afterwards all designs of a damper are looked at again on more samples of the band, and the best
//! that keeps a bound stands for it, whichever search it came from: so a looser bound is never worse.

mod design;
mod draw;
mod page;

pub use design::{energy, finer};

use crate::certify::{Certificate, certify};
use crate::designs::quoted;
use crate::request::{open, where_results_are};
use crate::resolved::{self, Resolved};
use crate::tune::optimize;
use crate::{Error, Observer, Request};
use design::{Candidate, SAME, by_excess, look};
use retune_model::{Design, Variable};
use retune_optim::Limit;
use retune_store::{Directory, Extent, Identity, Order, manifest};
use retune_study::{self as study, FrontsPlan, PerVariable, Study, Sweep};
use serde_json::json;

/// A search keeps this much below a limit of stroke, for between its samples a stroke may be a little larger.
const ROOM: f64 = 0.99;
/// The verdict of a damper that no search found.
const GIVEN: &str = "of the study";

/// The best design of a damper under a bound; none where no design that was found keeps it.
struct Row<'a> {
    sweep: Sweep,
    bound: f64,
    damper: usize,
    design: Option<&'a Candidate>,
}

/// All that was found.
struct Fronts {
    plan: FrontsPlan,
    /// What the searches found, in their order.
    designs: Vec<Candidate>,
    /// The dampers in the scenes of the studies, where they can be run.
    given: Vec<Candidate>,
}

/// A design that is certified: below the best of the first damper under the same bound.
struct Certified<'a> {
    row: Row<'a>,
    rival: Option<f64>,
    file: String,
    certificate: Certificate,
}

/// Tunes each damper under each bound, and shows what it is good for.
///
/// # Errors
/// A study is wrong, nothing can be computed, or the results cannot be written.
pub fn pareto(request: &Request, watch: &dyn Observer) -> Result<(), Error> {
    let plan = study::read_fronts(&request.study)?;
    let (out, order) = (request.out_of_file()?, request.order("fronts"));
    let dampers = plan.dampers.iter().map(|(name, study)| (name.as_str(), study));
    let resolved = Resolved::new(json!(plan.said), dampers).text()?;
    let solvers: Vec<_> = plan.dampers.iter().map(|(_, study)| study.solver).collect();
    let identity = Identity::of(&resolved);
    let directory = open(&out, &order, &identity, Extent::Whole, is_ours, watch)?;
    request.on_threads(|| {
        let (fronts, parts) = Fronts::search(plan, &directory, &order, watch)?;
        for sweep in Sweep::ALL {
            directory.write(&format!("{}.csv", sweep.name()), &fronts.csv(sweep))?;
            directory.write(&format!("{}.svg", sweep.name()), &draw::sweep(&fronts, sweep))?;
        }
        directory.write("front.csv", &fronts.front_csv())?;
        directory.write("front.svg", &draw::front(&fronts))?;
        let certified = fronts.certify()?;
        for Certified { file, certificate, .. } in &certified {
            directory.write_json(file, certificate)?;
        }
        directory.write("README.md", &page::page(&fronts, &certified))?;
        directory.write(resolved::NAME, &resolved)?;
        manifest::write(identity, solvers, &directory)?;
        directory.publish()?;
        parts.into_iter().try_for_each(Directory::finish)?;
        directory.finish()?;
        watch.result(&format!("\n{}", page::answer(&fronts)))?;
        watch.result(&where_results_are(&out)?)
    })
}

fn is_ours(name: &str) -> bool {
    const NAMES: [&str; 9] = [
        "k2.csv",
        "k2.svg",
        "stroke.csv",
        "stroke.svg",
        "front.csv",
        "front.svg",
        "README.md",
        resolved::NAME,
        manifest::NAME,
    ];
    NAMES.contains(&name) || (name.starts_with("certificate-") && name.ends_with(".json"))
}

impl Fronts {
    /// Makes all searches, the tighter bounds first.
    fn search(
        plan: FrontsPlan,
        directory: &Directory,
        order: &Order,
        watch: &dyn Observer,
    ) -> Result<(Self, Vec<Directory>), Error> {
        let mut fronts = Self { plan, designs: Vec::new(), given: Vec::new() };
        let mut parts = Vec::new();
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
                    let place = directory.part(&format!("{what}-{bound}/{}", study.name()));
                    let (optimum, results) = optimize(&study, &place, order, watch)?;
                    parts.push(results);
                    watch.log(&optimum.report())?;
                    let at = optimum.found().damper.design;
                    fronts.designs.extend(fronts.look(damper, at, optimum.verdict()));
                }
            }
        }
        Ok((fronts, parts))
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
    fn rows(&self, sweep: Sweep) -> Vec<Row<'_>> {
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

    /// The designs that no other beats in all of E1max, stroke, force and k2.
    fn front(&self) -> Vec<&Candidate> {
        let beaten = |design: &Candidate| self.designs.iter().any(|other| other.beats(design));
        let mut front: Vec<&Candidate> = self.designs.iter().filter(|design| !beaten(design)).collect();
        front.sort_by(|a, b| a.e1_max.total_cmp(&b.e1_max));
        front.dedup();
        front
    }

    fn name(&self, damper: usize) -> &str {
        self.plan.dampers.get(damper).map_or("", |(name, _)| name)
    }

    /// Whether a damper's response is in closed form, and so touches nothing.
    fn is_steady(&self, damper: usize) -> bool {
        let study = self.plan.dampers.get(damper).map(|(_, study)| study);
        study.is_some_and(|study| study.objective().is_steady())
    }

    /// Certifies the designs that are furthest below the first damper under the same bound, each value once.
    fn certify(&self) -> Result<Vec<Certified<'_>>, Error> {
        let mut gains: Vec<(f64, Row, Option<f64>)> = Vec::new();
        for row in Sweep::ALL.into_iter().flat_map(|sweep| self.rows(sweep)).filter(|row| row.damper > 0) {
            let rival = self.rival(&row);
            let Some(design) = row.design.filter(|design| design.force > 0.0 && design.verdict != GIVEN)
            else {
                continue;
            };
            let share = rival.map_or(0.0, |rival| design.e1_max / rival);
            if share < 1.0 - SAME
                && gains.iter().all(|(_, other, _)| !other.design.is_some_and(|other| other.is_like(design)))
            {
                gains.push((share, row, rival));
            }
        }
        gains.sort_by(|a, b| a.0.total_cmp(&b.0));
        gains.truncate(self.plan.said.certificates);
        let mut certified = Vec::new();
        for (_, row, rival) in gains {
            let Some(study) = row.design.and_then(|design| self.finer(row.damper, &design.at)) else {
                continue;
            };
            let file = format!("certificate-{}-{}.json", row.sweep.name(), row.bound);
            certified.push(Certified { row, rival, file, certificate: certify(&study)? });
        }
        Ok(certified)
    }

    /// The least E1max of the first damper under the bound of a row, J.
    fn rival(&self, row: &Row) -> Option<f64> {
        let rows = self.rows(row.sweep);
        let own = rows.iter().find(|other| other.damper == 0 && other.bound == row.bound);
        Some(own?.design?.e1_max)
    }

    /// A row for each bound and damper; what no design keeps has empty fields.
    fn csv(&self, sweep: Sweep) -> String {
        let mut text = format!("{}_most,damper,E1max,k2,c2,D,C,stroke,force,verdict\n", sweep.name());
        for Row { bound, damper, design, .. } in self.rows(sweep) {
            let fields = design.map_or(",,,,,,,none keeps it".to_owned(), Candidate::fields);
            text += &format!("{bound},{},{fields}\n", quoted(self.name(damper)));
        }
        text
    }

    fn front_csv(&self) -> String {
        let rows = self
            .front()
            .into_iter()
            .map(|design| format!("{},{}\n", quoted(self.name(design.damper)), design.fields()));
        format!("damper,E1max,k2,c2,D,C,stroke,force,verdict\n{}", rows.collect::<String>())
    }
}
