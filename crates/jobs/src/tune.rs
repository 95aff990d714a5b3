//! `optimize`: from a study to a tuned damper, its log and its figures.

pub(crate) mod band;
mod choice;
pub(crate) mod descent;
pub mod ends;
mod global;
pub mod log;
pub mod merge;
pub mod objective;
mod optimum;
pub(crate) mod pictures;
mod recompute;
mod refine;
mod report;
mod surf;
mod tmd;
mod turns;
mod valley;

pub(crate) use log::OPTIMUM;
pub use optimum::Optimum;
pub(crate) use optimum::{table2_header, table2_row};

use crate::artefact::Kind;
use crate::job::{Done, Job, Made};
use crate::summary::Summary;
use crate::{Error, Observer, Request, certify, resolved};
use global::Basins;
use objective::Task;
use optimum::Searched;
use report::Findings;
use retune_store::{Directory, Order};
use retune_study::{Search, Study, are};
use std::path::Path;

/// The files of a search.
pub static KIND: Kind = Kind {
    command: "optimize",
    answer: OPTIMUM,
    input: resolved::ONE,
    rows: &[
        (log::GRID, recompute::grid),
        (log::LOG, recompute::search),
        (log::STARTS, recompute::search),
        (log::BASINS, recompute::search),
        (log::BAND, recompute::band),
    ],
    whole: &[(OPTIMUM, recompute::optimum), (certify::FILE, recompute::certificate)],
    derived: &[report::FILE, "fminsearch.txt", "surf-*.svg", "convergence.svg", "band.svg"],
};

/// Tunes the damper of a study file.
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn tune(request: &Request, watch: &dyn Observer) -> Result<Done<Optimum>, Error> {
    tune_study(&retune_study::read(&request.study)?, request, watch)
}

/// Tunes the damper of a study in memory; the results name `request.study` as their source.
pub fn tune_study(study: &Study, request: &Request, watch: &dyn Observer) -> Result<Done<Optimum>, Error> {
    let search = searched(study)?;
    run(study, request, watch, |results| tuned(study, &search, results, watch))
}

/// Searches for the best design of a study as a part of a larger job. The results in the directory `out` can be resumed until it is
/// finished.
///
/// # Errors
/// The study has nothing to tune, nothing can be computed, or the results cannot be written.
pub fn optimize(
    study: &Study,
    out: &Path,
    order: &Order,
    watch: &dyn Observer,
) -> Result<(Optimum, Directory), Error> {
    let search = searched(study)?;
    let job = Job::of_study(&KIND, study, out, order)?;
    job.make(watch, |results| tuned(study, &search, results, watch))
}

/// Runs `work` as a whole job. If the results were finished before, only checks that their design keeps its limits.
fn run(
    study: &Study,
    request: &Request,
    watch: &dyn Observer,
    work: impl FnOnce(&mut Directory) -> Result<Optimum, Error> + Send,
) -> Result<Done<Optimum>, Error> {
    let job = Job::of_study(&KIND, study, &request.out_of(study), &request.order(KIND.command))?;
    let done = job.run(request, watch, |results| {
        match results.journal().known() {
            0 => {}
            known => watch.result(&format!("resumed: {} known", are(known, "value")))?,
        }
        let answer = work(results)?;
        watch.log(&answer.search())?;
        let report = format!("{}\n{}", answer.report(), answer.next(&job.out));
        Ok(Made { report, answer, parts: Vec::new() })
    })?;
    if let Done::FinishedBefore = done {
        certify::check_limits_in(&job.out, study.name())?;
    }
    Ok(done)
}

fn searched(study: &Study) -> Result<Search, Error> {
    study.search().map_err(Error::rule(study))
}

/// Searches and writes the results. On an error the work is discarded, unless it could not be written: only then can it be resumed later.
fn tuned(
    study: &Study,
    search: &Search,
    results: &Directory,
    watch: &dyn Observer,
) -> Result<Optimum, Error> {
    let task = Task { study, search, journal: results.journal(), place: "", watch };
    let optimum = search_and_write(&task, results);
    if optimum.as_ref().is_err_and(|error| !matches!(error, Error::Store(_))) {
        results.discard();
    }
    optimum
}

fn search_and_write(task: &Task, results: &Directory) -> Result<Optimum, Error> {
    let Task { study, search, watch, .. } = *task;
    let surf = surf::surf(task, results)?;
    let explored = global::global(task)?;
    let on_grid = surf.as_ref().map(|surf| surf.starts(search)).unwrap_or_default();
    let starts = ends::starts(search, &on_grid, explored.as_ref());
    let on_grid = on_grid.len();
    let mut refined = refine::refine(task, &starts, results)?;
    descent::finish(task, &mut refined)?;
    let (measured_at, valleys) = descent::probe_valleys(task, &mut refined)?;
    results.journal().check()?;
    let (certificate, passed_over) = choice::choose(study, &mut refined, watch)?;
    refine::write_winner(study, &refined, results)?;
    let basins = explored.as_ref().map(|found| Basins::new(task, found, &refined, on_grid));
    results.journal().check()?;
    if let Some(basins) = &basins {
        basins.write(&refined.objective, results)?;
    }

    let design = refined.objective.scene(&refined.best().minimum.x)?;
    let found = refined.objective.goal().evaluate(&design, &study.solver.settings(), f64::INFINITY)?;
    let scene = found.worst_run(design, refined.objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let summary = Summary::new(study, scene, &response);
    let valleys = if measured_at == refined.best().minimum.x {
        valleys
    } else {
        valley::measure(task, &refined.best().minimum.x).valleys
    };
    results.journal().check()?;
    let searched =
        Searched { surf: surf.as_ref(), explored: explored.as_ref(), basins, passed_over, valleys };
    results.write_json(certify::FILE, &certificate)?;
    let optimum = Optimum::new(study, search, searched, &refined, summary, found, certificate)?;
    results.write_json(OPTIMUM, &optimum)?;
    pictures::draw(study, search, surf.as_ref(), &refined, results)?;
    let band = if study.objective().omega.is_some() { band::write(study, design, results)? } else { None };
    let findings = Findings {
        study,
        search,
        surf: surf.as_ref(),
        explored: explored.as_ref(),
        refined: &refined,
        optimum: &optimum,
        evaluation: &found,
        tuned: design,
        worst: scene,
        response: &response,
        band,
        on_grid,
    };
    report::write(&findings, results)?;
    Ok(optimum)
}
