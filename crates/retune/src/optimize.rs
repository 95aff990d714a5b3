//! `optimize`: from a study to a tuned damper, its log and its figures.

mod band;
mod global;
pub mod log;
mod optimum;
pub mod pictures;
mod refine;
mod surf;

pub use optimum::{Found, Optimum, table2_header, table2_row};

use crate::certify::{self, certify};
use crate::cli;
use crate::error::Error;
use crate::results::Directory;
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
    with_threads(arguments.running.threads, || {
        let optimum = optimize(&study, &out, screen)?;
        screen.line(optimum.report())?;
        screen.line(where_results_are(&out)?)
    })
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

/// Searches the best design of a study and writes all results to the directory `out`.
///
/// # Errors
/// The study does not say what to tune, nothing can be computed, or the results cannot be written.
pub fn optimize(study: &Study, out: &Path, screen: Screen) -> Result<Optimum, Error> {
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let results = Directory::create(out, is_ours)?;
    results.write_json("study.json", &study.resolved())?;

    let surf = surf::surf(study, &search, &results, screen)?;
    let explored = global::global(study, &search, screen)?;
    let mut starts = surf.as_ref().map(|surf| surf.starts(&search)).unwrap_or_default();
    let on_grid = starts.len();
    starts.extend(explored.as_ref().map(|explored| explored.starts(search.starts)).unwrap_or_default());
    starts.extend(search.given.iter().cloned());
    if starts.is_empty() {
        starts.push(search.variables.iter().map(|variable| variable.get(&search.damper)).collect());
    }
    let refined = refine::refine(study, &search, starts, &results, screen)?;
    let basins = explored.as_ref().map(|found| Basins::new(found, &search, &refined, on_grid));
    if let Some(basins) = &basins {
        basins.write(&refined.objective, &results)?;
    }

    let design = refined.objective.scene(&refined.best().minimum.x)?;
    let found = refined.objective.evaluate(&design, f64::INFINITY)?;
    let scene = found.worst_run(design, refined.objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let summary = Summary::new(study, scene, &response);
    let searched = Searched { surf: surf.as_ref(), explored: explored.as_ref(), basins };
    let certificate = certify(&Study { scene: design, ..study.clone() })?;
    results.write_json(certify::FILE, &certificate)?;
    let optimum = Optimum::new(study, &search, searched, &refined, summary, found, certificate.short());
    results.write_json("optimum.json", &optimum)?;
    pictures::draw(study, &search, surf.as_ref(), &refined, &results)?;
    if study.objective().omega.is_some() {
        band::write(study, design, &results)?;
    }
    Ok(optimum)
}

/// The objective of a study over some parameters of its damper.
fn objective(study: &Study, search: &Search, variables: &[Variable]) -> PeakEnergy {
    let (window, settings) = (study.window.window(), study.solver.settings());
    PeakEnergy::new(study.scene, search.damper, variables.to_vec(), window, settings).with(study.goal())
}

/// Whether `optimize` writes files of this name.
fn is_ours(name: &str) -> bool {
    const NAMES: [&str; 11] = [
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
