//! The last stage of every search: descents by derivatives from the refined designs and from the best TMD, then further refinements from
//! the study's damper and from points near the best minimum, where these are lower.

use super::log::value_words;
use super::objective::{Task, searched};
use super::refine::{Descended, Refined, Run, run_unreported};
use super::tmd::{best_steady, tmd};
use super::valley::{Measured, Valley, measure};
use crate::Error;
use rayon::prelude::*;
use retune_optim::{Counts, DesignObjective, Foot, INFEASIBLE, Minimum, Point, Procedure, Row, Stop};
use retune_store::Journal;
use retune_study::{Search, counted};
use std::cell::OnceCell;

/// Relative decrease below which a lower value does not count as an improvement.
const GAIN: f64 = 1e-5;
/// The best TMD of a steady objective is added as a run if the best refined value is above its value by more than this share.
const BETTER: f64 = 1e-4;

/// The start of a run from the study's damper.
const DAMPER: &str = "the damper of the study";
/// The start of a run from a lower point near the best minimum.
const BESIDE: &str = "a lower place beside the best end";
/// Most such runs, one after the other.
const ROUNDS: usize = 3;

/// Descends from the end of every refinement, and from the best TMD if the damper has walls. At a kink, where several peaks are equally
/// high or a limit is active, a simplex stops short of the minimum. A better end replaces that of the refinement.
pub(super) fn finish(task: &Task, refined: &mut Refined) -> Result<(), Error> {
    let Task { study, search, journal, place, watch } = *task;
    let Refined { objective, runs, .. } = refined;
    let tmd = tmd(study, search);
    let starts: Vec<&[f64]> = runs.iter().map(|run| run.minimum.x.as_slice()).chain(tmd.as_deref()).collect();
    let count = runs.len();
    let bar = watch.progress("descents", starts.len() as u64);
    let foot = |(i, start): (usize, &&[f64])| {
        let can_improve = i == count || objective.goal().has_pieces();
        let foot = can_improve
            .then(|| descend(objective, search, start, journal, &format!("{place}fminsearch descent")));
        bar.inc(1);
        foot
    };
    let feet: Vec<Option<Foot>> = starts.par_iter().enumerate().map(foot).collect();
    bar.finish();
    journal.check()?;
    let mut feet = feet.into_iter();
    for (run, foot) in runs.iter_mut().zip(&mut feet) {
        foot.into_iter().for_each(|foot| take_if_lower(run, foot));
    }
    refined.take_lowest();
    let Refined { runs, .. } = refined;
    let mut from_tmd = tmd.zip(feet.flatten().next());
    if from_tmd.is_none() {
        // For a steady objective the optimum is known in closed form, so no search may end above it.
        let least = runs.iter().map(|run| run.minimum.value).fold(f64::INFINITY, f64::min);
        from_tmd = best_steady(study, search).filter(|(_, foot)| foot.end.value < (1.0 - BETTER) * least);
    }
    if let Some((best, Foot { from, end: Point { x, value }, counts })) = from_tmd
        && value.is_finite()
    {
        let row = Row { iteration: 0, func_count: 1, procedure: Procedure::Start, best, value: from };
        let scaling = search.options.scaling;
        let minimum = Minimum { x, value, iterations: 0, func_count: 1, stop: Stop::Converged, scaling };
        let descent = Some(Descended { from, evaluations: counts.evaluations });
        refined.push("the best TMD", Run { rows: vec![row], minimum, descent });
    }
    try_study_damper(task, refined)?;
    for (number, run) in refined.runs.iter().enumerate() {
        let Some(Descended { from, evaluations }) = run.descent else { continue };
        let begin =
            refined.beyond(number).map_or_else(|| format!("the end of start {}", number + 1), str::to_owned);
        let [from, to] = [from, run.minimum.value].map(|value| value_words(value, study.quantity()));
        watch.log(&format!(
            "descent from {begin}: {from} to {to} in {}",
            counted(evaluations, "evaluation")
        ))?;
    }
    Ok(())
}

/// Continues the search from the study's damper if that is better than all minima found: the result is never worse than the given design.
fn try_study_damper(task: &Task, refined: &mut Refined) -> Result<(), Error> {
    let Task { study, search, watch, .. } = *task;
    let design = search.own();
    if !design.iter().zip(&search.options.bounds).all(|(value, bounds)| bounds.contain(*value)) {
        return Ok(());
    }
    let least = (1.0 - GAIN) * refined.best().minimum.value;
    let mut objective = searched(study, search, &search.variables);
    let value = if objective.goal().follows_motions() {
        objective.learn(&design).map_or(f64::INFINITY, |found| found.ranked)
    } else {
        objective.value(&design, least)
    };
    if value >= least {
        return Ok(());
    }
    watch.log("the damper of the study is better than the ends of all starts: the search goes on from it")?;
    continue_from(task, refined, DAMPER, &design)
}

/// Probes the best minimum along each parameter; where the objective is lower, the search continues from there. Returns the design that was
/// probed last, and its valleys.
pub(super) fn probe_valleys(task: &Task, refined: &mut Refined) -> Result<(Vec<f64>, Vec<Valley>), Error> {
    let mut rounds = 0..ROUNDS;
    loop {
        let design = refined.best().minimum.x.clone();
        let Measured { valleys, lower } = measure(task, &design);
        let Some(lower) = lower.filter(|_| rounds.next().is_some()) else { return Ok((design, valleys)) };
        continue_from(task, refined, BESIDE, &lower)?;
        if refined.best().minimum.x == design {
            return Ok((design, valleys));
        }
    }
}

/// Adds a refinement from a design, and a descent from its end.
fn continue_from(
    task: &Task,
    refined: &mut Refined,
    from: &'static str,
    design: &[f64],
) -> Result<(), Error> {
    let Task { search, journal, place, watch, .. } = *task;
    let bar = watch.progress("fminsearch", 1);
    let mut run = run_unreported(task, &mut refined.objective, design)?;
    let stage = format!("{place}fminsearch descent");
    if refined.objective.goal().has_pieces() {
        let foot = descend(&refined.objective, search, &run.minimum.x, journal, &stage);
        take_if_lower(&mut run, foot);
    }
    bar.inc(1);
    bar.finish();
    refined.push(from, run);
    Ok(())
}

/// Replaces the minimum of a run by the end of its descent, where that is lower.
fn take_if_lower(run: &mut Run, Foot { end, counts, from }: Foot) {
    let least = if from < INFEASIBLE { (1.0 - GAIN) * run.minimum.value } else { run.minimum.value };
    if end.value < least {
        (run.minimum.x, run.minimum.value) = (end.x, end.value);
        run.descent = Some(Descended { from, evaluations: counts.evaluations });
    }
}

/// [`DesignObjective::descend`] within the bounds of a search; the journal keeps its result under the name of a stage.
pub fn descend(
    objective: &DesignObjective,
    search: &Search,
    start: &[f64],
    journal: &Journal,
    stage: &str,
) -> Foot {
    let found = OnceCell::new();
    let foot = || found.get_or_init(|| objective.descend(&search.options.bounds, start));
    let kept = |name: &str, of: &dyn Fn(&Foot) -> f64| {
        journal.value(&format!("{stage} {name}"), start, f64::INFINITY, || of(foot()), |_| ())
    };
    let x = (0..start.len()).map(|i| kept(&i.to_string(), &|foot| foot.end.x[i])).collect();
    let [from, value] = [kept("from", &|foot| foot.from), kept("value", &|foot| foot.end.value)];
    let counts = Counts {
        evaluations: kept("evaluations", &|foot| foot.counts.evaluations as f64) as u64,
        infeasible: kept("infeasible", &|foot| foot.counts.infeasible as f64) as u64,
    };
    if found.get().is_none() {
        objective.recall_all(counts);
    }
    Foot { from, end: Point { x, value }, counts }
}
