//! `optimize`: from a study to a tuned damper, its log and its figures.

pub mod band;
mod global;
pub mod log;
pub mod merge;
mod optimum;
pub mod pictures;
mod refine;
pub mod shard;
mod surf;

pub use optimum::{Found, Optimum, table2_header, table2_row};

use crate::certify::{self, certify};
use crate::cli;
use crate::error::Error;
use crate::results::identity::{Identity, study_text};
use crate::results::{Directory, Extent, Journal, Order, manifest};
use crate::screen::Screen;
use crate::study::{self, Search, Study};
use crate::summary::Summary;
use global::Basins;
use optimum::Searched;
use retune_optim::{PeakEnergy, Variable};
use std::path::{Path, PathBuf};

/// Tunes the damper of a study file.
///
/// # Errors
/// The study is wrong, nothing can be computed, or the results cannot be written.
pub fn command(arguments: &cli::Optimize) -> Result<(), Error> {
    let study = study::read(&arguments.study)?;
    let out = arguments.running.out.clone();
    let out = out.unwrap_or_else(|| Path::new("results").join(study.name()));
    let screen = Screen::new(arguments.running.quiet);
    if arguments.shard.is_none() && nothing_to_resume(&study, &out, &arguments.running, screen)? {
        return Ok(());
    }
    let order = arguments.running.order("optimize", &arguments.study);
    with_threads(arguments.running.threads, || {
        if let Some(shard) = arguments.shard {
            return shard::shard(&study, shard, &out, &order, screen);
        }
        let (optimum, results) = optimize(&study, &out, &order, screen)?;
        results.finish()?;
        screen.line(optimum.report())?;
        screen.line(where_results_are(&out)?)?;
        optimum.check_limits(study.name())
    })
}

/// Says so where a run is to go on that is finished.
fn nothing_to_resume(
    study: &Study,
    out: &Path,
    running: &cli::Running,
    screen: Screen,
) -> Result<bool, Error> {
    let finished = running.resume && manifest::is_finished(out, &Identity::of_study(study)?);
    if finished {
        Directory::tidy(out);
        screen.line(format!("finished already: nothing to go on with\n{}", where_results_are(out)?))?;
        certify::check_limits_in(out, study.name())?;
    }
    Ok(finished)
}

/// Runs `work` on `threads` threads, all cores if none are given.
///
/// # Errors
/// The threads cannot be started, or `work` fails.
pub fn with_threads<T: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> Result<T, Error> + Send,
) -> Result<T, Error> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0).into()).build()?;
    pool.install(work)
}

/// Searches the best design of a study and writes all results to the directory `out`. The work can go on until the directory
/// is finished.
///
/// # Errors
/// The study does not say what to tune, nothing can be computed, or the results cannot be written.
pub fn optimize(
    study: &Study,
    out: &Path,
    order: &Order,
    screen: Screen,
) -> Result<(Optimum, Directory), Error> {
    optimize_from(study, out, order, screen, |_| Ok(()))
}

/// As [`optimize`], with what `prepare` teaches the directory beforehand.
///
/// # Errors
/// As [`optimize`].
fn optimize_from(
    study: &Study,
    out: &Path,
    order: &Order,
    screen: Screen,
    prepare: impl FnOnce(&mut Directory) -> Result<(), Error>,
) -> Result<(Optimum, Directory), Error> {
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let mut results = Directory::open(out, order, &Identity::of_study(study)?, Extent::Whole, is_ours)?;
    prepare(&mut results)?;
    match results.journal().known() {
        0 => {}
        known => screen.log(format!("goes on: {} known", log::are(known, "value")))?,
    }
    match tuned(study, &search, &results, screen).and_then(|optimum| results.publish().map(|()| optimum)) {
        Ok(optimum) => Ok((optimum, results)),
        Err(error) => {
            // What cannot be written may go on once it can; what cannot be computed never will.
            if !matches!(error, Error::Output { .. } | Error::Standing { .. } | Error::Protected { .. }) {
                results.discard();
            }
            Err(error)
        }
    }
}

/// Searches and writes.
fn tuned(study: &Study, search: &Search, results: &Directory, screen: Screen) -> Result<Optimum, Error> {
    results.write("study.json", &study_text(study)?)?;
    let surf = surf::surf(study, search, results, screen)?;
    let explored = global::global(study, search, results.journal(), screen)?;
    let mut starts = surf.as_ref().map(|surf| surf.starts(search)).unwrap_or_default();
    let on_grid = starts.len();
    starts.extend(explored.as_ref().map(|explored| explored.starts(search.starts)).unwrap_or_default());
    starts.extend(search.given.iter().cloned());
    if starts.is_empty() {
        starts.push(search.variables.iter().map(|variable| variable.get(&search.damper)).collect());
    }
    let refined = refine::refine(study, search, starts, results, screen)?;
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
    manifest::write(Identity::of_study(study)?, [study.solver], results)?;
    Ok(optimum)
}

/// An objective as searches call it: what the journal knows of it is not computed again; then `on_known` is called.
fn kept<'a>(
    objective: &'a PeakEnergy,
    journal: &'a Journal,
    stage: &'static str,
    on_known: impl Fn() + Sync + 'a,
) -> impl Fn(&[f64], f64) -> f64 + Sync + 'a {
    move |design, cutoff| {
        let known = |value| {
            on_known();
            objective.recall(value);
        };
        journal.value(stage, design, cutoff, || objective.value(design, cutoff), known)
    }
}

/// The objective of a study over some parameters of its damper.
pub fn objective(study: &Study, search: &Search, variables: &[Variable]) -> PeakEnergy {
    let (window, settings) = (study.window.window(), study.solver.settings());
    PeakEnergy::new(study.scene, search.damper, variables.to_vec(), window, settings).with(study.goal())
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

/// Says where the results are, and lists them.
///
/// # Errors
/// The directory cannot be read.
pub fn where_results_are(out: &Path) -> Result<String, Error> {
    let refuse = |source| Error::Output { path: PathBuf::from(out), source };
    let entries = std::fs::read_dir(out).map_err(refuse)?;
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    Ok(format!("results in {}: {}", out.display(), names.join(" ")))
}
