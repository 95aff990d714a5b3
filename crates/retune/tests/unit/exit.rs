//! The exit codes, from inside the program.

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
        (Error::NotProven { name: name(), why: String::new() }, FAILED),
        (Error::Lines { failed: 1, lines: 24 }, FAILED),
        (Error::Run(retune_solver::SolverError::NonFinite { t: 1.5 }), FAILED),
    ];
    for (error, code) in codes {
        assert_eq!(code_of(&error), code, "{error}");
    }
}

#[test]
fn contract_every_code_stands_in_the_help_and_in_the_readme() {
    let readme = include_str!("../../../../README.md");
    for code in [0, FAILED, WRONG, INFEASIBLE, UNCHECKED, 130] {
        assert!(HELP.lines().any(|line| line.starts_with(&format!("{code:>5}  "))), "--help: {code}");
        assert!(readme.contains(&format!("| {code} | ")), "README.md: {code}");
    }
}
