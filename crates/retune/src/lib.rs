//! Retune: tunes vibration dampers from the command line. A library, so that the Python package installs the same program.

mod cli;
mod commands;
mod exit;
mod interrupt;
mod progress;
mod screen;

use clap::Parser;
use cli::Cli;
use std::ffi::OsString;

/// Runs the program with the words of its command line, the first being its own name. Returns its exit code.
pub fn program(words: Vec<OsString>) -> u8 {
    let arguments = match Cli::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(error) => return screen::show_usage(&error),
    };
    interrupt::remember(words);
    match commands::run(arguments.command) {
        Ok(()) => 0,
        Err(error) => {
            screen::show_error(&error);
            exit::code_of(&error)
        }
    }
}
