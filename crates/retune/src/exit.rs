//! The exit codes of the program. One list: for the code, `--help` and the README.

use retune_workbench::Error;

/// The computation failed; results do not hold (`verify`); a line had no value (`evaluate`).
pub const FAILED: u8 = 1;
/// The input is wrong, or a file or directory cannot be read or written.
pub const WRONG: u8 = 2;
/// No design that keeps the limits: results are written, and there is no verdict.
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
        | Error::Sweep(_)
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
        | Error::NotHeld { .. } => FAILED,
    }
}

/// The list for `--help`.
pub const HELP: &str = "\
Exit codes:
    0  done; results hold (`verify`)
    1  the computation failed, results do not hold (`verify`), or a line had no value (`evaluate`)
    2  the command line, a study or another file is wrong, or a file cannot be read or written
    3  no design that keeps the limits was found: the nearest is written, without a verdict
    4  something cannot be checked, and all that can be holds (`verify`)
  130  stopped by Ctrl-C or SIGTERM; what was computed is kept, and --resume goes on";

#[cfg(test)]
mod tests {
    use super::*;

    /// An error that the user can correct has exit code 2, a failed computation 1; broken limits, and results that cannot be
    /// checked, have their own codes.
    #[test]
    fn contract_exit_codes_say_whose_fault_it_is() {
        let source = || std::io::Error::from(std::io::ErrorKind::StorageFull);
        let place = || std::path::PathBuf::from("results/ssvi");
        let name = || "ssvi".to_owned();
        let codes = [
            (Error::Store(retune_store::Error::Output { path: place(), source: source() }), WRONG),
            (Error::Store(retune_store::Error::Busy { path: place(), holder: None }), WRONG),
            (Error::Rule { name: name(), rule: retune_study::Rule::NoOptimize }, WRONG),
            (Error::Infeasible { name: name(), words: String::new() }, INFEASIBLE),
            (Error::NotChecked { path: place(), problem: String::new() }, UNCHECKED),
            (Error::NotHeld { path: place(), problem: String::new() }, FAILED),
            (Error::Lines { failed: 1, lines: 24 }, FAILED),
            (Error::Run(retune_solver::SolverError::NonFinite { t: 1.5 }), FAILED),
        ];
        for (error, code) in codes {
            assert_eq!(code_of(&error), code, "{error}");
        }
    }

    #[test]
    fn contract_every_code_stands_in_the_help_and_in_the_readme() {
        let readme = include_str!("../../../README.md");
        for code in [0, FAILED, WRONG, INFEASIBLE, UNCHECKED, 130] {
            assert!(HELP.lines().any(|line| line.starts_with(&format!("{code:>5}  "))), "--help: {code}");
            assert!(readme.contains(&format!("| {code} | ")), "README.md: {code}");
        }
    }
}
