//! The searches of `fronts`: under each bound that of the study, then continuation along the bound in both directions.
//!
//! A search that looks at few frequencies finds designs that are good at those alone. Each design is therefore looked at on the samples of
//! the study of fronts. Where E1max rises by more than [`SAME`], the search is made again with four times its samples. The best design
//! under each bound is then a start under its neighbours, first towards tighter bounds, then towards looser ones, and refined on finer
//! samples. A wall distance that has become small is also tried at its bound, where `fminsearch` would never quite arrive.

use super::candidate::{Candidate, SAME, by_excess};
use super::fronts::{Fronts, GIVEN};
use super::refinement::{Under, clipped, minimum, scale_samples, set_samples};
use retune_model::{Design, Variable};
use retune_optim::Limit;
use retune_study::{self as study, FrontsPlan, PerVariable, Study, Sweep};
use retune_workbench::certify::certify;
use retune_workbench::look::{finer, look};
use retune_workbench::searches::Searches;
use retune_workbench::{Error, Observer};

/// A search keeps this much below a limit, for between its samples a stroke or a force may be a little larger.
const ROOM: f64 = 0.99;
/// By how many times the samples of a search are refined, where it is made again and for the refinement of its design.
const FINER: usize = 4;
/// A parameter this near to its lower bound, as a share of the side, is also tried at it.
const NEAR: f64 = 0.05;
/// A design touches a bound if it reaches this share of it.
const TOUCHES: f64 = 0.97;
/// Evaluations of a refinement on the samples of the study of fronts.
const FINEST: u64 = 100;

/// Makes all searches.
///
/// # Errors
/// A study cannot be searched under a bound, or results cannot be written.
pub(super) fn search(
    plan: FrontsPlan,
    searches: &mut Searches,
    watch: &dyn Observer,
) -> Result<Fronts, Error> {
    let mut fronts = Fronts::new(plan);
    for damper in 0..fronts.plan.dampers.len() {
        if let Some(place) = fronts.plan.dampers[damper].1.scene.damper {
            let at = Design::of(&place);
            fronts.given.extend(fronts.look(damper, at, GIVEN));
        }
        for sweep in fronts.plan.sweeps() {
            for bound in fronts.plan.values(sweep) {
                fronts.tune(Under { damper, sweep, bound }, searches, watch)?;
            }
            // A steady response is exact over the whole band: its searches need no second look.
            if !fronts.is_steady(damper) {
                fronts.continue_along(damper, sweep, searches, watch)?;
            }
        }
    }
    fronts.polish(searches)?;
    fronts.judge()?;
    fronts.certified = fronts.certify()?;
    Ok(fronts)
}

impl Fronts {
    /// The search of a study under a bound; with more samples, if few have shown it a design that is none.
    fn tune(&mut self, under: Under, searches: &mut Searches, watch: &dyn Observer) -> Result<(), Error> {
        let Under { damper, sweep, bound } = under;
        let (name, what, unit) = (self.name(damper).to_owned(), sweep.name(), sweep.unit());
        for more in [1, FINER] {
            let starts = self.starts(under);
            let mut study = self.under(under, starts)?;
            scale_samples(&mut study, more);
            let words = if more == 1 { "" } else { ", with four times the samples" };
            watch.log(&format!("\n{name}, {what} at most {bound} {unit}{words}"))?;
            let place = if more == 1 { format!("{what}-{bound}") } else { format!("{what}-{bound}-finer") };
            let optimum = searches.tune(&study, &place)?;
            watch.log(&optimum.report())?;
            let found = optimum.found();
            let seen = self.look(damper, found.damper.design, optimum.verdict());
            let rises = seen.as_ref().is_none_or(|seen| seen.e1_max > (1.0 + SAME) * found.e1_max);
            self.designs.extend(seen);
            if !rises {
                break;
            }
            if more > 1 {
                // What is good between the samples of the search may be good on finer ones nearby.
                self.refine(found.damper.design, under, searches)?;
            }
        }
        Ok(())
    }

    /// Carries the best design under each bound to the next one, towards tighter bounds and back.
    fn continue_along(
        &mut self,
        damper: usize,
        sweep: Sweep,
        searches: &Searches,
        watch: &dyn Observer,
    ) -> Result<(), Error> {
        let mut bounds = self.plan.values(sweep);
        for words in ["looser", "tighter"] {
            bounds.reverse(); // largest first, then smallest first
            for pair in bounds.windows(2) {
                let [from, bound] = [pair[0], pair[1]];
                let Some(start) = self.best(Under { damper, sweep, bound: from }) else { continue };
                let under = Under { damper, sweep, bound };
                let before = self.best(under).map_or(f64::NAN, |best| best.e1_max);
                let Some(start) = self.start(&start, under, from) else { continue };
                self.refine(start, under, searches)?;
                let after = self.best(under).map_or(f64::NAN, |best| best.e1_max);
                watch.log(&format!(
                    "{}, {} at most {bound} {}, from the {words} bound {from}: {before:.2} J, then {after:.2} J",
                    self.name(damper),
                    sweep.name(),
                    sweep.unit()
                ))?;
            }
        }
        Ok(())
    }

    /// The best design of a damper under a bound, or that which is beyond it by least.
    fn best(&self, Under { damper, sweep, bound }: Under) -> Option<Candidate> {
        let own = self.designs.iter().filter(|design| design.damper == damper);
        own.min_by(|a, b| by_excess(a, b, sweep, bound)).cloned()
    }

    /// Where the best design under the bound beside it is worth refining under this one: a tighter bound that it breaks, or a looser one
    /// if it touches its own, a spring then with the same share of the bound. Otherwise it is as good under both.
    fn start(&self, start: &Candidate, under: Under, from: f64) -> Option<Design> {
        let reached = start.reached(under.sweep);
        if under.bound < from {
            return (reached > under.bound).then_some(start.at);
        }
        let share = if under.sweep == Sweep::K2 { under.bound / from } else { 1.0 };
        let scaled = |variable: Variable| match variable {
            Variable::K2 => start.at.get(variable) * share,
            _ => start.at.get(variable),
        };
        (reached > TOUCHES * from).then(|| Design::new(scaled).ok()).flatten()
    }

    /// Refines a design under a bound on finer samples than those of its study, then its copies with a small wall distance at its bound;
    /// where E1max still rises on the samples of the study of fronts, on these.
    fn refine(&mut self, start: Design, under: Under, searches: &Searches) -> Result<(), Error> {
        let mut study = self.under(under, Vec::new())?;
        scale_samples(&mut study, FINER);
        let Some(optimize) = study.optimize.clone() else { return Ok(()) };
        let free = clipped(&start, &optimize);
        let mut ends = Vec::new();
        ends.extend(minimum(&study, &free, None, under, searches)?);
        let first = ends.first().map_or(start, |(at, _)| *at);
        for variable in [Variable::D, Variable::C] {
            let side = optimize.bounds.get(variable).unwrap_or((0.0, None));
            let (low, high) = (side.0, side.1.unwrap_or(f64::INFINITY));
            let is_near = optimize.vary.contains(&variable)
                && optimize.vary.len() > 1
                && first.get(variable) - low < NEAR * (high - low).min(1.0)
                && first.get(variable) > low;
            if is_near {
                let start = clipped(&first, &optimize);
                ends.extend(minimum(&study, &start, Some((variable, low)), under, searches)?);
            }
        }
        for (at, value) in ends {
            let Some(seen) = self.look(under.damper, at, CONTINUED) else { continue };
            let rises = seen.e1_max > (1.0 + SAME) * value && value < retune_optim::INFEASIBLE;
            let worth = self.best(under).is_none_or(|best| value < best.e1_max);
            self.designs.push(seen);
            if rises && worth {
                let mut study = study.clone();
                set_samples(&mut study, self.plan.said.samples);
                if let Some(optimize) = &mut study.optimize {
                    optimize.refine.max_fun_evals = Some(FINEST);
                }
                let again = minimum(&study, &clipped(&at, &optimize), None, under, searches)?;
                let seen = again.and_then(|(at, _)| self.look(under.damper, at, CONTINUED));
                self.designs.extend(seen);
            }
        }
        Ok(())
    }

    /// The study of a damper under a bound.
    fn under(&self, under: Under, starts: Vec<PerVariable<f64>>) -> Result<Study, Error> {
        let Under { damper, sweep, bound } = under;
        let room = if sweep == Sweep::K2 { 1.0 } else { ROOM };
        let (_, study) = &self.plan.dampers[damper];
        let refuse = |rule| Error::Rule { name: study.name().to_owned(), rule };
        study::bounded(study, sweep, room * bound, starts).map_err(refuse)
    }

    /// The designs at which a search starts: the best so far of the damper itself, and of those before it, under the bound.
    fn starts(&self, under: Under) -> Vec<PerVariable<f64>> {
        let Ok(study) = self.under(under, Vec::new()) else { return Vec::new() };
        let Some(optimize) = &study.optimize else { return Vec::new() };
        let best = (0..=under.damper).filter_map(|other| self.best(Under { damper: other, ..under }));
        best.map(|design| clipped(&design.at, optimize)).collect()
    }

    /// A design on the samples of the study of fronts; none where it cannot be run.
    fn look(&self, damper: usize, at: Design, verdict: &'static str) -> Option<Candidate> {
        let (_, study) = self.plan.dampers.get(damper)?;
        let found = look(&finer(study, self.plan.said.samples, &at)?)?;
        let [stroke, force] = [Limit::Stroke, Limit::Force].map(|limit| found.reached.get(limit));
        Some(Candidate { damper, at, e1_max: found.energy, checked: None, stroke, force, verdict })
    }

    /// Refines the best designs under each bound a last time, each design once.
    fn polish(&mut self, searches: &Searches) -> Result<(), Error> {
        let mut done: Vec<Design> = Vec::new();
        for under in self.all().into_iter().filter(|under| !self.is_steady(under.damper)).collect::<Vec<_>>()
        {
            let Some(best) = self.best(under).filter(|best| !done.contains(&best.at)) else { continue };
            done.push(best.at);
            self.refine(best.at, under, searches)?;
        }
        Ok(())
    }

    /// Looks at the best designs under each bound once more, on more samples, and gives those that continuation found a verdict.
    fn judge(&mut self) -> Result<(), Error> {
        for under in self.all() {
            let Some(at) = self.row_index(under.damper, under.sweep, under.bound) else { continue };
            let Candidate { at: design, checked, verdict, .. } = self.designs[at].clone();
            let (_, study) = &self.plan.dampers[under.damper];
            if checked.is_none() {
                let again = finer(study, self.plan.check(), &design).and_then(|study| look(&study));
                self.designs[at].checked = again.map(|found| found.energy);
            }
            if verdict == CONTINUED {
                let study = self.under(under, Vec::new())?;
                let scene = study.scene_at(&design);
                let own = Study { scene: scene.unwrap_or(study.scene), ..study };
                self.designs[at].verdict = certify(&own)?.short().verdict();
            }
        }
        Ok(())
    }

    /// Every bound for every damper.
    fn all(&self) -> Vec<Under> {
        let mut all = Vec::new();
        for damper in 0..self.plan.dampers.len() {
            for sweep in self.plan.sweeps() {
                all.extend(self.plan.values(sweep).into_iter().map(|bound| Under { damper, sweep, bound }));
            }
        }
        all
    }
}

/// The verdict of a design that continuation found, until it is judged.
const CONTINUED: &str = "not certified";
