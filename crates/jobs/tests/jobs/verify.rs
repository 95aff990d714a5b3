//! `verify`: results are computed again, and differences are reported.

use crate::band::ssvi_band;
use crate::{request, search};
use retune_jobs::Done;
use retune_jobs::certify::certify_file;
use retune_jobs::table2::table2;
use retune_jobs::{Error, Request, Silent, verify};
use retune_store::Error as StoreError;
use retune_testkit::desk::{Desk, tiny};
use retune_testkit::observers::{good, refused};
use retune_testkit::verified::{self, End};
use serde_json::json;
use std::path::Path;

/// The results of the tiny study in `out`.
fn desk() -> Desk {
    let desk = Desk::with(&tiny());
    search(&desk, "study.json", "out");
    desk
}

/// Verifies results; returns what was said and the end.
#[track_caller]
fn look(desk: &Desk, out: &str, sample: usize, within: f64) -> (String, End) {
    verified::look(desk, out, sample, within)
}

/// Verifies results that hold; returns what was said.
#[track_caller]
fn holds(desk: &Desk, out: &str, sample: usize) -> String {
    verified::holds(desk, out, sample)
}

#[test]
fn contract_results_are_verified_to_the_last_bit() {
    let desk = desk();
    let said = holds(&desk, "out", 7);
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "  15 files as they were made");
    assert_eq!(lines[1], "  surf.csv               7 of 24 rows run again (E1max): the same to the last bit");
    assert!(lines[2].starts_with("  fminsearch.csv         7 of "), "{said}");
    assert!(lines[3].starts_with("  fminsearch-starts.csv  7 of "), "{said}");
    assert_eq!(lines[4], "  optimum.json           its design made again: the same to the last bit");
    assert_eq!(lines[5], "  certificate.json       all of it made again: the same to the last bit");
    assert_eq!(lines[6], "holds: every file is as it was made, and all that was run or made again agrees");
    let all = holds(&desk, "out", 1000);
    assert!(all.contains("  surf.csv               24 of 24 rows run again (E1max): the same"), "{all}");
}

#[test]
fn contract_a_changed_row_is_found_by_hash_and_by_value() {
    let desk = desk();
    let surf = desk.read("out/surf.csv");
    let row = surf.lines().nth(5).expect("a row");
    let (design, energy) = row.rsplit_once(',').expect("a value");
    let other = energy.parse::<f64>().expect("a number") * (1.0 + 1e-6);
    desk.write("out/surf.csv", surf.replace(row, &format!("{design},{other}")));
    let (said, end) = look(&desk, "out", 24, 0.0);
    let differs = format!(
        "1 differs, by at most 1.0e-6 of its value: E1max in row 5 is {other:e}, now {:e}",
        energy.parse::<f64>().expect("a number")
    );
    let line = format!("  surf.csv               24 of 24 rows run again (E1max): {differs}");
    assert!(said.lines().any(|other| other == line), "{said}");
    let hash = "does not hold: surf.csv is not as it was made";
    assert_eq!(end, End::Not(format!("{hash}; surf.csv, {differs}")));
    assert_eq!(look(&desk, "out", 24, 1e-5).1, End::Not(hash.to_owned()));
}

#[test]
fn contract_another_study_beside_results_is_found() {
    let desk = desk();
    let study = desk.read("out/study.json").replace("\"k1\": 39500.0", "\"k1\": 39501.0");
    desk.write("out/study.json", study);
    desk.remove("out/convergence.svg");
    let End::Not(problem) = look(&desk, "out", 20, 0.0).1 else { panic!("it holds") };
    let words = "does not hold: convergence.svg is missing; study.json is not as it was made; \
                 study.json is not the study that made these results; surf.csv, ";
    assert!(problem.starts_with(words), "{problem}");
}

#[test]
fn contract_a_band_and_a_directory_of_results_are_verified() {
    let desk = Desk::with(&tiny());
    desk.write_json("band.json", &ssvi_band());
    search(&desk, "band.json", "all/band");
    search(&desk, "study.json", "all/inner/one");
    let said = holds(&desk, "all", 4);
    let place = |name: &str| format!("{}:\n", desk.path(name).display());
    assert!(said.starts_with(&place("all/band")), "{said}");
    assert!(said.contains("\n  band.csv               4 of 17 rows run again (E1max_none, E1max_study, E1max_tuned): the same"), "{said}");
    assert!(said.contains(&format!("\n{}", place("all/inner/one"))), "{said}");
}

#[test]
fn contract_directories_without_results_are_refused() {
    let desk = Desk::new();
    desk.write("none/a.txt", "");
    for (name, words) in [
        ("none", "cannot be read: there is no manifest.json and no study.json in it: these are no results"),
        ("nowhere", "cannot be read: No such file"),
    ] {
        let error = refused(verify::verify(&desk.path(name), 20, 0.0, &Silent));
        assert!(error.to_string().contains(words), "{error}");
        assert!(matches!(&error, Error::Store(StoreError::Input { path, .. }) if *path == desk.path(name)));
    }
}

/// Three answers: it holds, it does not, it cannot be checked.
#[test]
fn contract_what_cannot_be_checked_does_not_hold() {
    let desk = desk();
    let manifest = desk.read("out/manifest.json");
    let certificate = desk.read("out/certificate.json");
    let end = || look(&desk, "out", 3, 0.0).1;
    assert_eq!(end(), End::Holds);

    desk.remove("out/manifest.json");
    let none = "there is no manifest.json: what made these files, and whether they are as it made them";
    assert_eq!(end(), End::Unchecked(none.to_owned()));

    // A changed verdict, without the manifest.
    let said = desk.read_json("out/certificate.json")["verdict"].clone();
    assert!(said.is_string() && said != "sensitive", "{certificate}");
    let sensitive = certificate.replace(&format!("\"verdict\": {said}"), "\"verdict\": \"sensitive\"");
    desk.write("out/certificate.json", sensitive);
    let touched = "certificate.json, 1 differs, and not only in digits: verdict";
    assert_eq!(end(), End::Not(format!("does not hold: {touched}; cannot be checked: {none}")));
    desk.write("out/manifest.json", &manifest);
    assert_eq!(end(), End::Not(format!("does not hold: certificate.json is not as it was made; {touched}")));
    desk.write("out/certificate.json", &certificate);

    // A file that Retune writes but the manifest does not name.
    let line = manifest.lines().find(|line| line.contains("\"convergence.svg\"")).expect("a line");
    desk.write("out/manifest.json", manifest.replace(&format!("{line}\n"), ""));
    assert_eq!(end(), End::Unchecked("convergence.svg is not in the manifest".to_owned()));
    desk.write("out/manifest.json", "{");
    let End::Not(problem) = end() else { panic!("it holds") };
    assert!(problem.starts_with("does not hold: manifest.json, is no manifest: "), "{problem}");
    desk.write("out/manifest.json", &manifest);

    // Without the optimum the certificate still has its own design.
    let optimum = desk.read("out/optimum.json");
    desk.remove("out/optimum.json");
    let missing = "does not hold: optimum.json is missing; cannot be checked: there is no optimum.json: the design that was found";
    assert_eq!(end(), End::Not(missing.to_owned()));
    desk.write("out/optimum.json", optimum);

    // A row that no search writes.
    let surf = desk.read("out/surf.csv");
    let row = surf.lines().nth(1).expect("a row");
    desk.write("out/surf.csv", surf.replace(row, "stiff,1,2,3,low"));
    let End::Not(problem) = end() else { panic!("it holds") };
    let row = "; surf.csv, 1 differs, and not only in digits: what no command writes in row 1";
    assert!(problem.ends_with(row), "{problem}");
    desk.remove("out/study.json");
    let End::Not(problem) = end() else { panic!("it holds") };
    assert!(problem.contains("study.json is missing"), "{problem}");
}

/// Results below a directory without a manifest or study.
#[test]
fn contract_a_directory_without_a_manifest_below_is_named() {
    let desk = desk();
    desk.write("out/below/surf.csv", "k2,c2,D,C,E1max\n");
    let End::Unchecked(problem) = look(&desk, "out", 3, 0.0).1 else { panic!("it is checked") };
    assert_eq!(problem, "below: surf.csv: no manifest.json beside it says what made this");
}

/// Searches in directories below: each is there, and the one that its results were made of.
#[test]
fn contract_a_part_that_is_missing_or_another_is_found() {
    let desk = verified::desk();
    let mut stiffer = desk.read_json("study.json");
    stiffer["scene"]["primary"]["k1"] = json!(4e4);
    desk.write_json("stiffer.json", &stiffer);
    let row = |study: &str| json!({ "damper": study, "study": study, "reference": { "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 } });
    desk.write_json("table2.json", &json!({ "rows": [row("study.json"), row("stiffer.json")] }));
    good(table2(&request(&desk, "table2.json", "out"), &Silent));
    assert_eq!(look(&desk, "out", 1, 0.0).1, End::Holds);
    let names = desk.names("out");
    let parts: Vec<&String> = names.iter().filter(|name| desk.path("out").join(name).is_dir()).collect();
    let [one, .., other] = parts.as_slice() else { panic!("no two parts: {names:?}") };
    let [one, other] = [one, other].map(|name| desk.path("out").join(name));
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    std::fs::rename(&one, desk.path("aside")).expect("moved");
    let missing = format!("does not hold: {} is missing, or its manifest.json", name(&one));
    assert_eq!(look(&desk, "out", 1, 0.0).1, End::Not(missing));
    std::fs::rename(&other, &one).expect("moved");
    std::fs::rename(desk.path("aside"), &other).expect("moved");
    let End::Not(problem) = look(&desk, "out", 1, 0.0).1 else { panic!("it holds") };
    for part in [&one, &other] {
        let words = format!("{} has the results of another study than it was made with", name(part));
        assert!(problem.contains(&words), "{problem}");
    }
}

/// What a manifest says of how results were made is so.
#[test]
fn contract_a_manifest_with_another_solver_or_command_does_not_hold() {
    let desk = desk();
    let manifest = desk.read("out/manifest.json");
    for (field, other, words) in [
        ("\"method\": \"hybrid\"", "\"method\": \"ode45\"", "manifest.json, solver: study.json has another"),
        (
            "\"command\": \"optimize\"",
            "\"command\": \"sweep\"",
            "manifest.json, made_by.command: `sweep` makes no such files",
        ),
    ] {
        assert!(manifest.contains(field), "{manifest}");
        desk.write("out/manifest.json", manifest.replace(field, other));
        assert_eq!(look(&desk, "out", 1, 0.0).1, End::Not(format!("does not hold: {words}")));
    }
}

/// The tables of a search have the penalty of a design that breaks its limits; `optimum.json` has its energy. A table of designs
/// has the energy of a start that breaks the limits, and its job reports the broken limits.
#[test]
#[ignore = "slow: `just lab test-slow`"]
fn contract_results_that_break_their_limits_are_verified() {
    let mut study = tiny();
    study["optimize"]["limits"] = json!({ "stroke": 1e-6 });
    study["optimize"]["bounds"]["c2"] = json!([1, 1000]);
    study["optimize"]["objective"] = json!({ "starts": 1 });
    let desk = Desk::with(&study);
    assert!(matches!(search(&desk, "study.json", "out").check_limits(), Err(Error::Infeasible { .. })));
    holds(&desk, "out", 20);
    let value = desk.rows("out/surf.csv")[1][4].parse::<f64>().expect("a number");
    assert!(value > 1e100, "{value}");

    let paper = json!({ "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 });
    let row = json!({ "damper": "NES", "study": "study.json", "reference": paper });
    desk.write_json("table2.json", &json!({ "rows": [row] }));
    let done = good(table2(&request(&desk, "table2.json", "table"), &Silent));
    let Done::Made(table) = done else { panic!("it was finished before") };
    let error = refused(table.check_limits());
    assert!(matches!(&error, Error::Infeasible { name, .. } if name == "study"), "{error}");
    let said = holds(&desk, "table", 20);
    let line = "  table2.csv             2 of 2 rows run again (E1max, stroke, contact_force, x1max, a1max, ground_force): the same to the last bit";
    assert!(said.contains(line), "{said}");
}

/// The results of `certify` and `table2` name their studies as well, and their rows are computed again.
#[test]
fn contract_results_of_several_studies_and_certificates_are_verified_and_a_changed_digit_is_found() {
    let desk = verified::desk();
    for (study, table) in [("study.json", "certificate.json"), ("table2.json", "table2.csv")] {
        let request = request(&desk, study, "out");
        match table {
            "table2.csv" => drop(good(table2(&Request { replace: true, ..request }, &Silent))),
            _ => drop(good(certify_file(&request, &Silent))),
        }
        verified::a_changed_digit_is_found(&desk, "out", &[table]);
    }
}
