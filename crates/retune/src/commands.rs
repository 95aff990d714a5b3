//! Runs commands: turns arguments into a job and shows its results.

use crate::cli::{self, Cli, Command, Kind};
use crate::screen::{self, Screen};
use clap::CommandFactory;
use retune_jobs::design::{self, Requirements, Specification};
use retune_jobs::designs::Designs;
use retune_jobs::evaluate::Streams;
use retune_jobs::prove::Guess;
use retune_jobs::simulate::Trajectory;
use retune_jobs::sweep::Options;
use retune_jobs::sweep::Points;
use retune_jobs::tune::Optimum;
use retune_jobs::{Done, Error, Observer, Request, answer, certify, evaluate, table2, tune, verify};
use retune_jobs::{fronts, losses, retention};
use retune_model::Parameter;
use retune_study as study;
use std::io::BufReader;
use std::path::Path;

/// Runs a command.
///
/// # Errors
/// Those of its job.
pub fn run(command: Command) -> Result<(), Error> {
    match command {
        Command::Optimize { study, shard, running } => {
            let (request, screen) = running.request(&study);
            match shard {
                Some(shard) => tune::merge::share(&request, shard, &screen),
                None => found(tune::tune(&request, &screen)?),
            }
        }
        Command::Design(arguments) => design(&arguments),
        Command::Merge { study, parts, running } => {
            let (request, screen) = running.request(&study);
            found(tune::merge::merge(&request, &parts, &screen)?)
        }
        Command::Verify { results, sample, within, common } => {
            let screen = common.screen(false);
            common.request(&results).on_threads(|| verify::verify(&results, sample as usize, within, &screen))
        }
        Command::Certify { design, running } => {
            let (request, screen) = running.request(&design);
            certify::certify_file(&request, &screen)?.check_limits()
        }
        Command::Simulate(arguments) => simulate(&arguments),
        Command::Explore { study, port, no_browser, threads } => {
            let screen = Screen::new(false, false);
            let options = retune_explore::Options { study, port, browser: !no_browser, threads };
            retune_explore::explore(&options, &screen)
        }
        Command::Sweep(arguments) => sweep(arguments),
        Command::Branches(arguments) => branches(arguments),
        Command::Prove(arguments) => prove(&arguments),
        Command::Evaluate(arguments) => evaluate(&arguments),
        Command::Table2 { study, running } => {
            let (request, screen) = running.request(&study);
            made(table2::table2(&request, &screen)?, Designs::check_limits)
        }
        Command::Losses { study, running } => {
            let (request, screen) = running.request(&study);
            losses::losses(&request, &screen).map(drop)
        }
        Command::Retention { k1, study, running } => {
            let (request, screen) = running.request(&study);
            made(retention::retention(&request, &k1, &screen)?, |retained| retained.table.check_limits())
        }
        Command::Fronts { study, running } => {
            let (request, screen) = running.request(&study);
            fronts::fronts(&request, &screen).map(drop)
        }
        Command::Reproduce(arguments) => reproduce(&arguments, None),
        Command::Figure { number, paper } => reproduce(&paper, Some(&format!("figure{number}"))),
        Command::Table { number, paper } => reproduce(&paper, Some(&format!("table{number}"))),
        Command::Check { study, common } => check(&study, common),
        Command::Schema { kind } => Screen::new(false, false).line(answer::text(&match kind {
            Kind::Study => study::schema::<study::Study>(),
            Kind::Table2 => study::schema::<study::Table2>(),
            Kind::Fronts => study::schema::<study::Fronts>(),
            Kind::Paper => study::schema::<retune_jobs::paper::PaperPlan>(),
        })?),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "retune", &mut script);
            Screen::new(false, false).line(String::from_utf8_lossy(&script).trim_end())
        }
    }
}

fn design(arguments: &cli::Design) -> Result<(), Error> {
    let cli::Design { file, running, .. } = arguments;
    let given = arguments.specification()?;
    let specification = match file {
        Some(file) => Specification::read(file)?.with(given),
        None => given,
    };
    let of_mode =
        arguments.modes.as_deref().map(|table| design::structure(table, arguments.mode)).transpose()?;
    let (specification, said) = match of_mode {
        Some((structure, said)) => (specification.with(structure), Some(said)),
        None => (specification, None),
    };
    let requirements = Requirements { of_mode: said.is_some(), ..specification.requirements()? };
    let stem = file.as_deref().and_then(Path::file_stem).map(|stem| stem.to_string_lossy().into_owned());
    let name = stem.map_or("design".to_owned(), |stem| format!("design-{stem}"));
    let out = || design::place(&requirements, &name, running.resume);
    let out = running.out.clone().unwrap_or_else(out);
    let (mut request, screen) = running.request(&out);
    request.out = Some(out);
    if let Some(said) = said {
        screen.result(&said)?;
    }
    let designed = design::design(&requirements, &request, &screen)?;
    made(designed, |compared| compared.check_limits())
}

/// Refuses a design that breaks the limits of its study: it has its own exit code.
fn found(tuned: Done<Optimum>) -> Result<(), Error> {
    made(tuned, |optimum| optimum.check_limits())
}

/// Checks results unless they were finished by an earlier run.
fn made<T>(done: Done<T>, check: impl FnOnce(T) -> Result<(), Error>) -> Result<(), Error> {
    match done {
        Done::Made(results) => check(results),
        Done::FinishedBefore => Ok(()),
    }
}

fn reproduce(cli::Reproduce { study, running }: &cli::Reproduce, only: Option<&str>) -> Result<(), Error> {
    let (request, screen) = running.request(study);
    retune_jobs::paper::reproduce(&request, only, &screen).map(drop)
}

fn simulate(arguments: &cli::Simulate) -> Result<(), Error> {
    let mut study = study::read(&arguments.study)?;
    study.solver.method = arguments.solver.unwrap_or(study.solver.method);
    study.solver.contacts = arguments.contacts.unwrap_or(study.solver.contacts);
    study.solver.rtol = arguments.rtol.unwrap_or(study.solver.rtol);
    let mut study = study.with(&arguments.settings)?;
    if let Some(start) = arguments.from {
        let name = study.name().to_owned();
        study = study.beginning_at(start).map_err(|rule| Error::Rule { name, rule })?;
    }
    let inputs = [arguments.study.as_path()];
    let trajectory = arguments.trajectory.as_deref();
    let trajectory =
        trajectory.map(|file| Trajectory { file, interval: arguments.interval, inputs: &inputs });
    let request = arguments.common.request(&arguments.study);
    let summary = request.on_threads(|| retune_jobs::simulate::simulate(&study, trajectory))?;
    let text = if arguments.common.json { answer::text(&summary)? } else { summary.to_string() };
    arguments.common.screen(false).line(text)
}

fn prove(arguments: &cli::Prove) -> Result<(), Error> {
    let twice = arguments.settings.iter().any(|setting| setting.what() == Parameter::Omega.into());
    if arguments.omega.is_some() && twice {
        let problem = "omega is given by --set, too: give it once".to_owned();
        return Err(Error::Argument { option: "--omega", problem });
    }
    let request = arguments.common.request(&arguments.study);
    if let (Some(from), Some(to)) = (arguments.omega, arguments.to) {
        let band = || {
            retune_jobs::prove::prove_band(&arguments.study, &arguments.settings, [from, to], arguments.most)
        };
        let proof = request.on_threads(band)?;
        shown(&proof, &arguments.common)?;
        return proof.holds(arguments.most);
    }
    let from = arguments.from.map(|start| (start, usize::from(arguments.periods)));
    let guess = Guess { settings: arguments.settings.clone(), omega: arguments.omega, from };
    shown(&request.on_threads(|| retune_jobs::prove::prove(&arguments.study, &guess))?, &arguments.common)
}

/// Prints an answer, in words or as JSON.
fn shown(answer: &(impl serde::Serialize + std::fmt::Display), common: &cli::Common) -> Result<(), Error> {
    common.screen(false).line(if common.json { answer::text(answer)? } else { answer.to_string() })
}

fn sweep(arguments: cli::Sweep) -> Result<(), Error> {
    let cli::Sweep { study, over, from, to, unit, points, log, quantity, objective, .. } = arguments;
    let (request, screen) = arguments.running.request(&study);
    let options = Options { over, from, to, unit, points, log, quantities: quantity, objective };
    let points = Points::of(arguments.shard, arguments.merge);
    retune_jobs::sweep::sweep(&request, &options, &points, &screen)
}

fn branches(arguments: cli::Branches) -> Result<(), Error> {
    let (request, screen) = arguments.running.request(&arguments.study);
    let cli::Branches { over, from, to, samples, starts, apart, fine, margin, basins, .. } = arguments;
    let options =
        retune_jobs::branches::Options { over, from, to, samples, starts, apart, fine, margin, basins };
    retune_jobs::branches::branches(&request, &options, &screen).map(drop)
}

fn evaluate(cli::Evaluate { study, json, threads, quiet }: &cli::Evaluate) -> Result<(), Error> {
    let request = Request { threads: *threads, ..Request::new(study) };
    let streams = Streams {
        input: BufReader::new(std::io::stdin()),
        answers: &mut std::io::stdout(),
        complaints: &mut screen::complain,
    };
    let study = study::read(study)?;
    let notes = study.transient();
    notes.iter().filter(|_| !quiet).for_each(|words| (streams.complaints)(&format!("note: {words}")));
    evaluate::evaluate(&study, *json, &request, streams)
}

/// Checks a study file and prints a description of it.
fn check(path: &Path, common: cli::Common) -> Result<(), Error> {
    let described = retune_jobs::paper::describe(path)?;
    let screen = common.screen(false);
    screen.answered_with(&described.json(path))?;
    screen.result(&described.words)?;
    described.jobs.iter().try_for_each(|job| screen.result(&job.words()))?;
    screen.result(&format!("{}: good", path.display()))
}
