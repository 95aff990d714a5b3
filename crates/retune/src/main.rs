//! Retune: tunes vibration dampers from the command line.

mod cli;
mod commands;
mod exit;
mod interrupt;
mod progress;
mod screen;

use clap::Parser;
use cli::Cli;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match Cli::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return screen::show_usage(&error),
    };
    match commands::run(arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            screen::show_error(&error);
            exit::code_of(&error).into()
        }
    }
}
