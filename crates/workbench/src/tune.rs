//! `optimize`: from a study to a tuned damper, its log and its figures.

pub mod band;
mod global;
pub mod log;
pub mod merge;
pub mod objective;
mod optimum;
pub mod pictures;
mod refine;
pub mod shard;
mod surf;

pub use optimum::{Found, Optimum, table2_header, table2_row};

use crate::certify::{self, certify};
use crate::request::{self, where_results_are};
use crate::resolved::{identity_of, study_text};
use crate::summary::Summary;
use crate::{Error, Observer, Request};
use global::Basins;
use optimum::Searched;
use retune_store::{Begin, Directory, Extent, Order, manifest};
use retune_study::{Search, Study, are};
use shard::Shard;
use std::path::Path;

/// The result of a search.
pub enum Tuned {
    /// It is finished: the best design.
    Found(Box<Optimum>),
    /// The search was to be resumed, but was already finished.
    FinishedBefore,
}

/// Tunes the damper of a study file.
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn tune(request: &Request, watch: &dyn Observer) -> Result<Tuned, Error> {
    let study = retune_study::read(&request.study)?;
    finished(&study, request, watch, |out, order| optimize(&study, out, order, watch))
}

/// Makes a search with `search`, unless it is to be resumed and is already finished; reports its result.
fn finished(
    study: &Study,
    request: &Request,
    watch: &dyn Observer,
    search: impl FnOnce(&Path, &Order) -> Result<(Optimum, Directory), Error> + Send,
) -> Result<Tuned, Error> {
    let out = request.out_of(study);
    if request.begin == Begin::Resume && manifest::is_finished(&out, &identity_of(study)?) {
        Directory::tidy(&out);
        watch.result(&format!("finished already: nothing to go on with\n{}", where_results_are(&out)?))?;
        certify::check_limits_in(&out, study.name())?;
        return Ok(Tuned::FinishedBefore);
    }
    let order = request.order("optimize");
    let (optimum, results) = request.on_threads(|| search(&out, &order))?;
    results.finish()?;
    watch.result(&optimum.report())?;
    watch.result(&where_results_are(&out)?)?;
    Ok(Tuned::Found(Box::new(optimum)))
}

/// Computes a share of the grid of a study file, for [`merge`].
///
/// # Errors
/// The study is wrong or has no grid, or the part cannot be written.
pub fn tune_share(request: &Request, shard: Shard, watch: &dyn Observer) -> Result<(), Error> {
    let study = retune_study::read(&request.study)?;
    let (out, order) = (request.out_of(&study), request.order("optimize"));
    request.on_threads(|| shard::shard(&study, shard, &out, &order, watch))
}

/// Searches for the best design of a study and writes all results to the directory `out`. The work can be resumed until the
/// directory is finished.
///
/// # Errors
/// The study has nothing to tune, nothing can be computed, or the results cannot be written.
pub fn optimize(
    study: &Study,
    out: &Path,
    order: &Order,
    watch: &dyn Observer,
) -> Result<(Optimum, Directory), Error> {
    optimize_from(study, out, order, watch, |_| Ok(()))
}

/// As [`optimize`], after `prepare` has added known values to the directory.
///
/// # Errors
/// As [`optimize`].
fn optimize_from(
    study: &Study,
    out: &Path,
    order: &Order,
    watch: &dyn Observer,
    prepare: impl FnOnce(&mut Directory) -> Result<(), Error>,
) -> Result<(Optimum, Directory), Error> {
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let mut results = request::open(out, order, &identity_of(study)?, Extent::Whole, is_ours, watch)?;
    prepare(&mut results)?;
    match results.journal().known() {
        0 => {}
        known => watch.log(&format!("goes on: {} known", are(known, "value")))?,
    }
    match tuned(study, &search, &results, watch)
        .and_then(|optimum| Ok(results.publish().map(|()| optimum)?))
    {
        Ok(optimum) => Ok((optimum, results)),
        Err(error) => {
            // Work that cannot be written can be resumed later; work that cannot be computed cannot.
            if !matches!(error, Error::Store(_)) {
                results.discard();
            }
            Err(error)
        }
    }
}

/// Searches and writes.
fn tuned(
    study: &Study,
    search: &Search,
    results: &Directory,
    watch: &dyn Observer,
) -> Result<Optimum, Error> {
    results.write("study.json", &study_text(study)?)?;
    let surf = surf::surf(study, search, results, watch)?;
    let explored = global::global(study, search, results.journal(), watch)?;
    let mut starts = surf.as_ref().map(|surf| surf.starts(search)).unwrap_or_default();
    let on_grid = starts.len();
    starts.extend(explored.as_ref().map(|explored| explored.starts(search.starts)).unwrap_or_default());
    starts.extend(search.given.iter().cloned());
    if starts.is_empty() {
        starts.push(search.variables.iter().map(|variable| variable.get(&search.damper)).collect());
    }
    let refined = refine::refine(study, search, starts, results, watch)?;
    let basins =
        explored.as_ref().map(|found| Basins::new(found, search, &refined, results.journal(), on_grid));
    results.journal().check()?;
    if let Some(basins) = &basins {
        basins.write(&refined.objective, results)?;
    }

    let design = refined.objective.scene(&refined.best().minimum.x)?;
    let found = refined.objective.evaluate(&design, f64::INFINITY)?;
    let scene = found.worst_run(design, refined.objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let summary = Summary::new(study, scene, &response);
    let searched = Searched { surf: surf.as_ref(), explored: explored.as_ref(), basins };
    let certificate = certify(&Study { scene: design, ..study.clone() })?;
    results.write_json(certify::FILE, &certificate)?;
    let optimum = Optimum::new(study, search, searched, &refined, summary, found, certificate.short());
    results.write_json("optimum.json", &optimum)?;
    pictures::draw(study, search, surf.as_ref(), &refined, results)?;
    if study.objective().omega.is_some() {
        band::write(study, design, results)?;
    }
    manifest::write(identity_of(study)?, [study.solver], results)?;
    Ok(optimum)
}

/// Whether `optimize` writes files of this name.
fn is_ours(name: &str) -> bool {
    const NAMES: [&str; 12] = [
        certify::FILE,
        "basins.csv",
        "study.json",
        "surf.csv",
        "fminsearch.csv",
        "fminsearch.txt",
        "fminsearch-starts.csv",
        "optimum.json",
        "convergence.svg",
        "band.csv",
        "band.svg",
        manifest::NAME,
    ];
    NAMES.contains(&name) || (name.starts_with("surf-") && name.ends_with(".svg"))
}
