//! The program `retune`.

use std::process::ExitCode;

fn main() -> ExitCode {
    retune::program(std::env::args_os().collect()).into()
}
