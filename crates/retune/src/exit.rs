//! What the exit code of the program says. One list: for the code, `--help` and the README.

/// The computation failed; results do not hold (`verify`); a line had no value (`evaluate`).
pub const FAILED: u8 = 1;
/// What was given is wrong, or a place cannot be read or written.
pub const WRONG: u8 = 2;
/// No design that keeps the limits: results are written, and there is no verdict.
pub const INFEASIBLE: u8 = 3;
/// `verify` could not check everything, and what it could holds.
pub const UNCHECKED: u8 = 4;
/// Stopped by Ctrl-C or SIGTERM; `--resume` goes on.
#[cfg(unix)]
pub const STOPPED: u8 = 130;

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

    #[test]
    fn contract_every_code_stands_in_the_help_and_in_the_readme() {
        let readme = include_str!("../../../README.md");
        for code in [0, FAILED, WRONG, INFEASIBLE, UNCHECKED, 130] {
            assert!(HELP.lines().any(|line| line.starts_with(&format!("{code:>5}  "))), "--help: {code}");
            assert!(readme.contains(&format!("| {code} | ")), "README.md: {code}");
        }
    }
}
