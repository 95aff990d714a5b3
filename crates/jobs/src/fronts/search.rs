//! The searches of `fronts`: under each bound the study's search, then descents from its results, also with the neighbouring bounds.
//!
//! The best designs are evaluated again on the finest samples, by which designs are compared.

use super::candidate::{CONTINUED, Candidate, Under, at_most, by_excess};
use super::descents::Task;
use super::designs::{Fronts, GIVEN};
use crate::Error;
use crate::certify::judge;
use crate::needs::Largest;
use crate::rows::in_a_stage;
use crate::searches::Searches;
use crate::tune::ends::Ends;
use crate::tune::objective::{with_samples, worst};
use retune_model::{Design, Measure, Parameter, PerVariable, Scene};
use retune_optim::Limit;
use retune_store::Journal;
use retune_study::{FrontsPlan, Optimize, Study, Sweep, bounded, clipped};

/// Share of a limit that searches keep, since a stroke or a force may be slightly larger between samples.
const ROOM: f64 = 0.99;

pub(super) fn search(plan: FrontsPlan, searches: &Searches) -> Result<Fronts, Error> {
    let (designs, given, certified) = (Vec::new(), Vec::new(), Vec::new());
    let mut fronts = Fronts { plan, designs, given, none: None, certified };
    let count = fronts.plan.dampers.len();
    for damper in 0..count {
        let (_, study) = &fronts.plan.dampers[damper];
        let at = study.scene.damper.map(|place| Design::of_varied(&place, study.varied()));
        let given = at.and_then(|at| fronts.candidate(damper, at));
        fronts.given.extend(given.map(|given| Candidate { verdict: GIVEN, ..given }));
    }
    for (damper, at) in fronts.plan.designs.clone() {
        fronts.designs.extend(fronts.candidate(damper, at));
    }
    let mut tasks = Vec::new();
    for damper in 0..count {
        tasks.extend(fronts.tune(damper, searches)?);
    }
    fronts.descend_until_no_gain(tasks, searches)?;
    fronts.judge(searches)?;
    let bare = |(_, study): &(String, Study)| Largest::of(study, &Scene { damper: None, ..study.scene });
    fronts.none = fronts.plan.dampers.last().and_then(bare);
    fronts.certified = fronts.certify(searches.watch)?;
    Ok(fronts)
}

impl Fronts {
    /// Runs the searches of a damper under all bounds in parallel, and returns the descents from their results. A steady response is exact
    /// over the whole band, so its searches need no descents.
    fn tune(&mut self, damper: usize, searches: &Searches) -> Result<Vec<Task>, Error> {
        let bounds: Vec<Under> = self.all().into_iter().filter(|under| under.damper == damper).collect();
        let study = |under: &Under| Ok((self.under(*under, self.starts(*under))?, under.name()));
        let all = searches.ends_of_all(&bounds.iter().map(study).collect::<Result<Vec<_>, Error>>()?)?;
        let mut tasks = Vec::new();
        for (under, Ends { best, value, places }) in bounds.into_iter().zip(all) {
            let found =
                if value.is_nan() { "nothing that keeps it".to_owned() } else { format!("{value:.2} J") };
            searches.watch.log(&format!(
                "{}, {}: {found}",
                self.name(damper),
                at_most(under.sweep, under.bound)
            ))?;
            self.designs.extend(self.candidate(damper, best));
            if !self.is_steady(damper) {
                tasks.extend([best].iter().chain(&places).flat_map(|at| self.descents(at, under)));
            }
        }
        Ok(tasks)
    }

    /// [`Self::bounded`], with some room below a limit.
    pub(super) fn under(&self, under: Under, starts: Vec<PerVariable<f64>>) -> Result<Study, Error> {
        let room = if under.sweep == Sweep::K2 { 1.0 } else { ROOM };
        self.bounded(Under { bound: room * under.bound, ..under }, starts)
    }

    /// The search of a damper under a bound; none where there is none.
    pub(super) fn optimize(&self, under: Under) -> Option<Optimize> {
        self.under(under, Vec::new()).ok()?.optimize
    }

    /// The study of a damper under a bound.
    fn bounded(
        &self,
        Under { damper, sweep, bound }: Under,
        starts: Vec<PerVariable<f64>>,
    ) -> Result<Study, Error> {
        let (_, study) = &self.plan.dampers[damper];
        bounded(study, sweep, bound, starts).map_err(Error::rule(study))
    }

    /// The starts of a search: the best designs of the preceding dampers under the bound.
    fn starts(&self, under: Under) -> Vec<PerVariable<f64>> {
        let Some(optimize) = self.optimize(under) else { return Vec::new() };
        let best = (0..under.damper).filter_map(|damper| self.best(Under { damper, ..under }));
        best.map(|design| clipped(&design.at, &optimize)).collect()
    }

    /// The best design of a damper under a bound, or the one with the least excess over it.
    pub(super) fn best(&self, under: Under) -> Option<Candidate> {
        let own = self.designs.iter().filter(|design| design.damper == under.damper);
        own.min_by(|a, b| by_excess(a, b, under)).cloned()
    }

    /// A design evaluated on the samples of the plan; none where it cannot be run.
    pub(super) fn candidate(&self, damper: usize, at: Design) -> Option<Candidate> {
        let (_, study) = self.plan.dampers.get(damper)?;
        let found = worst(&with_samples(study, self.plan.said.samples, &at)?)?;
        let [stroke, force] =
            [Measure::Stroke, Measure::ContactForce].map(|of| found.reached.get(Limit::Of(of)));
        let (e1_max, checked, needs) = (found.value, None, None);
        let (verdict, reason) = (CONTINUED, String::new());
        Some(Candidate { damper, at, e1_max, checked, stroke, force, verdict, reason, needs })
    }

    /// Evaluates the best design under each bound on the finest samples and certifies it, until all best designs have both.
    fn judge(&mut self, searches: &Searches) -> Result<(), Error> {
        loop {
            let rows = self.all().into_iter().filter_map(|under| Some((self.found(under)?, under)));
            let open = |design: &Candidate| design.checked.is_none() || design.verdict == CONTINUED;
            let mut open: Vec<(usize, Under)> = rows.filter(|&(at, _)| open(&self.designs[at])).collect();
            open.sort_by_key(|(at, _)| *at);
            open.dedup_by_key(|(at, _)| *at);
            if open.is_empty() {
                break;
            }
            let stage = (searches.watch, "best designs, looked at once more");
            let judged = |&(at, under): &(usize, Under)| {
                Ok((at, self.judged(&self.designs[at], under, searches.journal())?))
            };
            let judged = in_a_stage(stage, &open, judged)?;
            searches.journal().check()?;
            judged.into_iter().for_each(|(at, design)| self.designs[at] = design);
        }
        self.check_front(searches)
    }

    /// Evaluates the designs of the front, and those of the studies, on the finest samples, until all that no other dominates by these are known.
    fn check_front(&mut self, searches: &Searches) -> Result<(), Error> {
        let journal = searches.journal();
        let given = self.given.iter().map(|design| self.checked(design, journal));
        let given: Vec<Candidate> =
            given.map(|given| Candidate { needs: self.needs(&given), ..given }).collect();
        self.given = given;
        loop {
            let is_open = |&at: &usize| {
                let design = &self.designs[at];
                design.checked.is_none() && !self.designs.iter().any(|other| other.dominates(design))
            };
            let open: Vec<usize> = (0..self.designs.len()).filter(is_open).collect();
            if open.is_empty() {
                return Ok(());
            }
            let checked = |&at: &usize| Ok((at, self.checked(&self.designs[at], journal)));
            let checked = in_a_stage((searches.watch, "front, on the finest samples"), &open, checked)?;
            journal.check()?;
            checked.into_iter().for_each(|(at, design)| self.designs[at] = design);
        }
    }

    /// The design with E1max on the finest samples.
    fn checked(&self, design: &Candidate, journal: &Journal) -> Candidate {
        let Candidate { damper, at, e1_max, .. } = design;
        let finest = || {
            let study = with_samples(&self.plan.dampers[*damper].1, self.plan.check(), at);
            study.and_then(|study| study.energy(&study.scene)).unwrap_or(f64::INFINITY)
        };
        let numbers = Parameter::VARIED.map(|parameter| at.get(parameter));
        let finest = journal.value(&format!("{damper} checked"), &numbers, f64::INFINITY, finest, |_| ());
        Candidate { checked: Some(finest.max(*e1_max)), ..design.clone() }
    }

    /// What a design needs and what the structure does, from rest on.
    fn needs(&self, design: &Candidate) -> Option<Largest> {
        let (_, study) = &self.plan.dampers[design.damper];
        Largest::of(study, &study.scene_at(&design.at)?)
    }

    /// The design with E1max on the finest samples; or, if it has that, with the verdict of its certificate.
    fn judged(&self, design: &Candidate, under: Under, journal: &Journal) -> Result<Candidate, Error> {
        if design.checked.is_none() {
            return Ok(self.checked(design, journal));
        }
        let study = self.bounded(under, Vec::new())?;
        let scene = study.scene_at(&design.at).unwrap_or(study.scene);
        let certificate = judge(&Study { scene, ..study })?;
        let needs = self.needs(design);
        let (verdict, reason) = (certificate.verdict(), certificate.reason().to_owned());
        Ok(Candidate { verdict, reason, needs, ..design.clone() })
    }

    /// All dampers under all bounds.
    pub(super) fn all(&self) -> Vec<Under> {
        let mut all = Vec::new();
        for damper in 0..self.plan.dampers.len() {
            for sweep in self.plan.sweeps() {
                all.extend(self.plan.values(sweep).into_iter().map(|bound| Under { damper, sweep, bound }));
            }
        }
        all
    }
}
