//! `verify`: results are computed again, and differences are reported.

mod common;

use common::{Answer, Desk, altered, tiny};
use serde_json::json;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write_json("study.json", &tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    desk
}

#[test]
fn contract_results_are_verified_to_the_last_bit() {
    let desk = desk();
    let said = desk.good(&["verify", "out", "--sample", "7"]);
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "  14 files as they were made");
    assert_eq!(lines[1], "  surf.csv               7 of 24 rows run again: the same to the last bit");
    assert!(lines[2].starts_with("  fminsearch.csv         7 of "), "{said}");
    assert!(lines[3].starts_with("  fminsearch-starts.csv  7 of "), "{said}");
    assert_eq!(lines[4], "  optimum.json           its design made again: the same to the last bit");
    assert_eq!(lines[5], "  certificate.json       all of it made again: the same to the last bit");
    assert_eq!(lines[6], "holds: every file is as it was made, and all that was run or made again agrees");
    let all = desk.good(&["verify", "out", "--sample", "1000"]);
    assert!(all.contains("  surf.csv               24 of 24 rows run again: the same"), "{all}");
}

#[test]
fn contract_a_changed_row_is_found_by_hash_and_by_value() {
    let desk = desk();
    let surf = desk.read("out/surf.csv");
    let row = surf.lines().nth(5).expect("a row");
    let (design, energy) = row.rsplit_once(',').expect("a value");
    let other = energy.parse::<f64>().expect("a number") * (1.0 + 1e-6);
    desk.write("out/surf.csv", surf.replace(row, &format!("{design},{other}")));
    let Answer { code, stdout, stderr } = desk.run(&["verify", "out", "--sample", "24"]);
    assert_eq!(code, Some(1));
    assert!(
        stdout.contains(
            "  surf.csv               24 of 24 rows run again: 1 differs, by at most 1.0e-6 of its value"
        ),
        "{stdout}"
    );
    assert_eq!(
        stderr,
        "error: out: does not hold: surf.csv is not as it was made; surf.csv, 1 differs, by at most 1.0e-6 of its value\n"
    );
    let Answer { stderr, .. } = desk.run(&["verify", "out", "--sample", "24", "--within", "1e-5"]);
    assert_eq!(stderr, "error: out: does not hold: surf.csv is not as it was made\n");
}

#[test]
fn contract_another_study_beside_results_is_found() {
    let desk = desk();
    let study = desk.read("out/study.json").replace("\"k1\": 39500.0", "\"k1\": 39501.0");
    desk.write("out/study.json", study);
    std::fs::remove_file(desk.path("out/convergence.svg")).expect("a file");
    let Answer { code, stderr, .. } = desk.run(&["verify", "out"]);
    assert_eq!(code, Some(1));
    let words = "error: out: does not hold: convergence.svg is missing; study.json is not as it was made; \
                 study.json is not the study that made these results; surf.csv, ";
    assert!(stderr.starts_with(words), "{stderr}");
}

#[test]
fn contract_a_band_and_a_directory_of_results_are_verified() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["objective"] = json!({ "omega": { "from": 6.0, "to": 6.6, "samples": 5 } });
    desk.write_json("band.json", &study);
    desk.good(&["optimize", "band.json", "--quiet", "--out", "all/band"]);
    desk.write_json("study.json", &tiny());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "all/inner/one"]);
    let said = desk.good(&["verify", "all", "--sample", "4"]);
    assert!(said.starts_with("all/band:\n"), "{said}");
    assert!(said.contains("\n  band.csv               4 of 17 rows run again: the same"), "{said}");
    assert!(said.contains("\nall/inner/one:\n"), "{said}");
}

#[test]
fn contract_directories_without_results_are_refused() {
    let desk = Desk::new();
    desk.write("none/a.txt", "");
    let Answer { code, stderr, .. } = desk.run(&["verify", "none"]);
    let words = "error: none: cannot be read: there is no manifest.json and no study.json in it: these are no results\n";
    assert_eq!((code, stderr.as_str()), (Some(2), words));
    let Answer { code, stderr, .. } = desk.run(&["verify", "nowhere"]);
    assert!(code == Some(2) && stderr.starts_with("error: nowhere: cannot be read: "), "{stderr}");
}

/// Three answers, each with its exit code: it holds, it does not, it cannot be checked.
#[test]
fn contract_what_cannot_be_checked_does_not_hold() {
    let desk = desk();
    let manifest = desk.read("out/manifest.json");
    let certificate = desk.read("out/certificate.json");
    let verify = || {
        let Answer { code, stdout, stderr } = desk.run(&["verify", "out", "--sample", "3"]);
        assert_eq!(code == Some(0), stdout.contains("\nholds: "), "{stdout}");
        (code, stderr)
    };
    assert_eq!(verify(), (Some(0), String::new()));

    let path = desk.path("out/manifest.json");
    std::fs::remove_file(&path).expect("a manifest");
    let none = "there is no manifest.json: what made these files, and whether they are as it made them";
    assert_eq!(verify(), (Some(4), format!("error: out: cannot be checked: {none}\n")));

    // A changed verdict, without the manifest.
    assert!(certificate.contains("\"verdict\": \"robust\""), "{certificate}");
    desk.write(
        "out/certificate.json",
        certificate.replace("\"verdict\": \"robust\"", "\"verdict\": \"sensitive\""),
    );
    let touched = "certificate.json, 1 differs, and not only in digits";
    let expected = format!("error: out: does not hold: {touched}; cannot be checked: {none}\n");
    assert_eq!(verify(), (Some(1), expected));
    desk.write("out/manifest.json", &manifest);
    let expected = format!("error: out: does not hold: certificate.json is not as it was made; {touched}\n");
    assert_eq!(verify(), (Some(1), expected));
    desk.write("out/certificate.json", &certificate);

    // A file that Retune writes but the manifest does not name.
    let line = manifest.lines().find(|line| line.contains("\"convergence.svg\"")).expect("a line");
    desk.write("out/manifest.json", manifest.replace(&format!("{line}\n"), ""));
    let expected = "error: out: cannot be checked: convergence.svg is not in the manifest\n";
    assert_eq!(verify(), (Some(4), expected.to_owned()));
    desk.write("out/manifest.json", "{");
    assert!(verify().1.starts_with("error: out: does not hold: manifest.json, is no manifest: "));
    desk.write("out/manifest.json", &manifest);

    // Without the optimum the certificate still has its own design.
    let optimum = desk.read("out/optimum.json");
    std::fs::remove_file(desk.path("out/optimum.json")).expect("an optimum");
    let expected = "error: out: does not hold: optimum.json is missing; cannot be checked: there is no optimum.json: the design \
                    that was found\n";
    assert_eq!(verify(), (Some(1), expected.to_owned()));
    desk.write("out/optimum.json", optimum);

    // A row that no search writes.
    let surf = desk.read("out/surf.csv");
    let row = surf.lines().nth(1).expect("a row");
    desk.write("out/surf.csv", surf.replace(row, "stiff,1,2,3,low"));
    let (code, said) = verify();
    assert_eq!(code, Some(1));
    assert!(said.ends_with("; surf.csv, 1 differs, and not only in digits\n"), "{said}");
    std::fs::remove_file(desk.path("out/study.json")).expect("a study");
    let (code, said) = verify();
    assert!(code == Some(1) && said.contains("study.json is missing"), "{said}");
}

/// Results below a directory without a manifest or study.
#[test]
fn contract_a_directory_without_a_manifest_below_is_named() {
    let desk = desk();
    desk.write("out/below/surf.csv", "k2,c2,D,C,E1max\n");
    let Answer { code, stderr, .. } = desk.run(&["verify", "out", "--sample", "3"]);
    assert_eq!(code, Some(4), "{stderr}");
    assert!(stderr.starts_with("error: out: cannot be checked: below/there is no manifest.json"), "{stderr}");
}

/// The tables of a search have the penalty of a design that breaks its limits; `optimum.json` has its energy.
#[test]
fn contract_results_that_break_their_limits_are_verified() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["limits"] = json!({ "stroke": 1e-6 });
    desk.write_json("none.json", &study);
    assert_eq!(desk.run(&["optimize", "none.json", "--quiet", "--out", "out"]).code, Some(3));
    let said = desk.good(&["verify", "out"]);
    assert!(said.contains("\nholds: "), "{said}");
    let surf = desk.read("out/surf.csv");
    let row = surf.lines().nth(1).expect("a row");
    let value = row.rsplit(',').next().expect("a value");
    assert!(value.parse::<f64>().is_ok_and(|value| value > 1e100), "{value}");
}

/// A table has the energy of a start that breaks the limits, and its command reports the broken limits.
#[test]
fn contract_a_table_of_designs_that_break_their_limits_is_verified() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["limits"] = json!({ "stroke": 1e-6 });
    desk.write_json("none.json", &study);
    let paper = json!({ "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 });
    desk.write_json(
        "table2.json",
        &json!({ "rows": [{ "damper": "NES", "study": "none.json", "paper": paper }] }),
    );
    let Answer { code, stderr, .. } = desk.run(&["table2", "table2.json", "--quiet", "--out", "out"]);
    assert_eq!(code, Some(3));
    assert!(stderr.starts_with("error: study none: the limits are not kept: "), "{stderr}");
    let said = desk.good(&["verify", "out"]);
    assert!(
        said.contains("  table2.csv             2 of 2 rows run again: the same to the last bit"),
        "{said}"
    );
}

/// The results of `certify`, `fronts` and `retune` name their studies as well, and their rows are computed again.
#[test]
fn contract_results_of_several_studies_and_certificates_are_verified_and_a_changed_digit_is_found() {
    let desk = Desk::new();
    let mut study = tiny();
    study["optimize"]["surf"] = json!(null);
    study["optimize"]["vary"] = json!(["k2", "c2"]);
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 8 });
    study["optimize"]["objective"] = json!({ "omega": { "from": 6.0, "to": 6.6, "samples": 2 } });
    desk.write_json("one.json", &study);
    let damper = json!({ "damper": "NES, \"single-sided\"", "study": "one.json" });
    let mut row = damper.clone();
    row["paper"] = json!({ "k2": 215, "c2": 232, "D": 0.06, "C": 0.36 });
    desk.write_json("table2.json", &json!({ "rows": [row] }));
    desk.write_json(
        "fronts.json",
        &json!({ "dampers": [damper], "k2": [300], "stroke": [0.9], "samples": 5 }),
    );
    for (arguments, tables) in [
        (["certify", "one.json"].as_slice(), ["certificate.json"].as_slice()),
        (&["table2", "table2.json"], &["table2.csv"]),
        (&["track", "3e4", "--study", "table2.json"], &["retune.csv", "retention.csv"]),
        (&["fronts", "fronts.json"], &["k2.csv", "stroke.csv", "front.csv"]),
    ] {
        let out = arguments[0];
        desk.good(&[arguments, &["--quiet", "--out", out]].concat());
        let said = desk.good(&["verify", out]);
        assert!(said.contains("files as they were made\n"), "{said}");
        for table in tables {
            let line = said.lines().find(|line| line.starts_with(&format!("  {table} "))).expect(table);
            assert!(line.ends_with("again: the same to the last bit"), "{line}");
            assert!(!line.contains(" 0 of "), "{line}");
            let file = format!("{out}/{table}");
            let whole = desk.read(&file);
            desk.write(&file, altered(&whole));
            let Answer { code, stderr, .. } = desk.run(&["verify", out, "--sample", "1000"]);
            assert_eq!(code, Some(1), "{table}: {stderr}");
            assert!(stderr.contains(&format!("{table} is not as it was made; ")), "{stderr}");
            assert!(stderr.contains(&format!("{table}, 1 differs, by at most ")), "{stderr}");
            desk.write(&file, whole);
        }
    }
}
