//! The exit codes of the program. One list: for the code, `--help` and the README.

use retune_jobs::Error;

/// The computation failed; results do not hold (`verify`); a line had no value (`evaluate`); a proof failed (`prove`).
pub const FAILED: u8 = 1;
/// The input is wrong, or a file or directory cannot be read or written.
pub const WRONG: u8 = 2;
/// None found that keeps the limits: the nearest design is written, and there is no verdict.
pub const INFEASIBLE: u8 = 3;
/// `verify` could not check everything, and everything it could check holds.
pub const UNCHECKED: u8 = 4;
/// Stopped by Ctrl-C or SIGTERM; `--resume` continues.
#[cfg(unix)]
pub const STOPPED: u8 = 130;

/// The exit code of a command that ends without its result: an error that the user can correct is [`WRONG`].
pub fn code_of(error: &Error) -> u8 {
    match error {
        Error::Store(_)
        | Error::Study(_)
        | Error::Setting(_)
        | Error::Rule { .. }
        | Error::Argument { .. }
        | Error::Requirement { .. }
        | Error::Interval { .. }
        | Error::Part { .. }
        | Error::MissingParts { .. } => WRONG,
        Error::Infeasible { .. } => INFEASIBLE,
        Error::NotChecked { .. } => UNCHECKED,
        Error::Threads(_)
        | Error::Run(_)
        | Error::Motion(_)
        | Error::Unusable(_)
        | Error::NoStart(_)
        | Error::Global { .. }
        | Error::Search { .. }
        | Error::Figure { .. }
        | Error::Lines { .. }
        | Error::NotProven { .. }
        | Error::NotHeld { .. } => FAILED,
    }
}

/// The list for `--help`.
pub const HELP: &str = "\
Exit codes:
    0  done; results hold (`verify`)
    1  the computation failed, results do not hold (`verify`), a line had no value (`evaluate`), or a proof failed (`prove`)
    2  the command line, a study or another file is wrong, or a file cannot be read or written
    3  none found that keeps the limits: the nearest design is written, without a verdict
    4  something cannot be checked, and all that can be holds (`verify`)
  130  stopped by Ctrl-C or SIGTERM; what was computed is kept, and --resume continues";

#[cfg(test)]
#[path = "../tests/unit/exit.rs"]
mod tests;
