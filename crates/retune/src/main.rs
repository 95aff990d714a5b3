//! Retune: tunes vibration dampers from the command line.

mod certify;
mod check;
mod cli;
mod error;
mod evaluate;
mod exit;
mod figure;
mod fronts;
mod interrupt;
mod optimize;
mod paper;
mod progress;
mod results;
mod retention;
mod screen;
mod simulate;
mod study;
mod summary;
mod tables;
mod verify;

use clap::{CommandFactory, Parser};
use cli::{Cli, Command, Kind};
use error::Error;
use screen::Screen;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match Cli::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return screen::show_usage(&error),
    };
    match run(arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            screen::show_error(&error);
            error.exit_code()
        }
    }
}

fn run(command: Command) -> Result<(), Error> {
    match command {
        Command::Optimize(arguments) => optimize::command(&arguments),
        Command::Merge(arguments) => optimize::merge::command(&arguments),
        Command::Verify(arguments) => verify::command(&arguments),
        Command::Certify(arguments) => certify::command(&arguments),
        Command::Simulate(arguments) => simulate::simulate(&arguments),
        Command::Evaluate(arguments) => evaluate::evaluate(&arguments),
        Command::Table2(arguments) => tables::table2(&arguments),
        Command::Retune(arguments) => retention::retune(&arguments),
        Command::Fronts(arguments) => fronts::fronts(&arguments),
        Command::Reproduce(arguments) => paper::reproduce(&arguments),
        Command::Figure { number, paper } => paper::one(&format!("figure{number}"), &paper),
        Command::Table { number, paper } => paper::one(&format!("table{number}"), &paper),
        Command::Check { study } => check::check(&study),
        Command::Schema { kind: Kind::Study } => print_schema(&schemars::schema_for!(study::Study)),
        Command::Schema { kind: Kind::Table2 } => print_schema(&schemars::schema_for!(study::Table2)),
        Command::Schema { kind: Kind::Fronts } => print_schema(&schemars::schema_for!(study::Fronts)),
        Command::Schema { kind: Kind::Paper } => print_schema(&schemars::schema_for!(paper::PaperPlan)),
        Command::Completions { shell } => print_completions(shell),
    }
}

fn print_schema(schema: &schemars::Schema) -> Result<(), Error> {
    Screen::new(false).line(simulate::json(schema)?)
}

fn print_completions(shell: clap_complete::Shell) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "retune", &mut script);
    Screen::new(false).line(String::from_utf8_lossy(&script).trim_end())
}
